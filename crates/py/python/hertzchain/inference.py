"""Inference: contact parameters, oils and suggested measurements from times of flight."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from .errors import ExperimentWarning, OptionError, existing, in_python
from .experiment import opened
from .results import DesignResult, FitResult, GaugeResult, MeasureResult, Parameter, Sweep, csv_text

if TYPE_CHECKING:
    from dask.distributed import Client
    from typing_extensions import Unpack

    from ._keywords import DesignOptions, FitOptions, GaugeOptions

__all__ = ["design", "fit", "gauge"]


@options.with_options("fit", "curves of the model (of recordings: signals of single shots)")
def fit(
    data: Any,
    model: Experiment | options.Path_ | None = None,
    *,
    free: str | Iterable[str],
    also: Iterable[tuple[Any, Experiment | options.Path_]] = (),
    folder: options.Path_ | None = None,
    client: Client | None = None,
    points: int | None = None,
    progress: object = None,
    **how: Unpack[FitOptions],
) -> FitResult:
    """Fits contact parameters to times of flight or to whole pulses.

    Errors in speeds: [York2004]; whole pulses: [GolubPereyra1973]; descent: [More1978]; the sampler:
    [GoodmanWeare2010], [ForemanMackey2013]. See docs/explanation/inference.md.

    Parameters
    ----------
    data : path, mapping of columns, DataFrame, MeasureResult or Sweep; or paths of recordings
        Times of flight in s against ``speed_m_s``, errors in ``*_error`` columns: a table. NaN, or
        masked, is missing. Or recordings of any format that `measure` reads, files or folders of
        them: then whole pulses are fitted, sample by sample.
    model : Experiment or str or path, optional
        The model, the name of a preset, or a file; where absent, preset ``"dry"`` is assumed with a warning.
    free : str or iterable of str
        Free numbers: short names (Y, nu, eta, K, A, B, of a material or section as in ``"wet.K"``)
        or paths; ``:power`` for a power law of speed, ``:each`` for one value a speed.
    also : iterable of (data, model), optional
        Further tables with their models, fitted together with ``data``; see docs/how-to/several-tables.md.
    folder : path, optional
        Where residuals so far and a posterior's walkers are kept. The same call with the same folder
        resumes an interrupted one, and returns the same bits; walkers stay there, to
        continue with more ``steps``.
    client : dask.distributed.Client, optional
        Computes the curves of a table's model on a cluster, all of them (``direct``), with the same
        bits; ``folder`` is seen by all workers under this name. ``against`` and ``also`` are not available.
    points : int, optional
        Most points of a batch of a cluster; smaller ones where not every thread would have one.
    **options
        Mappings have numbers in SI, or texts with a unit, by name (``fixed`` needs the unit); ``bounds`` and ``prior``
        have pairs: least and largest value, mean and standard deviation; ``against`` has the names that are free
        by model.

    Returns
    -------
    FitResult
        Parameters in SI with standard errors, what is not determined, and all of ``fit.json``, bit
        for bit as ``hertzchain fit --json`` prints it.

    Raises
    ------
    OptionError, ExperimentError
        Names, tables and options that do not fit, and what prevents a fit; mistakes in the model.
    ConnectionError
        The cluster's scheduler is gone: the same call resumes.

    Warns
    -----
    ExperimentWarning
        Speeds without errors, which are taken as exactly known; a model that is not named.
    """
    how = fit_options(how if client is None else {**how, "direct": True}, free)
    if options.count("points", points, 1) and client is None:
        raise OptionError("points is for fits on a cluster (client): leave it out")
    described = any(how.get(name) not in (None, ()) for name in ("shots", "rate", "channel"))
    files = _recordings(data, described)
    others = [(table(other), opened(chain)) for other, chain in also]
    if others and (client is not None or files is not None):
        raise OptionError("also fits several tables in this process: leave it out of fits of recordings and on a cluster")
    with options.progress(progress, None, "curve") as update:
        if client is not None:
            from .distributed import fit_on

            asked = options.text("fit", how, **resumed(folder))
            found = fit_on(client, _native.Likelihood(table(data), modelled(model), asked), folder, points, update)
        elif files is None:
            found = _native.fit([(table(data), modelled(model)), *others], options.text("fit", how, **resumed(folder)), update)
        else:
            found = _native.fit_pulses(modelled(model), options.text("fit", how, data=files, **resumed(folder)), update)
        return fit_result({**found, "assumed_model": assumed(model=(model, "dry"))})


def fit_result(found: dict[str, Any]) -> FitResult:
    """A fit from the program's JSON; warns of what was assumed."""
    for text in (found.get("assumed"), found.get("held_loads"), (found.get("posterior") or {}).get("unconverged")):
        if text is not None:
            warnings.warn(in_python(text), ExperimentWarning, stacklevel=3)
    rows, samples = found.pop("rows"), found.pop("samples", None)
    texts = ("observable", "source", "channel", "file")
    return FitResult(
        parameters={raw["name"]: Parameter(raw) for raw in found["parameters"]},
        covariance=np.array(found["covariance"], dtype=float),
        correlation=np.array(found["correlation"], dtype=float),
        rows={key: np.array([row[key] for row in rows], dtype=None if key in texts else float) for key in (rows[0] if rows else ())},
        samples=None if samples is None else np.ascontiguousarray(samples.T),
        details=found,
    )


@options.with_options("design", "curves of the model")
def design(
    data: Any,
    model: Experiment | options.Path_ | None = None,
    *,
    free: str | Iterable[str],
    progress: object = None,
    **how: Unpack[DesignOptions],
) -> DesignResult:
    """Ranks what to measure next so that parameters tighten most.

    [ChalonerVerdinelli1995], docs/explanation/inference.md.

    Parameters
    ----------
    data, model, free
        As for `fit` of a table.
    **options
        Speeds in m/s, pushes in N or with a unit.

    Returns
    -------
    DesignResult
        Candidates with the standard errors that they would leave, in the parameters' units.

    Raises
    ------
    OptionError, ExperimentError
        As for `fit`.
    """
    own = table(data)
    with options.progress(progress, None, "curve") as update:
        found = _native.design(own, modelled(model), options.text("design", how, free=_named(free), data=own[0]), update)
    return DesignResult(found | {"assumed_model": assumed(model=(model, "dry")), "parameter_units": found["units"]})


@options.with_options("gauge", "curves of the model")
def gauge(
    wet: Any,
    dry: Any,
    *,
    model: Experiment | options.Path_ | None = None,
    dry_model: Experiment | options.Path_ | None = None,
    oils: options.Path_ | None = None,
    progress: object = None,
    **how: Unpack[GaugeOptions],
) -> GaugeResult:
    """Compares known oils with a row's contacts, from times of flight, wet and dry.

    Oils of the paper: [Labbe2017]; contacts as in [Goldobin2015]; the verdict:
    docs/explanation/inference.md.

    Parameters
    ----------
    wet, dry : path, mapping of columns, DataFrame, MeasureResult or Sweep
        Times of flight of the wet and of the dry chain, as for `fit`.
    model, dry_model : Experiment or str or path, optional
        The chains, names of presets, or files; the wet one has a section with ``wet = true``. Where one is absent the
        paper's is assumed (presets ``"pump"`` and ``"dry"``), with a warning.
    oils : path, optional
        Table (CSV) of further oils.

    Returns
    -------
    GaugeResult
        The verdict, every oil's distance in standard errors, K in N/m^1.5 and A in s, bit for bit
        those of ``hertzchain gauge --json``.

    Raises
    ------
    OptionError, ExperimentError
        As for `fit`.

    Warns
    -----
    ExperimentWarning
        Models that are not named, for which the paper's are taken.
    """
    tables = (table(wet, "wet"), table(dry, "dry"))
    asked = options.text("gauge", how, wet=tables[0][0], dry=tables[1][0])
    more = None if oils is None else table(oils)
    with options.progress(progress, None, "curve") as update:
        found = _native.gauge(tables, (modelled(model or "pump"), modelled(dry_model or "dry")), more, asked, update)
    return GaugeResult(found | {"assumed_model": assumed(model=(model, "pump"), dry_model=(dry_model, "dry"))})


def _named(free: str | Iterable[str]) -> list[str]:
    """Names of free numbers, at least one."""
    names = free.split(",") if isinstance(free, str) else list(free) if isinstance(free, Iterable) and not isinstance(free, Mapping) else []
    if not names:
        raise OptionError('nothing is free: free names numbers, such as "eta,B"')
    return names


def fit_options(how: Mapping[str, Any], free: str | Iterable[str]) -> dict[str, Any]:
    """Options of a fit, with what is free; models to compare with as the command line has them."""
    against = {} if how.get("against") in (None, [], ()) else how["against"]
    if not isinstance(against, Mapping):
        raise OptionError('against is a dict of models and what is free in them, such as {"hertz": "Y"}')
    return {**how, "free": _named(free), "against": [f"{model}={','.join(_named(names))}" for model, names in against.items()]}


def table(data: Any, name: str = "data") -> tuple[str, str]:
    """Name in messages and CSV text of a table."""
    data = _only(data)
    if isinstance(data, (str, os.PathLike)):
        try:
            return existing(data), Path(data).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise OptionError(f"{os.fspath(data)} can't be read: {error}") from None
    if isinstance(data, MeasureResult):
        return "speeds.csv", data.tables["speeds.csv"]
    if isinstance(data, Sweep):
        return data.experiment, csv({"speed_m_s": data.speed_m_s, **data.columns})
    if isinstance(data, Mapping):
        return name, csv(data)
    if hasattr(data, "to_dict") and hasattr(data, "columns"):
        return name, csv(data.reset_index().to_dict("list"))
    raise OptionError(f"data of type {type(data).__name__}: expected a file, columns by name, a table, or a result of `measure`")


def _recordings(data: Any, described: bool) -> list[str] | None:
    """Paths of recordings; None if the data are a table. Where titles do not decide, options of recordings do."""
    data = _only(data)
    if isinstance(data, (str, os.PathLike)):
        path = existing(data)
        return None if _native.is_table(path, described) else [path]
    return [existing(path) for path in data] if isinstance(data, (list, tuple)) else None


def _only(data: Any) -> Any:
    """The element of a list of one."""
    return data[0] if isinstance(data, (list, tuple)) and len(data) == 1 else data


def csv(columns: Mapping[str, Any]) -> str:
    """Columns as CSV text with all digits; NaN and masked numbers as empty cells."""
    try:
        lists = {name: np.atleast_1d(options.unmasked(values)) for name, values in columns.items()}
    except ValueError:
        raise OptionError("only numbers can be masked; leave masked rows of a column of texts out") from None
    if {values.ndim for values in lists.values()} != {1} or len({values.size for values in lists.values()}) != 1:
        shapes = ", ".join(f"{name} {values.shape}" for name, values in lists.items())
        raise OptionError(f"columns must be of one length: {shapes or 'there are none'}")
    # NaN alone is not equal to itself.
    return csv_text({name: [one if one == one else "" for one in values.tolist()] for name, values in lists.items()})


def modelled(model: Experiment | options.Path_ | None) -> Experiment:
    """The model; the paper's dry chain where none is named."""
    return opened("dry" if model is None else model)


def assumed(**models: tuple[object, str]) -> str | None:
    """Warns of models that are not named and default to the paper's; returns the warning."""
    absent = [f"{name}={usual!r}" for name, (given, usual) in models.items() if given is None]
    if not absent:
        return None
    warning = f"no model is named: the paper's chain is assumed ({', '.join(absent)})"
    warnings.warn(warning, ExperimentWarning, stacklevel=3)
    return warning


def resumed(folder: options.Path_ | None) -> dict[str, Any]:
    """Options for a folder in which an interrupted fit resumes."""
    into = Path(folder or ".").resolve()
    return {} if folder is None else {"out": into, "resume": (into / "chain.json").exists()}
