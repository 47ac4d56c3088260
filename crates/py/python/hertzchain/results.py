"""What a shot gives: numbers in SI as NumPy arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ._table import Floats, Tabled, dataset, frame, lines, number, short, unit
from .errors import Finding

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["PowerLaw", "Shot", "Trace"]


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
    dimensionless : bool
        Whether K = m = 1 stands for SI: all units are then "1".

    References
    ----------
    What sensors show: docs/conventions.md.
    """

    time_s: Floats
    signals: dict[str, Floats]
    energy: dict[str, Floats]
    dimensionless: bool = False

    def unit(self, sensor: str) -> str:
        """Unit of a sensor's signal.

        Parameters
        ----------
        sensor : str
            Its name, such as ``"bead_7"``.

        Returns
        -------
        str
            "N", "m", "m/s", or "1" without units.
        """
        if self.dimensionless:
            return "1"
        return {"position": "m", "velocity": "m/s"}.get(sensor.split("_")[0], "N")

    def __getitem__(self, sensor: str) -> Floats:
        return self.signals[sensor]

    def stacked(self, kind: str) -> tuple[np.ndarray[Any, Any], Floats]:
        """Signals of all sensors of a kind as one array.

        Parameters
        ----------
        kind : str
            "bead", "contact", "position" or "velocity".

        Returns
        -------
        numbers : ndarray of int, shape (sensors,)
            Their beads or contacts, in order.
        signals : ndarray, shape (sensors, samples)
            In N, m or m/s.
        """
        found = {int(name.rsplit("_", 1)[1]): name for name in self.signals if name.rsplit("_", 1)[0] == kind}
        numbers = np.array(sorted(found), dtype=int)
        rows = [self.signals[found[number]] for number in numbers]
        return numbers, np.array(rows, dtype=float).reshape(len(rows), self.time_s.size)

    def to_xarray(self) -> xr.Dataset:
        """Signals as xarray has them.

        Returns
        -------
        xarray.Dataset
            One variable a sensor over ``time_s``, its unit in ``attrs["units"]``.
        """
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
        """Signals as pandas has them.

        Returns
        -------
        pandas.DataFrame
            One column a sensor; the index is the time in s; units in ``attrs["units"]``.
        """
        units = {name: self.unit(name) for name in self.signals}
        return frame({"time_s": self.time_s, **self.signals}, self.dimensionless, "time_s", units)

    def __repr__(self) -> str:
        rows = {name: f"{short(float(np.max(np.abs(signal))))} {self.unit(name)} at most" for name, signal in self.signals.items()}
        until = f"{self.time_s.size} samples until {short(float(self.time_s[-1]) if self.time_s.size else None)} s"
        return lines(f"Trace of {until}", rows)


@dataclass(frozen=True, eq=False, repr=False)
class Shot:
    """One impact, followed to its end.

    Attributes
    ----------
    experiment : str
        Its name.
    speed_m_s : float or None
        Speed of the striker in m/s.
    tof_incident_s, tof_reflected_s : float or None
        Times of flight in s: from the sensor bead to the wall, and back.
    accuracy_asked, accuracy_reached : float or None
        Relative error that times of flight may have; its bound reached, only if it was checked.
    pulse_speed_beads_per_s : float or None
        Beads a second between sensor bead and wall.
    passage : dict
        Peaks (``time_s``, ``value`` in N), widths in s, maxima that could be a peak
        instead (``competing``), the end of the search; or why there are none (``missing``),
        with the peak of the wall alone (``wall``) where the sensor bead has none before it.
    sensor_maxima : list of dict
        Maxima of the sensor bead's signal above 5 % of its largest.
    striker_rebound : dict or None
        Velocity of the striker at first separation and at the end, in m/s.
    energy : dict or None
        The budget at the end in J.
    velocities_m_s : ndarray, shape (bodies,)
        Velocities of all bodies at the end, the striker's first.
    duration_s : float
        How long the shot was followed, in s.
    solver, tolerance, step_s, force_passes, steps
        How it was computed: in words, error allowed a step, its length in s, counts.
    notes : list of str
        What a reader must know.
    warnings : tuple of Finding
        What is odd about the experiment at this speed.
    trace : Trace or None
        What was sampled.
    dimensionless : bool
        Whether K = m = 1 stands for SI.

    References
    ----------
    How times of flight, peaks and the budget are defined: docs/conventions.md; how they
    are computed: docs/numerics.md, with the pair of [DormandPrince1980].
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
        """What was sampled, as xarray has it.

        Returns
        -------
        xarray.Dataset
            One variable a sensor over ``time_s`` with its unit in ``attrs["units"]``; the
            shot's numbers, in SI, are attributes of the whole.
        """
        empty = Trace(np.empty(0), {}, {}, self.dimensionless)
        made = (self.trace or empty).to_xarray()
        made.attrs.update({name: value for name, value in self._numbers().items() if value is not None})
        return made

    def to_pandas(self) -> pd.Series:
        """The shot's numbers as pandas has them.

        Returns
        -------
        pandas.Series
            By name, NaN where there is none; units in ``attrs["units"]``.
        """
        import pandas as pd

        made = pd.Series({name: number(value) for name, value in self._numbers().items()}, name=self.experiment)
        made.attrs["units"] = {name: unit(name, self.dimensionless) for name in self._numbers()}
        return made

    def _numbers(self) -> dict[str, Any]:
        return {
            "speed_m_s": self.speed_m_s,
            "tof_incident_s": self.tof_incident_s,
            "tof_reflected_s": self.tof_reflected_s,
            "accuracy_reached": self.accuracy_reached,
            "pulse_speed_beads_per_s": self.pulse_speed_beads_per_s,
            "sensor_peak_n": self.passage.get("incident", {}).get("value"),
            "wall_peak_n": (self.passage.get("wall") or {}).get("value"),
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


@dataclass(frozen=True, repr=False)
class PowerLaw(Tabled):
    """``tof = prefactor_s * (speed in m/s)**exponent``, by least squares of logarithms.

    Attributes
    ----------
    prefactor_s, exponent : float
        The time of flight at 1 m/s in s; −1/5 for Hertz contacts alone.
    prefactor_error_s, exponent_error : float or None
        Standard errors by the scatter; None where two speeds tell none.
    prefactor_accuracy_s, exponent_accuracy : float or None
        What the accuracies of the times of flight alone leave open.
    covariance : list of list of float or None, shape (2, 2)
        Of the logarithm of the prefactor and the exponent.
    r_squared : float or None
        Share of the scatter that the law explains.
    residuals : list of float
        Relative differences of the times from the law, speed by speed.
    dimensionless : bool
        Whether K = m = 1 stands for SI.

    References
    ----------
    Scaling of Hertz chains: [Nesterenko1983]; the paper's curves: [Labbe2017].
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
    dimensionless: bool = False

    def __call__(self, speed_m_s: Any) -> Any:
        """Times of flight by the law.

        Parameters
        ----------
        speed_m_s : array_like
            Speeds in m/s, of any shape.

        Returns
        -------
        ndarray
            Times of flight in s, of the same shape.
        """
        return self.prefactor_s * np.asarray(speed_m_s, dtype=float) ** self.exponent

    @classmethod
    def of(cls, found: Mapping[str, Any], dimensionless: bool = False) -> PowerLaw | None:
        """From the extension's own.

        Parameters
        ----------
        found : mapping
            As the program's JSON has it.
        dimensionless : bool
            Whether K = m = 1 stands for SI.

        Returns
        -------
        PowerLaw or None
            None where no law goes through.
        """
        if "missing" in found:
            return None
        known: dict[str, Any] = {name: found.get(name) for name in cls.__dataclass_fields__}
        return cls(**known | {"residuals": found.get("residuals") or [], "dimensionless": dimensionless})

    def _columns(self) -> dict[str, list[float]]:
        names = ("prefactor_s", "prefactor_error_s", "prefactor_accuracy_s", "exponent", "exponent_error", "exponent_accuracy", "r_squared")
        return {name: [number(getattr(self, name))] for name in names}

    def _units(self) -> dict[str, str]:
        return {name: "1" if self.dimensionless else "s" for name in ("prefactor_s", "prefactor_error_s", "prefactor_accuracy_s")}

    def __repr__(self) -> str:
        def told(value: float, error: float | None) -> str:
            return short(value) if error is None else f"({short(value)} ± {short(error, 2)})"

        unit = "" if self.dimensionless else " s"
        return f"PowerLaw {told(self.prefactor_s, self.prefactor_error_s)}{unit} · v^{told(self.exponent, self.exponent_error)}"
