"""What is known without a shot: descriptions, theory, laws."""

from __future__ import annotations

import warnings as _warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._table import lines
from .errors import ExperimentWarning, Finding

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Description", "Group", "LawInfo", "Row", "check", "laws", "theory"]


@dataclass(frozen=True)
class Row:
    """A name, its value and unit; ranges are pairs, things with parts dicts."""

    name: str
    value: Any
    unit: str

    def __str__(self) -> str:
        value = f"{self.value:.7g}" if isinstance(self.value, float) else str(self.value)
        return f"{value} {self.unit}".strip()


@dataclass(frozen=True)
class Group:
    """Rows that belong together."""

    title: str
    rows: tuple[Row, ...]

    def __getitem__(self, name: str) -> Row:
        for row in self.rows:
            if row.name == name:
                return row
        raise KeyError(name)

    def __repr__(self) -> str:
        return lines(self.title, {row.name: str(row) for row in self.rows})


@dataclass(frozen=True)
class Description:
    """What was understood of an experiment, or what theory says of it, in SI."""

    groups: tuple[Group, ...]
    warnings: tuple[Finding, ...] = ()

    def __getitem__(self, title: str) -> Group:
        for group in self.groups:
            if group.title == title:
                return group
        raise KeyError(title)

    def __iter__(self) -> Iterator[Group]:
        return iter(self.groups)

    def to_pandas(self) -> pd.DataFrame:
        """One row a line: group, name, value, unit."""
        import pandas as pd

        rows = [(group.title, row.name, row.value, row.unit) for group in self.groups for row in group.rows]
        return pd.DataFrame(rows, columns=["group", "name", "value", "unit"])

    def __repr__(self) -> str:
        return "\n\n".join(repr(group) for group in self.groups)


@dataclass(frozen=True)
class LawInfo:
    """A contact law: its equation, parameters with units, validity and source."""

    name: str
    equation: str
    nature: str
    gated: bool
    validity: str
    reference: str
    source: dict[str, Any] | None
    parameters: list[dict[str, Any]]

    def __repr__(self) -> str:
        rows = {"equation": self.equation, "kind": self.nature, "validity": self.validity, "source": f"[{self.reference}]"}
        rows |= {parameter["name"]: f"{parameter['meaning']} [{parameter['unit']}]" for parameter in self.parameters}
        return lines(self.name, rows)


def _described(found: dict[str, Any]) -> Description:
    odd = tuple(Finding.of(raw) for raw in found["warnings"])
    for warning in odd:
        _warnings.warn(warning.report, ExperimentWarning, stacklevel=3)
    groups = (Group(group["title"], tuple(Row(**row) for row in group["rows"])) for group in found["groups"])
    return Description(tuple(groups), odd)


def check(experiment: Experiment, speed: float | str | None = None) -> Description:
    """What was understood of an experiment, in SI, and what follows from it; runs nothing.

    Raises
    ------
    ExperimentError
        What the physics refuses, at its place in the experiment.
    """
    return _described(_native.check(experiment, None if speed is None else options.text(speed)))


def theory(experiment: Experiment, speed: float | str | None = None) -> Description:
    """What theory says of a chain: exact solitary wave, normal modes, band gap, restitution.

    Raises
    ------
    ExperimentError
        What the physics refuses, at its place in the experiment.
    """
    return _described(_native.theory(experiment, None if speed is None else options.text(speed)))


def laws(name: str | None = None) -> list[LawInfo]:
    """Every contact law of the registry, or the one of this name.

    Raises
    ------
    OptionError
        A name that no law has.
    """
    return [LawInfo(**law) for law in _native.laws(name)]
