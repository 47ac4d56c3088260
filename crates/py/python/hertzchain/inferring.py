"""From times of flight to contacts: which parameters, which oil, what to measure next."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._posing import Data, Method, What, modelled, table, words
from ._table import Floats, lines, short

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Data", "Designed", "Fitted", "Gauged", "Parameter", "design", "fit", "gauge"]

@dataclass(frozen=True)
class Parameter:
    """A fitted number in SI; no standard error where the data do not determine it."""

    name: str
    unit: str
    value: float
    standard_error: float | None
    at_bound: bool
    start: float
    lower: float | None
    upper: float | None
    scale: float
    prior: dict[str, float] | None

    def __str__(self) -> str:
        error = "not determined" if self.standard_error is None else f"± {short(self.standard_error, 2)}"
        return f"{short(self.value)} {error} {self.unit}".strip()


@dataclass(frozen=True, repr=False, eq=False)
class Fitted:
    """A fit with everything that is to be said of it.

    Attributes
    ----------
    parameters : dict of str to Parameter
        In SI, with standard errors by covariance.
    covariance, correlation : ndarray, shape (parameters, parameters)
    rows : dict of str to ndarray, shape (values,)
        Measured beside fitted: ``speed_m_s``, ``observable``, ``measured``,
        ``error``, ``fitted``, ``fitted_error``, ``residual``.
    samples : ndarray of shape (samples, parameters) or None
        Of the posterior, if that was sampled and has converged.
    details : dict
        All of ``fit.json``: goodness of fit, identifiability, profiles,
        posterior, comparison of models.
    """

    parameters: dict[str, Parameter]
    covariance: Floats
    correlation: Floats
    rows: dict[str, np.ndarray[Any, Any]]
    samples: Floats | None
    details: dict[str, Any]

    def __getitem__(self, name: str) -> Parameter:
        return self.parameters[name]

    @property
    def chi_square(self) -> dict[str, float] | None:
        """Value, degrees of freedom, probability; None where none are left."""
        return self.details["chi_square"]

    @property
    def converged(self) -> bool:
        """Whether the descent came to a minimum."""
        return bool(self.details["converged"])

    def to_pandas(self) -> pd.DataFrame:
        """One row a measured value."""
        import pandas as pd

        return pd.DataFrame(self.rows)

    def to_xarray(self) -> xr.Dataset:
        """Parameters, errors and covariance over ``parameter``."""
        import xarray as xr

        names = list(self.parameters)
        errors = [np.nan if (error := p.standard_error) is None else error for p in self.parameters.values()]
        made = xr.Dataset(
            {
                "value": ("parameter", [p.value for p in self.parameters.values()]),
                "standard_error": ("parameter", errors),
                "unit": ("parameter", [p.unit for p in self.parameters.values()]),
                "covariance": (("parameter", "other"), self.covariance),
            },
            coords={"parameter": names, "other": names},
        )
        if self.samples is not None:
            made["samples"] = (("sample", "parameter"), self.samples)
        return made

    def __repr__(self) -> str:
        rows = {name: str(parameter) for name, parameter in self.parameters.items()}
        if (goodness := self.chi_square) is not None:
            rows["chi-square"] = f"{short(goodness['value'], 4)} with {goodness['freedom']} degrees of freedom"
        for confused in self.details["not_determined"]:
            rows["not determined"] = confused["words"]
        if not self.converged:
            rows["doubt"] = "the descent did not come to a minimum"
        return lines(f"Fit of {self.details['model']} to {self.details['data']['values']} values", rows)


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
    accuracy: float = 1e-5,
    robust: bool = False,
    starts: int = 1,
    steps: int = 20000,
    direct: bool = False,
    seed: int = 0,
    threads: int | None = None,
) -> Fitted:
    """Fits contact parameters to times of flight, with errors one can trust.

    Parameters
    ----------
    data : path, mapping of columns, DataFrame, Measured or Sweep
        Times of flight in s against ``speed_m_s``, errors in ``*_error`` columns.
        A table, not recordings: those go through `measure` first; their whole
        pulses are fitted by the program's ``fit`` alone.
    model : Experiment or str, optional
        The model, or the name of a preset; ``"dry"`` when absent.
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
        Standard errors in m/s, s and 1 where the table has none.
    case, use, accuracy, robust, starts, steps, direct, seed, threads
        As the options of ``hertzchain fit``.

    Raises
    ------
    OptionError
        Names, tables and options that do not fit, and what is in the way of a fit.
    ExperimentError
        Mistakes in the model.

    Notes
    -----
    The numbers are those of ``hertzchain fit --json``, bit for bit.
    """
    name, text = table(data)
    rivals = {model: given if isinstance(given, str) else ",".join(given) for model, given in (against or {}).items()}
    told = words(
        case=case, use=use, method=method, start=start, bounds=bounds, prior=prior, scale=scale, fixed=fixed,
        speed_error=speed_error, tof_error=tof_error, ratio_error=ratio_error, accuracy=accuracy, robust=robust,
        starts=starts, steps=steps, direct=direct, seed=seed, threads=threads,
    )  # fmt: skip
    told += options.listed("free", free)
    told += [f"--against={model}={given}" for model, given in rivals.items()]
    return fitted(_native.fit((name, text), modelled(model), [*told, "--", name]))


def fitted(found: dict[str, Any]) -> Fitted:
    """A fit from what the library tells of it."""
    rows, samples = found.pop("rows"), found.pop("samples", None)
    columns = {key: [row[key] for row in rows] for key in (rows[0] if rows else {})}
    return Fitted(
        parameters={raw["name"]: Parameter(**raw) for raw in found["parameters"]},
        covariance=np.array(found["covariance"], dtype=float),
        correlation=np.array(found["correlation"], dtype=float),
        rows={key: np.array(values, dtype=None if key == "observable" else float) for key, values in columns.items()},
        samples=None if samples is None else np.ascontiguousarray(samples.T),
        details=found,
    )


@dataclass(frozen=True, repr=False, eq=False)
class Designed:
    """What to measure next.

    Attributes
    ----------
    parameters : list of str
        The parameters to tighten, with their standard errors now.
    ranked : list of dict
        One measurement more, best first: ``measure``, ``standard_errors``,
        ``information_nats``.
    series : list of dict
        A series, each the best after those before it.
    undetermined : list of str
        Combinations that the data so far leave open: errors of their parameters mean little.
    """

    parameters: list[str]
    standard_errors_now: list[float | None]
    ranked: list[dict[str, Any]]
    series: list[dict[str, Any]]
    undetermined: list[str]

    def to_pandas(self) -> pd.DataFrame:
        """One row a candidate, best first."""
        import pandas as pd

        rows = (
            {"measure": one["measure"], **dict(zip(self.parameters, one["standard_errors"], strict=True)), "information_nats": one["information_nats"]}
            for one in self.ranked
        )
        return pd.DataFrame(list(rows))

    def to_xarray(self) -> xr.Dataset:
        """Candidates over ``measure``."""
        return self.to_pandas().set_index("measure").to_xarray()

    def __repr__(self) -> str:
        rows = {one["measure"]: f"{short(one['information_nats'], 3)} nats" for one in self.ranked[:5]}
        return lines(f"Design for {', '.join(self.parameters)}: measure next", rows)


def design(
    data: Any,
    model: Experiment | str | None = None,
    *,
    free: str | Iterable[str],
    target: str | Iterable[str] | None = None,
    speeds: str | Iterable[float] | None = None,
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
    accuracy: float = 1e-5,
    threads: int | None = None,
) -> Designed:
    """Ranks what to measure next so that parameters tighten most.

    Parameters
    ----------
    target : str or iterable of str, optional
        Parameters to tighten, as the fit names them; all when absent.
    speeds : str or iterable of float, optional
        Speeds that could be measured, in m/s.
    picks : int
        Length of the proposed series.
    data, model, free, case, use, start, bounds, prior, scale, fixed, speed_error, tof_error, \
ratio_error, accuracy, threads
        As for `fit`.

    Raises
    ------
    OptionError, ExperimentError
        As for `fit`.
    """
    name, text = table(data)
    listed = speeds if isinstance(speeds, str) or speeds is None else ",".join(map(options.text, speeds))
    told = words(
        case=case, use=use, start=start, bounds=bounds, prior=prior, scale=scale, fixed=fixed, speed_error=speed_error,
        tof_error=tof_error, ratio_error=ratio_error, accuracy=accuracy, threads=threads,
    )  # fmt: skip
    told += [*options.listed("free", free), *options.listed("target", target), *options.words(speeds=listed, picks=picks)]
    return Designed(**_native.design((name, text), modelled(model), [*told, "--", name]))


@dataclass(frozen=True, repr=False, eq=False)
class Gauged:
    """Which oil is on the contacts.

    Attributes
    ----------
    verdict : str
        In a sentence; it can be "none of these".
    oils : list of dict
        Known oils, nearest first: distance in standard errors, probability, whether possible.
    contacts : list of dict
        Stiffness K in N/m^1.5 and relaxation time A in s, speed by speed.
    dry : list of dict
        Fitted parameters of the dry contacts.
    details : dict
        All of ``gauge.json``.
    """

    verdict: str
    oils: list[dict[str, Any]]
    contacts: list[dict[str, Any]]
    dry: list[dict[str, Any]]
    details: dict[str, Any]

    def to_pandas(self) -> pd.DataFrame:
        """One row an oil."""
        import pandas as pd

        return pd.DataFrame(self.oils).drop(columns="farthest", errors="ignore")

    def to_xarray(self) -> xr.Dataset:
        """Stiffness and relaxation time over ``speed_m_s``."""
        import xarray as xr

        told = [row for row in self.contacts if "missing" not in row]
        speeds = [row["speed_m_s"] for row in told]

        def column(of: str, part: str) -> tuple[str, list[float]]:
            return "speed_m_s", [np.nan if (found := row.get(of)) is None else found[part] for row in told]

        made = xr.Dataset(
            {
                "stiffness": column("stiffness", "value"),
                "stiffness_error": column("stiffness", "standard_error"),
                "relaxation_time_s": column("relaxation_time_s", "value"),
                "relaxation_time_error_s": column("relaxation_time_s", "standard_error"),
            },
            coords={"speed_m_s": speeds},
        )
        for name in made.data_vars:
            made[name].attrs["units"] = "N/m^1.5" if str(name).startswith("stiffness") else "s"
        return made

    def __repr__(self) -> str:
        rows = {oil["name"]: f"{short(oil['distance'], 3)} standard errors away, {'possible' if oil['possible'] else 'rejected'}" for oil in self.oils}
        return lines(self.verdict, rows)


def gauge(
    wet: Any,
    dry: Any,
    *,
    wet_case: str | None = None,
    dry_case: str | None = None,
    model: Experiment | str = "pump",
    dry_model: Experiment | str = "dry",
    dry_free: str | Iterable[str] = ("aisi316.eta", "dry.B"),
    own: str | Iterable[str] = (),
    oils: str | os.PathLike[str] | None = None,
    use: Iterable[What] = ("incident", "reflected"),
    speed_error: float | None = None,
    tof_error: float | None = None,
    ratio_error: float | None = None,
    accuracy: float = 1e-5,
    threads: int | None = None,
) -> Gauged:
    """Tells the oil on a row's contacts from times of flight, wet and dry.

    Parameters
    ----------
    wet, dry : path, mapping of columns, DataFrame, Measured or Sweep
        Times of flight of the wet and of the dry chain, as for `fit`.
    model, dry_model : Experiment or str
        The chains; the wet one has a section with ``wet = true``.
    dry_free : iterable of str
        Free numbers of the dry contacts.
    own : iterable of str
        Numbers that each chain has for itself, such as the load that friction
        holds in a tapped row (``near_end.force``).
    oils : path, optional
        Table (CSV) of further oils.
    wet_case, dry_case, use, speed_error, tof_error, ratio_error, accuracy, threads
        As the options of ``hertzchain gauge``.

    Raises
    ------
    OptionError, ExperimentError
        As for `fit`.
    """
    tables = (table(wet, "wet"), table(dry, "dry"))
    told = [
        *options.words(
            wet_case=wet_case, dry_case=dry_case, speed_error=speed_error, tof_error=tof_error,
            ratio_error=ratio_error, accuracy=accuracy, threads=threads,
        ),
        *options.listed("use", use), *options.listed("dry-free", dry_free),
        *options.listed("own", own),
        f"--dry={tables[1][0]}", "--", tables[0][0],
    ]  # fmt: skip
    more = None if oils is None else table(oils)
    found = _native.gauge(tables, (modelled(model), modelled(dry_model)), more, told)
    return Gauged(found["verdict"], found["oils"], found["contacts"], found["dry"], found)
