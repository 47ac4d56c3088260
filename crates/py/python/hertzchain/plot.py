"""Figures of publication quality with matplotlib; each function returns axes.

``pip install hertzchain[plot]``. Functions draw into axes they are given, or into
a new figure in the style of this package, `STYLE`::

    with plt.style.context(hertzchain.plot.STYLE):
        ...
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from .experiment import preset
from .recording import Case
from .results import PowerLaw, Shot, Sweep, Trace
from .shooting import shot as shoot
from .shooting import sweep

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .inferring import Fitted

__all__ = [
    "STYLE",
    "corner",
    "figure2",
    "figure3",
    "figure4",
    "fit",
    "ratios",
    "signals",
    "space_time",
    "style",
    "times_of_flight",
]

STYLE = str(Path(__file__).with_name("hertzchain.mplstyle"))
"""Path of the style sheet."""

MICRO = 1e6
COLUMN = 3.35
MARKERS = ("o", "s", "^", "D", "v")
OILS = {"pump": "^", "gear": "s", "motor": "o"}


def style() -> AbstractContextManager[None]:
    """The package's style within a ``with`` block."""
    return plt.style.context(STYLE)


def _axes(ax: Axes | None, height: float = 2.5) -> Axes:
    if ax is not None:
        return ax
    with style():
        return plt.subplots(figsize=(COLUMN, height))[1]


def _scale(dimensionless: bool) -> tuple[float, str]:
    return (1.0, "") if dimensionless else (MICRO, " (µs)")


def signals(shot: Shot | Trace, sensors: Sequence[str] | None = None, ax: Axes | None = None) -> Axes:
    """Signals of sensors against time.

    Parameters
    ----------
    shot : Shot or Trace
        With sampled sensors: ``hertzchain.shot(..., trace=True)``.
    sensors : sequence of str, optional
        Which; all forces when absent.
    """
    trace = _trace(shot)
    shown = list(sensors or [name for name in trace.signals if trace.unit(name) in ("N", "1")])
    ax = _axes(ax)
    scale, unit = _scale(trace.dimensionless)
    for name in shown:
        ax.plot(scale * trace.time_s, trace[name], label=_label(name))
    ax.set_xlabel(f"Time{unit}")
    of = trace.unit(shown[0]) if shown else "N"
    ax.set_ylabel("Signal" if of == "1" else f"{ {'N': 'Force', 'm/s': 'Velocity', 'm': 'Displacement'}[of] } ({of})")
    ax.margins(x=0)
    if len(shown) > 1:
        ax.legend()
    return ax


def _trace(shot: Shot | Trace) -> Trace:
    trace = shot.trace if isinstance(shot, Shot) else shot
    if trace is None:
        raise ValueError("the shot has no trace: compute it with hertzchain.shot(..., trace=True)")
    return trace


def _label(sensor: str) -> str:
    kind, number = sensor.rsplit("_", 1)
    return f"bead {number} plus wall" if kind == "bead_plus_wall" else f"{kind} {number}"


def space_time(shot: Shot | Trace, kind: str = "contact", ax: Axes | None = None) -> Axes:
    """Space–time map: a signal of every contact or body over time.

    Parameters
    ----------
    shot : Shot or Trace
        With several sensors of the kind: ``trace=[f"contact_{i}" for i in range(41)]``.
    kind : {"contact", "velocity", "position", "bead"}
        Which signals.
    """
    trace = _trace(shot)
    numbers, values = trace.stacked(kind)
    if numbers.size < 2:
        raise ValueError(f"a map needs several sensors of kind {kind!r}; the trace has {numbers.size}")
    ax = _axes(ax, 2.7)
    scale, unit = _scale(trace.dimensionless)
    signed = bool(values.min() < -0.05 * values.max())
    most = float(np.abs(values).max())
    mesh = ax.pcolormesh(
        scale * trace.time_s,
        numbers,
        values,
        shading="nearest",
        rasterized=True,
        cmap="RdBu_r" if signed else None,
        vmin=-most if signed else 0.0,
        vmax=most,
    )
    ax.grid(False)
    ax.set_xlabel(f"Time{unit}")
    ax.set_ylabel("Contact" if kind == "contact" else "Bead")
    of = trace.unit(f"{kind}_0")
    name = {"contact": "Force", "bead": "Force", "velocity": "Velocity", "position": "Displacement"}[kind]
    figure = ax.get_figure()
    if figure is not None:
        figure.colorbar(mesh, ax=ax, label=name if of == "1" else f"{name} ({of})", pad=0.02)
    return ax


Curve = Sweep | Case
"""A computed curve, or a measured one."""


def _columns(curve: Curve) -> Mapping[str, NDArray[np.float64]]:
    return curve.columns | {"speed_m_s": curve.speed_m_s} if isinstance(curve, Sweep) else curve.columns


def _points(ax: Axes, curve: Curve, column: str, factor: float, **look: Any) -> None:
    """A line of computed numbers, or measured ones with their errors."""
    columns = _columns(curve)
    speeds, values = columns["speed_m_s"], factor * columns[column]
    if isinstance(curve, Sweep):
        look.pop("marker", None)
        ax.plot(speeds, values, **look)
        return
    look.pop("linestyle", None)
    ax.errorbar(
        speeds, values, factor * columns[f"{column}_error"], columns["speed_error_m_s"], linestyle="none", elinewidth=0.6, **look
    )


def times_of_flight(
    curves: Curve | Mapping[str, Curve], laws: bool = False, logarithmic: bool = True, ax: Axes | None = None
) -> Axes:
    """Incident and reflected times of flight against speed.

    Parameters
    ----------
    curves : Sweep, Case, or mapping of str to these
        Computed curves are lines, measured ones points with error bars. The
        reflected times have dashes, or hollow points.
    laws : bool
        Draw the power laws beside them.
    logarithmic : bool
        Both axes logarithmic.
    """
    ax = _axes(ax)
    named = curves if isinstance(curves, Mapping) else {"": curves}
    dimensionless = all(isinstance(curve, Sweep) and curve.dimensionless for curve in named.values())
    scale, unit = _scale(dimensionless)
    for at, (name, curve) in enumerate(named.items()):
        colour = f"C{at % 7}"
        ends = [("incident", "tof_incident_s", "-", colour), ("reflected", "tof_reflected_s", "--", "none")]
        for end, column, dashes, face in ends:
            label = f"{name} {end}".strip()
            _points(ax, curve, column, scale, color=colour, linestyle=dashes, marker=MARKERS[at % 5], markerfacecolor=face, label=label)
            law: PowerLaw | None = getattr(curve, f"power_law_{end}")
            if laws and law is not None:
                speeds = np.geomspace(*_ends(_columns(curve)["speed_m_s"]), 50)
                ax.plot(speeds, scale * law(speeds), color="0.6", linewidth=0.7, zorder=1)
    ax.set_xlabel("Speed of the striker" if dimensionless else "Speed of the striker (m/s)")
    ax.set_ylabel(f"Time of flight{unit}")
    if logarithmic:
        _logarithmic(ax)
    ax.legend()
    return ax


def _ends(values: NDArray[np.float64]) -> tuple[float, float]:
    return float(np.min(values)), float(np.max(values))


def _logarithmic(ax: Axes) -> None:
    """Logarithmic axes with plain numbers."""
    ax.set(xscale="log", yscale="log")
    for axis in (ax.xaxis, ax.yaxis):
        formatter = ScalarFormatter()
        formatter.set_scientific(False)
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0, 7.0)))
        axis.set_major_formatter(formatter)
        axis.set_minor_formatter(NullFormatter())


def ratios(
    wet: Mapping[str, Curve], dry: Curve, end: str = "incident", markers: Mapping[str, str] | None = None, ax: Axes | None = None
) -> Axes:
    """Times of flight of wet chains over those of the dry one, against speed.

    Parameters
    ----------
    wet : mapping of str to Sweep or Case
        By name of the oil.
    dry : Sweep or Case
        At least over the same speeds; between its own it is interpolated in
        logarithms.
    end : {"incident", "reflected"}
    """
    ax = _axes(ax)
    column = f"tof_{end}_s"
    reference = _columns(dry)
    order = np.argsort(reference["speed_m_s"])
    known = np.log(reference["speed_m_s"][order]), np.log(reference[column][order])
    for at, (name, curve) in enumerate(wet.items()):
        columns = _columns(curve)
        speeds = columns["speed_m_s"]
        ratio = columns[column] / np.exp(np.interp(np.log(speeds), *known))
        marker = (markers or {}).get(name, MARKERS[at % 5])
        ax.plot(speeds, ratio, marker=marker, color=f"C{at % 7}", label=name)
    ax.axhline(1.0, color="0.3", linewidth=0.6)
    ax.set_xlabel("Speed of the striker (m/s)")
    ax.set_ylabel(f"{end.capitalize()} ToF, wet / dry")
    ax.legend()
    return ax


FIGURE_2 = {"dry": 0.1368, "pump": 1.1520, "gear": 0.1396, "motor": 0.3993}
"""Chains and speeds in m/s of the paper's Fig. 2."""


def figure2(axes: Sequence[Axes] | None = None) -> NDArray[Any]:
    """The paper's Fig. 2, as its model gives it: one channel that adds sensor bead and wall.

    Dry, and with pump, gear and motor oil, at the paper's speeds.
    """
    if axes is None:
        with style():
            axes = plt.subplots(2, 2, figsize=(2 * COLUMN, 4.2))[1].ravel()
    made = np.asarray(axes).ravel()
    for ax, letter, (name, speed) in zip(made, "abcd", FIGURE_2.items(), strict=True):
        chain = preset(name)
        channel = f"bead_plus_wall_{chain.sensor_bead}"
        fired = shoot(chain, speed, trace=[channel], interval_s=1e-6)
        signals(fired, ax=ax)
        if (returning := fired.passage.get("reflected")) is not None:
            # What comes later, until the striker is away for good, is no part of the figure.
            ax.set_xlim(0.0, 1.6 * MICRO * returning["time_s"])
        ax.set_title(f"({letter}) {name}, {speed:.4f} m/s", loc="left")
    return made


def _paper_speeds(count: int) -> NDArray[np.float64]:
    """Speeds of the paper's range in m/s, in equal ratios."""
    return np.geomspace(0.075, 1.23, count)


def figure3(speeds: NDArray[np.float64] | None = None, ax: Axes | None = None) -> Axes:
    """The paper's Fig. 3: dry times of flight with the full model and without the cubic term.

    Incident below, reflected above; the same in logarithms as an inset.
    """
    speeds = _paper_speeds(40) if speeds is None else speeds
    curves = {"full model": sweep(preset("dry"), speeds), "without cubic term": sweep(preset("hertz-viscoelastic"), speeds)}
    ax = times_of_flight(curves, logarithmic=False, ax=_axes(ax, 2.9))
    ax.get_legend().remove()  # type: ignore[union-attr]
    inset = times_of_flight(curves, ax=ax.inset_axes((0.46, 0.47, 0.53, 0.51)))
    handles, labels = inset.get_legend_handles_labels()
    inset.get_legend().remove()  # type: ignore[union-attr]
    inset.set(xlabel="", ylabel="")
    inset.tick_params(labelsize=6)
    inset.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
    inset.xaxis.set_major_formatter("{x:g}")
    ax.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
    return ax


def figure4(speeds: NDArray[np.float64] | None = None, ax: Axes | None = None) -> Axes:
    """The paper's Fig. 4: incident times of flight of wet chains over the dry ones, by the model."""
    speeds = _paper_speeds(16) if speeds is None else speeds
    wet = {name: sweep(preset(name), speeds) for name in OILS}
    ax = ratios(wet, sweep(preset("dry"), speeds), markers=OILS, ax=ax)
    ax.set_xscale("log")
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter(ScalarFormatter())
    ax.xaxis.set_minor_formatter(NullFormatter())
    return ax


BAND = 1.96
"""Standard errors to either side of a band: 95 %."""


def fit(fitted: Fitted, axes: Sequence[Axes] | None = None) -> NDArray[Any]:
    """Data with the fitted curve and its 95 % band; residuals in standard errors below.

    Returns
    -------
    ndarray of Axes, shape (2,)
    """
    if axes is None:
        with style():
            sizes = {"height_ratios": (2.2, 1)}
            axes = plt.subplots(2, 1, figsize=(COLUMN, 3.6), sharex=True, gridspec_kw=sizes)[1]
    upper, lower = made = np.asarray(axes).ravel()
    for at, observable in enumerate(dict.fromkeys(fitted.rows["observable"].tolist())):
        _fitted_curve(upper, lower, fitted, str(observable), at)
    is_time = all(str(name).startswith("tof") for name in fitted.rows["observable"])
    upper.set_ylabel("Time of flight (µs)" if is_time else "Observable")
    upper.legend()
    upper.xaxis.set_tick_params(which="both", labelbottom=False)
    lower.axhline(0.0, color="0.3", linewidth=0.6)
    lower.set_xlabel("Speed of the striker (m/s)")
    lower.set_ylabel("Residual (σ)")
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
    colour, speeds = f"C{at % 7}", rows["speed_m_s"]
    curve, spread = scale * rows["fitted"], scale * BAND * rows["fitted_error"]
    name = observable.removeprefix("tof_").removesuffix("_s").replace("_", " ")
    upper.fill_between(speeds, curve - spread, curve + spread, color=colour, alpha=0.2, linewidth=0)
    upper.plot(speeds, curve, color=colour)
    upper.errorbar(speeds, scale * rows["measured"], scale * rows["error"], rows["speed_error_m_s"], color=colour, linestyle="none", marker=MARKERS[at % 5], elinewidth=0.6, label=name)
    lower.plot(speeds, rows["residual"], color=colour, linestyle="none", marker=MARKERS[at % 5])


def corner(fitted: Fitted, bins: int = 40, axes: NDArray[Any] | None = None) -> NDArray[Any]:
    """The posterior of each parameter and pair, with the best fit and the covariance's ellipses.

    Parameters
    ----------
    fitted : Fitted
        With ``method="posterior"``; without samples the covariance is all that is drawn.

    Returns
    -------
    ndarray of Axes, shape (parameters, parameters)
        The upper triangle is switched off.
    """
    names = list(fitted.parameters)
    count = len(names)
    if axes is None:
        with style():
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
        ax.hist(fitted.samples[:, at], bins, range=(low, high), density=True, color="C0", alpha=0.35)
    ax.plot(grid, normal, color="C1", linewidth=0.8)
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
        ax.plot(centre[0] + edge[0], centre[1] + edge[1], color="C1", linewidth=0.8)
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
