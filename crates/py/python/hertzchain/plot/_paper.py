"""The figures of the paper, as its model gives them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from ..experiment import preset
from ..shooting import shot as shoot
from ..shooting import sweep
from ._curves import ratios, times_of_flight
from ._pulses import signals
from ._style import COLUMN, MICRO, OILS, on_axes, styled

if TYPE_CHECKING:
    from numpy.typing import NDArray

FIGURE_2 = {"dry": 0.1368, "pump": 1.1520, "gear": 0.1396, "motor": 0.3993}
"""Chains and speeds in m/s of the paper's Fig. 2."""


@styled
def figure2(axes: Sequence[Axes] | None = None) -> NDArray[Any]:
    """The paper's Fig. 2, as its model gives it: one channel that adds sensor bead and wall.

    Dry, and with pump, gear and motor oil, at the paper's speeds.

    Parameters
    ----------
    axes : sequence of Axes, optional
        Four, to draw into; a new figure's when absent.

    Returns
    -------
    ndarray of Axes, shape (4,)
        Times in µs, forces in N.

    Raises
    ------
    ExperimentError
        None with the presets as they come.

    References
    ----------
    Fig. 2 of [Labbe2017].
    """
    if axes is None:
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


@styled
def figure3(speeds: NDArray[np.float64] | None = None, ax: Axes | None = None) -> Axes:
    """The paper's Fig. 3: dry times of flight with the full model and without the cubic term.

    Incident below, reflected above; the same in logarithms as an inset.

    Parameters
    ----------
    speeds : ndarray of shape (speeds,), optional
        In m/s; the paper's range when absent.
    ax : Axes, optional
        To draw into; a new figure's when absent.

    Returns
    -------
    Axes
        Speeds in m/s, times in µs.

    Raises
    ------
    OptionError
        Speeds that no shot can have.

    References
    ----------
    Fig. 3 of [Labbe2017].
    """
    speeds = _paper_speeds(40) if speeds is None else speeds
    curves = {"full model": sweep(preset("dry"), speeds), "without cubic term": sweep(preset("hertz-viscoelastic"), speeds)}
    ax = times_of_flight(curves, logarithmic=False, ax=on_axes(ax, 2.9))
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


@styled
def figure4(speeds: NDArray[np.float64] | None = None, ax: Axes | None = None) -> Axes:
    """The paper's Fig. 4: incident times of flight of wet chains over the dry ones, by the model.

    Parameters
    ----------
    speeds, ax
        As for `figure3`.

    Returns
    -------
    Axes
        Speeds in m/s, ratios without a unit.

    Raises
    ------
    OptionError
        Speeds that no shot can have.

    References
    ----------
    Fig. 4 of [Labbe2017].
    """
    speeds = _paper_speeds(16) if speeds is None else speeds
    wet = {name: sweep(preset(name), speeds) for name in OILS}
    ax = ratios(wet, sweep(preset("dry"), speeds), markers=OILS, ax=ax)
    ax.set_xscale("log")
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter(ScalarFormatter())
    ax.xaxis.set_minor_formatter(NullFormatter())
    return ax
