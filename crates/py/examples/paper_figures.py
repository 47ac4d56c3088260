"""The paper's Figs. 2 to 4 with matplotlib, drawn by hertzchain's own figures.

usage: python crates/py/examples/paper_figures.py [FOLDER]      (`hertzchain reproduce` draws them without Python)
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import hertzchain as hc
from hertzchain import plot

FIGURE_2 = {"dry": 0.1368, "pump": 1.1520, "gear": 0.1396, "motor": 0.3993}
"""Chains and speeds in m/s of Fig. 2."""
OILS = {"pump": "^", "gear": "s", "motor": "o"}


def figure2():
    """One channel that adds sensor bead and wall: dry, and with pump, gear and motor oil."""
    axes = plt.subplots(2, 2, figsize=(2 * plot.COLUMN, 4.2))[1].ravel()
    for ax, letter, (name, speed) in zip(axes, "abcd", FIGURE_2.items(), strict=True):
        channel = f"bead_plus_wall_{hc.preset(name).sensor_bead}"
        found = hc.shot(name, speed, trace=[channel], interval_s=1e-6)
        plot.signals(found, ax=ax)
        if (reflected := found.passage.get("reflected")) is not None:
            # What comes later, until the striker is away for good, is no part of the figure.
            ax.set_xlim(0.0, 1.6e6 * reflected["time_s"])
        ax.set_title(f"({letter}) {name}, {speed:.4f} m/s", loc="left")
    return axes


def figure3(speeds):
    """Dry times of flight with the full model and without the cubic term, in logarithms as an inset."""
    curves = {"full model": hc.sweep("dry", speeds), "without cubic term": hc.sweep("hertz-viscoelastic", speeds)}
    ax = plot.times_of_flight(curves, logarithmic=False, ax=plt.subplots(figsize=(plot.COLUMN, 2.9))[1])
    ax.get_legend().remove()
    inset = plot.times_of_flight(curves, ax=ax.inset_axes((0.46, 0.47, 0.53, 0.51)))
    handles, labels = inset.get_legend_handles_labels()
    inset.get_legend().remove()
    inset.set(xlabel="", ylabel="")
    inset.tick_params(labelsize=6)
    plot.plain_ticks(inset.xaxis, (1.0, 3.0))
    ax.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
    return ax


def figure4(speeds):
    """Incident times of flight of wet chains over the dry ones."""
    ax = plot.ratios({name: hc.sweep(name, speeds) for name in OILS}, hc.sweep("dry", speeds), markers=OILS)
    ax.set_xscale("log")
    plot.plain_ticks(ax.xaxis, (1.0, 2.0, 5.0))
    return ax


def main(folder: Path) -> None:
    """Writes the figures as PDF."""
    folder.mkdir(parents=True, exist_ok=True)
    with plot.style():
        drawn = {"figure2": figure2()[0], "figure3": figure3(np.geomspace(0.075, 1.23, 40)), "figure4": figure4(np.geomspace(0.075, 1.23, 16))}
        for name, ax in drawn.items():
            ax.get_figure().savefig(folder / f"{name}.pdf")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
