"""Numbers by law.py, row.py and contact.py for the tests of the Rust law: forces and loss of one contact along given motions, and rows.

Writes reference.json; with the word `law`, what contact.py gave stays. All are of first order in time: values are extrapolated from a step and half of it.
"""

import json
import pathlib
import sys

import numpy as np

from contact import Barus, Contact, Grid, drive, graded_faces
from law import FilmLaw
from pulse import MODULUS, REDUCED_RADIUS, STIFFNESS
from row import shot

SAMPLES, STEPS, NODES = 24, 40_000, 3000

# Static force in N, amplitude in m, duration of a pulse or period of a sine in s, duration in s, viscosity in Pa s, α in 1/Pa.
CASES = [
    ("pulse", 0.12, 6.7e-6, 60e-6, 60e-6, 0.119, 0.0),
    ("pulse", 0.24, 1.5e-6, 94e-6, 94e-6, 0.048, 0.0),
    ("pulse", 0.24, 4.0e-6, 70e-6, 70e-6, 0.058, 15e-9),
    ("pulse", 0.0, 6.7e-6, 60e-6, 54e-6, 0.119, 0.0),
    ("sine", 30.0, 1.5e-6, 80e-6, 200e-6, 0.119, 0.0),
    ("sine", 30.0, 1.5e-6, 80e-6, 200e-6, 0.058, 12e-9),
]


# Amplitude in m, duration of a pulse in s, viscosity in Pa s, α in 1/Pa; 0.24 N. What a contact of these traps in m³.
LIMITED = [
    (1.5e-6, 94e-6, 0.048, 0.0, 6e-16),
    (6.7e-6, 60e-6, 0.119, 0.0, 8e-15),
    (1.5e-6, 94e-6, 0.0478, 16e-9, 1.9e-15),
    (6.7e-6, 60e-6, 0.0478, 16e-9, 2.3e-14),
]
# Volumes over what is trapped; the first is flooded.
VOLUMES = [np.inf, 1000.0, 100.0, 30.0, 10.0, 3.0, 1.0, 0.5]


# Speed in m/s, viscosity in Pa s, α in 1/Pa of rows with 0.24 N.
ROWS = [(0.5, 0.119, 0.0), (0.075, 0.048, 0.0), (0.15, 0.058, 15e-9)]


def motion(kind, amplitude, period, times):
    """Displacement of the driven side in m."""
    if kind == "pulse":
        return amplitude * np.sin(np.pi * times / period) ** 2
    return amplitude * np.sin(2 * np.pi * times / period)


def run(case, steps):
    """Forces in N at the samples and energy lost in J at the end."""
    kind, force, amplitude, period, duration, viscosity, alpha = case
    static = (force / STIFFNESS) ** (2 / 3)
    law = FilmLaw(REDUCED_RADIUS, MODULUS, viscosity, 1.2 * (static + amplitude), alpha, nodes=NODES).start(static)
    overlaps = static + motion(kind, amplitude, period, duration / steps * np.arange(1, steps + 1))
    forces = np.array([law.step(duration / steps, overlap) for overlap in overlaps])
    return forces[steps // SAMPLES - 1 :: steps // SAMPLES], law.dissipated


def reference(case):
    """One case with what came out of it."""
    steps = STEPS - STEPS % SAMPLES
    (coarse, lost), (fine, less) = run(case, steps), run(case, 2 * steps)
    names = ("kind", "static_n", "amplitude_m", "period_s", "duration_s", "viscosity_pa_s", "pressure_viscosity_per_pa")
    numbers = {"force_n": [float(f"{value:.8g}") for value in 2 * fine - coarse], "loss_j": float(f"{2 * less - lost:.8g}")}
    return dict(zip(names, case)) | numbers


def whole(amplitude, period, viscosity, alpha, volume, steps, rings=120):
    """Forces in N at the samples and work in J by contact.py, with a volume of oil."""
    static = (0.24 / STIFFNESS) ** (2 / 3)
    edge = np.sqrt(REDUCED_RADIUS * (static + amplitude))
    grid = Grid(graded_faces(1.25 * edge, rings, 8 * edge), MODULUS)
    contact = Contact(grid, REDUCED_RADIUS, viscosity, Barus(alpha) if alpha else None).start(static, volume=volume)
    times = np.linspace(0, period, steps + 1)
    rows = drive(contact, times, static + motion("pulse", amplitude, period, times))
    force, overlap = rows[:, 2], rows[:, 1]
    return force[steps // SAMPLES :: steps // SAMPLES], np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(overlap))


def limited(case, over):
    """One pulse through a contact with a limited volume, and what came out of it."""
    *numbers, trapped = case
    volume = over * trapped
    (coarse, lost), (fine, less) = (whole(*numbers, volume, steps) for steps in (20 * SAMPLES, 40 * SAMPLES))
    names = ("amplitude_m", "duration_s", "viscosity_pa_s", "pressure_viscosity_per_pa")
    found = {"force_n": [float(f"{value:.5g}") for value in 2 * fine - coarse], "loss_j": float(f"{2 * less - lost:.5g}")}
    return dict(zip(names, numbers)) | {"over_trapped": over, "volume_m3": volume} | found


def row(speed, viscosity, alpha):
    """Incident time of flight in s and peak force of the wall in N."""
    coarse, fine = (np.array(shot(speed, viscosity, 0.24, alpha=alpha, step=step, nodes=1200)) for step in (1.25e-8, 6.25e-9))
    tof, _, wall, *_ = 2 * fine - coarse
    names = ("speed_m_s", "viscosity_pa_s", "pressure_viscosity_per_pa")
    return dict(zip(names, (speed, viscosity, alpha))) | {"tof_s": float(f"{tof:.8g}"), "wall_n": float(f"{wall:.8g}")}


def lines(results):
    """A list of JSON, one result a line."""
    return "[\n" + ",\n".join(json.dumps(result) for result in results) + "\n]"


if __name__ == "__main__":
    path = pathlib.Path(__file__).with_name("reference.json")
    if "law" in sys.argv:
        volumes = json.loads(path.read_text())["limited"]
    else:
        volumes = [limited(case, over) for case in LIMITED for over in VOLUMES]
    # JSON has no infinity.
    for case in volumes:
        case |= {name: None for name in ("over_trapped", "volume_m3") if case[name] == np.inf}
    contacts, rows = lines(reference(case) for case in CASES), lines(row(*case) for case in ROWS)
    path.write_text(f'{{"contacts": {contacts},\n"rows": {rows},\n"limited": {lines(volumes)}}}\n')
