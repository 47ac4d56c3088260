"""Recordings: made on a virtual rig, and measured."""

from __future__ import annotations

import csv
import io
import os
import warnings as _warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from threading import Thread
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._table import Floats, Tabled, dataset, frame, lines, span, unit
from .errors import ExperimentWarning, OptionError
from .results import PowerLaw

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Campaigned", "Case", "Measured", "campaign", "measure"]

Path_ = str | os.PathLike[str]


@dataclass(frozen=True, repr=False)
class Campaigned(Tabled):
    """What a run of a campaign has done: a table of one row.

    Attributes
    ----------
    folder : Path
        Where the recordings are, one HDF5 file a series.
    kept, run : int
        Series that were there before, and series run now.
    shots : int
        Shots fired now.
    bytes : int
        Size of all recordings of this part.
    failed : list of str
        Series that can't be computed, each with the reason; the others are there.
    seed : int
        Of all that is random.

    References
    ----------
    The virtual rig: docs/rig.md; the paper's: [Labbe2017].
    """

    folder: Path
    kept: int
    run: int
    shots: int
    bytes: int
    failed: list[str]
    seed: int

    @property
    def files(self) -> list[Path]:
        """The recordings, by name."""
        return sorted(self.folder.glob("*.h5"))

    def _columns(self) -> dict[str, list[Any]]:
        return {
            "folder": [str(self.folder)], "kept": [self.kept], "run": [self.run], "shots": [self.shots],
            "bytes": [self.bytes], "failed": [len(self.failed)], "seed": [self.seed],
        }  # fmt: skip

    def _units(self) -> dict[str, str]:
        return {"bytes": "B"}

    def __repr__(self) -> str:
        rows = {"series": f"{self.run} run now, {self.kept} kept", "shots": str(self.shots), "size": f"{self.bytes / 1e6:.3g} MB", "seed": str(self.seed)}
        rows |= {f"failed {at}": why for at, why in enumerate(self.failed, 1)}
        return lines(f"Campaign in {self.folder}", rows)


def campaign(
    experiment: Experiment,
    out: Path_,
    *,
    shard: str = "1/1",
    seed: int | None = None,
    threads: int | None = None,
    progress: object = None,
) -> Campaigned:
    """Runs a campaign on a virtual rig: taps and shots, recorded as by a real one.

    Files are the same bytes whatever the number of threads; a run that was
    broken off goes on where it stood.

    Parameters
    ----------
    experiment : Experiment
        With a ``[campaign]``, such as ``hertzchain.preset("paper")``.
    out : path
        Folder to write recordings into.
    shard : str
        Only the i-th of n parts, as ``"i/n"``: series are dealt out like cards.
    seed : int, optional
        In place of the experiment's.
    threads, progress
        As for `sweep`; progress counts shots.

    Returns
    -------
    Campaigned
        Where recordings are and how many; series that can't be computed are told in it.

    Raises
    ------
    OptionError, ExperimentError
        An experiment that no rig can do, a folder with something else in it.
    InternalError
        A recording that can't be written.

    Warns
    -----
    ExperimentWarning
        A record that ends before the wave is back, a rate of few samples a pulse.

    References
    ----------
    The rig and its runs: docs/rig.md, after [Labbe2017].
    """
    with options.progress(progress, None, "shot") as update:
        done = _native.campaign(experiment, out, shard, seed, options.count("threads", threads), update)
    for text in done.pop("warnings"):
        _warnings.warn(text, ExperimentWarning, stacklevel=2)
    return Campaigned(folder=Path(out), **done)


@dataclass(frozen=True, repr=False, eq=False)
class Case:
    """A measured curve: one row a speed.

    Attributes
    ----------
    name : str
        Name of the case, such as ``"dry"``.
    columns : dict of str to ndarray, shape (speeds,)
        ``speed_m_s``, ``tof_incident_s`` … with ``*_error`` for standard errors, and
        ``tof_correlation`` of those of both times, which share the wall's pick.
    power_law_incident, power_law_reflected : PowerLaw or None
        Weighted fits.

    References
    ----------
    From shots to curves: docs/measuring.md.
    """

    name: str
    columns: dict[str, Floats]
    power_law_incident: PowerLaw | None
    power_law_reflected: PowerLaw | None

    def __getitem__(self, column: str) -> Floats:
        return self.columns[column]

    def to_pandas(self) -> pd.DataFrame:
        """The curve as pandas has it.

        Returns
        -------
        pandas.DataFrame
            One row a speed; units in ``attrs["units"]``.
        """
        return frame(self.columns, False)

    def to_xarray(self) -> xr.Dataset:
        """The curve as xarray has it.

        Returns
        -------
        xarray.Dataset
            One variable a column over ``speed_m_s``, its unit in ``attrs["units"]``.
        """
        rest = {name: (("speed_m_s",), values) for name, values in self.columns.items() if name != "speed_m_s"}
        return dataset(rest, {"speed_m_s": (("speed_m_s",), self.columns["speed_m_s"])}, False, {"case": self.name})

    def __repr__(self) -> str:
        names = ("speed_m_s", "tof_incident_s", "tof_reflected_s")
        return lines(f"Case {self.name or '(unnamed)'}, {self.columns['speed_m_s'].size} speeds", {name: span(self.columns[name], name) for name in names})


@dataclass(frozen=True, repr=False, eq=False)
class Measured:
    """What came of a set of recordings.

    Attributes
    ----------
    shots : list of dict
        Every record: file, case, times of flight with errors in s, peaks in V, flags.
    cases : dict of str to Case
        One curve a case.
    ratios : list of dict
        Times of flight of each case over the reference's.
    refused : list of str
        What could not be read.
    lost : list
        Speeds of cases at which no shot has a time that counts, with the number of shots.
    low_pass : dict or None
        Corner in Hz and order of the amplifier's low-pass that maxima are corrected for.
    notes, unmatched : list
        What was taken for granted; what table and recordings do not find in each other.
    verdict : str or None
        What was refused or not found, as the program ends with.
    tables : dict of str to str
        The program's tables as text: ``shots.csv``, ``speeds.csv`` …

    References
    ----------
    What is measured, and how sure: docs/measuring.md.
    """

    shots: list[dict[str, Any]]
    cases: dict[str, Case]
    ratios: list[dict[str, Any]]
    notes: list[dict[str, Any]]
    low_pass: dict[str, float] | None
    unmatched: list[str]
    lost: list[dict[str, Any]]
    refused: list[str]
    verdict: str | None
    tables: dict[str, str]

    def to_pandas(self) -> pd.DataFrame:
        """All records as pandas has them, as in ``shots.csv``.

        Returns
        -------
        pandas.DataFrame
            One row a record; units in ``attrs["units"]``.
        """
        import pandas as pd

        titles, *rows = csv.reader(io.StringIO(self.tables["shots.csv"]))
        made = pd.DataFrame({title: _numbers([row[at] for row in rows]) for at, title in enumerate(titles)})
        made.attrs["units"] = {str(name): unit(str(name)) for name in made.columns}
        return made

    def to_xarray(self) -> xr.Dataset:
        """All records as xarray has them.

        Returns
        -------
        xarray.Dataset
            One variable a column over ``record``, its unit in ``attrs["units"]``.
        """
        made = self.to_pandas().rename_axis("record").to_xarray()
        for name in made.data_vars:
            made[name].attrs["units"] = unit(str(name))
        return made

    def save(self, folder: Path_) -> list[Path]:
        """Writes the tables into a folder; tables without rows are left out.

        Parameters
        ----------
        folder : path
            Made if need be.

        Returns
        -------
        list of Path
            The files.
        """
        into = Path(folder)
        into.mkdir(parents=True, exist_ok=True)
        written: list[Path] = []
        for name, text in self.tables.items():
            if text.count("\n") > 1:
                (into / name).write_text(text, encoding="utf-8")
                written.append(into / name)
        return written

    def __repr__(self) -> str:
        timed = sum("missing" not in shot for shot in self.shots)
        rows = {"times of flight": f"{timed} of {len(self.shots)} records"}
        rows |= {case.name or "(unnamed)": f"{case['speed_m_s'].size} speeds" for case in self.cases.values()}
        if self.refused:
            rows["refused"] = str(len(self.refused))
        return lines("Measured", rows)


def measure(
    records: Path_ | Iterable[Path_] | NDArray[Any],
    *,
    rate: str | float | None = None,
    trust_rate: bool = False,
    channel: str | int | Iterable[str | int] = (),
    time_unit: Literal["s", "ms", "us", "ns"] | None = None,
    shot_samples: int | None = None,
    level: float | None = None,
    whole: bool = False,
    rows: Literal["shots", "channels", "times", "moments"] | None = None,
    method: Literal["local", "onset", "correlation", "shape"] = "local",
    onset: float = 0.5,
    beads: int | None = None,
    sensor: int | None = None,
    polarity: Literal["positive", "negative"] | None = None,
    wall_polarity: Literal["positive", "negative"] | None = None,
    smooth: str | float | None = None,
    low_pass: str | float | None = None,
    filter: str | None = None,
    ac_coupling: str | float | None = None,
    rig: Path_ | None = None,
    shots: Path_ | None = None,
    speed_error: float | None = None,
    speed_gap: float = 0.01,
    reference: str = "dry",
    keep_dubious: bool = False,
    threads: int | None = None,
    progress: object = None,
    high_pass: str | float | None = None,
    bandwidth: str | float | None = None,
    bandwidth_order: str | None = None,
) -> Measured:
    """Measures times of flight on recordings of any rig, with errors and curves.

    Parameters
    ----------
    records : path, iterable of paths, or ndarray
        Files (HDF5 of a campaign, text, NPY, NPZ, WAV, TDMS) or folders of them;
        or volts as an array of shape (samples,) or (shots, samples), with ``rate``;
        what else rows of an array are, ``rows`` tells.
    rate : float or str, optional
        Sampling rate in Hz, or as ``"1MHz"``.
    rig : path or str, optional
        Experiment file or preset of the rig.
    shots : path, optional
        Table of speeds and cases: file, case, speed, speed error.
    speed_error, speed_gap : float
        In m/s: standard error where nobody tells one; speeds nearer than the gap are one.
    threads, progress
        As for `sweep`; progress counts records.
    channel : str, int or iterable, optional
        Channel, column or array by name or number from 1; two: the sensor bead's, the wall's.
    method : {"local", "onset", "correlation", "shape"}
        How pulses are timed.
    smooth : str or float, optional
        Corner in Hz of a low-pass to apply, without delay.
    low_pass, filter : str or float, str, optional
        Corner in Hz (0 leaves times as they are), and order and kind, of the amplifier's low-pass,
        whose delay and rounding are taken out of maxima.
    ac_coupling : str or float, optional
        Corner in Hz of the AC coupling (high-pass) that the signal went through: its droop is
        corrected. 0 leaves it.
    high_pass, bandwidth, bandwidth_order : optional
        The former names of ``ac_coupling``, ``low_pass`` and ``filter``: rejected.
    level : float, optional
        In V: where shots of a long recording begin.
    trust_rate, time_unit, shot_samples, whole, rows, onset, beads, sensor, polarity, \
wall_polarity, reference, keep_dubious
        As the options of ``hertzchain measure``.

    Returns
    -------
    Measured
        Times in s with standard errors, peaks in V. Bad records are told in it one by one,
        the rest is measured.

    Raises
    ------
    OptionError
        Options that do not go together, a folder without recordings.

    Notes
    -----
    The numbers are those of ``hertzchain measure --json``, bit for bit.

    References
    ----------
    How pulses are timed and how sure that is: docs/measuring.md.
    """
    if isinstance(records, np.ndarray) and records.ndim == 2:
        # The shape of an array of many short shots would mislead.
        rows = rows or "shots"
    channels = [channel] if isinstance(channel, (str, int)) else list(channel)
    told = options.words(
        rate=rate, trust_rate=trust_rate, time_unit=time_unit, shot_samples=shot_samples, level=level, whole=whole,
        rows=rows, method=method, onset=onset, beads=beads, sensor=sensor, polarity=polarity,
        wall_polarity=wall_polarity, smooth=smooth, low_pass=low_pass, filter=filter, ac_coupling=ac_coupling, high_pass=high_pass,
        bandwidth=bandwidth, bandwidth_order=bandwidth_order, rig=rig, shots=shots,
        speed_error=speed_error, speed_gap=speed_gap, reference=reference, keep_dubious=keep_dubious,
    )  # fmt: skip
    told += [f"--channel={name}" for name in channels]
    with _folder() as folder, options.progress(progress, None, "record") as update:
        files = _files(records, folder)
        found = _native.measure([*told, "--", *files], options.count("threads", threads), update)
    cases = [_case(case) for case in found.pop("cases")]
    return Measured(cases={case.name: case for case in cases}, **found)


@contextmanager
def _folder() -> Iterator[Path]:
    """A folder for arrays, removed afterwards while others go on: of a gigabyte that takes a tenth of a second."""
    folder = mkdtemp(prefix="hertzchain-")
    try:
        yield Path(folder)
    finally:
        Thread(target=rmtree, args=(folder, True)).start()


def _files(records: Path_ | Iterable[Path_] | NDArray[Any], folder: Path) -> list[str]:
    if isinstance(records, np.ndarray):
        if records.dtype.kind not in "fiu" or records.ndim not in (1, 2) or records.size == 0:
            raise OptionError(f"records of {records.dtype} and shape {records.shape}: expected volts of shape (samples,) or (shots, samples)")
        return [_saved(records, folder / "array.npy")]
    if isinstance(records, (str, os.PathLike)):
        return [os.fspath(records)]
    return [os.fspath(record) for record in records]


PIECE = 1 << 20
"""Samples that are written in a go: signals are heard between two."""


def _saved(records: NDArray[Any], path: Path) -> str:
    """An array of any layout as a file of NumPy."""
    header = {"descr": np.lib.format.dtype_to_descr(records.dtype), "fortran_order": False, "shape": records.shape}
    table = records.reshape(1, -1) if records.ndim == 1 else records
    rows, columns = table.shape
    together = max(1, PIECE // columns)
    with open(path, "wb") as file:
        np.lib.format.write_array_header_1_0(file, header)
        for first in range(0, rows, together):
            for left in range(0, columns, PIECE):
                file.write(table[first : first + together, left : left + PIECE].tobytes())
    return str(path)


def _numbers(cells: list[str]) -> NDArray[Any] | list[str]:
    """Cells of a column, with all their digits where they are numbers; NaN where they are empty."""
    try:
        if all(cell.isdigit() for cell in cells):
            return np.array(cells, dtype=int)
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return cells


def _case(raw: Mapping[str, Any]) -> Case:
    columns: dict[str, list[float]] = {}

    def put(name: str, value: float | None) -> None:
        columns.setdefault(name, []).append(np.nan if value is None else value)

    for row in raw["speeds"]:
        put("speed_m_s", row["speed_m_s"]["value"])
        put("speed_error_m_s", row["speed_m_s"]["sigma"])
        put("shots", row["shots"])
        for name in ("tof_incident_s", "tof_reflected_s", "wall_over_passing", "returning_over_passing"):
            found = row[name] or {}
            put(name, found.get("mean"))
            put(f"{name}_error", found.get("error"))
        put("tof_correlation", row["tof_correlation"])
    laws = (raw["power_law_incident"], raw["power_law_reflected"])
    made = {name: np.array(values, dtype=float) for name, values in columns.items()}
    return Case(raw["case"], made, *(PowerLaw.of(law) for law in laws))
