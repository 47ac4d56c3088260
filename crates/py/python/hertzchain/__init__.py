"""Rows of beads and their solitary waves: predict, measure, infer.

A row of touching balls is hit at one end; a solitary wave runs down it. This
package computes what sensors in the row see and when, with the same functions,
options and numbers as the ``hertzchain`` program.

>>> import hertzchain as hc
>>> dry = hc.preset("dry")
>>> hc.shot(dry, speed=0.5).tof_incident_s  # doctest: +ELLIPSIS
0.0007619040...
"""

from . import errors, experiment, inference, records, results, simulation
from ._hertzchain import __version__, instruction_set
from .errors import *
from .experiment import *
from .inference import design, fit, gauge
from .records import *
from .results import *
from .simulation import *

__all__ = ["__version__", "design", "fit", "gauge", "instruction_set"]
__all__ += errors.__all__ + experiment.__all__ + records.__all__ + results.__all__ + simulation.__all__
