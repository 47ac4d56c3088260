"""Simulation: one shot, sweeps over speeds, ensembles over arrays of numbers."""

from __future__ import annotations

import re
import warnings as _warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from .errors import ExperimentWarning, OptionError, findings
from .experiment import opened
from .results import Ensemble, Floats, Shot, Sweep, Trace, WarningSummary, power_law, warn

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._keywords import EnsembleOptions, ShotOptions, SweepOptions

__all__ = ["ForceLaw", "ensemble", "shot", "sweep"]

Sensor = str | tuple[str, int]

MOST_SPEEDS = 100_000
"""Most speeds in one sweep, as on the command line."""

MOST_SHOTS = 50_000_000
"""Most shots in one ensemble: their numbers alone take five gigabytes."""


@dataclass(frozen=True)
class ForceLaw:
    """A contact force as a function of overlap and overlap rate, for exploration.

    Python computes it step by step in one thread, some hundred times as slow as
    a law of the registry; `hertzchain.shot` takes it.

    Parameters
    ----------
    force : function of (overlap_m, rate_m_s)
        Force in N, positive where it pushes beads apart, from two arrays of
        shape (contacts,): overlaps δ > 0 in m and rates δ̇ in m/s, positive
        while approaching. Must return an array of that shape.
    energy : function of (overlap_m,), optional
        Energy in J that a contact gives back, of which ``force`` at δ̇ = 0 is the derivative.
        Without it shots have no energy budget; with it the rest of ``force`` counts as dissipation.
    name, equation : str
        As budgets and messages print them.
    first, last : int, optional
        Contacts on which it acts; contact 0 is the striker's, ``last=None`` the wall's.
    beside : bool
        Whether it adds to the experiment's laws there instead of replacing them.

    Examples
    --------
    >>> import numpy as np, hertzchain as hc
    >>> K = 8.79e9
    >>> hertz = ForceLaw(lambda overlap, rate: K * overlap**1.5, energy=lambda overlap: 0.4 * K * overlap**2.5)
    >>> shot = hc.shot(hc.preset("hertz"), 1.0, forces=hertz)
    """

    force: Callable[[Floats, Floats], Any]
    energy: Callable[[Floats], Any] | None = None
    name: str = "python"
    equation: str = "F(δ, δ̇)"
    first: int = 0
    last: int | None = None
    beside: bool = False

    def _native(self) -> _native.Force:
        return _native.Force(self.name, self.equation, self.force, self.energy, self.first, self.last, self.beside)


@options.with_options("shot", "solver steps")
def shot(
    experiment: Experiment | options.Path_,
    speed: float | str | None = None,
    *,
    trace: bool | Iterable[Sensor] = False,
    interval_s: float | None = None,
    forces: ForceLaw | Iterable[ForceLaw] = (),
    progress: object = None,
    **how: Unpack[ShotOptions],
) -> Shot:
    """Computes one shot: times of flight, peaks, rebound, energy.

    The model of the paper: [Labbe2017]; contact laws: `hertzchain.laws`; the solver:
    [DormandPrince1980], docs/explanation/numerics.md.

    Parameters
    ----------
    trace : bool or iterable of sensors
        Sample the experiment's sensors, or these: ``"bead_7"``,
        ``("contact", 40)``, ``"position_0"``, ``"velocity_3"``.
    interval_s : float, optional
        Time between samples in s; a tenth of the contact time when absent. A
        trace has at most 30,000,000 numbers.
    forces : ForceLaw or iterable of ForceLaw
        Force laws of Python, in place of the experiment's or beside them.

    Returns
    -------
    Shot
        Numbers in SI, bit for bit those of ``hertzchain shot --json``; ``trace`` if asked for.

    Raises
    ------
    ExperimentError, OptionError
        What the physics rejects, at its place in the experiment; a number that a shot can't have.

    Warns
    -----
    ExperimentWarning
        Warnings about the experiment at this speed, such as a law out of its range.

    Examples
    --------
    >>> import hertzchain as hc
    >>> round(1e6 * hc.shot(hc.preset("dry"), 0.5, accuracy=1e-8).tof_incident_s, 6)
    761.904024
    """
    experiment = opened(experiment)
    asked = options.text("shot", how, speed=speed)
    laws = [] if forces is None else list(forces) if isinstance(forces, Iterable) else [forces]
    if not all(isinstance(law, ForceLaw) for law in laws):
        raise OptionError("forces takes ForceLaw, one or several")
    sensors, interval = _sensors(trace), None if interval_s is None else float(interval_s)
    if sensors is None and interval is not None:
        raise OptionError("interval_s is for the samples of a trace: give trace, or leave it out")
    with options.progress(progress, None, "step") as update:
        found = _native.shot(experiment, asked, None if sensors is None else (sensors, interval), [law._native() for law in laws], update)
    warnings = findings(found.pop("warnings"))
    for warning in warnings:
        _warnings.warn(warning.report, ExperimentWarning, stacklevel=2)
    raw, velocities, dimensionless = found.pop("trace"), found.pop("velocities_m_s"), experiment.is_dimensionless
    sampled = None
    if raw is not None:
        names = [f"{kind}_{number}" for kind, number in raw["sensors"]]
        sampled = Trace(raw["time_s"], dict(zip(names, raw["columns"], strict=True)), raw["energy"], dimensionless)
    return Shot(found, velocities, warnings, sampled, dimensionless)


def _sensors(trace: bool | Iterable[Sensor]) -> list[tuple[str, int]] | None:
    """Sensors by kind and number; an empty list for the experiment's own."""
    if isinstance(trace, bool) or trace is None:
        return [] if trace else None
    if found := [_sensor(sensor) for sensor in ([trace] if isinstance(trace, str) else trace)]:
        return found
    raise OptionError("trace names no sensor; True takes the experiment's own")


def _sensor(sensor: Sensor) -> tuple[str, int]:
    kind, number = sensor.rpartition("_")[::2] if isinstance(sensor, str) else sensor
    if not str(number).isdecimal():
        raise OptionError(f"{sensor!r} is no sensor; expected a kind and a number, such as bead_7")
    return kind, int(number)


@options.with_options("sweep")
def sweep(
    experiment: Experiment | options.Path_,
    speeds: ArrayLike | str = "log:0.075:1.23:25",
    *,
    progress: object = None,
    **how: Unpack[SweepOptions],
) -> Sweep:
    """Computes times of flight against speed, with power-law fits.

    Curves of times of flight: [Labbe2017]; error control: docs/explanation/numerics.md.

    Parameters
    ----------
    speeds : array_like of shape (speeds,), or str
        Speeds in m/s, at most 100,000; or ``"0.1,0.2"``, ``"FROM:TO:COUNT"``, ``"log:FROM:TO:COUNT"``.

    Returns
    -------
    Sweep
        Arrays of shape (speeds,) in SI, NaN where there is no number; bit for bit those of
        ``hertzchain sweep --json``.

    Raises
    ------
    ExperimentError, OptionError
        If no speed can be computed; a single speed that fails is in ``Sweep.errors``.

    Warns
    -----
    ExperimentWarning
        Once a call: the warnings of the first speed that has any, and how many others have; all of
        them are in ``Sweep.warnings``.
    """
    experiment = opened(experiment)
    values = _native.speeds(speeds) if isinstance(speeds, str) else _numbers("speeds", speeds)
    # A letter behind a digit, but for that of an exponent.
    if experiment.is_dimensionless and isinstance(speeds, str) and re.search(r"[\d.]\s*(?![eE][-+\d])[^\W\d_]", speeds):
        raise OptionError(f"--speeds {speeds} has a unit, but the experiment is dimensionless; expected numbers: 0.5,1")
    if values.ndim > 1 or values.size > MOST_SPEEDS:
        raise OptionError(f"speeds, {values.shape}: expected one dimension, at most {MOST_SPEEDS}; see `ensemble`")
    values = np.ascontiguousarray(np.atleast_1d(values))
    with options.progress(progress, values.size, "shot") as update:
        found = _native.Run(experiment, values, [], [], options.text("sweep", how)).compute(True, update)
    errors, warnings = dict(found["errors"]), dict(found["warnings"])
    _check_any(errors, values.size)
    warn(next(iter(warnings.values()), []), len(warnings))
    laws = (power_law(found[f"power_law_{end}"], experiment.is_dimensionless) for end in ("incident", "reflected"))
    return Sweep(
        found["experiment"], found["speed_m_s"], found["columns"], *laws, found["calibration"], found["error_control"], errors, warnings,
        experiment.is_dimensionless,
    )  # fmt: skip


@options.with_options("ensemble")
def ensemble(
    experiment: Experiment | options.Path_,
    speed: ArrayLike | None = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    *,
    progress: object = None,
    **how: Unpack[EnsembleOptions],
) -> Ensemble:
    """Computes shots over arrays of speeds and of named numbers, at the engine's full speed.

    Arrays are broadcast against each other as NumPy does. Batches of shots in equal steps:
    docs/explanation/numerics.md.

    Parameters
    ----------
    speed : array_like, optional
        Speeds of the striker in m/s; the experiment's own when absent.
    parameters : mapping of str to array_like, optional
        Numbers of the experiment in SI by their paths, or by unmistakable ends
        of them: ``{"young_modulus": [200e9, 213e9]}``. Neighbours along the last
        axis that share their numbers are set up once.

    Returns
    -------
    Ensemble
        Columns of the common shape in SI, NaN where there is no number.

    Raises
    ------
    ExperimentError, OptionError
        A name that is no number, arrays that do not fit each other, or an
        ensemble of which nothing can be computed; single shots that fail are
        in ``Ensemble.errors``.

    Warns
    -----
    ExperimentWarning
        Once a call: as in ``Ensemble.warnings``.

    Examples
    --------
    >>> import numpy as np, hertzchain as hc
    >>> found = hc.ensemble(hc.preset("dry"), np.array([[0.1], [0.5]]), {"damping_cubic.coefficient": [0.0, 77.0]})
    >>> found.tof_incident_s.shape
    (2, 2)
    """
    experiment = opened(experiment)
    speeds, values = broadcast(experiment, speed, parameters)
    with options.progress(progress, speeds.size, "shot") as update:
        found = _native.Run(experiment, speeds, list(values), list(values.values()), options.text("ensemble", how)).compute(False, update)
    return gathered(experiment, speeds.shape, list(values), found)


def gathered(experiment: Experiment, shape: tuple[int, ...], names: Sequence[str], found: Mapping[str, Any]) -> Ensemble:
    """An ensemble from the extension's rows, with one warning for all its shots."""

    def index(place: int) -> tuple[int, ...]:
        return tuple(int(at) for at in np.unravel_index(place, shape))

    summary = None
    if (first := found["warnings"]) is not None:
        place, messages, shots = first
        summary = WarningSummary(index(place), messages, shots)
        warn(messages, shots, 4)
    _check_any(dict(found["errors"]), int(np.prod(shape)), 4)
    units = [(path, unit) for path, _, unit in experiment.numbers()]
    return Ensemble(
        experiment=experiment.name,
        shape=shape,
        speed_m_s=found["speed_m_s"].reshape(shape),
        parameters={name: own.reshape(shape) for name, own in zip(names, found["values"], strict=True)},
        columns={name: column.reshape(shape) for name, column in found["columns"].items()},
        errors={index(place): why for place, why in found["errors"]},
        parameter_units={name: next((unit for path, unit in units if f".{path}".endswith(f".{name}")), "1") for name in names},
        warnings=summary,
        dimensionless=experiment.is_dimensionless,
        error_control=found["error_control"],
    )


def broadcast(
    experiment: Experiment, speed: ArrayLike | None, parameters: Mapping[str, ArrayLike] | None
) -> tuple[Floats, dict[str, Floats]]:
    """Speeds and named numbers of one shape, as an ensemble takes them."""
    if speed is None:
        if experiment.speed_m_s is None:
            raise OptionError("an ensemble needs a chain with a striker")
        speed = experiment.speed_m_s
    named = {name: _numbers(name, values) for name, values in (parameters or {}).items()}
    arrays = [_numbers("speed", speed), *named.values()]
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in zip(["speed", *named], arrays, strict=True))
        raise OptionError(f"these shapes can't be broadcast against each other: {shapes}") from None
    if (count := int(np.prod(shape, dtype=object))) > MOST_SHOTS:
        raise OptionError(f"an ensemble of shape {shape} has {count} shots; expected at most {MOST_SHOTS}: call it in parts")
    speeds, *values = (np.broadcast_to(array, shape) for array in arrays)
    return speeds, dict(zip(named, values, strict=True))


def _numbers(name: str, values: object) -> Floats:
    """Real numbers of any shape, as doubles."""
    made = np.asarray(options.unmasked(values))
    if made.dtype.kind not in "fiu":
        raise OptionError(f"{name} holds {made.dtype}: expected real numbers")
    return made.astype(np.float64, copy=False)


def _check_any(errors: Mapping[int, str], count: int, level: int = 3) -> None:
    """Raises where no shot was computed, and warns where some were not, as at a speed of NaN."""
    if not errors:
        return
    first = next(iter(errors.values()))
    if len(errors) == count:
        raise OptionError(f"no shot could be computed; the first: {first}")
    _warnings.warn(f"{len(errors)} of {count} shots could not be computed; the first: {first}", ExperimentWarning, stacklevel=level)
