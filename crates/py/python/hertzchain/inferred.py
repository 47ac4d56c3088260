"""What inference gives: parameters with errors, what to measure next, which oil."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ._table import Floats, Tabled, frame, lines, number, short, unit

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Designed", "Fitted", "Gauged", "Parameter"]


@dataclass(frozen=True, repr=False)
class Parameter(Tabled):
    """A fitted number.

    Attributes
    ----------
    name, unit : str
        As the fit names it, and its SI unit.
    value : float
        At the best fit.
    standard_error : float or None
        By the covariance; None where the data do not determine it, and at a bound.
    determined : bool
        Whether the data determine it; if not, its value is one of many that fit as well.
    at_bound : bool
        Whether the best fit lies at the end of what it may be.
    limit : dict or None
        Of one at or near a bound, by profile: ``side`` ("at most" or "at least"), ``percent_68``, ``percent_95``.
    start, lower, upper, scale : float or None
        Where it started, what it may be, a change that matters.
    prior : dict or None
        What was known of it.

    References
    ----------
    Names, scales and priors: docs/inferring.md.
    """

    name: str
    unit: str
    value: float
    standard_error: float | None
    determined: bool
    at_bound: bool
    limit: dict[str, Any] | None
    start: float
    lower: float | None
    upper: float | None
    scale: float
    prior: dict[str, float] | None

    def _columns(self) -> dict[str, list[Any]]:
        numbers = ("value", "standard_error", "start", "lower", "upper", "scale")
        return {"name": [self.name], "unit": [self.unit], **{of: [number(getattr(self, of))] for of in numbers}, "determined": [self.determined], "at_bound": [self.at_bound]}

    def _units(self) -> dict[str, str]:
        return dict.fromkeys(("value", "standard_error", "start", "lower", "upper", "scale"), self.unit)

    def __str__(self) -> str:
        error = "not determined" if self.standard_error is None else f"± {short(self.standard_error, 2)}"
        if self.at_bound:
            error = "at its bound"
            if self.limit and self.limit["percent_95"] is not None:
                error += f", {self.limit['side']} {short(self.limit['percent_95'], 3)} (95 %)"
        return f"{short(self.value)} {error} {self.unit}".strip()

    def __repr__(self) -> str:
        return f"{self.name} = {self}"


@dataclass(frozen=True, repr=False, eq=False)
class Fitted:
    """A fit with everything that is to be said of it.

    Attributes
    ----------
    parameters : dict of str to Parameter
        In SI, with standard errors by covariance.
    covariance, correlation : ndarray, shape (parameters, parameters)
        In products of the parameters' SI units; and without units.
    rows : dict of str to ndarray, shape (values,)
        Measured beside fitted. Of times of flight: ``speed_m_s``, ``observable``,
        ``measured``, ``error``, ``fitted``, ``fitted_error`` (in s, ratios in 1),
        ``residual`` in standard errors. Of whole pulses, a mean of samples each:
        ``source``, ``channel``, ``time_s`` after the passing maximum, ``measured_v``,
        ``error_v``, ``fitted_v``.
    samples : ndarray of shape (samples, parameters) or None
        Of the posterior in SI, if that was sampled and has converged.
    details : dict
        All of ``fit.json``: goodness of fit, identifiability, profiles,
        posterior, comparison of models.

    References
    ----------
    What a fit minimises, how sure its numbers are, what is not determined:
    docs/inferring.md, after [York2004], [GolubPereyra1973].
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
        """Measured beside fitted, as pandas has it.

        Returns
        -------
        pandas.DataFrame
            One row a measured value; units in ``attrs["units"]``: of columns that hold times
            and ratios both, by what is in ``observable``.
        """
        observables = [str(name) for name in dict.fromkeys(self.rows.get("observable", np.empty(0)).tolist())]
        both = " or ".join(dict.fromkeys(unit(name) for name in observables))
        of_both = ("measured", "error", "fitted", "fitted_error")
        return frame(self.rows, False, units={name: both for name in of_both if name in self.rows})

    def to_xarray(self) -> xr.Dataset:
        """Parameters and their covariance, as xarray has them.

        Returns
        -------
        xarray.Dataset
            Values, standard errors and covariance over ``parameter``, and samples of a
            posterior; ``attrs["units"]`` lists a unit for each parameter, the covariance
            is in their products.
        """
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
        units = [p.unit for p in self.parameters.values()]
        for name in made.data_vars:
            made[name].attrs["units"] = {"unit": "1", "covariance": "products of units"}.get(str(name), units)
        return made

    def __repr__(self) -> str:
        rows = {name: str(parameter) for name, parameter in self.parameters.items()}
        if (goodness := self.chi_square) is not None:
            rows["chi-square"] = f"{short(goodness['value'], 4)} with {goodness['freedom']} degrees of freedom"
        if (assumed := self.details.get("assumed")) is not None:
            rows["assumed"] = assumed
        for confused in self.details["not_determined"]:
            rows["not determined"] = confused["words"]
        if not self.converged:
            rows["doubt"] = "the descent did not come to a minimum"
        if "data" in self.details:
            return lines(f"Fit of {self.details['model']} to {self.details['data']['values']} values", rows)
        rows |= {"left out": why for why in self.details["left_out"][:1]}
        return lines(f"Fit of {self.details['model']} to whole pulses of {len(self.details['records'])} records", rows)


@dataclass(frozen=True, repr=False, eq=False)
class Designed(Tabled):
    """What to measure next: a table of candidates, best first.

    Attributes
    ----------
    follows_data : bool
        Whether the model follows the data so far within their errors; the ranking is the model's.
    parameters : list of str
        The parameters to tighten.
    units : list of str
        Their SI units.
    standard_errors_now : list of float or None
        Their standard errors with the data so far.
    ranked : list of dict
        One measurement more, best first: ``measure``, ``standard_errors``,
        ``information_nats``.
    series : list of dict
        A series, each the best after those before it.
    undetermined : list of str
        Combinations that the data so far leave open: errors of their parameters mean little.
    hopeless : list of str
        What nothing that could be measured determines, and what is tightened instead: then
        `parameters` are combinations.
    references : list of dict
        Of each free K or A the contact whose value it is, the contacts of its section, and
        the range of their ratios to it.
    assumed_model : str or None
        That the paper's chain was assumed, where no model was named.

    References
    ----------
    Information of a measurement that was not made: [ChalonerVerdinelli1995], docs/inferring.md.
    """

    follows_data: bool
    parameters: list[str]
    units: list[str]
    standard_errors_now: list[float | None]
    ranked: list[dict[str, Any]]
    series: list[dict[str, Any]]
    undetermined: list[str]
    hopeless: list[str]
    references: list[dict[str, Any]] = field(default_factory=list)
    assumed_model: str | None = None

    _index = "measure"

    def _columns(self) -> dict[str, list[Any]]:
        def after(at: int) -> list[float]:
            return [number(one["standard_errors"][at]) for one in self.ranked]

        return {
            "measure": [one["measure"] for one in self.ranked],
            **{name: after(at) for at, name in enumerate(self.parameters)},
            "information_nats": [one["information_nats"] for one in self.ranked],
        }

    def _units(self) -> dict[str, str]:
        return {**dict(zip(self.parameters, self.units, strict=True)), "information_nats": "nat"}

    def __repr__(self) -> str:
        rows = {one["measure"]: f"{short(one['information_nats'], 3)} nats" for one in self.ranked[:5]}
        rows |= {f"left open, {at}": words for at, words in enumerate(self.undetermined, 1)}
        rows |= {f"hopeless, {at}": words for at, words in enumerate(self.hopeless, 1)}
        return lines(f"Design for {', '.join(self.parameters)}: measure next", rows)


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

    References
    ----------
    Oils of the paper: [Labbe2017]; the verdict: docs/inferring.md.
    """

    verdict: str
    oils: list[dict[str, Any]]
    contacts: list[dict[str, Any]]
    dry: list[dict[str, Any]]
    details: dict[str, Any]

    def to_pandas(self) -> pd.DataFrame:
        """The oils as pandas has them.

        Returns
        -------
        pandas.DataFrame
            One row an oil, nearest first; units in ``attrs["units"]``, of distances "standard error".
        """
        names = ("name", "distance", "possible", "probability", "chi_square", "freedom")
        return frame({name: [oil[name] for oil in self.oils] for name in names}, False, units={"distance": "standard error"})

    def to_xarray(self) -> xr.Dataset:
        """The wet contacts as xarray has them.

        Returns
        -------
        xarray.Dataset
            Stiffness, relaxation time and their standard errors over ``speed_m_s``, units
            in ``attrs["units"]``.
        """
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
            coords={"speed_m_s": ("speed_m_s", speeds, {"units": "m/s"})},
        )
        for name in made.data_vars:
            made[name].attrs["units"] = "N/m^1.5" if str(name).startswith("stiffness") else "s"
        return made

    def __repr__(self) -> str:
        rows = {oil["name"]: f"{short(oil['distance'], 3)} standard errors away, {'possible' if oil['possible'] else 'rejected'}" for oil in self.oils}
        if doubts := self.details["doubts"]:
            rows["doubt"] = doubts
        return lines(self.verdict, rows)
