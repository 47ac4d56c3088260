"""What all figures have in common: the style sheet, sizes, markers."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

STYLE = str(Path(__file__).parent.with_name("hertzchain.mplstyle"))
"""Path of the style sheet."""

MICRO = 1e6
COLUMN = 3.35
MARKERS = ("o", "s", "^", "D", "v")
OILS = {"pump": "^", "gear": "s", "motor": "o"}


def style() -> AbstractContextManager[None]:
    """The package's style within a ``with`` block.

    Returns
    -------
    context manager
        Gives matplotlib's settings back in the end.

    References
    ----------
    The style sheet at `STYLE`: columns of 85 mm, as journals of physics have.
    """
    return plt.style.context(STYLE)


def on_axes(ax: Axes | None, height: float = 2.5) -> Axes:
    if ax is not None:
        return ax
    with style():
        return plt.subplots(figsize=(COLUMN, height))[1]


def time_scale(dimensionless: bool) -> tuple[float, str]:
    return (1.0, "") if dimensionless else (MICRO, " (µs)")
