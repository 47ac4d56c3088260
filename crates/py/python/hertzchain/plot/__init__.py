"""Figures of publication quality with matplotlib; each function returns axes.

``pip install hertzchain[plot]``. Functions draw into axes they are given, or into
a new figure in the style of this package, `STYLE`, which is there for other figures, too::

    with hertzchain.plot.style():
        ...
"""

from ._curves import ratios, times_of_flight
from ._fits import corner, fit
from ._paper import figure2, figure3, figure4
from ._pulses import signals, space_time
from ._style import STYLE, style

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
