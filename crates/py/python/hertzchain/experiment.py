"""Experiments: from files, from dicts, from objects."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields

from . import _hertzchain as _native
from ._hertzchain import Experiment
from ._toml import text as toml
from .errors import OptionError

__all__ = [
    "Beads",
    "Contacts",
    "Experiment",
    "FarEnd",
    "Law",
    "Material",
    "PowerOfSpeed",
    "Striker",
    "build",
    "load",
    "preset",
    "presets",
    "schema",
]

Quantity = float | str


@dataclass(frozen=True)
class PowerOfSpeed:
    """A material's number that follows the striker's speed v in m/s.

    ``prefactor * v**exponent``.

    Parameters
    ----------
    prefactor : float or str
        Its value at 1 m/s, in SI or as text with a unit.
    exponent : float
        Of the speed.

    References
    ----------
    Effective numbers of oils: [Labbe2017].
    """

    prefactor: Quantity
    exponent: float


def _si(unit: str) -> dict[str, str]:
    return {"unit": unit}


@dataclass(frozen=True)
class Material:
    """What beads are made of. Numbers are in SI, texts have units of their own.

    Parameters
    ----------
    young_modulus : float or str
        Young modulus Y in Pa.
    poisson_ratio : float
        Poisson ratio ν.
    density : float or str, optional
        In kg/m³; needed where beads have no mass.
    shear_viscosity, bulk_viscosity : float or str, optional
        η₁ and η₂ in Pa s; η₂ is η₁ where it is left out.

    References
    ----------
    Viscosities of a body: [Goldobin2015].
    """

    young_modulus: Quantity | PowerOfSpeed = field(metadata=_si("Pa"))
    poisson_ratio: Quantity | PowerOfSpeed = field(metadata=_si("1"))
    density: Quantity | None = field(default=None, metadata=_si("kg/m^3"))
    shear_viscosity: Quantity | PowerOfSpeed | None = field(default=None, metadata=_si("Pa s"))
    bulk_viscosity: Quantity | PowerOfSpeed | None = field(default=None, metadata=_si("Pa s"))


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

    References
    ----------
    Which bead is which: docs/conventions.md.
    """

    count: int = field(metadata=_si(""))
    radius: Quantity = field(metadata=_si("m"))
    material: str = field(metadata=_si(""))
    mass: Quantity | None = field(default=None, metadata=_si("kg"))


class Law:
    """A contact law by its name, with its parameters in SI or as texts.

    ``hertzchain.laws()`` lists names, equations, parameters and units.

    Parameters
    ----------
    name : str
        Of a law of the registry.
    **parameters : float or str
        Its parameters, in SI or as texts with units.

    References
    ----------
    Each law's own: `hertzchain.laws`; docs/physics.md.

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

    def table(self) -> str | dict[str, object]:
        """As it stands in an experiment file.

        Returns
        -------
        str or dict
            Text or table of TOML.
        """
        if not self.parameters:
            return self.name
        units = {known["name"]: known["unit"] for known in _native.laws(self.name)[0]["parameters"]}
        given = {
            name: _quantity(value, units.get(name, "1").format(**self.parameters))
            for name, value in self.parameters.items()
        }
        return {"law": self.name, **given}


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

    References
    ----------
    Wet and dry contacts of the paper: [Labbe2017]; readings: docs/physics.md.
    """

    laws: Sequence[str | Law]
    from_: int = 0
    to: int | None = None
    material: str | None = None
    wet: bool | None = None

    def table(self) -> dict[str, object]:
        """As it stands in an experiment file.

        Returns
        -------
        str or dict
            Text or table of TOML.
        """
        laws = [law.table() if isinstance(law, Law) else law for law in self.laws]
        rest = {"to": self.to, "material": self.material, "wet": self.wet}
        given = {key: value for key, value in rest.items() if value is not None}
        return {"from": self.from_, **given, "laws": laws}


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

    References
    ----------
    Its weight loads nothing at rest: docs/conventions.md.
    """

    speed: Quantity = field(metadata=_si("m/s"))
    radius: Quantity | None = field(default=None, metadata=_si("m"))
    mass: Quantity | None = field(default=None, metadata=_si("kg"))
    material: str | None = field(default=None, metadata=_si(""))


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

    References
    ----------
    Ends of chains: docs/conventions.md; the paper's stop: [Labbe2017].
    """

    kind: str = field(default="half-bead", metadata=_si(""))
    radius: Quantity | None = field(default=None, metadata=_si("m"))
    mass: Quantity | None = field(default=None, metadata=_si("kg"))
    material: str | None = field(default=None, metadata=_si(""))


Part = Material | Beads | Striker | FarEnd


def _quantity(value: object, unit: str) -> object:
    if isinstance(value, PowerOfSpeed):
        return {"prefactor": _quantity(value.prefactor, unit), "exponent": value.exponent}
    if isinstance(value, str) or unit == "":
        return value
    number = float(value)  # type: ignore[arg-type]
    return number if unit == "1" else f"{number!r} {unit}"


def _part(part: object) -> object:
    if isinstance(part, (Contacts, Law)):
        return part.table()
    if isinstance(part, (Material, Beads, Striker, FarEnd)):
        named = ((spec.name, spec.metadata["unit"], getattr(part, spec.name)) for spec in fields(part))
        return {name: _quantity(value, unit) for name, unit, value in named if value is not None}
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
    OptionError
        A file that can't be read.

    References
    ----------
    Keys and units of the file: `schema`, docs/conventions.md.
    """
    return Experiment.open(path)


def preset(name: str) -> Experiment:
    """An experiment that comes with the program.

    Parameters
    ----------
    name : str
        One of `presets`.

    Returns
    -------
    Experiment
        In SI.

    Raises
    ------
    OptionError
        A name that no preset has.

    References
    ----------
    The paper's chains: [Labbe2017]; each file of experiments/ names its own.
    """
    return Experiment.preset(name)


def presets() -> dict[str, str]:
    """The experiments that come with the program.

    Returns
    -------
    dict of str to str
        Titles by name.

    References
    ----------
    The files of experiments/, which name their sources.
    """
    return dict(_native.presets())


def schema() -> str:
    """The JSON Schema of experiment files.

    Returns
    -------
    str
        JSON, with every key, its unit and what it means.

    References
    ----------
    Words and signs: docs/conventions.md.
    """
    return _native.schema()


def build(tables: Mapping[str, object] | str | None = None, /, name: str = "python", **more: object) -> Experiment:
    """Builds an experiment from a dict, from keywords, or from the text of a file.

    Keys are those of an experiment file. In a plain dict, as in a file, a
    quantity is a text with a unit; in `Material`, `Beads`, `Law`, `Striker` and
    `FarEnd` a number is in SI.

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
    ExperimentError
        Every mistake, at its line of the text that was made of the dict.
    OptionError
        Values that no experiment can hold.

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

    References
    ----------
    Keys and units: `schema`, docs/conventions.md; laws: `laws`.
    """
    if isinstance(tables, str):
        if more:
            raise OptionError("a text is a whole experiment: keywords have no place in it")
        return Experiment.from_text(name, tables)
    whole = {**(tables or {}), **more}
    parts = {key: _part(value) for key, value in whole.items()}
    return Experiment.from_text(name, toml(parts))
