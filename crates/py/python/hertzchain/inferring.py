"""From times of flight to contacts: which parameters, which oil, what to measure next."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, Literal

import numpy as np

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._posing import Data, Method, What, assumed, kept, modelled, recordings, table, words
from .errors import ExperimentWarning
from .inferred import Designed, Fitted, Gauged, Parameter

__all__ = ["Data", "design", "fit", "gauge"]


def fit(
    data: Any,
    model: Experiment | str | None = None,
    *,
    free: str | Iterable[str],
    case: str | None = None,
    use: Iterable[What] = ("incident", "reflected"),
    method: Method = "covariance",
    start: options.Assignments | None = None,
    bounds: options.Assignments | None = None,
    prior: options.Assignments | None = None,
    scale: options.Assignments | None = None,
    fixed: options.Assignments | None = None,
    against: Mapping[str, str | Iterable[str]] | None = None,
    speed_error: float | None = None,
    tof_error: float | None = None,
    ratio_error: float | None = None,
    error_shots: int | Literal["known"] | None = None,
    accuracy: float = 1e-5,
    robust: bool = False,
    starts: int = 1,
    steps: int = 20000,
    direct: bool = False,
    shots: str | os.PathLike[str] | None = None,
    rate: str | float | None = None,
    channel: str | int | Iterable[str | int] = (),
    low_pass: str | float | None = None,
    filter: str | None = None,
    most_shots: int = 40,
    seed: int = 0,
    threads: int | None = None,
    folder: str | os.PathLike[str] | None = None,
    progress: object = None,
) -> Fitted:
    """Fits contact parameters to times of flight or to whole pulses, with errors one can trust.

    Parameters
    ----------
    data : path, mapping of columns, DataFrame, Measured or Sweep; or paths of recordings
        Times of flight in s against ``speed_m_s``, errors in ``*_error`` columns: a table. What is
        NaN, or masked, was not measured.
        Or recordings of any format that `measure` reads, files or folders of them: then
        whole pulses are fitted, sample by sample.
    model : Experiment or str, optional
        The model, or the name of a preset. Where it is absent the paper's dry chain is assumed
        (preset ``"dry"``), with a warning.
    free : str or iterable of str
        Free numbers: short names (Y, nu, eta, K, A, B, of a material or section as
        in ``"wet.K"``) or paths; ``:power`` for a power law of speed, ``:each``
        for one value a speed.
    method : {"covariance", "profile", "posterior"}
        How uncertainty is told, beside the covariance.
    start, scale, fixed : mapping of str to float or str, optional
        Numbers in SI or texts with a unit, by name.
    bounds, prior : mapping of str to pair, optional
        ``{"eta": (1e4, 1e5)}``: least and largest value; mean and standard deviation.
    against : mapping of str to str, optional
        Other models of the same data: presets or files, and what is free in them.
    speed_error, tof_error, ratio_error : float, optional
        Standard errors in m/s, s and 1 where the table has none; ``speed_error=0`` says that
        speeds are exact.
    error_shots : int or "known", optional
        Shots a row from whose scatter the standard errors come, which widens them for that; what the
        table tells in its columns ``shots`` and ``tof_incident_s_count`` when absent.
    use : iterable of {"incident", "reflected", "wall-ratio", "returning-ratio"}
        Which observables of a table are fitted.
    accuracy : float
        Relative error that the model's times of flight may have.
    steps : int
        Most steps of a posterior's walkers.
    direct : bool
        Compute every curve of a posterior, in place of interpolating where that is as good.
    folder : path, optional
        Where residuals so far and a posterior's walkers are kept. The same call with the same folder
        goes on where one was broken off, and comes to the same bits; walkers stay there, to
        be led on with more ``steps``.
    shots : path, optional
        Of recordings: table of speeds and cases, as for `measure`.
    rate, channel
        Of recordings that do not say: sampling rate in Hz; the sensor bead's channel and the wall's.
    low_pass, filter
        Of recordings: corner of the amplifier's low-pass in Hz or with a unit, and its order and
        kind (``"first"``, ``"butterworth2"`` to ``"butterworth4"``, ``"bessel2"`` to ``"bessel4"``),
        in place of the model's.
    most_shots : int
        Most recordings that are fitted, spread evenly over those that are good.
    case, robust, starts, seed, threads
        As the options of ``hertzchain fit``.
    progress : bool, bar or function, optional
        True draws tqdm's bar; a bar's ``update``, or a function, is told how many curves of
        the model were tried since the last time (of recordings: signals of single shots).

    Warns
    -----
    ExperimentWarning
        Speeds without errors, which are taken as exactly known; a model that is not named.

    Returns
    -------
    Fitted
        Parameters in SI with standard errors, what is not determined, and all of ``fit.json``.

    Raises
    ------
    OptionError
        Names, tables and options that do not fit, and what is in the way of a fit.
    ExperimentError
        Mistakes in the model.

    Notes
    -----
    The numbers are those of ``hertzchain fit --json``, bit for bit.

    References
    ----------
    Errors in speeds: [York2004]; whole pulses: [GolubPereyra1973]; descent: [More1978];
    the sampler: [GoodmanWeare2010], [ForemanMackey2013]. See docs/inferring.md.
    """
    rivals = {model: given if isinstance(given, str) else ",".join(given) for model, given in (against or {}).items()}
    told = words(
        case=case, use=use, method=method, start=start, bounds=bounds, prior=prior, scale=scale, fixed=fixed,
        speed_error=speed_error, tof_error=tof_error, ratio_error=ratio_error, error_shots=error_shots, accuracy=accuracy, robust=robust,
        starts=starts, steps=steps, direct=direct, seed=seed, threads=threads,
    )  # fmt: skip
    told += options.listed("free", free)
    told += [f"--against={model}={given}" for model, given in rivals.items()]
    told += kept(folder)
    told += options.words(shots=shots, rate=rate)
    told += [f"--channel={name}" for name in ([channel] if isinstance(channel, (str, int)) else channel)]
    files = recordings(data, shots is not None or rate is not None or channel != ())
    with options.progress(progress, None, "curve") as update:
        if files is None:
            name, text = table(data)
            found = _native.fit((name, text), modelled(model), [*told, "--", name], update)
            return fitted({**found, "assumed_model": assumed(model=(model, "dry"))})
        told += options.words(low_pass=low_pass, filter=filter, most_shots=most_shots)
        found = _native.fit_pulses(modelled(model), [*told, "--", *files], update)
        return fitted({**found, "assumed_model": assumed(model=(model, "dry"))})


def fitted(found: dict[str, Any]) -> Fitted:
    """A fit from what the library tells of it."""
    for key in ("assumed", "held_loads"):
        if (taken := found.get(key)) is not None:
            warnings.warn(taken, ExperimentWarning, stacklevel=3)
    rows, samples = found.pop("rows"), found.pop("samples", None)
    columns = {key: [row[key] for row in rows] for key in (rows[0] if rows else {})}
    return Fitted(
        parameters={raw["name"]: Parameter(**raw) for raw in found["parameters"]},
        covariance=np.array(found["covariance"], dtype=float),
        correlation=np.array(found["correlation"], dtype=float),
        rows={key: np.array(values, dtype=None if key in ("observable", "source", "channel") else float) for key, values in columns.items()},
        samples=None if samples is None else np.ascontiguousarray(samples.T),
        details=found,
    )


def design(
    data: Any,
    model: Experiment | str | None = None,
    *,
    free: str | Iterable[str],
    target: str | Iterable[str] | None = None,
    speeds: str | Iterable[float] | None = None,
    preloads: Iterable[float | str] = ("0.24N",),
    sensors: Iterable[int] | None = None,
    costs: Mapping[str, float] | None = None,
    picks: int = 5,
    case: str | None = None,
    use: Iterable[What] = ("incident", "reflected"),
    start: options.Assignments | None = None,
    bounds: options.Assignments | None = None,
    prior: options.Assignments | None = None,
    scale: options.Assignments | None = None,
    fixed: options.Assignments | None = None,
    speed_error: float | None = None,
    tof_error: float | None = None,
    ratio_error: float | None = None,
    error_shots: int | Literal["known"] | None = None,
    accuracy: float = 1e-5,
    threads: int | None = None,
    progress: object = None,
) -> Designed:
    """Ranks what to measure next so that parameters tighten most.

    Parameters
    ----------
    data, model, free, case, use, start, bounds, prior, scale, fixed, speed_error, tof_error, \
ratio_error, error_shots, accuracy, threads, progress
        As for `fit` of a table: numbers in SI.
    target : str or iterable of str, optional
        Parameters to tighten, as the fit names them; all when absent.
    speeds : str or iterable of float, optional
        Speeds that could be measured, in m/s.
    preloads : iterable of float or str
        Pushes on bead 1 that could be tried, in N or with a unit.
    sensors : iterable of int, optional
        Beads that could hold the sensor; an eighth, a half and three quarters down the chain
        when absent.
    costs : mapping of str to float, optional
        What a speed costs when it is measured in a way: ``incident``, ``reflected``, ``ratio``,
        ``sensor`` or ``preload``, each 1 when absent. Ways are ranked by information over cost.
    picks : int
        Length of the proposed series.

    Returns
    -------
    Designed
        Candidates with the standard errors that they would leave, in the parameters' units.

    Raises
    ------
    OptionError, ExperimentError
        As for `fit`.

    References
    ----------
    [ChalonerVerdinelli1995], docs/inferring.md.
    """
    name, text = table(data)
    listed = speeds if isinstance(speeds, str) or speeds is None else ",".join(map(options.text, speeds))
    told = words(
        case=case, use=use, start=start, bounds=bounds, prior=prior, scale=scale, fixed=fixed, speed_error=speed_error,
        tof_error=tof_error, ratio_error=ratio_error, error_shots=error_shots, accuracy=accuracy, threads=threads,
    )  # fmt: skip
    told += [*options.listed("free", free), *options.listed("target", target), *options.words(speeds=listed, picks=picks)]
    told += options.listed("preloads", [options.text(force) for force in preloads] or ["none"])
    told += options.listed("sensors", None if sensors is None else map(str, sensors))
    told += options.listed("costs", [f"{way}={options.text(value)}" for way, value in (costs or {}).items()] or None)
    with options.progress(progress, None, "curve") as update:
        found = _native.design((name, text), modelled(model), [*told, "--", name], update)
    return Designed(**found, assumed_model=assumed(model=(model, "dry")))


def gauge(
    wet: Any,
    dry: Any,
    *,
    wet_case: str | None = None,
    dry_case: str | None = None,
    model: Experiment | str | None = None,
    dry_model: Experiment | str | None = None,
    dry_free: str | Iterable[str] = ("aisi316.eta", "dry.B"),
    own: str | Iterable[str] = (),
    form: Literal["each", "power"] = "each",
    oils: str | os.PathLike[str] | None = None,
    use: Iterable[What] = ("incident", "reflected"),
    speed_error: float | None = None,
    tof_error: float | None = None,
    ratio_error: float | None = None,
    error_shots: int | Literal["known"] | None = None,
    accuracy: float = 1e-5,
    threads: int | None = None,
    progress: object = None,
) -> Gauged:
    """Tells the oil on a row's contacts from times of flight, wet and dry.

    Parameters
    ----------
    wet, dry : path, mapping of columns, DataFrame, Measured or Sweep
        Times of flight of the wet and of the dry chain, as for `fit`.
    model, dry_model : Experiment or str, optional
        The chains; the wet one has a section with ``wet = true``. Where one is absent the
        paper's is assumed (presets ``"pump"`` and ``"dry"``), with a warning.
    dry_free : iterable of str
        Free numbers of the dry contacts.
    own : iterable of str
        Numbers that each chain has for itself, such as the load that friction
        holds in a tapped row (``near_end.force``).
    form : {"each", "power"}
        How K and A depend on speed: each speed for itself, or as power laws fitted to the
        whole curve, which incident times tell if speeds are known well.
    oils : path, optional
        Table (CSV) of further oils.
    wet_case, dry_case, use, speed_error, tof_error, ratio_error, error_shots, accuracy, threads, progress
        As for `fit`; cases of each table of its own.

    Warns
    -----
    ExperimentWarning
        Models that are not named, for which the paper's are taken.

    Returns
    -------
    Gauged
        The verdict, every oil's distance in standard errors, K in N/m^1.5 and A in s.

    Raises
    ------
    OptionError, ExperimentError
        As for `fit`.

    Notes
    -----
    The numbers are those of ``hertzchain gauge --json``, bit for bit.

    References
    ----------
    Oils of the paper: [Labbe2017]; contacts as in [Goldobin2015]; the verdict: docs/inferring.md.
    """
    tables = (table(wet, "wet"), table(dry, "dry"))
    told = [
        *options.words(
            wet_case=wet_case, dry_case=dry_case, speed_error=speed_error, tof_error=tof_error,
            ratio_error=ratio_error, error_shots=error_shots, accuracy=accuracy, form=form, threads=threads,
        ),
        *options.listed("use", use), *options.listed("dry-free", dry_free),
        *options.listed("own", own),
        f"--dry={tables[1][0]}", "--", tables[0][0],
    ]  # fmt: skip
    more = None if oils is None else table(oils)
    with options.progress(progress, None, "curve") as update:
        found = _native.gauge(tables, (modelled(model or "pump"), modelled(dry_model or "dry")), more, told, update)
    found["assumed_model"] = assumed(model=(model, "pump"), dry_model=(dry_model, "dry"))
    return Gauged(found["verdict"], found["oils"], found["contacts"], found["dry"], found)
