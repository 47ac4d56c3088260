"""Rows of beads and their solitary waves: predict, measure, infer.

A row of touching balls is hit at one end; a solitary wave runs down it. This
package computes what sensors in the row see and when, with the same verbs,
words and numbers as the ``hertzchain`` program.

>>> import hertzchain as hc
>>> dry = hc.preset("dry")
>>> hc.shot(dry, speed=0.5).tof_incident_s  # doctest: +ELLIPSIS
0.0007619040...
"""

from ._hertzchain import instruction_set
from .curves import Ensemble, Odd, Sweep
from .errors import (
    ExperimentError,
    ExperimentWarning,
    Finding,
    HertzchainError,
    InternalError,
    OptionError,
)
from .experiment import (
    Beads,
    Contacts,
    Experiment,
    FarEnd,
    Law,
    Material,
    PowerOfSpeed,
    Striker,
    build,
    load,
    preset,
    presets,
    schema,
)
from .force import ForceLaw
from .inferred import Designed, Fitted, Gauged, Parameter
from .inferring import design, fit, gauge
from .knowing import Description, Group, LawInfo, Row, check, laws, theory
from .recording import Campaigned, Case, Measured, campaign, measure
from .results import PowerLaw, Shot, Trace
from .shooting import ensemble, shot, sweep

__all__ = [
    "Beads",
    "Campaigned",
    "Case",
    "Contacts",
    "Description",
    "Designed",
    "Ensemble",
    "Experiment",
    "ExperimentError",
    "ExperimentWarning",
    "FarEnd",
    "Finding",
    "Fitted",
    "ForceLaw",
    "Gauged",
    "Group",
    "HertzchainError",
    "InternalError",
    "Law",
    "LawInfo",
    "Material",
    "Measured",
    "Odd",
    "OptionError",
    "Parameter",
    "PowerLaw",
    "PowerOfSpeed",
    "Row",
    "Shot",
    "Striker",
    "Sweep",
    "Trace",
    "build",
    "campaign",
    "check",
    "design",
    "ensemble",
    "fit",
    "gauge",
    "instruction_set",
    "laws",
    "load",
    "measure",
    "preset",
    "presets",
    "schema",
    "shot",
    "sweep",
    "theory",
]
