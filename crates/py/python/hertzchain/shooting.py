"""Shots: one, several speeds, ensembles."""

from __future__ import annotations

import warnings as _warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._table import Floats, warned
from .curves import Ensemble, Odd, Sweep
from .errors import ExperimentWarning, Finding, OptionError
from .force import ForceLaw
from .results import PowerLaw, Shot, Trace

__all__ = ["ensemble", "shot", "sweep"]

Sensor = str | tuple[str, int]

MOST_SPEEDS = 100_000
"""Most speeds in one sweep, as on the command line."""

MOST_SHOTS = 50_000_000
"""Most shots in one ensemble: their numbers alone take five gigabytes."""


def shot(
    experiment: Experiment,
    speed: float | str | None = None,
    *,
    accuracy: float | None = None,
    solver: options.Solver | None = None,
    step: float | str | None = None,
    duration: float | str | None = None,
    pick: options.Pick | None = None,
    check: bool = False,
    trace: bool | Iterable[Sensor] = False,
    interval_s: float | None = None,
    forces: ForceLaw | Iterable[ForceLaw] = (),
    progress: object = None,
) -> Shot:
    """Computes one shot: times of flight, peaks, rebound, energy.

    Parameters
    ----------
    experiment : Experiment
        The chain and what hits it.
    speed : float or str, optional
        Speed of the striker in m/s, or a text such as ``"50 cm/s"``; the
        experiment's own when absent.
    accuracy : float, optional
        Relative accuracy of times of flight, from 1e-13 to 1e-2.
    solver : {"adaptive", "rk4", "verlet"}, optional
        How the motion is computed; the experiment's own when absent.
    step, duration : float or str, optional
        Step of a solver that has one, and how long the shot is followed, in s.
    pick : {"peak", "flank-10", "flank-50", "cross-correlation"}, optional
        Where pulses are timed.
    check : bool
        Compute again ten times as tightly and tell the accuracy reached.
    trace : bool or iterable of sensors
        Sample the experiment's sensors, or these: ``"bead_7"``,
        ``("contact", 40)``, ``"position_0"``, ``"velocity_3"``.
    interval_s : float, optional
        Time between samples in s; a tenth of the contact time when absent. A
        trace has at most 10^8 numbers.
    forces : ForceLaw or iterable of ForceLaw
        Force laws of Python, in place of the experiment's or beside them.
    progress : bool, bar or function, optional
        True draws tqdm's bar; a bar's ``update``, or a function, is told how many
        steps of the solver were taken since the last time.

    Returns
    -------
    Shot
        Numbers in SI; ``trace`` if asked for.

    Raises
    ------
    ExperimentError
        What the physics refuses, at its place in the experiment.
    OptionError
        A number that a shot can't have.

    Warns
    -----
    ExperimentWarning
        What is odd about the experiment at this speed, such as a law out of its range.

    Notes
    -----
    The numbers are those of ``hertzchain shot --json``, bit for bit.

    Examples
    --------
    >>> import hertzchain as hc
    >>> round(1e6 * hc.shot(hc.preset("dry"), 0.5, accuracy=1e-8).tof_incident_s, 6)
    761.904024

    References
    ----------
    The model of the paper: [Labbe2017]; contact laws: `hertzchain.laws`; the solver:
    [DormandPrince1980], docs/numerics.md.
    """
    how = options.how(accuracy, solver, step, duration, pick, check)
    laws = [forces] if isinstance(forces, ForceLaw) else list(forces)
    at = None if speed is None else options.text(speed)
    watched, interval, native = _watched(trace), _interval(interval_s), [law.native() for law in laws]
    watch = None if watched is None else (watched, interval)
    with options.progress(progress, None, "step") as update:
        found = _native.shot(experiment, at, how, watch, native, update)
    odd = tuple(Finding.of(raw) for raw in found.pop("warnings"))
    for warning in odd:
        _warnings.warn(warning.report, ExperimentWarning, stacklevel=2)
    raw = found.pop("trace")
    sampled = None if raw is None else _trace(raw, experiment.is_dimensionless)
    return Shot(**found, warnings=odd, trace=sampled, dimensionless=experiment.is_dimensionless)


def _interval(interval_s: float | None) -> float | None:
    return None if interval_s is None else float(interval_s)


def _watched(trace: bool | Iterable[Sensor]) -> list[tuple[str, int]] | None:
    """Sensors by kind and number; none for the experiment's own."""
    if isinstance(trace, bool):
        return [] if trace else None
    found = [_sensor(sensor) for sensor in ([trace] if isinstance(trace, str) else trace)]
    if not found:
        raise OptionError("trace names no sensor; True takes the experiment's own")
    return found


def _sensor(sensor: Sensor) -> tuple[str, int]:
    kind, number = sensor.rpartition("_")[::2] if isinstance(sensor, str) else sensor
    try:
        whole = int(number)
    except (TypeError, ValueError):
        whole = -1
    if whole < 0:
        raise OptionError(f"{sensor!r} is no sensor; expected a kind and a number, such as bead_7")
    return kind, whole


def _trace(raw: Mapping[str, Any], dimensionless: bool) -> Trace:
    names = [f"{kind}_{number}" for kind, number in raw["sensors"]]
    return Trace(raw["time_s"], dict(zip(names, raw["columns"], strict=True)), raw["energy"], dimensionless)


def _asked(how: list[str], rebound: bool, judges: str, threads: int | None) -> dict[str, Any]:
    return {"options": how, "rebound": bool(rebound), "judges": judges, "threads": options.count("threads", threads)}


def sweep(
    experiment: Experiment,
    speeds: ArrayLike | str = "log:0.075:1.23:25",
    *,
    accuracy: float | None = None,
    solver: options.Solver | None = None,
    step: float | str | None = None,
    duration: float | str | None = None,
    pick: options.Pick | None = None,
    check: bool = False,
    rebound: bool = False,
    judges: Literal["each", "pilots"] = "each",
    threads: int | None = None,
    progress: object = None,
) -> Sweep:
    """Computes times of flight against speed, with power-law fits.

    Parameters
    ----------
    experiment : Experiment
        A chain with a striker.
    speeds : array_like of shape (speeds,), or str
        Speeds in m/s, at most 100,000; or ``"0.1,0.2"``, ``"FROM:TO:COUNT"``, ``"log:FROM:TO:COUNT"``.
    accuracy, solver, step, duration, pick, check
        As for `shot`; errors of times of flight are below ``accuracy`` of them.
    rebound : bool
        Follow the striker until it is away for good; takes the slower loop.
    judges : {"each", "pilots"}
        Who tells how right times of flight are: two more shots each, or forty
        pilots for all.
    threads : int, optional
        All cores when absent; results do not depend on it.
    progress : bool, bar or function, optional
        True draws tqdm's bar; a bar's ``update``, or a function, is told how
        many shots were done since the last time.

    Returns
    -------
    Sweep
        Arrays of shape (speeds,) in SI, NaN where there is no number.

    Raises
    ------
    ExperimentError, OptionError
        What no speed can do; a single speed that fails is in ``Sweep.errors``.

    Warns
    -----
    ExperimentWarning
        Once a call: what is odd at the first such speed, and at how many others; all of
        it is in ``Sweep.warnings``.

    Notes
    -----
    The numbers are those of ``hertzchain sweep --json``, bit for bit.

    References
    ----------
    Curves of times of flight: [Labbe2017]; judges and pilots: docs/numerics.md.
    """
    values = _native.speeds(speeds) if isinstance(speeds, str) else _numbers("speeds", speeds)
    if values.size > MOST_SPEEDS:
        raise OptionError(f"{values.size} speeds: expected at most {MOST_SPEEDS}; `ensemble` takes more")
    if values.ndim > 1:
        raise OptionError(f"speeds of shape {values.shape}: expected one dimension; `ensemble` takes more")
    values = np.ascontiguousarray(np.atleast_1d(values))
    how = options.how(accuracy, solver, step, duration, pick, check)
    with options.progress(progress, values.size, "shot") as update:
        found = _native.sweep(experiment, values, _asked(how, rebound, judges, threads), update)
    errors, odd = dict(found["errors"]), dict(found["warnings"])
    _all_failed(errors, values.size)
    warned(next(iter(odd.values()), []), len(odd))
    return Sweep(
        experiment=found["experiment"],
        speed_m_s=found["speed_m_s"],
        columns=found["columns"],
        power_law_incident=PowerLaw.of(found["power_law_incident"], experiment.is_dimensionless),
        power_law_reflected=PowerLaw.of(found["power_law_reflected"], experiment.is_dimensionless),
        pilots=found["pilots"],
        errors=errors,
        warnings=odd,
        dimensionless=experiment.is_dimensionless,
    )


def ensemble(
    experiment: Experiment,
    speed: ArrayLike | None = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    *,
    accuracy: float | None = None,
    duration: float | str | None = None,
    pick: options.Pick | None = None,
    rebound: bool = False,
    judges: Literal["each", "pilots", "none"] = "each",
    threads: int | None = None,
    progress: object = None,
) -> Ensemble:
    """Computes shots over arrays of speeds and of named numbers, at the engine's full speed.

    Arrays are broadcast against each other as NumPy does.

    Parameters
    ----------
    experiment : Experiment
        A chain with a striker.
    speed : array_like, optional
        Speeds of the striker in m/s; the experiment's own when absent.
    parameters : mapping of str to array_like, optional
        Numbers of the experiment in SI by their paths, or by unmistakable ends
        of them: ``{"young_modulus": [200e9, 213e9]}``. Neighbours along the last
        axis that share their numbers are set up once.
    accuracy, duration, pick, rebound, threads, progress
        As for `sweep`.
    judges : {"each", "pilots", "none"}
        As for `sweep`; ``"none"`` computes every shot once, to the same accuracy,
        and tells nothing about it.

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
        Once a call: what is odd about the first such shot, and of how many; it is in
        ``Ensemble.odd``.

    Examples
    --------
    >>> import numpy as np, hertzchain as hc
    >>> found = hc.ensemble(hc.preset("dry"), np.array([[0.1], [0.5]]), {"damping_cubic.coefficient": [0.0, 77.0]})
    >>> found.tof_incident_s.shape
    (2, 2)

    References
    ----------
    Many shots side by side in equal steps: docs/numerics.md.
    """
    speeds, values = broadcast(experiment, speed, parameters)
    how = options.how(accuracy, None, None, duration, pick, False)
    asked = _asked(how, rebound, judges, threads)
    with options.progress(progress, speeds.size, "shot") as update:
        found = _native.ensemble(experiment, speeds, list(values), list(values.values()), asked, update)
    _all_failed(dict(found["errors"]), speeds.size)
    shape = speeds.shape
    odd = Odd.of(found["odd"], shape)
    if odd is not None:
        warned(odd.lines, odd.shots)
    errors = {tuple(int(i) for i in np.unravel_index(at, shape)): why for at, why in found["errors"]}
    return Ensemble(
        experiment=experiment.name,
        shape=shape,
        speed_m_s=found["speed_m_s"].reshape(shape),
        parameters={name: own.reshape(shape) for name, own in zip(values, found["values"], strict=True)},
        columns={name: column.reshape(shape) for name, column in found["columns"].items()},
        errors=errors,
        units=units_of(experiment, values),
        odd=odd,
        dimensionless=experiment.is_dimensionless,
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
    for name in named:
        experiment.get(name)
    speeds, *values = _broadcast({"speed": _numbers("speed", speed), **named})
    return speeds, dict(zip(named, values, strict=True))


def units_of(experiment: Experiment, names: Iterable[str]) -> dict[str, str]:
    """SI units of named numbers."""
    units = {path: unit for path, _, unit in experiment.numbers()}

    def of(name: str) -> str:
        return next((unit for path, unit in units.items() if path == name or path.endswith(f".{name}")), "1")

    return {name: of(name) for name in names}


def _numbers(name: str, values: object) -> Floats:
    """Real numbers of any shape, as doubles."""
    made = np.asarray(values)
    if made.dtype.kind not in "fiu":
        raise OptionError(f"{name} holds {made.dtype}: expected real numbers")
    return made.astype(np.float64, copy=False)


def _broadcast(arrays: Mapping[str, Floats]) -> Sequence[Floats]:
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise OptionError(f"these shapes can't be broadcast against each other: {shapes}") from None
    if (count := int(np.prod(shape, dtype=object))) > MOST_SHOTS:
        raise OptionError(f"an ensemble of shape {shape} has {count} shots; expected at most {MOST_SHOTS}: call it in parts")
    return [np.broadcast_to(array, shape) for array in arrays.values()]


def _all_failed(errors: Mapping[int, str], count: int) -> None:
    if count and len(errors) == count:
        raise OptionError(f"no shot could be computed; the first: {errors[0]}")
