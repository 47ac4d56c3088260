"""Keyword options: declared in Rust, documented and checked here."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from difflib import get_close_matches
from inspect import Parameter, signature
from numbers import Integral
from textwrap import wrap
from typing import Any, Literal, Protocol, TypedDict, TypeVar, runtime_checkable

from . import _hertzchain as _native
from .errors import OptionError

Path_ = str | os.PathLike[str]
Quantity = str | float
Pick = Literal["peak", "flank-10", "flank-50", "cross-correlation"]
Assignments = Mapping[str, Quantity | tuple[Quantity, Quantity]]
Observable = Literal["incident", "reflected", "wall-ratio", "returning-ratio"]
Filter = Literal["first", "butterworth2", "butterworth3", "butterworth4", "bessel2", "bessel3", "bessel4"]
Polarity = Literal["positive", "negative"]
ErrorControl = Literal["per-shot", "calibrated"]


class EnsembleOptions(TypedDict, total=False):
    """Options of `ensemble`."""

    accuracy: float | None
    duration: Quantity | None
    pick: Pick | None


class ShotOptions(EnsembleOptions, total=False):
    """Options of `shot` and `sweep`."""

    solver: Literal["adaptive", "rk4", "verlet"] | None
    step: Quantity | None
    check: bool


class MeasureOptions(TypedDict, total=False):
    """Options of `measure`."""

    rate: Quantity | None
    trust_rate: bool
    channel: str | int | Iterable[str | int]
    time_unit: str | None
    shot_samples: int | None
    level: Quantity | None
    whole: bool
    rows: Literal["samples", "shots", "channels"] | None
    method: Literal["local", "onset", "correlation", "shape"]
    onset: Quantity
    beads: int | None
    sensor: int | None
    polarity: Polarity | None
    wall_polarity: Polarity | None
    smooth: Quantity | None
    low_pass: Quantity | None
    filter: Filter | None
    ac_coupling: Quantity | None
    rig: Path_ | None
    shots: Path_ | None
    speed_error: Quantity | None
    speed_gap: Quantity
    reference: str
    keep_dubious: bool


class CurveOptions(TypedDict, total=False):
    """Options of `fit`, `design` and `gauge`."""

    use: Observable | Iterable[Observable]
    speed_error: Quantity | None
    tof_error: Quantity | None
    ratio_error: Quantity | None
    error_shots: int | Literal["known"] | None
    accuracy: float
    threads: int | None


class ModelOptions(CurveOptions, total=False):
    """Options of `fit` and `design`."""

    case: str | None
    start: Assignments | None
    bounds: Assignments | None
    prior: Assignments | None
    scale: Assignments | None
    fixed: Assignments | None


class FitOptions(ModelOptions, total=False):
    """Options of `fit`."""

    method: Literal["covariance", "profile", "posterior"]
    against: Mapping[str, str | Iterable[str]] | None
    robust: bool
    starts: int
    steps: int
    direct: bool
    seed: int
    shots: Path_ | None
    rate: Quantity | None
    channel: str | int | Iterable[str | int]
    low_pass: Quantity | None
    filter: Filter | None
    most_shots: int


class DesignOptions(ModelOptions, total=False):
    """Options of `design`."""

    target: str | Iterable[str] | None
    speeds: str | Iterable[float] | None
    preloads: Iterable[Quantity]
    sensors: Iterable[int] | None
    costs: Mapping[str, float] | None
    picks: int


class GaugeOptions(CurveOptions, total=False):
    """Options of `gauge`."""

    wet_case: str | None
    dry_case: str | None
    dry_free: str | Iterable[str]
    own: str | Iterable[str]
    form: Literal["each", "power"]


# Python's names for options that the command line names otherwise.
_NAMES = {"fixed": "set"}
_BETWEEN = {"bounds": ":", "prior": "+-"}

Function = TypeVar("Function", bound=Callable[..., Any])


def with_options(verb: str, declared: type) -> Callable[[Function], Function]:
    """Completes signature and docstring of a function that takes ``**options``.

    Names and types are those of ``declared``; defaults and descriptions are Rust's.
    """
    known = {name: (default, text) for name, default, text in _native.options(verb)}

    def complete(function: Function) -> Function:
        keywords, lines = [], []
        for name, kind in _annotations(declared).items():
            default, text = known[_NAMES.get(name, name)]
            keywords.append(Parameter(name, Parameter.KEYWORD_ONLY, default=_plain(default)))
            lines += [f"    {name} : {kind}", *wrap(f"{text}.", 100, initial_indent=" " * 8, subsequent_indent=" " * 8)]
        own = [one for one in signature(function).parameters.values() if one.kind is not Parameter.VAR_KEYWORD]
        taken = {one.name for one in own}
        merged = [*own, *(one for one in keywords if one.name not in taken)]
        function.__signature__ = signature(function).replace(parameters=merged)  # type: ignore[attr-defined]
        if function.__doc__ is not None:
            function.__doc__ = function.__doc__.replace("    **options", "\n".join(lines), 1)
        return function

    return complete


def _annotations(declared: type) -> dict[str, str]:
    """Names of the options of a class with their types as text."""
    kinds = declared.__annotations__.items()
    return {name: getattr(kind, "__forward_arg__", str(kind)) for name, kind in kinds}


def _plain(default: str | None) -> Any:
    """A default as Python writes it."""
    if default in (None, "true", "false"):
        return None if default is None else default == "true"
    for number in (int, float):
        try:
            return number(default)
        except ValueError:
            pass
    return tuple(default.split(",")) if "," in default else default


def words(verb: str, declared: type, given: Mapping[str, Any]) -> list[str]:
    """Options as the extension reads them; None and False are absent."""
    known = _annotations(declared)
    made: list[str] = []
    for name, value in given.items():
        if name not in known:
            near = get_close_matches(name, known, 1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise TypeError(f"{verb}() got an unexpected keyword argument {name!r}{hint}")
        made += _words(name, value)
    return made


def _words(name: str, value: Any) -> list[str]:
    option = "--" + _NAMES.get(name, name).replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [option]
    if name in ("step", "duration") and not isinstance(value, str):
        return [f"{option}={text(value)} s"]
    if isinstance(value, Mapping):
        between = _BETWEEN.get(name, ",")
        return [f"{option}={key}={_joined(one, between)}" for key, one in value.items()]
    if isinstance(value, Iterable) and not isinstance(value, (str, bytes)) and getattr(value, "ndim", 1):
        return [f"{option}={_joined(value, ',')}"] if name == "speeds" else [f"{option}={text(one)}" for one in value]
    return [f"{option}={text(value)}"]


def _joined(value: Any, between: str) -> str:
    if isinstance(value, Iterable) and not isinstance(value, (str, bytes)):
        return between.join(map(text, value))
    return text(value)


def text(value: object) -> str:
    """A value as a user would type it, with all its digits."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)  # type: ignore[return-value]
    if isinstance(value, Integral) and not isinstance(value, bool):
        return str(int(value))
    if hasattr(value, "__float__") and not isinstance(value, bool):
        return repr(float(value))  # type: ignore[arg-type]
    raise OptionError(f"{value!r} is neither a number nor a text")


def count(name: str, value: int | None, least: int = 0, most: int = 1024) -> int:
    """A whole number; 0 for None."""
    if value is None:
        return 0
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise OptionError(f"{name} = {value!r}: expected a whole number from {least} to {most}")
    return value


@runtime_checkable
class Updating(Protocol):
    """A progress bar such as tqdm's."""

    def update(self, n: float | None = 1) -> object: ...


@contextmanager
def progress(wanted: object, total: int | None, unit: str) -> Iterator[Any]:
    """The function to call with progress; a bar that was drawn for it is closed in the end.

    ``True`` draws tqdm's bar; something with ``update``, or any function, is
    called with what was done since the last time.
    """
    if wanted is None or wanted is False:
        yield None
    elif wanted is True:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            raise ModuleNotFoundError("progress=True draws tqdm's bar: pip install tqdm, or give a function to call with progress") from None
        with tqdm(total=total, unit=unit) as bar:
            yield bar.update
    elif isinstance(wanted, Updating):
        yield wanted.update
    elif callable(wanted):
        yield wanted
    else:
        raise OptionError(f"progress = {wanted!r}: expected True, a bar with `update`, or a function")
