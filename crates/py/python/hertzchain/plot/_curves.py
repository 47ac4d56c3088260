"""Times of flight and their ratios against speed."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from ..curves import Sweep
from ..errors import ExperimentWarning
from ..recording import Case
from ..results import PowerLaw
from ._style import MARKERS, colour_of, on_axes, styled, time_scale

if TYPE_CHECKING:
    from numpy.typing import NDArray

Curve = Sweep | Case
"""A computed curve, or a measured one."""


def columns_of(curve: Curve) -> Mapping[str, NDArray[np.float64]]:
    return curve.columns | {"speed_m_s": curve.speed_m_s} if isinstance(curve, Sweep) else curve.columns


def _points(ax: Axes, curve: Curve, column: str, factor: float, **look: Any) -> None:
    """A line of computed numbers, or measured ones with their errors."""
    columns = columns_of(curve)
    speeds, values = columns["speed_m_s"], factor * columns[column]
    if isinstance(curve, Sweep):
        look.pop("marker", None)
        ax.plot(speeds, values, **look)
        return
    look.pop("linestyle", None)
    ax.errorbar(
        speeds, values, factor * columns[f"{column}_error"], columns["speed_error_m_s"], linestyle="none", elinewidth=0.6, **look
    )


@styled
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
    ax : Axes, optional
        To draw into; a new figure's when absent.

    Returns
    -------
    Axes
        Speeds in m/s, times in µs.

    Raises
    ------
    KeyError
        A curve without such a column.

    References
    ----------
    The paper's Fig. 3: [Labbe2017].
    """
    ax = on_axes(ax)
    named = curves if isinstance(curves, Mapping) else {"": curves}
    dimensionless = all(isinstance(curve, Sweep) and curve.dimensionless for curve in named.values())
    scale, unit = time_scale(dimensionless)
    for at, (name, curve) in enumerate(named.items()):
        colour = colour_of(at)
        ends = [("incident", "tof_incident_s", "-", colour), ("reflected", "tof_reflected_s", "--", "none")]
        for end, column, dashes, face in ends:
            label = f"{name} {end}".strip()
            _points(ax, curve, column, scale, color=colour, linestyle=dashes, marker=MARKERS[at % 5], markerfacecolor=face, label=label)
            law: PowerLaw | None = getattr(curve, f"power_law_{end}")
            if laws and law is not None:
                speeds = np.geomspace(*_ends(columns_of(curve)["speed_m_s"]), 50)
                ax.plot(speeds, scale * law(speeds), color="0.6", linewidth=0.7, zorder=1)
    ax.set_xlabel("Speed of the striker" if dimensionless else "Speed of the striker (m/s)")
    ax.set_ylabel(f"Time of flight{unit}")
    if logarithmic:
        _log_axes(ax)
    ax.legend()
    return ax


def _ends(values: NDArray[np.float64]) -> tuple[float, float]:
    return float(np.min(values)), float(np.max(values))


def _log_axes(ax: Axes) -> None:
    """Logarithmic axes with plain numbers."""
    ax.set(xscale="log", yscale="log")
    for axis in (ax.xaxis, ax.yaxis):
        formatter = ScalarFormatter()
        formatter.set_scientific(False)
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0, 7.0)))
        axis.set_major_formatter(formatter)
        axis.set_minor_formatter(NullFormatter())


CONTINUED = np.log(1.02)
"""How far a curve is continued beyond its ends, in ln(speed)."""


def _continued(at: NDArray[np.float64], x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
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
    """Times of flight of wet chains over those of the dry one, against speed.

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
    ax : Axes, optional
        To draw into; a new figure's when absent.

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

    References
    ----------
    The paper's Fig. 4: [Labbe2017].
    """
    ax = on_axes(ax)
    column = f"tof_{end}_s"
    reference = columns_of(dry)
    order = np.argsort(reference["speed_m_s"])
    known = np.log(reference["speed_m_s"][order]), np.log(reference[column][order])
    for at, (name, curve) in enumerate(wet.items()):
        columns = columns_of(curve)
        speeds = columns["speed_m_s"]
        times = _continued(np.log(speeds), *known)
        if beyond := int(np.isinf(times).sum()):
            text = f"{beyond} of {speeds.size} ratios of {name} are not drawn: the dry curve has no times of flight at their speeds"
            warnings.warn(text, ExperimentWarning, stacklevel=3)
        ratio = columns[column] / np.exp(np.where(np.isinf(times), np.nan, times))
        marker = (markers or {}).get(name, MARKERS[at % 5])
        ax.plot(speeds, ratio, marker=marker, color=colour_of(at), label=name)
    ax.axhline(1.0, color="0.3", linewidth=0.6)
    ax.set_xlabel("Speed of the striker (m/s)")
    ax.set_ylabel(f"{end.capitalize()} ToF, wet / dry")
    ax.legend()
    return ax
