"""What is known without a shot: descriptions, theory, laws."""

from __future__ import annotations

import warnings as _warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._table import Tabled, lines
from .errors import ExperimentWarning, Finding

__all__ = ["Description", "Group", "LawInfo", "Row", "check", "laws", "theory"]


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

    References
    ----------
    Words and signs: docs/conventions.md.
    """

    name: str
    value: Any
    unit: str

    def __str__(self) -> str:
        return f"{_told(self.value)} {self.unit}".strip()


def _told(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.7g}"
    if isinstance(value, dict):
        return ", ".join(f"{name} {_told(part)}" for name, part in value.items())
    if isinstance(value, (list, tuple)):
        return " to ".join(map(_told, value))
    return str(value)


class _Rows(Tabled):
    """Groups of rows as a table."""

    def _groups(self) -> tuple[Group, ...]:
        raise NotImplementedError

    def _columns(self) -> dict[str, list[Any]]:
        rows = [(group.title, row) for group in self._groups() for row in group.rows]
        names = [row.name for _, row in rows]
        return {"group": [title for title, _ in rows], "name": names, "value": [row.value for _, row in rows], "unit": [row.unit for _, row in rows]}

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

    References
    ----------
    Words and signs: docs/conventions.md.
    """

    title: str
    rows: tuple[Row, ...]

    def __getitem__(self, name: str) -> Row:
        for row in self.rows:
            if row.name == name:
                return row
        raise KeyError(name)

    def _groups(self) -> tuple[Group, ...]:
        return (self,)

    def __repr__(self) -> str:
        return lines(self.title, {row.name: str(row) for row in self.rows})


@dataclass(frozen=True, repr=False)
class Description(_Rows):
    """What was understood of an experiment, or what theory says of it; ``found[title]`` is a group.

    Attributes
    ----------
    groups : tuple of Group
        In SI.
    warnings : tuple of Finding
        What is odd about the experiment.

    References
    ----------
    Words and signs: docs/conventions.md; theory: docs/physics.md.
    """

    groups: tuple[Group, ...]
    warnings: tuple[Finding, ...] = ()

    def __getitem__(self, title: str) -> Group:
        for group in self.groups:
            if group.title == title:
                return group
        raise KeyError(title)

    def __iter__(self) -> Iterator[Group]:
        return iter(self.groups)

    def _groups(self) -> tuple[Group, ...]:
        return self.groups

    def __repr__(self) -> str:
        return "\n\n".join(repr(group) for group in self.groups)


@dataclass(frozen=True, repr=False)
class LawInfo(Tabled):
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
        Where it may be believed.
    reference : str
        Its key in references.bib.
    source : dict or None
        What that key stands for: authors, title, journal, volume, pages, year.
    parameters : list of dict
        Name, meaning, SI unit, least value, default, whether it is required.

    References
    ----------
    Each law's own, in ``reference``; all of them: docs/physics.md.
    """

    _index = "name"

    name: str
    equation: str
    nature: str
    gated: bool
    validity: str
    reference: str
    source: dict[str, Any] | None
    parameters: list[dict[str, Any]]

    def _columns(self) -> dict[str, list[Any]]:
        names = ("name", "meaning", "unit", "default", "least", "required")
        return {name: [parameter.get(name) for parameter in self.parameters] for name in names}

    def _units(self) -> dict[str, str]:
        return dict.fromkeys(("default", "least"), "as in the column unit")

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

    Parameters
    ----------
    experiment : Experiment
        The chain and what hits it.
    speed : float or str, optional
        Speed of the striker in m/s, or a text with a unit; the experiment's own when absent.

    Returns
    -------
    Description
        Groups of names, values in SI and units.

    Raises
    ------
    ExperimentError
        What the physics refuses, at its place in the experiment.
    OptionError
        A speed that is none.

    Warns
    -----
    ExperimentWarning
        What is odd about the experiment at this speed.

    References
    ----------
    Words and signs: docs/conventions.md.
    """
    return _described(_native.check(experiment, None if speed is None else options.text(speed)))


def theory(experiment: Experiment, speed: float | str | None = None) -> Description:
    """What theory says of a chain: exact solitary wave, normal modes, band gap, restitution.

    Parameters
    ----------
    experiment, speed
        As for `check`.

    Returns
    -------
    Description
        Groups of names, values in SI and units.

    Raises
    ------
    ExperimentError, OptionError
        As for `check`, which warns of the same.

    References
    ----------
    Long waves: [Nesterenko1983]; the exact solitary wave: [FrieseckeWattis1994], [EnglishPego2005];
    restitution: [Goldobin2015]. See docs/physics.md.
    """
    return _described(_native.theory(experiment, None if speed is None else options.text(speed)))


def laws(name: str | None = None) -> list[LawInfo]:
    """Every contact law of the registry, or the one of this name.

    Parameters
    ----------
    name : str, optional
        One law's.

    Returns
    -------
    list of LawInfo
        Equations, parameters with SI units, validity, source.

    Raises
    ------
    OptionError
        A name that no law has.

    References
    ----------
    Each law's own, in its ``reference``; how laws are added: docs/add-a-contact-law.md.
    """
    return [LawInfo(**law) for law in _native.laws(name)]
