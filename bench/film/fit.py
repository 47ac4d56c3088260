"""Fits the pure numbers of law.py to contact.py: rows with a whole contact in each oily gap, and pulses through one contact.

    python fit.py whole       computes the rows of whole contacts that whole.json lacks: half an hour of two cores for all
    python fit.py             the law beside them
    python fit.py fit         fits and prints the numbers: ten minutes of two cores
"""

import itertools
import json
import multiprocessing
import pathlib
import sys

import numpy as np
from scipy.optimize import least_squares

from contact import Barus
from law import CONSTANTS, FilmLaw
from oils import OILS, SPEEDS, USUAL_ALPHA, viscosity
from pulse import MODULUS, REDUCED_RADIUS
from row import shot
from table import through

WHOLE = pathlib.Path(__file__).with_name("whole.json")
NAMES = ("beads", "speed_m_s", "viscosity_pa_s", "pressure_viscosity_per_pa", "push_n")
# The paper's row and oils at 25 °C.
ROWS = [(40, speed, float(viscosity(oil, 25)), USUAL_ALPHA[oil], 0.24) for oil in OILS for speed in SPEEDS]
# Other oils, and warm pump oil.
ROWS += [(40, 0.075, 0.0478, 16e-9, 0.24), (40, 1.2, 0.0478, 16e-9, 0.24), (40, 0.15, 0.058, 15e-9, 0.24)]
ROWS += [(40, 0.075, 0.048, 0.0, 0.24), (40, 0.15, 0.119, 0.0, 0.24), (40, 0.5, 0.119, 0.0, 0.24)]
# Short rows, beyond the paper's oils and pushes: half the weight.
ROWS += [(18, 0.15, 0.4, 20e-9, 0.24), (18, 0.3, 0.03, 8e-9, 0.24), (18, 0.6, 0.05, 0.0, 0.24), (18, 0.04, 0.2, 12e-9, 0.24)]
ROWS += [(18, 0.15, 0.2, 0.0, 0.24), (18, 0.075, 0.3, 0.0, 0.24), (18, 1.2, 0.3, 0.0, 0.24), (18, 0.15, 0.0478, 16e-9, 0.02), (18, 0.15, 0.0478, 16e-9, 1.0)]
# Largest overlap in m, viscosity in Pa s, α in 1/Pa of pulses of a dry row under 0.24 N.
PULSES = list(itertools.product((1.5e-6, 4e-6, 12e-6), (0.03, 0.1, 0.3), (0.0, 8e-9, 16e-9, 22e-9)))
# What counts as one: of times and the wall's peaks; of forces over their peak, at every 15th step, and of losses.
SCALES = (1e-3, 0.025), (0.12, 0.08)
# What is farthest off counts most: rows of 40 balls, and losses up to 16 1/GPa, also by the third power of errors over these.
FARTHEST = (1.25e-3, 0.031), 0.14


def whole(beads, speed, thickness, alpha, push):
    """Incident time in s and the wall's peak in N, extrapolated from a step and half of it: of first order in time."""
    step = 6e-7 * (speed / 0.075) ** -0.25
    run = lambda step: np.array(shot(speed, thickness, push, step=step, contacts=True, law=Barus(alpha) if alpha else None, rings=60, beads=beads)[:3])
    coarse, fine = run(step), run(step / 2)
    return 2 * fine - coarse


def write_whole():
    """Rows of whole contacts; those that are there already are kept."""
    known = {tuple(row[name] for name in NAMES): row for row in (json.loads(WHOLE.read_text()) if WHOLE.exists() else [])}
    for row in ROWS:
        if row not in known:
            tof, _, wall = whole(*row)
            known[row] = dict(zip(NAMES, row)) | {"tof_s": float(f"{tof:.7g}"), "wall_n": float(f"{wall:.6g}")}
            print(known[row], flush=True)
            WHOLE.write_text("[\n" + ",\n".join(json.dumps(known[row]) for row in ROWS if row in known) + "\n]\n")


def row_errors(row, constants, step=2e-7, nodes=200):
    """The law's incident time and wall's peak over the whole contacts', less one."""
    beads, speed, thickness, alpha, push = (row[name] for name in NAMES)
    step *= (speed / 0.075) ** -0.2
    tof, _, wall, *_ = shot(speed, thickness, push, step=step, alpha=alpha, beads=beads, constants=tuple(constants), nodes=nodes)
    return tof / row["tof_s"] - 1, wall / row["wall_n"] - 1


def pulse(largest, thickness, alpha):
    """Viscosity, α, times, overlaps and forces of a pulse by contact.py."""
    rows = through(largest, thickness, rings=90, steps=300, preload=0.24, law=Barus(alpha) if alpha else None)[1]
    return thickness, alpha, *rows.T[:3]


def pulse_errors(curve, constants):
    """Errors of forces over their peak and the relative error of the loss."""
    thickness, alpha, times, overlaps, forces = curve
    law = FilmLaw(REDUCED_RADIUS, MODULUS, thickness, 1.3 * overlaps.max(), alpha, tuple(constants), nodes=250).start(overlaps[0])
    found = np.array([law.force()] + [law.step(b - a, d) for a, b, d in zip(times, times[1:], overlaps[1:])])
    work = lambda force: np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(overlaps))
    return (found - forces) / forces.max(), work(found) / work(forces) - 1


class Comparison:
    """The law beside the rows and pulses of whole contacts."""

    def __init__(self, pool):
        self.pool, self.rows = pool, json.loads(WHOLE.read_text())
        self.curves = pool.starmap(pulse, PULSES)
        # The law's rows are of first order in time: what the step of the fit changes, at the first numbers.
        fine, finer = self.of_rows(CONSTANTS, 1e-7, 400), self.of_rows(CONSTANTS, 5e-8, 400)
        self.shift = 2 * finer - fine - self.of_rows(CONSTANTS)

    def of_rows(self, constants, *step):
        return np.array(self.pool.starmap(row_errors, [(row, constants, *step) for row in self.rows], chunksize=1))

    def errors(self, constants):
        return self.of_rows(constants) + self.shift, [pulse_errors(curve, constants) for curve in self.curves]

    def residuals(self, constants):
        rows, pulses = self.errors(constants)
        long = np.array([row["beads"] == 40 for row in self.rows])
        weights = np.where(long, 1.0, 0.5)[:, None]
        forces = [force[::15] / SCALES[1][0] for force, _ in pulses]
        losses = np.array([loss for _, loss in pulses])
        usual = np.array([alpha <= 16e-9 for *_, alpha in PULSES])
        farthest = [((rows[long] / FARTHEST[0]) ** 3).ravel(), (losses[usual] / FARTHEST[1]) ** 3]
        return np.concatenate([(weights * rows / SCALES[0]).ravel(), *forces, losses / SCALES[1][1], *farthest])

    def fit(self):
        """All numbers are positive but m: their logarithms are free."""
        signs = np.sign(CONSTANTS)
        found = least_squares(lambda logs: self.residuals(signs * np.exp(logs)), np.log(np.abs(CONSTANTS)), diff_step=0.01, verbose=2, max_nfev=12)
        return tuple(float(f"{number:.4g}") for number in signs * np.exp(found.x))

    def report(self, constants):
        rows, pulses = self.errors(constants)
        for row, (time, wall) in zip(self.rows, rows):
            case = (*(row[name] for name in NAMES[:3]), 1e9 * row[NAMES[3]], row[NAMES[4]], 100 * time, 100 * wall)
            print("%2d balls, %.3f m/s, %.4f Pa s, %4.1f 1/GPa, %.2f N: time %+.2f %%, wall's peak %+.1f %%" % case)
        for (largest, thickness, alpha), (force, loss) in zip(PULSES, pulses):
            case = (1e6 * largest, thickness, 1e9 * alpha, 100 * force[np.argmax(np.abs(force))], 100 * loss)
            print("%4.1f µm, %.2f Pa s, %2.0f 1/GPa: force %+.1f %% of the peak, loss %+.1f %%" % case)


def main():
    words = sys.argv[1:]
    if "whole" in words:
        return write_whole()
    with multiprocessing.Pool() as pool:
        comparison = Comparison(pool)
        constants = comparison.fit() if "fit" in words else CONSTANTS
        print("constants:", constants)
        comparison.report(constants)


if __name__ == "__main__":
    main()
