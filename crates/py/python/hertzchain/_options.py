"""Keyword options: declared in Rust, documented, checked and handed over here.

Their names and types for type checkers are in ``_keywords.pyi``, which ``crates/py/keywords.py`` writes.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from difflib import get_close_matches
from functools import lru_cache
from inspect import Parameter, signature
from numbers import Integral
from textwrap import wrap
from typing import Any, Protocol, TypeVar, runtime_checkable

import numpy as np

from . import _hertzchain as _native
from .errors import OptionError

Path_ = str | os.PathLike[str]

# Python's names for options that the command line names otherwise.
NAMES = {"set": "fixed"}

Function = TypeVar("Function", bound=Callable[..., Any])


@lru_cache
def declared(verb: str) -> dict[str, tuple[str, str | None, str]]:
    """Type, default and description of every option of a verb, by Python's names."""
    return {NAMES.get(name, name): parts for name, *parts in _native.options(verb)}  # type: ignore[misc]


def with_options(verb: str) -> Callable[[Function], Function]:
    """Completes signature and docstring of a function that takes ``**options``."""

    def complete(function: Function) -> Function:
        own = [one for one in signature(function).parameters.values() if one.kind is not Parameter.VAR_KEYWORD]
        taken = {one.name for one in own}
        keywords, lines = [], []
        for name, (kind, default, text) in declared(verb).items():
            if name not in taken:
                keywords.append(Parameter(name, Parameter.KEYWORD_ONLY, default=_default(default)))
                optional = ", optional" if default is None else ""
                lines += [f"    {name} : {kind}{optional}", *wrap(f"{text}.", 100, initial_indent=" " * 8, subsequent_indent=" " * 8)]
        function.__signature__ = signature(function).replace(parameters=[*own, *keywords])  # type: ignore[attr-defined]
        if function.__doc__ is not None:
            function.__doc__ = function.__doc__.replace("    **options", "\n".join(lines), 1)
        return function

    return complete


def _default(default: str | None) -> Any:
    """A default as Python writes it."""
    if default in (None, "true", "false"):
        return None if default is None else default == "true"
    for number in (int, float):
        try:
            return number(default)
        except ValueError:
            pass
    return tuple(default.split(",")) if "," in default else default


def text(verb: str, given: Mapping[str, Any], **more: Any) -> str:
    """Options as the extension reads them: JSON by the names in Rust."""
    known = declared("sweep" if verb == "ensemble" else verb)
    for name in given:
        if name not in known:
            near = get_close_matches(name, known, 1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise TypeError(f"{verb}() got an unexpected keyword argument {name!r}{hint}")
    named = {("set" if name == "fixed" else name): value for name, value in given.items()}
    return json.dumps(plain(named | more))


def plain(value: object) -> Any:
    """A value as JSON has it, with all its digits."""
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if hasattr(value, "__float__") and not getattr(value, "ndim", 0):
        number = float(value)
        return number if math.isfinite(number) else repr(number)
    if isinstance(value, Iterable) and not isinstance(value, (bytes, bytearray)):
        return [plain(one) for one in value]
    raise OptionError(f"{value!r} is neither a number nor a text, nor a list or a dict of these")


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
            raise ModuleNotFoundError(
                "progress=True draws tqdm's bar: pip install 'hertzchain[progress]', or give a function to call with progress"
            ) from None
        with tqdm(total=total, unit=unit) as bar:
            yield bar.update
    elif isinstance(wanted, Updating):
        yield wanted.update
    elif callable(wanted):
        yield wanted
    else:
        raise OptionError(f"progress = {wanted!r}: expected True, a bar with `update`, or a function")
