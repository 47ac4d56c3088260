"""Figures of publication quality with matplotlib; each function returns axes.

``pip install hertzchain[plot]``. Functions draw into axes they are given, or into
a new figure in the style of this package, `STYLE`, which is there for other figures, too::

    with hertzchain.plot.style():
        ...
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import to_hex
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
from numpy.typing import NDArray

from ._options import with_options
from .errors import ExperimentWarning
from .results import Case, FitResult, Floats, PowerLaw, Shot, Sweep, Trace

__all__ = [
    "STYLE", "corner", "fit", "ratios", "signals", "space_time", "style", "times_of_flight",
]  # fmt: skip

Given = ParamSpec("Given")
Drawn = TypeVar("Drawn")

STYLE = str(Path(__file__).with_name("hertzchain.mplstyle"))
"""Path of the style sheet."""

MICRO, COLUMN = 1e6, 3.35
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "p")
# Of incident and reflected curves: the first pair unless colours are equal.
DASHES: Any = (("-", "--"), ("-.", ":"), ((0, (9, 2)), (0, (1, 4))))
OF_CASES = {"": "#0072b2", "dry": "#000000", "pump": "#008a64", "gear": "#0060a6", "motor": "#ce5600"}
OTHERS = ("#cc79a7", "#e69f00", "#56b4e9", "#882255", "#332288", "#999933", "#8c564b")


def style() -> AbstractContextManager[None]:
    """The package's style within a ``with`` block.

    The style sheet at `STYLE`: columns of 85 mm, as journals of physics have.

    Returns
    -------
    context manager
        Gives matplotlib's settings back in the end.
    """
    # A backend that is loaded within the context loses with it what it has set: Jupyter's the
    # interactive mode, without which no later figure is shown. This loads it and draws nothing new.
    plt.draw_if_interactive()
    return plt.style.context(STYLE)


def styled(draw: Callable[Given, Drawn]) -> Callable[Given, Drawn]:
    """In the package's style, unless it draws into given axes."""

    @with_options(None)
    @wraps(draw)
    def within(*args: Given.args, **kwargs: Given.kwargs) -> Drawn:
        given = signature(draw).bind(*args, **kwargs).arguments
        own = given.get("ax") is None and given.get("axes") is None
        with style() if own else nullcontext():
            return draw(*args, **kwargs)

    return within


def on_axes(ax: Axes | None, height: float = 2.5) -> Axes:
    """The axes that are given, or a new figure's."""
    return plt.subplots(figsize=(COLUMN, height))[1] if ax is None else ax


def time_scale(dimensionless: bool) -> tuple[float, str]:
    """What times are multiplied by, and the unit behind their name."""
    return (1.0, "") if dimensionless else (MICRO, " (µs)")


def colour_of(at: int) -> str:
    """A colour of the style's: "C0" would be whichever is the first when the figure is saved."""
    return to_hex(f"C{at % 7}")


def looks_of(names: Iterable[str]) -> Iterator[tuple[str, str, Any]]:
    """Colour, marker and dashes of cases: a colour follows from the name alone, by the program or by its letters."""
    others = {name: OTHERS[sum(name.encode()) % len(OTHERS)] for name in names}
    colours = [OF_CASES.get(name.replace("-", " ").split(" ")[0], other) for name, other in others.items()]
    for at, colour in enumerate(colours):
        yield colour, MARKERS[at % len(MARKERS)], DASHES[colours[:at].count(colour) % len(DASHES)]


def legend_above(ax: Axes) -> None:
    """A legend above the axes, in two columns if these are no wider."""
    for columns in (2, 1):
        legend = ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns)
        if legend.get_window_extent().width < 1.05 * ax.bbox.width:
            break


@styled
def signals(shot: Shot | Trace, sensors: Sequence[str] | None = None, ax: Axes | None = None) -> Axes:
    """Signals of sensors against time, as in Fig. 2 of [Labbe2017].

    Parameters
    ----------
    shot : Shot or Trace
        With sampled sensors: ``hertzchain.shot(..., trace=True)``.
    sensors : sequence of str, optional
        Which; all forces when absent, or all there is.

    Returns
    -------
    Axes
        Times in µs; forces in N, velocities in m/s or displacements in m.

    Raises
    ------
    ValueError
        A shot without a trace; sensors of several units.
    KeyError
        A sensor that was not sampled.
    """
    trace = _trace(shot)
    forces = [name for name in trace.signals if trace.units[name] in ("N", "1")]
    shown = [sensors] if isinstance(sensors, str) else list(sensors or forces or trace.signals)
    if len(units := {trace.units[name] for name in shown}) > 1:
        raise ValueError(f"sensors in {' and '.join(sorted(units))}: expected one unit in a figure")
    ax = on_axes(ax)
    scale, unit = time_scale(trace.dimensionless)
    for name in shown:
        ax.plot(scale * trace.time_s, trace[name], label=_label(name))
    ax.set_xlabel(f"Time{unit}")
    of = min(units, default="N")
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


@styled
def space_time(shot: Shot | Trace, kind: str = "contact", ax: Axes | None = None) -> Axes:
    """Space–time map: a signal of every contact or body over time.

    Maps of pulses in space and time: [Nesterenko2001].

    Parameters
    ----------
    shot : Shot or Trace
        With several sensors of the kind: ``trace=[f"contact_{i}" for i in range(41)]``.
    kind : {"contact", "velocity", "position", "bead"}
        Which signals.

    Returns
    -------
    Axes
        Times in µs; contacts or bodies upward; the signal as colour.

    Raises
    ------
    ValueError
        A shot without a trace, or with fewer than two such sensors.
    """
    trace = _trace(shot)
    numbers, values = trace.stacked(kind)
    if numbers.size < 2:
        raise ValueError(f"a map needs several sensors of kind {kind!r}; the trace has {numbers.size}")
    ax = on_axes(ax, 2.7)
    scale, unit = time_scale(trace.dimensionless)
    most = float(np.abs(values).max())
    colours: dict[str, Any] = {"cmap": "RdBu_r", "vmin": -most} if values.min() < -0.05 * most else {"vmin": 0.0}
    mesh = ax.pcolormesh(scale * trace.time_s, numbers, values, shading="nearest", rasterized=True, vmax=most, **colours)
    ax.grid(False)
    ax.set(xlabel=f"Time{unit}", ylabel="Contact" if kind == "contact" else "Bead")
    of = trace.units[f"{kind}_{numbers[0]}"]
    name = {"contact": "Force", "bead": "Force", "velocity": "Velocity", "position": "Displacement"}[kind]
    ax.figure.colorbar(mesh, ax=ax, label=name if of == "1" else f"{name} ({of})", pad=0.02)
    return ax


Curve = Sweep | Case
"""A computed curve, or a measured one."""


def _points(ax: Axes, curve: Curve, column: str, factor: float, **look: Any) -> None:
    """A line of computed numbers, or measured ones with their errors."""
    columns = curve._columns()
    speeds, values = columns["speed_m_s"], factor * columns[column]
    if isinstance(curve, Sweep):
        look.pop("marker", None)
        ax.plot(speeds, values, **look)
        return
    look |= {"linestyle": "none", "elinewidth": 0.6}
    ax.errorbar(speeds, values, factor * columns[f"{column}_error"], columns["speed_error_m_s"], **look)


@styled
def times_of_flight(
    curves: Curve | Mapping[str, Curve], laws: bool = False, logarithmic: bool = True, ax: Axes | None = None
) -> Axes:
    """Incident and reflected times of flight against speed, as in Fig. 3 of [Labbe2017].

    Parameters
    ----------
    curves : Sweep, Case, or mapping of str to these
        Computed curves are lines, measured ones points with error bars. The
        reflected times have dashes, or hollow points.
    laws : bool
        Draw the power laws beside them.
    logarithmic : bool
        Both axes logarithmic.

    Returns
    -------
    Axes
        Speeds in m/s, times in µs.

    Raises
    ------
    KeyError
        A curve without such a column.
    """
    ax = on_axes(ax)
    named = curves if isinstance(curves, Mapping) else {"": curves}
    dimensionless = all(isinstance(curve, Sweep) and curve.dimensionless for curve in named.values())
    scale, unit = time_scale(dimensionless)
    for (name, curve), (colour, marker, dashes) in zip(named.items(), looks_of(named), strict=True):
        for end, dash, face in zip(("incident", "reflected"), dashes, (colour, "none"), strict=True):
            look = {"color": colour, "linestyle": dash, "marker": marker, "markerfacecolor": face}
            _points(ax, curve, f"tof_{end}_s", scale, label=f"{name} {end}".strip(), **look)
            law: PowerLaw | None = getattr(curve, f"power_law_{end}")
            if laws and law is not None:
                known = curve._columns()["speed_m_s"]
                speeds = np.geomspace(np.min(known), np.max(known), 50)
                ax.plot(speeds, scale * law(speeds), color="0.6", linewidth=0.7, zorder=1)
    ax.set(xlabel="Speed of the striker" if dimensionless else "Speed of the striker (m/s)", ylabel=f"Time of flight{unit}")
    if logarithmic:
        ax.set(xscale="log", yscale="log")
        for axis in (ax.xaxis, ax.yaxis):
            plain_ticks(axis, (1.0, 2.0, 3.0, 5.0, 7.0))
    legend_above(ax)
    return ax


def plain_ticks(axis: Axis, steps: Sequence[float]) -> None:
    """Plain numbers as ticks of a logarithmic axis: decades, these steps of each, or even steps, at least three."""
    low, high = axis.get_view_interval()
    for locator in (LogLocator(), LogLocator(subs=steps), MaxNLocator(6, steps=(1, 2, 5, 10), min_n_ticks=3)):
        axis.set_major_locator(locator)
        if sum(low <= tick <= high for tick in axis.get_majorticklocs()) >= 3:
            break
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _relative(curve: Curve, column: str) -> Floats:
    """Standard errors of a column over it; 0 of a computed one."""
    return (found := curve._columns()).get(f"{column}_error", 0.0 * found[column]) / found[column]


CONTINUED = np.log(1.02)
"""How far a curve is continued beyond its ends, in ln(speed)."""


def _continued(at: Floats, x: Floats, y: Floats) -> Floats:
    """A curve between its points and, along its last chords, a little beyond; infinite farther out."""
    found = np.interp(at, x, y)
    for end, inner, outside in ((0, 1, x[0] - at), (-1, -2, at - x[-1])):
        slope = (y[end] - y[inner]) / (x[end] - x[inner]) if x.size > 1 else 0.0
        found = np.where(outside > 0.0, y[end] + slope * (at - x[end]), found)
        found = np.where(outside > CONTINUED, np.inf, found)
    return found


@styled
def ratios(
    wet: Mapping[str, Curve], dry: Curve, end: str = "incident", markers: Mapping[str, str] | None = None, ax: Axes | None = None
) -> Axes:
    """Times of flight of wet chains over those of the dry one, against speed, as in Fig. 4 of [Labbe2017].

    Parameters
    ----------
    wet : mapping of str to Sweep or Case
        By name of the oil.
    dry : Sweep or Case
        Over the same speeds: it is interpolated in logarithms, and continued by 2 % of a speed.
        Ratios beyond are not drawn.
    end : {"incident", "reflected"}
        Whose times of flight.
    markers : mapping of str to str, optional
        By name of the oil.

    Returns
    -------
    Axes
        Speeds in m/s, ratios without a unit, errors of measured ones.

    Raises
    ------
    KeyError
        A curve without such a column.

    Warns
    -----
    ExperimentWarning
        Ratios that are not drawn.
    """
    ax = on_axes(ax)
    column = f"tof_{end}_s"
    reference = dry._columns()
    order = np.argsort(reference["speed_m_s"])
    known = np.log(reference["speed_m_s"][order]), np.log(reference[column][order])
    for (name, curve), (colour, marker, dashes) in zip(wet.items(), looks_of(wet), strict=True):
        speeds, own = (curve._columns()[of] for of in ("speed_m_s", column))
        times = _continued(np.log(speeds), *known)
        if beyond := int(np.isinf(times).sum()):
            text = f"{beyond} of {speeds.size} ratios of {name} are not drawn: the dry curve has no times of flight at their speeds"
            warnings.warn(text, ExperimentWarning, stacklevel=3)
        ratio = own / np.exp(np.where(np.isinf(times), np.nan, times))
        error = ratio * np.hypot(_relative(curve, column), np.interp(np.log(speeds), known[0], _relative(dry, column)[order]))
        bars, line = (None, dashes[0]) if isinstance(curve, Sweep) else (error, "none")
        ax.errorbar(speeds, ratio, bars, color=colour, marker=(markers or {}).get(name, marker), ls=line, label=name)
    ax.axhline(1.0, color="0.3", linewidth=0.6)
    ax.set(xlabel="Speed of the striker" + ("" if getattr(dry, "dimensionless", False) else " (m/s)"), ylabel=f"{end.capitalize()} ToF, wet / dry")
    legend_above(ax)
    return ax


BAND = 1.96
"""Standard errors to either side of a band: 95 %."""


@styled
def fit(fitted: FitResult, axes: Sequence[Axes] | None = None) -> NDArray[Any]:
    """Data with the fitted curve and its 95 % band; residuals in standard errors below.

    Of a fit of whole pulses, the first recording's. Bands by the covariance:
    docs/explanation/inference.md.

    Parameters
    ----------
    fitted : FitResult
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
    """
    if axes is None:
        axes = plt.subplots(2, 1, figsize=(COLUMN, 3.6), sharex=True, height_ratios=(2.2, 1))[1]
    upper, lower = made = np.asarray(axes).ravel()
    upper.xaxis.set_tick_params(which="both", labelbottom=False)
    lower.axhline(0.0, color="0.3", linewidth=0.6)
    lower.set_ylabel("Residual (σ)")
    if "source" in fitted.rows:
        _model_pulses(upper, lower, fitted)
        return made
    for at, observable in enumerate(dict.fromkeys(fitted.rows["observable"].tolist())):
        _model_curve(upper, lower, fitted, str(observable), at)
    is_time = all(str(name).startswith("tof") for name in fitted.rows["observable"])
    upper.set_ylabel("Time of flight (µs)" if is_time else "Observable")
    upper.legend()
    lower.set_xlabel("Speed of the striker (m/s)")
    lower.set_xscale("log")
    plain_ticks(lower.xaxis, (1.0, 2.0, 5.0))
    return made


def _model_curve(upper: Axes, lower: Axes, fitted: FitResult, observable: str, at: int) -> None:
    order = np.argsort(fitted.rows["speed_m_s"])
    own = order[fitted.rows["observable"][order] == observable]
    rows = {name: values[own] for name, values in fitted.rows.items()}
    scale = MICRO if observable.startswith("tof") else 1.0
    colour, speeds = colour_of(at), rows["speed_m_s"]
    curve, spread = scale * rows["fitted"], scale * BAND * rows["fitted_error"]
    name = observable.removeprefix("tof_").removesuffix("_s").replace("_", " ")
    upper.fill_between(speeds, curve - spread, curve + spread, color=colour, alpha=0.2, linewidth=0)
    upper.plot(speeds, curve, color=colour)
    upper.errorbar(speeds, scale * rows["measured"], scale * rows["error"], rows["speed_error_m_s"], color=colour, linestyle="none", marker=MARKERS[at % 5], elinewidth=0.6, label=name)
    lower.plot(speeds, rows["residual"], color=colour, linestyle="none", marker=MARKERS[at % 5])


def _model_pulses(upper: Axes, lower: Axes, fitted: FitResult) -> None:
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
    lower.set_xlabel("Time after the incident maximum (µs)")


@styled
def corner(fitted: FitResult, bins: int = 40, axes: NDArray[Any] | None = None) -> NDArray[Any]:
    """The posterior of each parameter and pair, with the best fit and the covariance's ellipses.

    Samples by [GoodmanWeare2010]: docs/explanation/inference.md.

    Parameters
    ----------
    fitted : FitResult
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
    """
    count = len(fitted.parameters)
    if axes is None:
        side = max(COLUMN, 1.5 * count)
        axes = plt.subplots(count, count, figsize=(side, side), squeeze=False)[1]
    made = np.asarray(axes).reshape(count, count)
    for row, column in np.ndindex(count, count):
        ax = made[row, column]
        if column > row:
            ax.axis("off")
        elif column == row:
            _marginal(ax, fitted, row, bins)
        else:
            _pair(ax, fitted, (column, row), bins)
        _corner_labels(ax, fitted, (row, column), count)
    return made


def _normal(fitted: FitResult, at: int) -> tuple[float, float]:
    """Best fit and standard deviation of a parameter by the covariance."""
    return list(fitted.parameters.values())[at].value, float(np.sqrt(fitted.covariance[at, at]))


def _range(fitted: FitResult, at: int) -> tuple[float, float]:
    """What is shown of a parameter: four standard errors, or where its samples are."""
    if fitted.samples is None:
        best, spread = _normal(fitted, at)
        return best - 4 * spread, best + 4 * spread
    low, high = np.quantile(fitted.samples[:, at], (0.001, 0.999))
    return float(low), float(high)


def _marginal(ax: Axes, fitted: FitResult, at: int, bins: int) -> None:
    low, high = _range(fitted, at)
    best, spread = _normal(fitted, at)
    grid = np.linspace(low, high, 200)
    normal = np.exp(-0.5 * ((grid - best) / spread) ** 2) / (spread * np.sqrt(2 * np.pi))
    if fitted.samples is not None:
        ax.hist(fitted.samples[:, at], bins, range=(low, high), density=True, color=colour_of(0), alpha=0.35)
    ax.plot(grid, normal, color=colour_of(1), linewidth=0.8)
    ax.axvline(best, color="0.3", linewidth=0.6)
    ax.set(xlim=(low, high), yticks=[])
    ax.grid(False)


def _pair(ax: Axes, fitted: FitResult, pair: tuple[int, int], bins: int) -> None:
    ranges = [_range(fitted, at) for at in pair]
    centre = [_normal(fitted, at)[0] for at in pair]
    if fitted.samples is not None:
        cells, x, y = np.histogram2d(fitted.samples[:, pair[0]], fitted.samples[:, pair[1]], bins=bins, range=ranges)
        ax.pcolormesh(x, y, cells.T, cmap="Blues", rasterized=True)
    values, vectors = np.linalg.eigh(fitted.covariance[np.ix_(pair, pair)])
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = np.array([np.cos(angle), np.sin(angle)])
    # Radii that hold 68 % and 95 % of a normal distribution of two numbers.
    for radius in (1.515, 2.448):
        edge = vectors @ (np.sqrt(np.maximum(values, 0.0))[:, None] * circle) * radius
        ax.plot(centre[0] + edge[0], centre[1] + edge[1], color=colour_of(1), linewidth=0.8)
    ax.plot(*centre, marker="+", color="0.2")
    ax.set(xlim=ranges[0], ylim=ranges[1])
    ax.grid(False)


def _corner_labels(ax: Axes, fitted: FitResult, place: tuple[int, int], count: int) -> None:
    row, column = place
    units = [one.unit.replace("^2", "²").replace("^3", "³") for one in fitted.parameters.values()]
    labels = [f"{name}\n({unit})" if unit else name for name, unit in zip(fitted.parameters, units, strict=True)]
    if row == count - 1:
        ax.set_xlabel(labels[column])
    else:
        ax.tick_params(labelbottom=False)
    if column == 0 and row > 0:
        ax.set_ylabel(labels[row])
    elif column < row:
        ax.tick_params(labelleft=False)
    ax.locator_params(axis="x", nbins=3)
    if column < row:
        ax.locator_params(axis="y", nbins=3)
    ax.ticklabel_format(style="sci", scilimits=(-2, 3), useMathText=True)
