"""What sweeps and ensembles give: numbers in SI as NumPy arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._table import Floats, Tabled, dataset, frame, lines, short, span
from .results import PowerLaw

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Ensemble", "Odd", "Sweep"]


class Flights:
    """Columns of shots, those of the times of flight by name."""

    columns: dict[str, Floats]

    @property
    def tof_incident_s(self) -> Floats:
        """Incident times of flight in s."""
        return self.columns["tof_incident_s"]

    @property
    def tof_reflected_s(self) -> Floats:
        """Reflected times of flight in s."""
        return self.columns["tof_reflected_s"]

    @property
    def accuracy_reached(self) -> Floats:
        """Bounds on the relative errors of times of flight; NaN where shots were not judged."""
        return self.columns["accuracy_reached"]


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Flights):
    """Shots of one chain at several speeds. All arrays have shape (speeds,); NaN is missing.

    Attributes
    ----------
    experiment : str
        Its name.
    speed_m_s : ndarray
        Speeds of the striker in m/s.
    tof_incident_s, tof_reflected_s : ndarray
        Times of flight in s.
    accuracy_reached : ndarray
        Bounds on their relative errors.
    columns : dict of str to ndarray
        Everything: times of flight, peaks in N, widths in s, pulse speed,
        rebound in m/s, duration in s, and time and height of the highest
        maximum that could be the arrival instead (``competing_time_s``,
        ``competing_peak_n``), or the reflected pulse's peak
        (``competing_reflected_*``).
    power_law_incident, power_law_reflected : PowerLaw or None
        None where fewer than two speeds have a time of flight.
    pilots : dict or None
        Which setting pilots chose, where they were asked.
    errors : dict of int to str
        Why speeds, by index, have no shot.
    warnings : dict of int to list of str
        What is odd about the chain at speeds, by index.
    dimensionless : bool
        Whether K = m = 1 stands for SI.

    References
    ----------
    Definitions of all columns: docs/conventions.md; how accuracies are judged:
    docs/numerics.md; the paper's curves: [Labbe2017].
    """

    experiment: str
    speed_m_s: Floats
    columns: dict[str, Floats]
    power_law_incident: PowerLaw | None
    power_law_reflected: PowerLaw | None
    pilots: dict[str, Any] | None
    errors: dict[int, str]
    warnings: dict[int, list[str]]
    dimensionless: bool = False

    def to_xarray(self) -> xr.Dataset:
        """The columns as xarray has them.

        Returns
        -------
        xarray.Dataset
            One variable a column over ``speed_m_s``, its unit in ``attrs["units"]``.
        """
        columns = {name: (("speed_m_s",), values) for name, values in self.columns.items()}
        return dataset(columns, {"speed_m_s": (("speed_m_s",), self.speed_m_s)}, self.dimensionless, {"experiment": self.experiment})

    def to_pandas(self) -> pd.DataFrame:
        """The columns as pandas has them.

        Returns
        -------
        pandas.DataFrame
            One row a speed; the index is the speed in m/s; units in ``attrs["units"]``.
        """
        return frame({"speed_m_s": self.speed_m_s, **self.columns}, self.dimensionless, "speed_m_s")

    def __repr__(self) -> str:
        rows = {name: span(self.columns[name], name, self.dimensionless) for name in ("tof_incident_s", "tof_reflected_s", "accuracy_reached")}
        for name, law in (("incident", self.power_law_incident), ("reflected", self.power_law_reflected)):
            if law is not None:
                rows[f"{name} law"] = f"{short(law.prefactor_s)} · v^{short(law.exponent)}"
        if self.errors:
            rows["without a shot"] = f"{len(self.errors)} speeds"
        if self.warnings:
            rows["odd"] = f"{len(self.warnings)} of {self.speed_m_s.size} speeds, the first: {'; '.join(next(iter(self.warnings.values())))}"
        return lines(f"Sweep of {self.experiment} over {self.speed_m_s.size} speeds", rows)


@dataclass(frozen=True)
class Odd(Tabled):
    """What is odd about the chain in some shots of many, by the first of them.

    Attributes
    ----------
    index : tuple of int
        The first such shot's.
    lines : list of str
        What is odd about it, as the program warns of it, such as a law out of its range.
    shots : int
        How many shots there are of which there is something to say.

    References
    ----------
    Ranges of laws, as `hertzchain.laws` tells them: docs/physics.md.
    """

    index: tuple[int, ...]
    lines: list[str]
    shots: int

    @classmethod
    def of(cls, found: tuple[int, list[str], int] | None, shape: tuple[int, ...]) -> Odd | None:
        """From the extension's own.

        Parameters
        ----------
        found : tuple or None
            Place, lines and count.
        shape : tuple of int
            Of all shots.

        Returns
        -------
        Odd or None
            None where nothing is odd.
        """
        if found is None:
            return None
        place, said, shots = found
        return cls(tuple(int(i) for i in np.unravel_index(place, shape)), said, shots)

    def _columns(self) -> dict[str, list[Any]]:
        return {"index": [self.index], "lines": ["\n".join(self.lines)], "shots": [self.shots]}

    def __str__(self) -> str:
        return f"first of {self.shots} at {self.index}: {'; '.join(self.lines)}"


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Flights):
    """Shots over arrays of speeds and of named numbers, broadcast against each other.

    Attributes
    ----------
    experiment : str
        Its name.
    shape : tuple of int
        The common shape; every column has it.
    speed_m_s : ndarray
        Speeds of the striker in m/s.
    parameters : dict of str to ndarray
        Named numbers in SI.
    columns : dict of str to ndarray
        As in `Sweep`; NaN is missing.
    errors : dict of tuple to str
        Why there is no shot, by index.
    units : dict of str to str
        SI units of the named numbers.
    odd : Odd or None
        What is odd about the chain somewhere, such as a law out of its range.
    dimensionless : bool
        Whether K = m = 1 stands for SI.

    References
    ----------
    Definitions of all columns: docs/conventions.md; the loop that computes them:
    docs/numerics.md.
    """

    experiment: str
    shape: tuple[int, ...]
    speed_m_s: Floats
    parameters: dict[str, Floats]
    columns: dict[str, Floats]
    errors: dict[tuple[int, ...], str]
    units: dict[str, str]
    odd: Odd | None = None
    dimensionless: bool = False

    def __getitem__(self, column: str) -> Floats:
        return self.columns[column]

    def _inputs(self) -> dict[str, Floats]:
        return {"speed_m_s": self.speed_m_s, **self.parameters}

    def to_xarray(self) -> xr.Dataset:
        """The columns as xarray has them.

        Returns
        -------
        xarray.Dataset
            Every column over ``axis_0``, ``axis_1`` …, its unit in ``attrs["units"]``;
            inputs that follow one axis are its coordinates.
        """
        axes = tuple(f"axis_{at}" for at in range(len(self.shape)))
        columns = {name: (axes, values) for name, values in self.columns.items()}
        made = dataset(columns, {name: _coordinate(values, axes) for name, values in self._inputs().items()}, self.dimensionless, {"experiment": self.experiment})
        for name, unit in self.units.items():
            made[name].attrs["units"] = unit
        return made

    def to_pandas(self) -> pd.DataFrame:
        """The columns as pandas has them.

        Returns
        -------
        pandas.DataFrame
            One row a shot, in the order of a C array, inputs first; units in ``attrs["units"]``.
        """
        flat = {name: np.ravel(values) for name, values in (self._inputs() | self.columns).items()}
        return frame(flat, self.dimensionless, units=self.units)

    def __repr__(self) -> str:
        rows = {name: span(values, name, self.dimensionless) for name, values in self._inputs().items()}
        rows |= {name: span(self.columns[name], name, self.dimensionless) for name in ("tof_incident_s", "tof_reflected_s")}
        if self.errors:
            rows["without a shot"] = str(len(self.errors))
        if self.odd is not None:
            rows["odd"] = str(self.odd)
        return lines(f"Ensemble of {self.experiment}, shape {self.shape}", rows)


def _coordinate(values: Floats, axes: tuple[str, ...]) -> tuple[tuple[str, ...], Floats]:
    """The axes along which values change, and the values along them."""
    kept = [at for at in range(values.ndim) if values.shape[at] > 0 and not _same(values, at)]
    at = tuple(slice(None) if axis in kept else 0 for axis in range(values.ndim))
    if values.size == 0:
        return axes, values
    return tuple(axes[axis] for axis in kept), np.asarray(values[at])


def _same(values: Floats, axis: int) -> bool:
    first = np.take(values, [0], axis=axis)
    return bool(np.array_equal(np.broadcast_to(first, values.shape), values, equal_nan=True))
