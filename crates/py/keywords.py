"""Writes the types of keyword options for type checkers, from the options that Rust declares.

usage: python crates/py/keywords.py      with the extension installed
"""

from pathlib import Path

from hertzchain import _options

STUB = Path(__file__).parent / "python/hertzchain/_keywords.pyi"
VERBS = ["shot", "sweep", "ensemble", "measure", "fit", "design", "gauge"]
HEAD = '''"""Keyword options of the verbs, for type checkers: written by crates/py/keywords.py."""

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, Literal, TypedDict

Path = str | PathLike[str]
Quantity = str | float
'''


def stub() -> str:
    """The text of the stub."""
    classes = [f"class {verb.capitalize()}Options(TypedDict, total=False):\n{fields(verb)}" for verb in VERBS]
    return "\n\n".join([HEAD, *classes])


def fields(verb: str) -> str:
    """One option a line; those without a default may be None."""
    declared = _options.declared(verb).items()
    return "".join(f"    {name}: {kind}{' | None' if default is None else ''}\n" for name, (kind, default, _) in declared)


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
