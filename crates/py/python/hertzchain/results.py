"""What shots, sweeps and ensembles give: numbers in SI as NumPy arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ._table import Floats, dataset, frame, lines, short, span
from .errors import Finding

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Ensemble", "PowerLaw", "Shot", "Sweep", "Trace"]


@dataclass(frozen=True, eq=False, repr=False)
class Trace:
    """What sensors show while a shot runs.

    Attributes
    ----------
    time_s : ndarray, shape (samples,)
        Times in s, from the first touch on.
    signals : dict of str to ndarray, shape (samples,)
        By sensor: ``bead_7`` and ``contact_40`` in N, ``position_3`` in m,
        ``velocity_3`` in m/s, ``bead_plus_wall_7`` in N.
    energy : dict of str to ndarray, shape (steps,)
        The energy budget along the way in J, at its own ``time_s``.
    """

    time_s: Floats
    signals: dict[str, Floats]
    energy: dict[str, Floats]
    dimensionless: bool = False

    def unit(self, sensor: str) -> str:
        """Unit of a sensor's signal."""
        if self.dimensionless:
            return "1"
        return {"position": "m", "velocity": "m/s"}.get(sensor.split("_")[0], "N")

    def __getitem__(self, sensor: str) -> Floats:
        return self.signals[sensor]

    def stacked(self, kind: str) -> tuple[np.ndarray[Any, Any], Floats]:
        """Numbers of all sensors of a kind and their signals, shape (sensors, samples)."""
        found = {int(name.rsplit("_", 1)[1]): name for name in self.signals if name.rsplit("_", 1)[0] == kind}
        numbers = np.array(sorted(found), dtype=int)
        rows = [self.signals[found[number]] for number in numbers]
        return numbers, np.array(rows, dtype=float).reshape(len(rows), self.time_s.size)

    def to_xarray(self) -> xr.Dataset:
        """One variable a sensor over ``time_s``."""
        made = dataset(
            {name: (("time_s",), signal) for name, signal in self.signals.items()},
            {"time_s": (("time_s",), self.time_s)},
            self.dimensionless,
            {},
        )
        for name in self.signals:
            made[name].attrs["units"] = self.unit(name)
        return made

    def to_pandas(self) -> pd.DataFrame:
        """One column a sensor; the index is the time in s."""
        made = frame({"time_s": self.time_s, **self.signals}, self.dimensionless, "time_s")
        made.attrs["units"].update({name: self.unit(name) for name in self.signals})
        return made

    def __repr__(self) -> str:
        rows = {name: f"{short(float(np.max(np.abs(signal))))} {self.unit(name)} at most" for name, signal in self.signals.items()}
        until = f"{self.time_s.size} samples until {short(float(self.time_s[-1]) if self.time_s.size else None)} s"
        return lines(f"Trace of {until}", rows)


@dataclass(frozen=True, eq=False, repr=False)
class Shot:
    """One impact, followed to its end.

    Attributes
    ----------
    speed_m_s : float or None
        Speed of the striker in m/s.
    tof_incident_s, tof_reflected_s : float or None
        Times of flight in s: from the sensor bead to the wall, and back.
    accuracy_asked, accuracy_reached : float or None
        Relative accuracy of times of flight; reached only if it was checked.
    pulse_speed_beads_per_s : float or None
        Beads a second between sensor bead and wall.
    passage : dict
        Peaks (``time_s``, ``value`` in N), widths in s, or why there are none.
    sensor_maxima : list of dict
        Maxima of the sensor bead's signal above 5 % of its largest.
    striker_rebound : dict or None
        Velocity of the striker at first separation and at the end, in m/s.
    energy : dict or None
        The budget at the end in J.
    velocities_m_s : ndarray, shape (bodies,)
        Velocities of all bodies at the end, the striker's first.
    duration_s, solver, steps, force_passes, notes
        How it was computed, and what a reader must know.
    warnings : tuple of Finding
        What is odd about the experiment at this speed.
    trace : Trace or None
        What was sampled.
    """

    experiment: str
    speed_m_s: float | None
    tof_incident_s: float | None
    tof_reflected_s: float | None
    accuracy_asked: float
    accuracy_reached: float | None
    pulse_speed_beads_per_s: float | None
    passage: dict[str, Any]
    sensor_maxima: list[dict[str, float]]
    striker_rebound: dict[str, float | None] | None
    energy: dict[str, Any] | None
    velocities_m_s: Floats
    duration_s: float
    solver: str
    tolerance: float | None
    step_s: float | None
    force_passes: int
    steps: int
    notes: list[str]
    warnings: tuple[Finding, ...] = ()
    trace: Trace | None = None
    dimensionless: bool = False

    def to_xarray(self) -> xr.Dataset:
        """What was sampled over ``time_s``, with the shot's numbers as attributes."""
        empty = Trace(np.empty(0), {}, {}, self.dimensionless)
        made = (self.trace or empty).to_xarray()
        made.attrs.update({name: value for name, value in self._numbers().items() if value is not None})
        return made

    def to_pandas(self) -> pd.Series:
        """The shot's numbers as a series."""
        import pandas as pd

        return pd.Series(self._numbers(), name=self.experiment)

    def _numbers(self) -> dict[str, Any]:
        return {
            "speed_m_s": self.speed_m_s,
            "tof_incident_s": self.tof_incident_s,
            "tof_reflected_s": self.tof_reflected_s,
            "accuracy_reached": self.accuracy_reached,
            "pulse_speed_beads_per_s": self.pulse_speed_beads_per_s,
            "sensor_peak_n": self.passage.get("incident", {}).get("value"),
            "wall_peak_n": self.passage.get("wall", {}).get("value"),
            "returning_peak_n": (self.passage.get("reflected") or {}).get("value"),
            "striker_rebound_m_s": (self.striker_rebound or {}).get("end_m_s"),
            "duration_s": self.duration_s,
        }

    def __repr__(self) -> str:
        si = not self.dimensionless
        rows = {
            "incident ToF": f"{short(self.tof_incident_s, 9)}{' s' if si else ''}",
            "reflected ToF": f"{short(self.tof_reflected_s, 9)}{' s' if si else ''}",
        }
        if missing := self.passage.get("missing"):
            rows = {"no time of flight": str(missing)}
        if self.accuracy_reached is not None:
            rows["accuracy reached"] = short(self.accuracy_reached, 2)
        if self.energy:
            rows["energy residual"] = f"{short(self.energy['relative_residual'], 2)} of the input"
        rows |= {"note": note for note in self.notes}
        speed = "" if self.speed_m_s is None else f" at {short(self.speed_m_s)}{' m/s' if si else ''}"
        return lines(f"Shot of {self.experiment}{speed}", rows)


@dataclass(frozen=True)
class PowerLaw:
    """``tof = prefactor_s * (speed in m/s)**exponent``, by least squares of logarithms.

    Standard errors in ``*_error``; what the accuracies of the times of flight
    alone leave open in ``*_accuracy``. None where two speeds tell no errors.
    """

    prefactor_s: float
    exponent: float
    prefactor_error_s: float | None
    exponent_error: float | None
    prefactor_accuracy_s: float | None
    exponent_accuracy: float | None
    covariance: Any
    r_squared: float | None
    residuals: list[float] = field(default_factory=list[float])

    def __call__(self, speed_m_s: Any) -> Any:
        """Times of flight in s at speeds in m/s."""
        return self.prefactor_s * np.asarray(speed_m_s, dtype=float) ** self.exponent

    @classmethod
    def of(cls, found: Mapping[str, Any]) -> PowerLaw | None:
        """From the extension's own; None where no law goes through."""
        if "missing" in found:
            return None
        known: dict[str, Any] = {name: found.get(name) for name in cls.__dataclass_fields__}
        return cls(**known)


@dataclass(frozen=True, eq=False, repr=False)
class Sweep:
    """Shots of one chain at several speeds. All arrays have shape (speeds,); NaN is missing.

    Attributes
    ----------
    speed_m_s : ndarray
        Speeds of the striker in m/s.
    tof_incident_s, tof_reflected_s : ndarray
        Times of flight in s.
    accuracy_reached : ndarray
        Bounds on their relative errors.
    columns : dict of str to ndarray
        Everything: times of flight, peaks in N, widths in s, pulse speed,
        rebound in m/s, duration in s.
    power_law_incident, power_law_reflected : PowerLaw or None
        None where fewer than two speeds have a time of flight.
    errors : dict of int to str
        Why speeds, by index, have no shot.
    warnings : dict of int to list of str
        What is odd about the chain at speeds, by index.
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
        """Bounds on the relative errors of times of flight."""
        return self.columns["accuracy_reached"]

    def to_xarray(self) -> xr.Dataset:
        """One variable a column over ``speed_m_s``."""
        columns = {name: (("speed_m_s",), values) for name, values in self.columns.items()}
        return dataset(columns, {"speed_m_s": (("speed_m_s",), self.speed_m_s)}, self.dimensionless, {"experiment": self.experiment})

    def to_pandas(self) -> pd.DataFrame:
        """One row a speed; the index is the speed."""
        return frame({"speed_m_s": self.speed_m_s, **self.columns}, self.dimensionless, "speed_m_s")

    def __repr__(self) -> str:
        rows = {name: span(self.columns[name], name, self.dimensionless) for name in ("tof_incident_s", "tof_reflected_s", "accuracy_reached")}
        for name, law in (("incident", self.power_law_incident), ("reflected", self.power_law_reflected)):
            if law is not None:
                rows[f"{name} law"] = f"{short(law.prefactor_s)} · v^{short(law.exponent)}"
        if self.errors:
            rows["without a shot"] = f"{len(self.errors)} speeds"
        return lines(f"Sweep of {self.experiment} over {self.speed_m_s.size} speeds", rows)


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble:
    """Shots over arrays of speeds and of named numbers, broadcast against each other.

    Attributes
    ----------
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
    """

    experiment: str
    shape: tuple[int, ...]
    speed_m_s: Floats
    parameters: dict[str, Floats]
    columns: dict[str, Floats]
    errors: dict[tuple[int, ...], str]
    units: dict[str, str]
    dimensionless: bool = False

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
        """Bounds on the relative errors; NaN where shots were not judged."""
        return self.columns["accuracy_reached"]

    def __getitem__(self, column: str) -> Floats:
        return self.columns[column]

    def _inputs(self) -> dict[str, Floats]:
        return {"speed_m_s": self.speed_m_s, **self.parameters}

    def to_xarray(self) -> xr.Dataset:
        """Every column over ``axis_0``, ``axis_1`` …; inputs that follow one axis are its coordinates."""
        axes = tuple(f"axis_{at}" for at in range(len(self.shape)))
        columns = {name: (axes, values) for name, values in self.columns.items()}
        made = dataset(columns, {name: _coordinate(values, axes) for name, values in self._inputs().items()}, self.dimensionless, {"experiment": self.experiment})
        for name, unit in self.units.items():
            made[name].attrs["units"] = unit
        return made

    def to_pandas(self) -> pd.DataFrame:
        """One row a shot, in the order of a C array."""
        flat = {name: np.ravel(values) for name, values in (self._inputs() | self.columns).items()}
        made = frame(flat, self.dimensionless)
        made.attrs["units"].update(self.units)
        return made

    def __repr__(self) -> str:
        rows = {name: span(values, name, self.dimensionless) for name, values in self._inputs().items()}
        rows |= {name: span(self.columns[name], name, self.dimensionless) for name in ("tof_incident_s", "tof_reflected_s")}
        if self.errors:
            rows["without a shot"] = str(len(self.errors))
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
