"""Experiments: from files, from dicts, from objects; their description, theory and laws."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment, presets, schema
from .errors import ExperimentWarning, OptionError, existing, findings
from .results import Description, Group, LawInfo, Row

__all__ = [
    "Beads", "Contacts", "Experiment", "FarEnd", "Law", "Material", "PowerOfSpeed", "Striker", "build",
    "check", "laws", "load", "preset", "presets", "schema", "theory",
]  # fmt: skip

Quantity = float | str


@dataclass(frozen=True)
class PowerOfSpeed:
    """A material's number that follows the striker's speed v in m/s: ``prefactor * v**exponent``.

    Parameters
    ----------
    prefactor : float or str
        Its value at 1 m/s, in SI or as text with a unit.
    exponent : float
        Of the speed.
    """

    prefactor: Quantity
    exponent: float


@dataclass(frozen=True)
class Material:
    """What beads are made of. Numbers are in SI, texts have units of their own.

    Parameters
    ----------
    young_modulus : float or str
        Young modulus Y in Pa.
    poisson_ratio : float
        Poisson ratio ν.
    density, yield_strength : float or str, optional
        In kg/m³, needed where beads have no mass; in Pa, to report first yield.
    shear_viscosity, bulk_viscosity : float or str, optional
        η₁ and η₂ in Pa s; η₂ is η₁ where it is left out.
    """

    young_modulus: Quantity | PowerOfSpeed
    poisson_ratio: Quantity | PowerOfSpeed
    density: Quantity | None = None
    shear_viscosity: Quantity | PowerOfSpeed | None = None
    bulk_viscosity: Quantity | PowerOfSpeed | None = None
    yield_strength: Quantity | None = None


@dataclass(frozen=True)
class Beads:
    """Beads alike in a row. Numbers are in SI, texts have units of their own.

    Parameters
    ----------
    count : int
        How many.
    radius : float or str
        In m.
    material : str
        Name of a material.
    mass : float or str, optional
        In kg; by the density when absent.
    """

    count: int
    radius: Quantity
    material: str
    mass: Quantity | None = None


class Law:
    """A contact law by its name, with its parameters in SI or as texts.

    Names, equations, parameters and units: `hertzchain.laws`; docs/explanation/physics.md.

    Parameters
    ----------
    name : str
        Of a law of the registry.
    **parameters : float or str
        Its parameters, in SI or as texts with units.

    Examples
    --------
    >>> Law("damping_cubic", coefficient=77.0)
    Law('damping_cubic', coefficient=77.0)
    """

    def __init__(self, name: str, **parameters: Quantity) -> None:
        self.name = name
        self.parameters = parameters

    def __repr__(self) -> str:
        given = "".join(f", {name}={value!r}" for name, value in self.parameters.items())
        return f"Law({self.name!r}{given})"

    def _table(self) -> str | dict[str, object]:
        if not self.parameters:
            return self.name
        units = {known["name"]: known["unit"] for known in _native.laws(self.name)[0]["parameters"]}
        named = {name: units.get(name, "1").format(**self.parameters) for name in self.parameters}
        return {"law": self.name} | {name: _quantity(self.parameters[name], unit) for name, unit in named.items()}


@dataclass(frozen=True)
class Contacts:
    """Laws of consecutive contacts, whose forces add.

    Parameters
    ----------
    laws : sequence of str or Law
        Their forces add.
    from_, to : int, optional
        The first and the last contact: 0 is the striker's, ``to=None`` the wall's.
    material : str, optional
        Name of an effective one, in place of both sides'.
    wet : bool, optional
        Whether readings take it for wet.
    """

    laws: Sequence[str | Law]
    from_: int = 0
    to: int | None = None
    material: str | None = None
    wet: bool | None = None


@dataclass(frozen=True)
class Striker:
    """The bead that hits bead 1; as bead 1 where nothing else is said.

    Parameters
    ----------
    speed : float or str
        In m/s.
    radius, mass : float or str, optional
        In m and kg.
    material : str, optional
        Name of a material.
    """

    speed: Quantity
    radius: Quantity | None = None
    mass: Quantity | None = None
    material: str | None = None


@dataclass(frozen=True)
class FarEnd:
    """What bead N leans on.

    Parameters
    ----------
    kind : {"half-bead", "plane", "stop", "plane-stop", "free", "periodic"}
        A fixed half-bead or plane, a stop of finite mass with either, nothing, or bead 1.
    radius, mass : float or str, optional
        Of a half-bead in m, of a stop in kg.
    material : str, optional
        Name of a material.
    """

    kind: str = "half-bead"
    radius: Quantity | None = None
    mass: Quantity | None = None
    material: str | None = None


_UNITS = {
    "young_modulus": "Pa", "poisson_ratio": "1", "density": "kg/m^3", "shear_viscosity": "Pa s", "bulk_viscosity": "Pa s",
    "radius": "m", "mass": "kg", "speed": "m/s",
}  # fmt: skip


def _quantity(value: object, unit: str) -> object:
    """A number in SI as text with its unit; anything else as it is."""
    if isinstance(value, PowerOfSpeed):
        return {"prefactor": _quantity(value.prefactor, unit), "exponent": value.exponent}
    if isinstance(value, str) or unit == "":
        return value
    return float(value) if unit == "1" else f"{float(value)!r} {unit}"  # type: ignore[arg-type]


def _part(part: object) -> object:
    """A value, a table or a list as it stands in an experiment file."""
    if isinstance(part, Law):
        return part._table()
    if isinstance(part, (Material, Beads, Contacts, Striker, FarEnd)):
        # A keyword of Python has an underscore behind it.
        named = {one.name.rstrip("_"): getattr(part, one.name) for one in fields(part)}
        return {name: _quantity(_part(value), _UNITS.get(name, "")) for name, value in named.items() if value is not None}
    if isinstance(part, Mapping):
        return {key: _part(value) for key, value in part.items()}
    if isinstance(part, Sequence) and not isinstance(part, str):
        return [_part(member) for member in part]
    return part


def load(path: str | os.PathLike[str]) -> Experiment:
    """Reads an experiment file (TOML).

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    Experiment
        As the file describes it, in SI.

    Raises
    ------
    ExperimentError
        Every mistake in the file at once, each with its line, underlined.
    MissingFileError, OptionError
        A file that is not there, or can't be read.
    """
    return Experiment.open(existing(path))


preset = Experiment.preset


def opened(experiment: Experiment | options.Path_) -> Experiment:
    """An experiment; a preset by its name, a file by its path."""
    if isinstance(experiment, Experiment):
        return experiment
    if isinstance(experiment, str) and not experiment.endswith(".toml") and os.sep not in experiment:
        return preset(experiment)
    if isinstance(experiment, (str, os.PathLike)):
        return load(experiment)
    raise OptionError(f"an experiment of type {type(experiment).__name__}: expected an Experiment, the name of a preset, or a file")


def build(tables: Mapping[str, object] | str | None = None, /, name: str = "python", **more: object) -> Experiment:
    """Builds an experiment from a dict, from keywords, or from the text of a file.

    Keys are those of an experiment file. In a plain dict, as in a file, a quantity is a text with a
    unit; in `Material`, `Beads`, `Law`, `Striker` and `FarEnd` a number is in SI.

    Parameters
    ----------
    tables : mapping or str, optional
        What stands in the file, or its text.
    name : str
        Its name in messages; files named in it lie in this name's folder.
    **more
        Further keys.

    Returns
    -------
    Experiment
        In SI.

    Raises
    ------
    ExperimentError, OptionError
        Every mistake, at its line of the text that was made of the dict; values that no experiment can hold.

    Examples
    --------
    >>> import hertzchain as hc
    >>> chain = hc.build(
    ...     materials={"steel": hc.Material(213e9, 0.3, density=7960.0)},
    ...     striker=hc.Striker(speed=0.5),
    ...     beads=[hc.Beads(count=20, radius=6.35e-3, material="steel")],
    ...     contacts=[hc.Contacts(["elastic_hertz", hc.Law("damping_cubic", coefficient=77.0)])],
    ... )
    >>> chain.beads
    20
    """
    if isinstance(tables, str):
        if more:
            raise OptionError("a text is a whole experiment: keywords have no place in it")
        return Experiment.from_text(name, tables)
    whole = {key: _part(value) for key, value in {**(tables or {}), **more}.items()}
    return Experiment.from_tables(name, json.dumps(options.plain(whole)))


@options.with_options(None)
def check(experiment: Experiment | options.Path_, speed: float | str | None = None) -> Description:
    """Describes an experiment in SI with what follows from it; runs nothing.

    Words and signs: docs/reference/conventions.md.

    Parameters
    ----------

    Returns
    -------
    Description
        Groups of names, values in SI and units.

    Raises
    ------
    ExperimentError, OptionError
        What the physics rejects, at its place in the experiment; a text that is no speed.

    Warns
    -----
    ExperimentWarning
        Warnings about the experiment at this speed.
    """
    return _description(_native.check(opened(experiment), options.text("check", {}, speed=speed)))


@options.with_options(None)
def theory(experiment: Experiment | options.Path_, speed: float | str | None = None) -> Description:
    """Theory of a chain: exact solitary wave, normal modes, band gap, restitution.

    Long waves: [Nesterenko1983]; the exact solitary wave: [FrieseckeWattis1994], [EnglishPego2005];
    restitution: [Goldobin2015]. See docs/explanation/physics.md.

    Parameters
    ----------

    Returns
    -------
    Description
        Groups of names, values in SI and units.

    Raises
    ------
    ExperimentError, OptionError
        As for `check`, which has the same warnings.
    """
    return _description(_native.theory(opened(experiment), options.text("theory", {}, speed=speed)))


def _description(found: Mapping[str, Any]) -> Description:
    reported = findings(found["warnings"])
    for warning in reported:
        warnings.warn(warning.report, ExperimentWarning, stacklevel=3)
    groups = (Group(group["title"], tuple(Row(**row) for row in group["rows"])) for group in found["groups"])
    return Description(tuple(groups), reported)


def laws(name: str | None = None) -> list[LawInfo]:
    """Every contact law of the registry, or the one of this name.

    Each law's own, in its ``reference``; how laws are added: docs/how-to/add-a-contact-law.md.

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
    """
    return [LawInfo(law) for law in _native.laws(name)]
