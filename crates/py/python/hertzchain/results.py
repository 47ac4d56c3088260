"""Results: numbers in SI as NumPy arrays, for pandas, xarray, files and people."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import warnings as _warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .errors import CONTROLS, ExperimentWarning, Finding

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = [
    "CampaignResult", "Case", "Description", "DesignResult", "Ensemble", "FitResult", "GaugeResult", "Group",
    "LawInfo", "MeasureResult", "Parameter", "PowerLaw", "Result", "Row", "Shot", "Sweep", "Trace",
    "WarningSummary",
]  # fmt: skip

Floats = NDArray[np.float64]
Variable = tuple[tuple[str, ...], Any]
"""Names of dimensions, and values."""

_ENDINGS = {"_beads_per_s": "beads/s", "_m_s": "m/s", "_s": "s", "_n": "N", "_j": "J", "_m": "m", "_v": "V", "_nats": "nat", "bytes": "B"}


def unit(name: str, dimensionless: bool = False) -> str:
    """SI unit of a column by the end of its name, of its uncertainty too; "1" for plain numbers."""
    if dimensionless:
        return "1"
    name = re.sub("_sigma|_(error|deviation|err|std)$", "", name)
    return next((unit for ending, unit in _ENDINGS.items() if name.endswith(ending)), "1")


class Result:
    """Base of all results: a table with units for pandas, xarray, files and people."""

    _index: ClassVar[str | None] = None
    _dimension: ClassVar[str] = "row"
    _fields: ClassVar[tuple[str, ...]] = ()
    _rows: ClassVar[str | None] = None
    _printed: ClassVar[tuple[str, ...]] = ()

    def _columns(self) -> Mapping[str, Sequence[Any] | NDArray[Any]]:
        """The table: columns of one length; by default the fields of the rows, or of this as one row."""
        if self._rows is not None:
            return {name: [row.get(name) for row in getattr(self, self._rows)] for name in self._fields}
        return {name: [_cell(getattr(self, name))] for name in self._fields}

    def _variables(self) -> Mapping[str, Variable]:
        """What xarray gets; the table over its index."""
        return {name: ((self._index or self._dimension,), _array(values)) for name, values in self._columns().items()}

    def _coordinates(self) -> tuple[str, ...]:
        """Coordinates beside those that xarray knows as such: variables with the name of a dimension."""
        return ()

    def _units(self) -> Mapping[str, Any]:
        """Units of columns and variables whose names do not end in theirs."""
        return {}

    def _attributes(self) -> Mapping[str, Any]:
        return {}

    def _summary(self) -> tuple[str, Mapping[str, str]]:
        """Title and rows as printed."""
        raise NotImplementedError

    def _unit(self, name: str) -> Any:
        return self._units().get(name) or unit(name, getattr(self, "dimensionless", False))

    @property
    def units(self) -> dict[str, str]:
        """SI units of the table's columns, by name."""
        return {name: self._unit(name) for name in self._columns()}

    def to_pandas(self) -> pd.DataFrame:
        """The table for pandas.

        Returns
        -------
        pandas.DataFrame
            Units of all columns, by name, in ``attrs["units"]``.
        """
        import pandas as pd

        made = pd.DataFrame(dict(self._columns()))
        made.attrs["units"] = self.units
        return made if self._index is None else made.set_index(self._index)

    def to_xarray(self) -> xr.Dataset:
        """The numbers for xarray.

        Returns
        -------
        xarray.Dataset
            One variable a column, its unit in ``attrs["units"]``.
        """
        import xarray as xr

        coordinates = self._coordinates()
        made = {name: (*part, {"units": self._unit(name)}) for name, part in self._variables().items()}
        attributes = {name: value for name, value in self._attributes().items() if value is not None}
        data = {name: part for name, part in made.items() if name not in coordinates}
        return xr.Dataset(data, {name: made[name] for name in coordinates}, attributes)

    def save(self, path: str | os.PathLike[str]) -> list[Path]:
        """Writes the table as CSV; or, into a file that ends in ``.json``, all of ``details``.

        Parameters
        ----------
        path : path
            The file.

        Returns
        -------
        list of Path
            What was written.
        """
        path = Path(path)
        if path.suffix == ".json":
            whole = getattr(self, "details", None) or {name: _array(values).tolist() for name, values in self._columns().items()}
            path.write_text(json.dumps(whole, indent=2, default=str), encoding="utf-8")
        else:
            path.write_text(csv_text(self._columns()), encoding="utf-8")
        return [path]

    def __getitem__(self, name: str) -> Any:
        # Columns of an ensemble have its shape; in its table they are flat.
        columns = self.__dict__.get("columns", {})
        return columns[name] if name in columns else self._columns()[name]

    def __getattr__(self, name: str) -> Any:
        # Keys of the program's JSON, and columns, that have no attribute of their own.
        for held in ("details", "columns"):
            if name in (own := self.__dict__.get(held, ())):
                return own[name]
        raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")

    def __repr__(self) -> str:
        title, rows = self._summary()
        width = max((len(name) for name in rows), default=0)
        return "\n".join([title, *(f"  {name:<{width}}  {value}" for name, value in rows.items()), *self._lines()]).translate(CONTROLS)

    def _lines(self, most: int = 10) -> list[str]:
        """The first rows of the printed columns, right-aligned under their names."""
        columns = self._columns()
        shown = [name for name in (*self._coordinates(), *self._printed) if name in columns]
        count = len(columns[shown[0]]) if shown else 0
        cells = [[name, *(str(short(one, 7) if isinstance(one, float) else one) for one in columns[name][:most])] for name in shown]
        widths = [max(map(len, column)) for column in cells]
        lines = ["  " + "  ".join(f"{cell:>{width}}" for cell, width in zip(row, widths, strict=True)) for row in zip(*cells, strict=True)]
        return lines + ([f"  … and {count - most} more"] if count > most else [])


def _array(values: Sequence[Any] | NDArray[Any]) -> NDArray[Any]:
    """As an array of one dimension; lists and dicts stay what they are."""
    if isinstance(values, np.ndarray):
        return values
    if all(isinstance(value, (bool, int, float, str)) for value in values):
        return np.array(values)
    made = np.empty(len(values), dtype=object)
    made[:] = list(values)
    return made


def csv_text(columns: Mapping[str, Sequence[Any] | NDArray[Any]]) -> str:
    """Columns as CSV with all digits."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([list(columns), *zip(*columns.values(), strict=True)])
    return text.getvalue()


def _cell(value: Any) -> Any:
    """As in a table: NaN for None, a count for a list, text for a path."""
    if isinstance(value, list):
        return len(value)
    return str(value) if isinstance(value, Path) else number(value)


def number(value: float | None) -> float:
    """NaN for None."""
    return float("nan") if value is None else value


def short(value: float | None, digits: int = 6) -> str:
    """A number for people; a dash for None."""
    return "–" if value is None or np.isnan(value) else f"{value:.{digits}g}"


@dataclass(frozen=True, eq=False, repr=False)
class Trace(Result):
    """Sampled signals of sensors during a shot.

    Attributes
    ----------
    time_s : ndarray, shape (samples,)
        Times in s, from the first touch on.
    signals : dict of str to ndarray, shape (samples,)
        By sensor: ``bead_7`` and ``contact_40`` in N, ``position_3`` in m,
        ``velocity_3`` in m/s, ``bead_plus_wall_7`` in N.
    energy : dict of str to ndarray, shape (steps,)
        The energy budget along the way in J, at its own ``time_s``.
    dimensionless : bool
        Whether K = m = 1 stands for SI: all units are then "1".
    """

    _index = "time_s"

    time_s: Floats
    signals: dict[str, Floats]
    energy: dict[str, Floats]
    dimensionless: bool = False

    def stacked(self, kind: str) -> tuple[NDArray[Any], Floats]:
        """Signals of all sensors of a kind as one array.

        Parameters
        ----------
        kind : str
            "bead", "contact", "position" or "velocity".

        Returns
        -------
        numbers : ndarray of int, shape (sensors,)
            Their beads or contacts, in order.
        signals : ndarray, shape (sensors, samples)
            In N, m or m/s.
        """
        found = {int(name.rsplit("_", 1)[1]): name for name in self.signals if name.rsplit("_", 1)[0] == kind}
        numbers = np.array(sorted(found), dtype=int)
        rows = [self.signals[found[number]] for number in numbers]
        return numbers, np.array(rows, dtype=float).reshape(len(rows), self.time_s.size)

    def _columns(self) -> dict[str, Floats]:
        return {"time_s": self.time_s, **self.signals}

    def _units(self) -> dict[str, str]:
        kinds = {"position": "m", "velocity": "m/s"}
        return {name: "1" if self.dimensionless else kinds.get(name.split("_")[0], "N") for name in self.signals}

    def _summary(self) -> tuple[str, dict[str, str]]:
        unit, second = ({}, "") if self.dimensionless else (self.units, " s")
        rows = {name: f"{short(np.max(np.abs(signal)))} {unit.get(name, '')} at most".replace("  ", " ") for name, signal in self.signals.items()}
        return f"Trace of {self.time_s.size} samples until {short(self.time_s[-1] if self.time_s.size else None)}{second}", rows


@dataclass(frozen=True, eq=False, repr=False)
class Shot(Result):
    """One impact, followed to its end. Definitions: docs/reference/conventions.md.

    Attributes
    ----------
    experiment : str
        Its name.
    speed_m_s : float or None
        Speed of the striker in m/s.
    tof_incident_s, tof_reflected_s : float or None
        Times of flight in s: from the sensor bead to the wall, and back.
    accuracy_asked, accuracy_reached : float or None
        Relative error allowed in times of flight; its bound reached, only if it was checked.
    pulse_speed_beads_per_s : float or None
        Beads a second between sensor bead and wall.
    passage : dict
        Peaks (``time_s``, ``value`` in N), widths in s, maxima that could be a peak
        instead (``competing``), the end of the search; or why there are none (``missing``),
        with the peak of the wall alone (``wall``) where the sensor bead has none before it.
    sensor_maxima : list of dict
        Maxima of the sensor bead's signal above 5 % of its largest.
    striker_rebound : dict or None
        Velocity of the striker at first separation and at the end, in m/s.
    energy : dict or None
        The budget at the end in J.
    duration_s : float
        How long the shot was followed, in s.
    solver, tolerance, step_s, force_passes, steps
        How it was computed: in words, error allowed a step, its length in s, counts.
    notes : list of str
        Remarks, such as a bound that was not reached.
    details : dict
        All of ``shot --json``, which has the attributes so far.
    velocities_m_s : ndarray, shape (bodies,)
        Velocities of all bodies at the end, the striker's first.
    warnings : tuple of Finding
        Warnings about the experiment at this speed.
    trace : Trace or None
        Sampled signals.
    dimensionless : bool
        Whether K = m = 1 stands for SI.
    """

    details: dict[str, Any]
    velocities_m_s: Floats
    warnings: tuple[Finding, ...] = ()
    trace: Trace | None = None
    dimensionless: bool = False

    def to_pandas(self) -> pd.Series:  # type: ignore[override]
        """The shot's numbers for pandas.

        Returns
        -------
        pandas.Series
            By name, NaN where there is none; units in ``attrs["units"]``.
        """
        made = super().to_pandas().iloc[0].rename(self.experiment)
        made.attrs["units"] = self.units
        return made

    def _variables(self) -> Mapping[str, Variable]:
        return {} if self.trace is None else self.trace._variables()

    def _units(self) -> dict[str, str]:
        return {} if self.trace is None else self.trace._units()

    def _attributes(self) -> dict[str, Any]:
        return self._numbers()

    def _columns(self) -> dict[str, list[float]]:
        return {name: [number(value)] for name, value in self._numbers().items()}

    def _numbers(self) -> dict[str, float | None]:
        names = ("speed_m_s", "tof_incident_s", "tof_reflected_s", "accuracy_reached", "pulse_speed_beads_per_s")
        pulses = {"sensor_peak_n": "incident", "wall_peak_n": "wall", "reflected_peak_n": "reflected"}
        return {
            **{name: getattr(self, name) for name in names},
            **{name: (self.passage.get(pulse) or {}).get("value") for name, pulse in pulses.items()},
            "striker_rebound_m_s": (self.striker_rebound or {}).get("end_m_s"),
            "duration_s": self.duration_s,
        }

    def _summary(self) -> tuple[str, dict[str, str]]:
        second, speed_unit = ("", "") if self.dimensionless else (" s", " m/s")
        rows = {"incident ToF": f"{short(self.tof_incident_s, 9)}{second}", "reflected ToF": f"{short(self.tof_reflected_s, 9)}{second}"}
        if missing := self.passage.get("missing"):
            rows = {"no time of flight": str(missing)}
        if self.accuracy_reached is not None:
            rows["accuracy reached"] = short(self.accuracy_reached, 2)
        if self.energy:
            rows["energy residual"] = f"{short(self.energy['relative_residual'], 2)} of the input"
        rows |= {"note": note for note in self.notes}
        speed = "" if self.speed_m_s is None else f" at {short(self.speed_m_s)}{speed_unit}"
        return f"Shot of {self.experiment}{speed}", rows


@dataclass(frozen=True, repr=False)
class PowerLaw(Result):
    """``tof = prefactor_s * (speed in m/s)**exponent``, by least squares of logarithms.

    Attributes
    ----------
    prefactor_s, exponent : float
        The time of flight at 1 m/s in s; −1/5 for Hertz contacts alone.
    prefactor_error_s, exponent_error : float or None
        Standard errors by the scatter; None for two speeds.
    prefactor_accuracy_s, exponent_accuracy : float or None
        Errors that the accuracies of the times of flight allow.
    covariance : float
        Of the logarithm of the prefactor and the exponent.
    r_squared : float or None
        Coefficient of determination.
    residuals : list of float
        Relative differences of the times from the law, speed by speed.
    details : dict
        All of these.
    dimensionless : bool
        Whether K = m = 1 stands for SI.
    """

    _fields = ("prefactor_s", "prefactor_error_s", "prefactor_accuracy_s", "exponent", "exponent_error", "exponent_accuracy", "r_squared")

    details: dict[str, Any]
    dimensionless: bool = False

    def __call__(self, speed_m_s: Any) -> Any:
        """Times of flight in s by the law, of the shape of the speeds."""
        return self.prefactor_s * np.asarray(speed_m_s, dtype=float) ** self.exponent

    def __repr__(self) -> str:
        def reported(value: float, error: float | None) -> str:
            return short(value) if error is None else f"({short(value)} ± {short(error, 2)})"

        second = "" if self.dimensionless else " s"
        against = ", not a power law within the errors" if self.details.get("supported") is False else ""
        return f"PowerLaw {reported(self.prefactor_s, self.prefactor_error_s)}{second} · v^{reported(self.exponent, self.exponent_error)}{against}"


def power_law(found: Mapping[str, Any], dimensionless: bool = False) -> PowerLaw | None:
    """A power law of the program's JSON; None for fewer than two speeds."""
    if "missing" in found:
        return None
    return PowerLaw({**dict.fromkeys((*PowerLaw._fields, "covariance")), "residuals": [], **found}, dimensionless)


class _Table(Result):
    """A result with named columns."""

    _index: ClassVar[str | None] = "speed_m_s"
    _printed = ("speed_m_s", "tof_incident_s", "tof_reflected_s")

    columns: dict[str, Floats]

    def _columns(self) -> Mapping[str, Floats]:
        return self.columns

    def _attributes(self) -> Mapping[str, Any]:
        return {"experiment": self.__dict__.get("experiment"), "case": self.__dict__.get("name")}


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(_Table):
    """Shots of one chain at several speeds. All arrays have shape (speeds,); NaN is missing.

    Attributes
    ----------
    experiment : str
        Its name.
    speed_m_s : ndarray
        Speeds of the striker in m/s.
    tof_incident_s, tof_reflected_s : ndarray
        Times of flight in s.
    accuracy_reached : ndarray
        Bounds on their relative errors.
    columns : dict of str to ndarray
        Everything: times of flight, peaks in N, widths in s, pulse speed, rebound in m/s, duration
        in s, and time and height of the highest maximum that could be the arrival instead
        (``competing_time_s``, ``competing_peak_n``), or the reflected pulse's peak
        (``competing_reflected_*``).
    power_law_incident, power_law_reflected : PowerLaw or None
        None where fewer than two speeds have a time of flight.
    calibration : dict or None
        The step that calibration shots chose; None with control per shot.
    error_control : str
        How errors were controlled, and why.
    errors : dict of int to str
        Why speeds, by index, have no shot.
    warnings : dict of int to list of str
        Warnings about the chain at speeds, by index.
    dimensionless : bool
        Whether K = m = 1 stands for SI.
    """

    _printed = ("speed_m_s", "tof_incident_s", "tof_reflected_s", "accuracy_reached")

    experiment: str
    speed_m_s: Floats
    columns: dict[str, Floats]
    power_law_incident: PowerLaw | None
    power_law_reflected: PowerLaw | None
    calibration: dict[str, Any] | None
    error_control: str
    errors: dict[int, str]
    warnings: dict[int, list[str]]
    dimensionless: bool = False

    def _columns(self) -> dict[str, Floats]:
        return {"speed_m_s": self.speed_m_s, **self.columns}

    def _summary(self) -> tuple[str, dict[str, str]]:
        laws = {"incident law": self.power_law_incident, "reflected law": self.power_law_reflected}
        rows = {name: f"{short(law.prefactor_s)} · v^{short(law.exponent)}" for name, law in laws.items() if law is not None}
        if self.errors:
            rows["failed"] = f"{len(self.errors)} speeds"
        if self.warnings:
            rows["warnings"] = f"at {len(self.warnings)} of {self.speed_m_s.size} speeds, first: {'; '.join(next(iter(self.warnings.values())))}"
        return f"Sweep of {self.experiment} over {self.speed_m_s.size} speeds", rows


@dataclass(frozen=True)
class WarningSummary(Result):
    """Warnings about the chain in some shots of many, by the first of them.

    Attributes
    ----------
    index : tuple of int
        Index of the first such shot.
    messages : list of str
        Its warnings, as the program prints them, such as a law out of its range.
    shots : int
        How many shots have warnings.
    """

    index: tuple[int, ...]
    messages: list[str]
    shots: int

    def _columns(self) -> dict[str, list[Any]]:
        return {"index": [str(self.index)], "messages": ["\n".join(self.messages)], "shots": [self.shots]}

    def __str__(self) -> str:
        return f"first of {self.shots} at {self.index}: {'; '.join(self.messages)}"


def warn(messages: Sequence[str], shots: int, level: int = 3) -> None:
    """One warning for all shots of a call that have any."""
    if messages:
        others = {1: "", 2: "\n(similar warnings for another shot)"}.get(shots, f"\n(similar warnings for {shots - 1} other shots)")
        _warnings.warn("\n".join(messages) + others, ExperimentWarning, stacklevel=level)


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(_Table):
    """Shots over arrays of speeds and of named numbers, broadcast against each other.

    Attributes
    ----------
    experiment, speed_m_s, columns, dimensionless
        As of a `Sweep`.
    shape : tuple of int
        The common shape; every column has it.
    parameters : dict of str to ndarray
        Named numbers in SI.
    errors : dict of tuple to str
        Why there is no shot, by index.
    parameter_units : dict of str to str
        SI units of the named numbers.
    warnings : WarningSummary or None
        Warnings about the chain in some shots, such as a law out of its range.
    error_control : str
        How errors were controlled, and why.
    """

    _printed = ("tof_incident_s", "tof_reflected_s")

    experiment: str
    shape: tuple[int, ...]
    speed_m_s: Floats
    parameters: dict[str, Floats]
    columns: dict[str, Floats]
    errors: dict[tuple[int, ...], str]
    parameter_units: dict[str, str]
    warnings: WarningSummary | None = None
    dimensionless: bool = False
    error_control: str = ""

    def _coordinates(self) -> tuple[str, ...]:
        return ("speed_m_s", *self.parameters)

    def _inputs(self) -> dict[str, Floats]:
        return {"speed_m_s": self.speed_m_s, **self.parameters}

    def _columns(self) -> dict[str, Floats]:
        return {name: np.ravel(values) for name, values in (self._inputs() | self.columns).items()}

    def _variables(self) -> dict[str, Variable]:
        # An axis has the name of the first input that changes along it alone.
        varied = {name: _varied(values) for name, values in self._inputs().items()}
        names = [next((name for name, axes in varied.items() if axes == (at,)), f"axis_{at}") for at in range(len(self.shape))]
        inputs: dict[str, Variable] = {}
        for name, values in self._inputs().items():
            at = tuple(slice(None) if axis in varied[name] else 0 for axis in range(values.ndim))
            inputs[name] = tuple(names[axis] for axis in varied[name]), np.asarray(values[at])
        return inputs | {name: (tuple(names), values) for name, values in self.columns.items()}

    def _units(self) -> dict[str, str]:
        return self.parameter_units

    def _summary(self) -> tuple[str, dict[str, str]]:
        rows = {"failed": str(len(self.errors))} if self.errors else {}
        return f"Ensemble of {self.experiment}, shape {self.shape}", rows | ({"warnings": str(self.warnings)} if self.warnings else {})


def _varied(values: Floats) -> tuple[int, ...]:
    """The axes along which values change; all of them where there are no values."""

    def changes(axis: int) -> bool:
        first = np.take(values, [0], axis=axis)
        return not np.array_equal(np.broadcast_to(first, values.shape), values, equal_nan=True)

    return tuple(axis for axis in range(values.ndim) if values.size == 0 or changes(axis))


@dataclass(frozen=True, repr=False)
class CampaignResult(Result):
    """Outcome of a campaign's run: a table of one row.

    Attributes
    ----------
    folder : Path
        Where the recordings are, one HDF5 file a series.
    kept, run : int
        Series that were there before, and series run now.
    shots : int
        Shots run now.
    bytes : int
        Size of all recordings of this part.
    failed : list of str
        Series that can't be computed, each with the reason; the others are there.
    seed : int
        Of all that is random.
    details : dict
        All of these but the folder.
    """

    _fields = ("folder", "kept", "run", "shots", "bytes", "failed", "seed")

    folder: Path
    details: dict[str, Any]

    @property
    def files(self) -> list[Path]:
        """The recordings, by name."""
        return sorted(self.folder.glob("*.h5"))

    def _summary(self) -> tuple[str, dict[str, str]]:
        rows = {"series": f"{self.run} run now, {self.kept} kept", "shots": str(self.shots), "size": f"{self.bytes / 1e6:.3g} MB", "seed": str(self.seed)}
        return f"Campaign in {self.folder}", rows | {f"failed {at}": why for at, why in enumerate(self.failed, 1)}


@dataclass(frozen=True, repr=False, eq=False)
class Case(_Table):
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
    """

    _printed = ("speed_m_s", "shots", "tof_incident_s", "tof_incident_s_error", "tof_reflected_s", "tof_reflected_s_error")

    name: str
    columns: dict[str, Floats]
    power_law_incident: PowerLaw | None
    power_law_reflected: PowerLaw | None

    def _summary(self) -> tuple[str, dict[str, str]]:
        return f"Case {self.name or '(unnamed)'}, {self.columns['speed_m_s'].size} speeds", {}


@dataclass(frozen=True, repr=False, eq=False)
class MeasureResult(Result):
    """Times of flight of a set of recordings; `fit` takes it as data.

    Attributes
    ----------
    shots : list of dict
        Every record: file, case, times of flight with errors in s, peaks in V, flags.
    cases : dict of str to Case
        One curve a case.
    tables : dict of str to str
        The program's tables as text: ``shots.csv``, ``speeds.csv`` …
    details : dict
        ``measure --json`` but its cases: also ratios, notes, the low-pass, lines of the table without recordings (``unmatched``).
    refused : list of str
        Files that could not be read.
    verdict : str or None
        What was refused or not found, as the program ends with.
    """

    _dimension = "record"
    _printed = ("file", "case", "tof_incident_s", "tof_reflected_s")

    cases: dict[str, Case]
    tables: dict[str, str]
    details: dict[str, Any]

    def _columns(self) -> dict[str, NDArray[Any] | list[str]]:
        titles, *rows = csv.reader(io.StringIO(self.tables["shots.csv"]))
        columns = {title: [row[at] for row in rows] for at, title in enumerate(titles)}
        return {title: cells if title in TEXTS else _numbers(cells) for title, cells in columns.items()}

    def _coordinates(self) -> tuple[str, ...]:
        return ("speed_m_s",) if np.isfinite(np.asarray(self._columns()["speed_m_s"], float)).any() else ()

    def save(self, path: str | os.PathLike[str]) -> list[Path]:
        """Writes the tables into a folder; tables without rows are left out.

        Parameters
        ----------
        path : path
            The folder, made if need be.

        Returns
        -------
        list of Path
            What was written.
        """
        Path(path).mkdir(parents=True, exist_ok=True)
        written = {Path(path) / name: text for name, text in self.tables.items() if text.count("\n") > 1}
        for file, text in written.items():
            file.write_text(text, encoding="utf-8")
        return list(written)

    def _summary(self) -> tuple[str, dict[str, str]]:
        timed = sum("missing" not in shot for shot in self.shots)
        rows = {"times of flight": f"{timed} of {len(self.shots) + len(self.refused)} records"}
        rows |= {case.name or "(unnamed)": f"{case['speed_m_s'].size} speeds" for case in self.cases.values()}
        return "Measured", rows | ({"refused": str(len(self.refused))} if self.refused else {})


TEXTS = ("file", "case", "counted", "not_counted_because", "flags")
"""Columns of text, also where all cells are empty or digits."""


def _numbers(cells: list[str]) -> NDArray[Any]:
    """Cells of a column of numbers; NaN where they are empty."""
    if all(cell.isdigit() for cell in cells):
        return np.array(cells, dtype=int)
    return np.array([float(cell) if cell else np.nan for cell in cells])


@dataclass(frozen=True, repr=False)
class Parameter(Result):
    """A fitted number.

    Attributes
    ----------
    name, unit : str
        As the fit names it, and its SI unit.
    value : float
        At the best fit.
    standard_error : float or None
        By the covariance; None where the data do not determine it, and at a bound.
    determined : bool
        Whether the data determine it; if not, its value is one of many that fit as well.
    at_bound : bool
        Whether the best fit lies at one of its bounds.
    limit : dict or None
        Of one at or near a bound, by profile: ``side`` ("at most" or "at least"), ``percent_68``, ``percent_95``.
    start, lower, upper, scale : float or None
        Where it started, its bounds, a change that matters.
    prior : dict or None
        Its prior distribution.
    details : dict
        All of these.
    """

    _fields = ("name", "unit", "value", "standard_error", "start", "lower", "upper", "scale", "determined", "at_bound")

    details: dict[str, Any]

    def _units(self) -> dict[str, str]:
        return dict.fromkeys(("value", "standard_error", "start", "lower", "upper", "scale"), self.unit)

    def __str__(self) -> str:
        error = "not determined" if self.standard_error is None else f"± {short(self.standard_error, 2)}"
        if self.at_bound:
            error = "at its bound"
            if self.limit and self.limit["percent_95"] is not None:
                error += f", {self.limit['side']} {short(self.limit['percent_95'], 3)} (95 %)"
        return f"{short(self.value)} {error} {self.unit}".strip()

    def __repr__(self) -> str:
        return f"{self.name} = {self}"


@dataclass(frozen=True, repr=False, eq=False)
class FitResult(Result):
    """A fit: parameters with errors, goodness of fit, what is not determined.

    Its table is the measured values beside the fitted ones; xarray gets the parameters, their covariance and samples of a posterior.

    Attributes
    ----------
    parameters : dict of str to Parameter
        In SI, with standard errors by covariance.
    covariance, correlation : ndarray, shape (parameters, parameters)
        In products of the parameters' SI units; and without units.
    rows : dict of str to ndarray, shape (values,)
        Of times of flight: ``speed_m_s``, ``observable``, ``measured``, ``error``, ``fitted``, ``fitted_error`` (in s, ratios
        in 1), ``residual`` in standard errors. Of whole pulses, a mean of samples each: ``source``, ``channel``,
        ``time_s`` after the incident maximum, ``measured_v``, ``error_v``, ``fitted_v``.
    samples : ndarray of shape (samples, parameters) or None
        Of the posterior in SI, if that was sampled and has converged.
    chi_square : dict or None
        ``value``, degrees of ``freedom``, ``probability``; None without degrees of freedom.
    converged : bool
        Whether the descent came to a minimum.
    details : dict
        All of ``fit.json``: goodness of fit, identifiability, profiles, posterior, comparison of models.
    """

    parameters: dict[str, Parameter]
    covariance: Floats
    correlation: Floats
    rows: dict[str, NDArray[Any]]
    samples: Floats | None
    details: dict[str, Any]

    def __getitem__(self, name: str) -> Parameter:
        return self.parameters[name]

    def _columns(self) -> dict[str, NDArray[Any]]:
        return self.rows

    def _units(self) -> dict[str, Any]:
        # Columns that hold times and ratios have both units; parameters one each.
        observables = dict.fromkeys(map(str, self.rows.get("observable", np.empty(0)).tolist()))
        both = " or ".join(dict.fromkeys(unit(name) for name in observables))
        own = [one.unit for one in self.parameters.values()]
        return {
            **dict.fromkeys(("measured", "error", "fitted", "fitted_error"), both),
            **dict.fromkeys(("value", "standard_error", "samples"), own),
            "covariance": "products of units",
        }

    def _variables(self) -> dict[str, Variable]:
        own = self.parameters.values()
        over = ("parameter",)
        made: dict[str, Variable] = {
            "parameter": (over, list(self.parameters)),
            "other": (("other",), list(self.parameters)),
            "value": (over, [one.value for one in own]),
            "standard_error": (over, [number(one.standard_error) for one in own]),
            "unit": (over, [one.unit for one in own]),
            "covariance": ((*over, "other"), self.covariance),
        }
        return made if self.samples is None else made | {"samples": (("sample", *over), self.samples)}

    def _summary(self) -> tuple[str, dict[str, str]]:
        known = self.details
        rows = {name: str(parameter) for name, parameter in self.parameters.items()}
        if (goodness := self.chi_square) is not None:
            misfit = ", the model does not follow the data" if known.get("follows_data") is False else ""
            rows["χ²/ν"] = f"{short(goodness['value'], 4)}/{goodness['freedom']}, p = {short(goodness['probability'], 2)}{misfit}"
        rows |= {} if known.get("assumed") is None else {"assumed": known["assumed"]}
        rows |= {"not determined": direction["words"] for direction in known["not_determined"]}
        if not self.converged:
            rows["warning"] = "the descent did not come to a minimum"
        if "data" in known:
            tables = f" in {len(known['tables'])} tables" if "tables" in known else ""
            return f"Fit of {known['model']} to {known['data']['values']} values{tables}", rows
        rows |= {"left out": why for why in known["left_out"][:1]}
        return f"Fit of {known['model']} to whole pulses of {len(known['records'])} records", rows


@dataclass(frozen=True, repr=False, eq=False)
class DesignResult(Result):
    """Suggested measurements: a table of candidates, best first.

    Attributes
    ----------
    parameters, parameter_units : list of str
        The parameters to tighten, and their SI units.
    ranked : list of dict
        One measurement more, best first: ``measure``, ``standard_errors``, ``information_nats``.
    series : list of dict
        A series, each the best after those before it.
    details : dict
        All of ``design.json``: whether the model follows the data, standard errors now, what is
        not identifiable, which contact each free K or A stands for, the default model that was
        assumed (``assumed_model``).
    """

    _index = "measure"

    details: dict[str, Any]

    def _columns(self) -> dict[str, list[Any]]:
        errors = {name: [number(one["standard_errors"][at]) for one in self.ranked] for at, name in enumerate(self.parameters)}
        return {"measure": [one["measure"] for one in self.ranked], **errors, "information_nats": [one["information_nats"] for one in self.ranked]}

    def _units(self) -> dict[str, str]:
        return dict(zip(self.parameters, self.parameter_units, strict=True))

    def _summary(self) -> tuple[str, dict[str, str]]:
        rows = {one["measure"]: f"{short(one['information_nats'], 3)} nats" for one in self.ranked[:5]}
        # Null spaces of the data so far, and of all candidates.
        for key, title in {"undetermined": "not determined", "not_identifiable": "not identifiable"}.items():
            rows |= {f"{title}, {at}": text for at, text in enumerate(self.details.get(key, ()), 1)}
        return f"Design for {', '.join(self.parameters)}: measure next", rows


@dataclass(frozen=True, repr=False, eq=False)
class GaugeResult(Result):
    """Distances of the known oils from the contacts' K and A: a table of oils, nearest first.

    Attributes
    ----------
    verdict : str
        In a sentence; it can be "none of these".
    oils : list of dict
        Known oils, nearest first: distance in standard errors, probability, whether possible.
    contacts : list of dict
        Stiffness K in N/m^1.5 and relaxation time A in s, or a film's number, speed by speed; xarray gets these.
    film : dict or None
        A film's numbers in place of oils (``parameters``, then the table), chi-square of the wet data.
    dry : list of dict
        Fitted parameters of the dry contacts.
    details : dict
        All of ``gauge.json``.
    """

    _fields = ("name", "distance", "possible", "probability", "chi_square", "freedom")

    details: dict[str, Any]

    def _units(self) -> dict[str, str]:
        film = next((row["film"]["unit"] for row in self.contacts if "film" in row), "1")
        units = {"stiffness": "N/m^1.5", "stiffness_error": "N/m^1.5", "film": film, "film_error": film}
        return {"distance": "standard error", **units, **dict.fromkeys(("value", "standard_error"), "as in the column unit")}

    def _variables(self) -> dict[str, Variable]:
        found = [row for row in self.contacts if "missing" not in row]
        made: dict[str, Variable] = {"speed_m_s": (("speed_m_s",), [row["speed_m_s"] for row in found])}
        both = (("stiffness", "stiffness_error"), ("relaxation_time_s", "relaxation_time_error_s"))
        for of, error in [("film", "film_error")] if self.film else both:
            for name, part in ((of, "value"), (error, "standard_error")):
                made[name] = ("speed_m_s",), [number((row.get(of) or {}).get(part)) for row in found]
        return made

    def _columns(self) -> dict[str, list[Any]]:
        rows, names = (self.film["parameters"], ("name", "value", "standard_error", "unit")) if self.film else (self.oils, self._fields)
        return {name: [row[name] for row in rows] for name in names}

    def _summary(self) -> tuple[str, dict[str, str]]:
        rows = {oil["name"]: f"{short(oil['distance'], 3)} standard errors away, {'possible' if oil['possible'] else 'rejected'}" for oil in self.oils}
        for of in (self.film or {}).get("parameters", ()):
            rows[of["name"]] = f"{short(of['value'], 4)} ± {short(of['standard_error'], 2)} {of['unit']}"
        if flags := self.details.get("doubts"):
            rows["warning"] = flags
        return self.verdict, rows


@dataclass(frozen=True)
class Row:
    """A name, its value and unit.

    Attributes
    ----------
    name : str
        What it is.
    value : float, int, str, bool, list or dict
        In SI; ranges are pairs, things with parts dicts whose keys name their units.
    unit : str
        SI unit; empty for texts and plain numbers.
    """

    name: str
    value: Any
    unit: str

    def __str__(self) -> str:
        return f"{_readable(self.value)} {self.unit}".strip().translate(CONTROLS)


def _readable(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.7g}"
    if isinstance(value, dict):
        return ", ".join(f"{name} {_readable(part)}" for name, part in value.items())
    if isinstance(value, (list, tuple)):
        return " to ".join(map(_readable, value))
    return str(value)


class _Rows(Result):
    """Groups of rows, or one that is all of them."""

    def _columns(self) -> dict[str, list[Any]]:
        rows = [(group.title, row) for group in getattr(self, "groups", (self,)) for row in group.rows]
        return {"group": [title for title, _ in rows], **{of: [getattr(row, of) for _, row in rows] for of in ("name", "value", "unit")}}

    def _units(self) -> dict[str, str]:
        return {"value": "as in the column unit"}


@dataclass(frozen=True, repr=False)
class Group(_Rows):
    """Rows that belong together; ``group[name]`` is one of them.

    Attributes
    ----------
    title : str
        What they are about.
    rows : tuple of Row
        In SI.
    """

    title: str
    rows: tuple[Row, ...]

    def __getitem__(self, name: str) -> Row:
        return {row.name: row for row in self.rows}[name]

    def _summary(self) -> tuple[str, dict[str, str]]:
        return self.title, {row.name: str(row) for row in self.rows}


@dataclass(frozen=True, repr=False)
class Description(_Rows):
    """An experiment, or its theory, in groups of numbers; ``found[title]`` is a group.

    Attributes
    ----------
    groups : tuple of Group
        In SI.
    warnings : tuple of Finding
        Warnings about the experiment.
    """

    groups: tuple[Group, ...]
    warnings: tuple[Finding, ...] = ()

    def __getitem__(self, title: str) -> Group:
        return {group.title: group for group in self.groups}[title]

    def __iter__(self) -> Iterator[Group]:
        return iter(self.groups)

    def __repr__(self) -> str:
        return "\n\n".join(map(repr, self.groups))


@dataclass(frozen=True, repr=False)
class LawInfo(Result):
    """A contact law: a table of its parameters.

    Attributes
    ----------
    name, equation : str
        As experiment files name it, and its force in plain text.
    nature : str
        Elastic, dissipative or elastic–plastic.
    gated : bool
        Whether it acts on closed contacts alone.
    validity : str
        Its range of validity.
    reference : str
        Its key in references.bib.
    source : dict or None
        The reference: authors, title, journal, volume, pages, year.
    parameters : list of dict
        Name, meaning, SI unit, least value, default, whether it is required.
    details : dict
        All of these.
    """

    _index = "name"
    _rows = "parameters"
    _fields = ("name", "meaning", "unit", "default", "least", "required")

    details: dict[str, Any]

    def _units(self) -> dict[str, str]:
        return dict.fromkeys(("default", "least"), "as in the column unit")

    def _summary(self) -> tuple[str, dict[str, str]]:
        rows = {"equation": self.equation, "kind": self.nature, "validity": self.validity, "source": f"[{self.reference}]"}
        return self.name, rows | {one["name"]: f"{one['meaning']} [{one['unit']}]" for one in self.parameters}
