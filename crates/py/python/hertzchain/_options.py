"""Keywords as options of the command line, so that both have the same words."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Literal, Protocol, runtime_checkable

from .errors import OptionError

Solver = Literal["adaptive", "rk4", "verlet"]
Pick = Literal["peak", "flank-10", "flank-50", "cross-correlation"]
Value = str | float | int
Assignments = Mapping[str, Value | tuple[Value, Value]]


@runtime_checkable
class Updating(Protocol):
    """A bar of progress such as tqdm's."""

    def update(self, n: float | None = 1) -> object: ...


def text(value: object) -> str:
    """A value as a user would type it, with all its digits."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool,)):
        raise OptionError(f"{value!r} is neither a number nor a text")
    if isinstance(value, (int, float)) or hasattr(value, "__float__"):
        return repr(float(value))  # type: ignore[arg-type]
    raise OptionError(f"{value!r} is neither a number nor a text")


def words(**options: object) -> list[str]:
    """``name=value`` as ``--name=value``; None and False are left out."""
    told: list[str] = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            told.append(option)
        elif isinstance(value, (str, os.PathLike)):
            told.append(f"{option}={os.fspath(value)}")
        elif isinstance(value, int):
            told.append(f"{option}={value}")
        else:
            told.append(f"{option}={text(value)}")
    return told


def listed(name: str, values: str | Iterable[str] | None) -> list[str]:
    """Names separated by commas."""
    if values is None:
        return []
    joined = values if isinstance(values, str) else ",".join(values)
    return [f"--{name}={joined}"] if joined else []


def assigned(name: str, values: Assignments | None, between: str) -> list[str]:
    """``{number: value}`` as ``--name=number=value``; pairs with a sign between."""

    def one(value: Value | tuple[Value, Value]) -> str:
        if isinstance(value, tuple):
            return between.join(text(part) for part in value)
        return text(value)

    return [f"--{name}={key}={one(value)}" for key, value in (values or {}).items()]


def how(
    accuracy: float | None,
    solver: Solver | None,
    step: str | float | None,
    duration: str | float | None,
    pick: Pick | None,
    check: bool,
) -> list[str]:
    """How shots are computed."""
    return words(
        accuracy=accuracy,
        solver=solver,
        step=_time(step),
        duration=_time(duration),
        pick=pick,
        check=check,
    )


def _time(value: str | float | None) -> str | None:
    """Numbers are in seconds; a dimensionless experiment takes plain text only."""
    if value is None or isinstance(value, str):
        return value
    return f"{text(value)} s"


def count(name: str, value: int | None, least: int = 0, most: int = 1024) -> int:
    """A whole number; none is 0."""
    if value is None:
        return 0
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise OptionError(f"{name} = {value!r}: expected a whole number from {least} to {most}")
    return value


@contextmanager
def progress(wanted: object, total: int | None, unit: str) -> Iterator[Any]:
    """What is to be told of progress; a bar that was drawn for it is closed in the end.

    ``True`` draws tqdm's bar; something with ``update``, or any function, is
    called with what was done since the last time.
    """
    update, bar = _teller(wanted, total, unit)
    try:
        yield update
    finally:
        if bar is not None:
            bar.close()


def _teller(wanted: object, total: int | None, unit: str) -> tuple[Any, Any]:
    if wanted is None or wanted is False:
        return None, None
    if wanted is True:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            raise ModuleNotFoundError("progress=True draws tqdm's bar: pip install tqdm, or give a function that is told of progress") from None
        bar = tqdm(total=total, unit=unit)
        return bar.update, bar
    if isinstance(wanted, Updating):
        return wanted.update, None
    if callable(wanted):
        return wanted, None
    raise OptionError(f"progress = {wanted!r}: expected True, a bar with `update`, or a function")
