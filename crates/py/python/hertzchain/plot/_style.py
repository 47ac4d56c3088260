"""What all figures have in common: the style sheet, sizes, markers."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import ParamSpec, TypeVar

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import to_hex

Given = ParamSpec("Given")
Drawn = TypeVar("Drawn")

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
    # A backend that is loaded within the context loses with it what it has set: Jupyter's the
    # interactive mode, without which no later figure is shown. This loads it and draws nothing new.
    plt.draw_if_interactive()
    return plt.style.context(STYLE)


def styled(draw: Callable[Given, Drawn]) -> Callable[Given, Drawn]:
    """In the package's style, unless it draws into axes of somebody else's."""

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
    """One of the style's colours: named "C0" it would be whichever is the first when the figure is saved."""
    return to_hex(f"C{at % 7}")
