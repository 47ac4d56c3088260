"""Records: made on a virtual rig, and measured."""

from __future__ import annotations

import os
import warnings as _warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from .errors import ExperimentWarning, OptionError, existing, in_python
from .experiment import opened
from .results import CampaignResult, Case, MeasureResult, number, power_law

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._keywords import MeasureOptions

__all__ = ["campaign", "measure"]


@options.with_options(None)
def campaign(
    experiment: Experiment | options.Path_,
    out: options.Path_,
    *,
    shard: str = "1/1",
    seed: int | None = None,
    threads: int | None = None,
    progress: object = None,
) -> CampaignResult:
    """Runs a campaign on a virtual rig: taps and shots, recorded as by a real one.

    Files are the same bytes whatever the number of threads; an interrupted run resumes. The rig and its
    runs: docs/explanation/rig.md, after [Labbe2017].

    Parameters
    ----------
    experiment : Experiment or str or path
        With a ``[campaign]``, such as the preset ``"paper"``.
    out : path
        Folder to write recordings into.
    shard : str
        Only the i-th of n parts, as ``"i/n"``: every n-th series.
    seed : int, optional
        In place of the experiment's.

    Returns
    -------
    CampaignResult
        Where recordings are and how many; series that can't be computed are listed in it.

    Raises
    ------
    OptionError, ExperimentError, InternalError
        An experiment that no rig can do, a folder with another campaign in it, a recording that can't be written.

    Warns
    -----
    ExperimentWarning
        A record that ends before the wave is back, a rate of few samples a pulse.
    """
    how = options.text("campaign", {}, out=out, shard=shard, seed=seed, threads=threads)
    with options.progress(progress, None, "shot") as update:
        done = _native.campaign(opened(experiment), how, update)
    for text in done.pop("warnings"):
        _warnings.warn(text, ExperimentWarning, stacklevel=2)
    return CampaignResult(Path(out), done)


@options.with_options("measure", "records")
def measure(
    records: options.Path_ | Iterable[options.Path_] | NDArray[Any],
    *,
    threads: int | None = None,
    progress: object = None,
    **how: Unpack[MeasureOptions],
) -> MeasureResult:
    """Measures times of flight on recordings of any rig, with errors and curves.

    How pulses are timed, with which errors: docs/explanation/picking.md.

    Parameters
    ----------
    records : path, iterable of paths, or ndarray
        Files (HDF5 of a campaign, text, NPY, NPZ, WAV, TDMS) or folders of them;
        or volts as an array, also of pandas, with ``rate``: (samples,), (shots, samples), (samples, channels) or
        (shots, channels, samples); ``rows`` states what else rows are.

    Returns
    -------
    MeasureResult
        Times in s with standard errors, peaks in V, bit for bit those of ``hertzchain measure
        --json``. Bad records are listed in it one by one, the rest is measured. `fit` takes it as data.

    Raises
    ------
    OptionError
        Options that do not go together, a folder without recordings, a file that is not there.

    Warns
    -----
    ExperimentWarning
        Records that can't be read, or have no time of flight.
    """
    if getattr(records, "ndim", 0) == 2 and 64 <= records.shape[1] < records.shape[0] and not how.get("channel"):
        how.setdefault("rows", "shots")
    asked = options.text("measure", how)
    with TemporaryDirectory(prefix="hertzchain-", ignore_cleanup_errors=True) as folder, options.progress(progress, None, "record") as update:
        found = _native.measure(_files(records, Path(folder)), asked, options.count("threads", threads), f"{folder}{os.sep}", update)
    if found["verdict"] is not None:
        refused = "".join(f"\n{why}" for why in found["refused"][:3])
        _warnings.warn(in_python(found["verdict"] + refused), ExperimentWarning, stacklevel=2)
    tables, cases = found.pop("tables"), map(_case, found.pop("cases"))
    return MeasureResult({case.name: case for case in cases}, tables, found)


def _files(records: options.Path_ | Iterable[options.Path_] | NDArray[Any], folder: Path) -> list[str]:
    volts = options.unmasked(np.asanyarray(records)) if hasattr(records, "__array__") else None
    if volts is not None and volts.dtype.kind not in "OUT":
        if volts.dtype.kind not in "fiu" or volts.ndim not in (1, 2, 3) or volts.size == 0:
            raise OptionError(f"records of {volts.dtype} and shape {volts.shape}: expected volts of one to three axes")
        path = folder / "array.npy"
        with open(path, "wb") as file:
            # Into anything but a file NumPy writes pieces, between which Ctrl-C works.
            pieces: Any = SimpleNamespace(write=file.write)
            np.save(pieces, np.ascontiguousarray(volts))
        return [str(path)]
    return [existing(record) for record in ([records] if isinstance(records, (str, os.PathLike)) else records)]


def _case(raw: Mapping[str, Any]) -> Case:
    """A curve of the program's JSON: values with their standard errors as columns."""
    columns: dict[str, list[float]] = {}
    for row in raw["speeds"]:
        found = {"speed_m_s": row["speed_m_s"]["value"], "speed_error_m_s": row["speed_m_s"]["sigma"], "shots": row["shots"]}
        for name in ("tof_incident_s", "tof_reflected_s", "wall_over_incident", "reflected_over_incident"):
            found |= {name: (row[name] or {}).get("mean"), f"{name}_error": (row[name] or {}).get("error")}
        for name, value in (found | {"tof_correlation": row["tof_correlation"]}).items():
            columns.setdefault(name, []).append(number(value))
    laws = (power_law(raw[f"power_law_{end}"]) for end in ("incident", "reflected"))
    return Case(raw["case"], {name: np.array(values, dtype=float) for name, values in columns.items()}, *laws)
