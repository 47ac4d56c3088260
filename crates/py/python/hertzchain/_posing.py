"""Data, models and keywords of inference as the command line has them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict

import numpy as np

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from .curves import Sweep
from .errors import ExperimentWarning, OptionError
from .experiment import preset
from .recording import Measured

if TYPE_CHECKING:
    from typing_extensions import Unpack

Method = Literal["covariance", "profile", "posterior"]
What = Literal["incident", "reflected", "wall-ratio", "returning-ratio"]
Data = "str | os.PathLike[str] | Mapping[str, Any] | Measured | Sweep | pd.DataFrame"
"""A table of times of flight against speed: a CSV file, columns by name, or a result."""


def table(data: Any, name: str = "data") -> tuple[str, str]:
    """The text of a table and its name in messages."""
    data = _only(data)
    if isinstance(data, (str, os.PathLike)):
        try:
            return os.fspath(data), Path(data).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise OptionError(f"{os.fspath(data)} can't be read: {error}") from None
    if isinstance(data, Measured):
        return "speeds.csv", data.tables["speeds.csv"]
    if isinstance(data, Sweep):
        return data.experiment, csv({"speed_m_s": data.speed_m_s, **data.columns})
    if isinstance(data, Mapping):
        return name, csv(data)
    if hasattr(data, "to_dict") and hasattr(data, "columns"):
        return name, csv(data.reset_index().to_dict("list"))
    raise OptionError(f"data of type {type(data).__name__}: expected a file, columns by name, a table, or what `measure` gives")


def recordings(data: Any, described: bool = False) -> list[str] | None:
    """Paths of recordings; None if the data are a table. Whether options of recordings are given decides where titles do not."""
    data = _only(data)
    if isinstance(data, (str, os.PathLike)):
        path = os.fspath(data)
        return None if _native.is_table(path, described) else [path]
    if isinstance(data, (list, tuple)):
        return [os.fspath(path) for path in data]
    return None


def _only(data: Any) -> Any:
    """What a list of one holds."""
    return data[0] if isinstance(data, (list, tuple)) and len(data) == 1 else data


def csv(columns: Mapping[str, Any]) -> str:
    lists = {name: np.atleast_1d(_plain(name, values)) for name, values in columns.items()}
    lengths = {values.size for values in lists.values() if values.ndim == 1}
    if len(lengths) != 1 or any(values.ndim != 1 for values in lists.values()):
        shapes = ", ".join(f"{name} {values.shape}" for name, values in lists.items())
        raise OptionError(f"columns must be of one length: {shapes or 'there are none'}")
    rows = zip(*(map(_cell, values) for values in lists.values()), strict=True)
    return "\n".join([",".join(map(str, lists)), *(",".join(row) for row in rows)]) + "\n"


def _plain(name: str, values: Any) -> np.ndarray[Any, Any]:
    """An array without a mask: what is masked was not measured."""
    if not np.ma.is_masked(values):
        return np.asarray(values)
    try:
        return np.asarray(np.ma.filled(values.astype(float), np.nan))
    except ValueError:
        raise OptionError(f"column {name!r}: only numbers can be masked; leave its masked rows out") from None


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return '"' + value.replace('"', '""') + '"'
    number = float(value)
    return "" if np.isnan(number) else repr(number)


def modelled(model: Experiment | str | None) -> Experiment:
    return model if isinstance(model, Experiment) else preset(model or "dry")


def assumed(**models: tuple[object, str]) -> str | None:
    """That models which are not named are the paper's, as a warning and in a sentence."""
    absent = [f"{name}={usual!r}" for name, (given, usual) in models.items() if given is None]
    if not absent:
        return None
    warning = f"no model is named: the paper's chain is assumed ({', '.join(absent)})"
    warnings.warn(warning, ExperimentWarning, stacklevel=3)
    return warning


CHAIN = "chain.json"
"""A posterior's walkers in a fit's folder."""


def kept(folder: str | os.PathLike[str] | None) -> list[str]:
    """Options for a folder in which a fit that was broken off goes on."""
    if folder is None:
        return []
    into = Path(folder).resolve()
    begun = (into / CHAIN).exists()
    return [f"--out={into}", *(["--resume"] if begun else [])]


class FitOptions(TypedDict, total=False):
    """Keywords of a fit, as the command line has them."""

    case: str | None
    use: Iterable[What]
    method: Method
    start: options.Assignments | None
    bounds: options.Assignments | None
    prior: options.Assignments | None
    scale: options.Assignments | None
    fixed: options.Assignments | None
    speed_error: float | None
    tof_error: float | None
    ratio_error: float | None
    error_shots: int | Literal["known"] | None
    accuracy: float
    robust: bool
    starts: int
    steps: int
    direct: bool
    seed: int
    threads: int | None


def words(**given: Unpack[FitOptions]) -> list[str]:
    """Keywords of a fit as options; absent ones are left to the command line."""
    plain = {key: value for key, value in given.items() if key not in _NOT_PLAIN}
    return [
        *options.words(**plain),
        *options.listed("use", given.get("use")),
        *options.assigned("set", given.get("fixed"), ""),
        *options.assigned("start", given.get("start"), ""),
        *options.assigned("bounds", given.get("bounds"), ":"),
        *options.assigned("prior", given.get("prior"), "+-"),
        *options.assigned("scale", given.get("scale"), ""),
    ]


_NOT_PLAIN = ("use", "start", "bounds", "prior", "scale", "fixed")
