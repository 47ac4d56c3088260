"""Overlap over time of one contact of a dry row of the paper's beads, from the row's own equations of motion."""

import numpy as np
from scipy.integrate import solve_ivp

MASS, RADIUS, YOUNG, POISSON = 8.54e-3, 6.35e-3, 213e9, 0.3
REDUCED_RADIUS = RADIUS / 2
MODULUS = YOUNG / (2 * (1 - POISSON**2))
STIFFNESS = 4 / 3 * MODULUS * np.sqrt(REDUCED_RADIUS)
RELAXATION, CUBIC = 3.3852895149e-7, 77.0


def row(speed, preload=0.24, beads=40, damped=False, until=None):
    """Solution of a row hit by an equal striker: overlap(contact, times), rate(contact, times), force(contact, times)."""
    static = np.concatenate([[0.0], np.full(beads, (preload / STIFFNESS) ** (2 / 3))])

    def contacts(x, v):
        after = np.append(x[1:], 0.0), np.append(v[1:], 0.0)
        overlap = np.maximum(static + x - after[0], 0.0)
        return overlap, v - after[1]

    def forces(overlap, rate):
        force = STIFFNESS * overlap**1.5
        if damped:
            force = force + (overlap > 0) * (1.5 * RELAXATION * STIFFNESS * np.sqrt(overlap) * rate + CUBIC * rate**3)
        return force

    def motion(_, y):
        x, v = y[: beads + 1], y[beads + 1 :]
        force = forces(*contacts(x, v))
        before = np.concatenate([[0.0, force[0] + preload], force[1:-1]])
        return np.concatenate([v, (before - force) / MASS])

    start = np.zeros(2 * (beads + 1))
    start[beads + 1] = speed
    duration = until or 2.2e-3 * (0.5 / speed) ** 0.2 * 0.5
    run = solve_ivp(motion, (0, duration), start, method="DOP853", rtol=1e-9, atol=1e-14, max_step=2e-6, dense_output=True)

    def look(contact, times):
        y = run.sol(times)
        x, v = y[: beads + 1], y[beads + 1 :]
        x, v = np.vstack([x, np.zeros(len(times))]), np.vstack([v, np.zeros(len(times))])
        overlap = np.maximum(static[contact] + x[contact] - x[contact + 1], 0.0)
        rate = v[contact] - v[contact + 1]
        return overlap, rate, forces(overlap, rate)

    return look, duration


def pulse(largest, preload=0.24, contact=20, damped=False, samples=20001):
    """(times, overlaps) of the incident pulse at one contact, the striker's speed chosen for a largest overlap."""
    speed = (STIFFNESS * largest**1.5 / 348.6) ** (5 / 6)
    for _ in range(6):
        look, duration = row(speed, preload, damped=damped, until=None)
        times = np.linspace(0, duration, samples)
        overlap = look(contact, times)[0]
        peak = np.argmax(overlap)
        if abs(overlap[peak] / largest - 1) < 1e-4:
            break
        speed *= (largest / overlap[peak]) ** 1.25
    return times, overlap, look(contact, times)[2], speed
