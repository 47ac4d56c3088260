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
from .errors import ExperimentWarning, OptionError
from .experiment import preset
from .results import DesignResult, FitResult, GaugeResult, MeasureResult, Parameter, Sweep

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Data", "design", "fit", "gauge"]

Data = "str | os.PathLike[str] | Mapping[str, Any] | MeasureResult | Sweep | pd.DataFrame"
"""A table of times of flight against speed: a CSV file, columns by name, or a result."""


@options.with_options("fit", options.FitOptions)
def fit(
    data: Any,
    model: Experiment | str | None = None,
    *,
    free: str | Iterable[str],
    folder: options.Path_ | None = None,
    progress: object = None,
    **how: Unpack[options.FitOptions],
) -> FitResult:
    """Fits contact parameters to times of flight or to whole pulses.

    Parameters
    ----------
    data : path, mapping of columns, DataFrame, MeasureResult or Sweep; or paths of recordings
        Times of flight in s against ``speed_m_s``, errors in ``*_error`` columns: a table. NaN, or
        masked, is missing.
        Or recordings of any format that `measure` reads, files or folders of them: then
        whole pulses are fitted, sample by sample.
    model : Experiment or str, optional
        The model, or the name of a preset. Where it is absent the paper's dry chain is assumed
        (preset ``"dry"``), with a warning.
    free : str or iterable of str
        Free numbers: short names (Y, nu, eta, K, A, B, of a material or section
        as in ``"wet.K"``) or paths; ``:power`` for a power law of speed, ``:each``
        for one value a speed.
    folder : path, optional
        Where residuals so far and a posterior's walkers are kept. The same call with the same folder
        resumes an interrupted one, and returns the same bits; walkers stay there, to
        continue with more ``steps``.
    progress : bool, bar or function, optional
        True draws tqdm's bar; a bar's ``update``, or a function, is called with the number of curves of
        the model since the last time (of recordings: signals of single shots).
    **options
        Mappings have numbers in SI, or texts with a unit, by name; ``bounds`` and ``prior`` have pairs:
        least and largest value, mean and standard deviation; ``against`` has the names that are free
        by model.

    Returns
    -------
    FitResult
        Parameters in SI with standard errors, what is not determined, and all of ``fit.json``, bit
        for bit as ``hertzchain fit --json`` prints it.

    Raises
    ------
    OptionError
        Names, tables and options that do not fit, and what prevents a fit.
    ExperimentError
        Mistakes in the model.

    Warns
    -----
    ExperimentWarning
        Speeds without errors, which are taken as exactly known; a model that is not named.

    References
    ----------
    Errors in speeds: [York2004]; whole pulses: [GolubPereyra1973]; descent: [More1978];
    the sampler: [GoodmanWeare2010], [ForemanMackey2013]. See docs/explanation/inference.md.
    """
    words = [*options.words("fit", options.FitOptions, how), *_free(free), *resumed(folder)]
    described = any(how.get(name) not in (None, ()) for name in ("shots", "rate", "channel"))
    files = _recordings(data, described)
    with options.progress(progress, None, "curve") as update:
        if files is None:
            name, text = table(data)
            found = _native.fit((name, text), modelled(model), [*words, "--", name], update)
        else:
            found = _native.fit_pulses(modelled(model), [*words, "--", *files], update)
        return fit_result({**found, "assumed_model": assumed(model=(model, "dry"))})


def fit_result(found: dict[str, Any]) -> FitResult:
    """A fit from the program's JSON; warns of what was assumed."""
    for key in ("assumed", "held_loads"):
        if (text := found.get(key)) is not None:
            warnings.warn(text, ExperimentWarning, stacklevel=3)
    rows, samples = found.pop("rows"), found.pop("samples", None)
    texts = ("observable", "source", "channel")
    return FitResult(
        parameters={raw["name"]: Parameter(**raw) for raw in found["parameters"]},
        covariance=np.array(found["covariance"], dtype=float),
        correlation=np.array(found["correlation"], dtype=float),
        rows={key: np.array([row[key] for row in rows], dtype=None if key in texts else float) for key in (rows[0] if rows else ())},
        samples=None if samples is None else np.ascontiguousarray(samples.T),
        details=found,
    )


@options.with_options("design", options.DesignOptions)
def design(
    data: Any,
    model: Experiment | str | None = None,
    *,
    free: str | Iterable[str],
    progress: object = None,
    **how: Unpack[options.DesignOptions],
) -> DesignResult:
    """Ranks what to measure next so that parameters tighten most.

    Parameters
    ----------
    data, model, free, progress
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

    References
    ----------
    [ChalonerVerdinelli1995], docs/explanation/inference.md.
    """
    name, text = table(data)
    if "preloads" in how:
        how["preloads"] = list(how["preloads"]) or ["none"]
    words = [*options.words("design", options.DesignOptions, how), *_free(free), "--", name]
    with options.progress(progress, None, "curve") as update:
        found = _native.design((name, text), modelled(model), words, update)
    found["assumed_model"] = assumed(model=(model, "dry"))
    return DesignResult(found["parameters"], found["units"], found["ranked"], found["series"], found)


@options.with_options("gauge", options.GaugeOptions)
def gauge(
    wet: Any,
    dry: Any,
    *,
    model: Experiment | str | None = None,
    dry_model: Experiment | str | None = None,
    oils: options.Path_ | None = None,
    progress: object = None,
    **how: Unpack[options.GaugeOptions],
) -> GaugeResult:
    """Compares known oils with a row's contacts, from times of flight, wet and dry.

    Parameters
    ----------
    wet, dry : path, mapping of columns, DataFrame, MeasureResult or Sweep
        Times of flight of the wet and of the dry chain, as for `fit`.
    model, dry_model : Experiment or str, optional
        The chains; the wet one has a section with ``wet = true``. Where one is absent the
        paper's is assumed (presets ``"pump"`` and ``"dry"``), with a warning.
    oils : path, optional
        Table (CSV) of further oils.
    progress
        As for `fit`.
    **options

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

    References
    ----------
    Oils of the paper: [Labbe2017]; contacts as in [Goldobin2015]; the verdict: docs/explanation/inference.md.
    """
    tables = (table(wet, "wet"), table(dry, "dry"))
    words = [*options.words("gauge", options.GaugeOptions, how), f"--dry={tables[1][0]}", "--", tables[0][0]]
    more = None if oils is None else table(oils)
    with options.progress(progress, None, "curve") as update:
        found = _native.gauge(tables, (modelled(model or "pump"), modelled(dry_model or "dry")), more, words, update)
    found["assumed_model"] = assumed(model=(model, "pump"), dry_model=(dry_model, "dry"))
    return GaugeResult(found["verdict"], found["oils"], found["contacts"], found["dry"], found)


def _free(free: str | Iterable[str]) -> list[str]:
    return [f"--free={name}" for name in ([free] if isinstance(free, str) else free)]


def table(data: Any, name: str = "data") -> tuple[str, str]:
    """Name in messages and CSV text of a table."""
    data = _only(data)
    if isinstance(data, (str, os.PathLike)):
        try:
            return os.fspath(data), Path(data).read_text(encoding="utf-8")
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
        path = os.fspath(data)
        return None if _native.is_table(path, described) else [path]
    return [os.fspath(path) for path in data] if isinstance(data, (list, tuple)) else None


def _only(data: Any) -> Any:
    """The element of a list of one."""
    return data[0] if isinstance(data, (list, tuple)) and len(data) == 1 else data


def csv(columns: Mapping[str, Any]) -> str:
    """Columns as CSV text with all digits; NaN and masked numbers as empty cells."""
    lists = {name: np.atleast_1d(_unmasked(name, values)) for name, values in columns.items()}
    if {values.ndim for values in lists.values()} != {1} or len({values.size for values in lists.values()}) != 1:
        shapes = ", ".join(f"{name} {values.shape}" for name, values in lists.items())
        raise OptionError(f"columns must be of one length: {shapes or 'there are none'}")
    rows = zip(*(map(_cell, values) for values in lists.values()), strict=True)
    return "\n".join(",".join(row) for row in [map(str, lists), *rows]) + "\n"


def _unmasked(name: str, values: Any) -> Any:
    if not np.ma.isMaskedArray(values):
        return values
    try:
        return np.ma.filled(values.astype(float), np.nan)
    except ValueError:
        raise OptionError(f"column {name!r}: only numbers can be masked; leave its masked rows out") from None


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return '"' + value.replace('"', '""') + '"'
    number = float(value)
    return "" if np.isnan(number) else repr(number)


def modelled(model: Experiment | str | None) -> Experiment:
    """The model, or a preset by its name."""
    return model if isinstance(model, Experiment) else preset(model or "dry")


def assumed(**models: tuple[object, str]) -> str | None:
    """Warns of models that are not named and default to the paper's; returns the warning."""
    absent = [f"{name}={usual!r}" for name, (given, usual) in models.items() if given is None]
    if not absent:
        return None
    warning = f"no model is named: the paper's chain is assumed ({', '.join(absent)})"
    warnings.warn(warning, ExperimentWarning, stacklevel=3)
    return warning


def resumed(folder: options.Path_ | None) -> list[str]:
    """Options for a folder in which an interrupted fit resumes."""
    if folder is None:
        return []
    into = Path(folder).resolve()
    begun = (into / "chain.json").exists()
    return [f"--out={into}", *(["--resume"] if begun else [])]
