"""Fits with bands, and posteriors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from ._style import COLUMN, MARKERS, MICRO, colour_of, styled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..inferred import Fitted

BAND = 1.96
"""Standard errors to either side of a band: 95 %."""


@styled
def fit(fitted: Fitted, axes: Sequence[Axes] | None = None) -> NDArray[Any]:
    """Data with the fitted curve and its 95 % band; residuals in standard errors below.

    Of a fit of whole pulses, the first recording's.

    Parameters
    ----------
    fitted : Fitted
        By `hertzchain.fit`.
    axes : sequence of Axes, optional
        Two, to draw into; a new figure's when absent.

    Returns
    -------
    ndarray of Axes, shape (2,)
        Speeds in m/s against times in µs, or times in µs against V; residuals below.

    Raises
    ------
    ValueError
        Axes that are not two.

    References
    ----------
    Bands by the covariance: docs/inferring.md.
    """
    if axes is None:
        sizes = {"height_ratios": (2.2, 1)}
        axes = plt.subplots(2, 1, figsize=(COLUMN, 3.6), sharex=True, gridspec_kw=sizes)[1]
    upper, lower = made = np.asarray(axes).ravel()
    upper.xaxis.set_tick_params(which="both", labelbottom=False)
    lower.axhline(0.0, color="0.3", linewidth=0.6)
    lower.set_ylabel("Residual (σ)")
    if "source" in fitted.rows:
        _fitted_pulses(upper, lower, fitted)
        return made
    for at, observable in enumerate(dict.fromkeys(fitted.rows["observable"].tolist())):
        _fitted_curve(upper, lower, fitted, str(observable), at)
    is_time = all(str(name).startswith("tof") for name in fitted.rows["observable"])
    upper.set_ylabel("Time of flight (µs)" if is_time else "Observable")
    upper.legend()
    lower.set_xlabel("Speed of the striker (m/s)")
    lower.set_xscale("log")
    lower.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    lower.xaxis.set_major_formatter(ScalarFormatter())
    lower.xaxis.set_minor_formatter(NullFormatter())
    return made


def _fitted_curve(upper: Axes, lower: Axes, fitted: Fitted, observable: str, at: int) -> None:
    own = fitted.rows["observable"] == observable
    rows = {name: values[own] for name, values in fitted.rows.items()}
    order = np.argsort(rows["speed_m_s"])
    rows = {name: values[order] for name, values in rows.items()}
    scale = MICRO if observable.startswith("tof") else 1.0
    colour, speeds = colour_of(at), rows["speed_m_s"]
    curve, spread = scale * rows["fitted"], scale * BAND * rows["fitted_error"]
    name = observable.removeprefix("tof_").removesuffix("_s").replace("_", " ")
    upper.fill_between(speeds, curve - spread, curve + spread, color=colour, alpha=0.2, linewidth=0)
    upper.plot(speeds, curve, color=colour)
    upper.errorbar(speeds, scale * rows["measured"], scale * rows["error"], rows["speed_error_m_s"], color=colour, linestyle="none", marker=MARKERS[at % 5], elinewidth=0.6, label=name)
    lower.plot(speeds, rows["residual"], color=colour, linestyle="none", marker=MARKERS[at % 5])


def _fitted_pulses(upper: Axes, lower: Axes, fitted: Fitted) -> None:
    own = fitted.rows["source"] == fitted.rows["source"][0]
    rows = {name: values[own] for name, values in fitted.rows.items()}
    for at, channel in enumerate(np.unique(rows["channel"])):
        here = rows["channel"] == channel
        time, measured, fit = (rows[name][here] for name in ("time_s", "measured_v", "fitted_v"))
        upper.plot(MICRO * time, measured, color=colour_of(at), linestyle="none", marker=".", markersize=2, label="recorded")
        upper.plot(MICRO * time, fit, color="0.2", linewidth=0.8, label="fitted")
        lower.plot(MICRO * time, (measured - fit) / rows["error_v"][here], color=colour_of(at), linestyle="none", marker=".", markersize=2)
    upper.set_ylabel("Signal (V)")
    upper.legend()
    upper.margins(x=0)
    lower.set_xlabel("Time after the passing maximum (µs)")


@styled
def corner(fitted: Fitted, bins: int = 40, axes: NDArray[Any] | None = None) -> NDArray[Any]:
    """The posterior of each parameter and pair, with the best fit and the covariance's ellipses.

    Parameters
    ----------
    fitted : Fitted
        With ``method="posterior"``; without samples the covariance is all that is drawn.
    bins : int
        Of each histogram.
    axes : ndarray of Axes, shape (parameters, parameters), optional
        To draw into; a new figure's when absent.

    Returns
    -------
    ndarray of Axes, shape (parameters, parameters)
        In SI units of the parameters; the upper triangle is switched off.

    Raises
    ------
    ValueError
        Axes of another shape.

    References
    ----------
    Samples by [GoodmanWeare2010]: docs/inferring.md.
    """
    names = list(fitted.parameters)
    count = len(names)
    if axes is None:
        side = max(COLUMN, 1.5 * count)
        axes = plt.subplots(count, count, figsize=(side, side), squeeze=False)[1]
    made = np.asarray(axes).reshape(count, count)
    for row in range(count):
        for column in range(count):
            ax = made[row, column]
            if column > row:
                ax.axis("off")
            elif column == row:
                _marginal(ax, fitted, row, bins)
            else:
                _pair(ax, fitted, (column, row), bins)
            _corner_labels(ax, fitted, (row, column), count)
    return made


def _range(fitted: Fitted, at: int) -> tuple[float, float]:
    """What is shown of a parameter: four standard errors, or where its samples are."""
    best = list(fitted.parameters.values())[at].value
    spread = float(np.sqrt(fitted.covariance[at, at]))
    if fitted.samples is None:
        return best - 4 * spread, best + 4 * spread
    low, high = np.quantile(fitted.samples[:, at], (0.001, 0.999))
    return float(low), float(high)


def _marginal(ax: Axes, fitted: Fitted, at: int, bins: int) -> None:
    low, high = _range(fitted, at)
    best = list(fitted.parameters.values())[at].value
    spread = float(np.sqrt(fitted.covariance[at, at]))
    grid = np.linspace(low, high, 200)
    normal = np.exp(-0.5 * ((grid - best) / spread) ** 2) / (spread * np.sqrt(2 * np.pi))
    if fitted.samples is not None:
        ax.hist(fitted.samples[:, at], bins, range=(low, high), density=True, color=colour_of(0), alpha=0.35)
    ax.plot(grid, normal, color=colour_of(1), linewidth=0.8)
    ax.axvline(best, color="0.3", linewidth=0.6)
    ax.set(xlim=(low, high), yticks=[])
    ax.grid(False)


def _pair(ax: Axes, fitted: Fitted, pair: tuple[int, int], bins: int) -> None:
    ranges = [_range(fitted, at) for at in pair]
    centre = [list(fitted.parameters.values())[at].value for at in pair]
    if fitted.samples is not None:
        cells, x, y = np.histogram2d(fitted.samples[:, pair[0]], fitted.samples[:, pair[1]], bins=bins, range=ranges)
        ax.pcolormesh(x, y, cells.T, cmap="Blues", rasterized=True)
    part = fitted.covariance[np.ix_(pair, pair)]
    values, vectors = np.linalg.eigh(part)
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = np.array([np.cos(angle), np.sin(angle)])
    # Radii that hold 68 % and 95 % of a normal distribution of two numbers.
    for radius in (1.515, 2.448):
        edge = vectors @ (np.sqrt(np.maximum(values, 0.0))[:, None] * circle) * radius
        ax.plot(centre[0] + edge[0], centre[1] + edge[1], color=colour_of(1), linewidth=0.8)
    ax.plot(*centre, marker="+", color="0.2")
    ax.set(xlim=ranges[0], ylim=ranges[1])
    ax.grid(False)


def _corner_labels(ax: Axes, fitted: Fitted, place: tuple[int, int], count: int) -> None:
    row, column = place
    parameters = list(fitted.parameters.values())

    def label(at: int) -> str:
        unit = parameters[at].unit.replace("^2", "²").replace("^3", "³")
        return f"{parameters[at].name}\n({unit})" if unit else parameters[at].name

    if row == count - 1:
        ax.set_xlabel(label(column))
    else:
        ax.tick_params(labelbottom=False)
    if column == 0 and row > 0:
        ax.set_ylabel(label(row))
    elif column < row:
        ax.tick_params(labelleft=False)
    ax.locator_params(axis="x", nbins=3)
    if column < row:
        ax.locator_params(axis="y", nbins=3)
    ax.ticklabel_format(style="sci", scilimits=(-2, 3), useMathText=True)
