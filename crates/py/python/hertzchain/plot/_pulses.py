"""Signals of sensors against time and place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from ..results import Shot, Trace
from ._style import on_axes, styled, time_scale


@styled
def signals(shot: Shot | Trace, sensors: Sequence[str] | None = None, ax: Axes | None = None) -> Axes:
    """Signals of sensors against time.

    Parameters
    ----------
    shot : Shot or Trace
        With sampled sensors: ``hertzchain.shot(..., trace=True)``.
    sensors : sequence of str, optional
        Which; all forces when absent.
    ax : Axes, optional
        To draw into; a new figure's when absent.

    Returns
    -------
    Axes
        Times in µs; forces in N, velocities in m/s or displacements in m.

    Raises
    ------
    ValueError
        A shot without a trace.
    KeyError
        A sensor that was not sampled.

    References
    ----------
    The paper's Fig. 2: [Labbe2017].
    """
    trace = _trace(shot)
    shown = list(sensors or [name for name in trace.signals if trace.unit(name) in ("N", "1")])
    ax = on_axes(ax)
    scale, unit = time_scale(trace.dimensionless)
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


@styled
def space_time(shot: Shot | Trace, kind: str = "contact", ax: Axes | None = None) -> Axes:
    """Space–time map: a signal of every contact or body over time.

    Parameters
    ----------
    shot : Shot or Trace
        With several sensors of the kind: ``trace=[f"contact_{i}" for i in range(41)]``.
    kind : {"contact", "velocity", "position", "bead"}
        Which signals.
    ax : Axes, optional
        To draw into; a new figure's when absent.

    Returns
    -------
    Axes
        Times in µs; contacts or bodies upward; the signal as colour.

    Raises
    ------
    ValueError
        A shot without a trace, or with fewer than two such sensors.

    References
    ----------
    Maps of pulses in space and time: [Nesterenko2001].
    """
    trace = _trace(shot)
    numbers, values = trace.stacked(kind)
    if numbers.size < 2:
        raise ValueError(f"a map needs several sensors of kind {kind!r}; the trace has {numbers.size}")
    ax = on_axes(ax, 2.7)
    scale, unit = time_scale(trace.dimensionless)
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
