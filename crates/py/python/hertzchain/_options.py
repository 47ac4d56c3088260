"""Keyword options: declared in Rust, documented, checked and handed over here.

Their names and types for type checkers are in ``_keywords.pyi``, which ``crates/py/keywords.py`` writes.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from difflib import get_close_matches
from functools import lru_cache
from inspect import Parameter, cleandoc, signature
from numbers import Integral
from textwrap import fill, indent
from typing import Any, TypeVar

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
    made = {NAMES.get(name, name): parts for name, *parts in _native.options(verb)}
    if verb in ("ensemble", "distributed.sweep"):
        # An array, which is an argument of its own.
        made["speed"] = made.pop("speeds")
    return made  # type: ignore[return-value]


# Parameters of several functions: type and description; {} is what progress counts.
SHARED = {
    "experiment": ("Experiment or str or path", "The chain and its striker; or the name of a preset, or a file."),
    "speed": ("float or str, optional", 'Speed of the striker in m/s, or a text such as ``"50 cm/s"``; the experiment\'s own when absent.'),
    "threads": ("int, optional", "Threads to compute with; all cores when absent."),
    "client": ("dask.distributed.Client, optional", "Everything stays in this process when absent."),
    "progress": (
        "bool, bar or function, optional",
        "True draws tqdm's bar; a bar's ``update``, or a function, is called with the number of {} since the last time.",
    ),
    "ax": ("Axes, optional", "To draw into; a new figure's when absent."),
}
PARAMETERS = re.compile(r"Parameters\n-+\n(?P<entries>(?:.*\n)*?)(?=\n\w+\n-+\n)")


def with_options(verb: str | None, counted: str = "shots") -> Callable[[Function], Function]:
    """Completes signature and docstring of a function: shared parameters, and options of a verb."""

    def complete(function: Function) -> Function:
        text = cleandoc(function.__doc__ or "")
        known = signature(function)
        own = [one for one in known.parameters.values() if verb is None or one.kind is not Parameter.VAR_KEYWORD]
        options = {} if verb is None else declared(verb)
        added = {name: parts for name, parts in options.items() if name not in known.parameters}
        keywords = [Parameter(name, Parameter.KEYWORD_ONLY, default=_default(default)) for name, (_, default, _) in added.items()]
        function.__signature__ = known.replace(parameters=[*own, *keywords])  # type: ignore[attr-defined]
        if (section := PARAMETERS.search(text)) is not None:
            heads = re.findall(r"^(\w.*?)(?: :|$)", section["entries"], re.MULTILINE)
            described = {name.strip() for head in heads for name in head.split(",")}
            shared = {one.name: SHARED[one.name] for one in own if one.name in SHARED and one.name not in described}
            # The experiment comes first in every signature, then the speed.
            first = {name: shared.pop(name) for name in ("experiment", "speed") if name in shared}
            rest = {name: (f"{kind}, optional" if default is None else kind, f"{about}.") for name, (kind, default, about) in added.items()}
            entries = _entries(first) + section["entries"] + _entries(shared | rest).replace("{}", counted)
            function.__doc__ = text[: section.start("entries")] + entries + text[section.end() :]
        return function

    return complete


def _entries(described: Mapping[str, tuple[str, str]]) -> str:
    """Entries of a section, from types and descriptions by name."""
    lines = (f"{name} : {kind}\n{indent(fill(about, 96), '    ')}\n" for name, (kind, about) in described.items())
    return "".join(lines)


def _default(default: str | None) -> Any:
    """A default as Python writes it."""
    try:
        return None if default is None else json.loads(default)
    except ValueError:
        return tuple(default.split(",")) if "," in default else default


def text(verb: str, given: Mapping[str, Any], **more: Any) -> str:
    """Options as the extension reads them: JSON by the names in Rust."""
    known = declared(verb)
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


def unmasked(values: Any) -> Any:
    """Masked numbers as NaN."""
    return np.ma.filled(values.astype(float), np.nan) if np.ma.isMaskedArray(values) else values


def count(name: str, value: int | None, least: int = 0, most: int = 1024) -> int:
    """A whole number; 0 for None."""
    if value is None:
        return 0
    if isinstance(value, bool) or not isinstance(value, Integral) or not least <= value <= most:
        raise OptionError(f"{name} = {value!r}: expected a whole number from {least} to {most}")
    return int(value)


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
    elif callable(update := getattr(wanted, "update", wanted)):
        yield update
    else:
        raise OptionError(f"progress = {wanted!r}: expected True, a bar with `update`, or a function")
