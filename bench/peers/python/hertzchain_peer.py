"""hertzchain as its users run it, with defaults: `hertzchain sweep` from command to table, and `hertzchain.ensemble`.

Nine speeds are computed for each that is asked for, so that a batch is 9,000 shots where other tools have 1,000.
"""

import json
import os
import resource
import subprocess
import time
from pathlib import Path

import hertzchain
import numpy as np

FINER = 9
PROGRAM = os.environ["HERTZCHAIN"]
EXPERIMENTS = Path(__file__).resolve().parents[3] / "experiments"


def version():
    return hertzchain.__version__


def clock(method):
    """Processor time in s, of which a ninth counts for a speed asked for; of programs that were started and have
    ended, or of this one."""
    if method == "command":
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return (used.ru_utime + used.ru_stime) / FINER
    return time.process_time() / FINER


def ends(speeds):
    """First, last and number of speeds, nine for each of evenly spread ones, which is the fifth of its nine."""
    spacing = (speeds[-1] - speeds[0]) / max(len(speeds) - 1, 1) or 1e-3
    aside = spacing * (FINER // 2) / FINER
    return float(speeds[0] - aside), float(speeds[-1] + aside), FINER * len(speeds)


def command(experiment, accuracy, first, last, count):
    """Start, reading of the experiment and writing of the table are in the time."""
    words = [PROGRAM, "sweep", experiment, "--speeds", f"{first!r}:{last!r}:{count}"]
    words += ["--accuracy", repr(accuracy), "--threads", "1", "--json"]
    return json.loads(subprocess.run(words, check=True, capture_output=True).stdout)


def ensemble(experiment, accuracy, first, last, count):
    return hertzchain.ensemble(experiment, np.linspace(first, last, count), accuracy=accuracy, threads=1)


def run(method, case, accuracy, speeds):
    how = str(EXPERIMENTS / f"{case}.toml"), accuracy, *ends(speeds)
    if method == "command":
        shots = command(*how)["points"]
        pairs = [(shot["tof_incident_s"], shot["tof_reflected_s"]) for shot in shots]
        pairs = [tuple(float("nan") if tof is None else tof for tof in pair) for pair in pairs]
    else:
        result = ensemble(*how)
        pairs = list(zip(result.tof_incident_s.tolist(), result.tof_reflected_s.tolist()))
    return pairs[FINER // 2 :: FINER]
