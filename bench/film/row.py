"""The paper's row with oil on its contacts: times of flight by the reduced law, or with the whole contact of contact.py in every bead gap."""

import numpy as np
from numba import njit

from contact import Contact, Grid, graded_faces
from law import CONSTANTS, law_step
from pulse import CUBIC, MASS, MODULUS, REDUCED_RADIUS, RELAXATION, STIFFNESS

BEADS, SENSOR = 40, 7


@njit
def run_law(speed, static, first_wet, oily, viscosity, alpha, stiffer, constants, losses, step, count, nodes, largest, beads):
    """Forces of contacts 6, 7 and the last over time, the energy lost to oil, and the least force, by velocity Verlet.

    Without oil (`oily` false) wet contacts are dry ones, `stiffer` times as stiff.
    `losses` = (A of dry contacts, B of dry contacts, A of wet contacts, B of wet contacts); a wet contact starts at rest without film.
    """
    width = np.sqrt(REDUCED_RADIUS * largest) / nodes
    law = (REDUCED_RADIUS, MODULUS, viscosity, alpha, width, constants)
    x, v = np.zeros(beads + 2), np.zeros(beads + 2)
    v[0] = speed
    film, volume, state = np.zeros((beads + 1, nodes + 1)), np.zeros((beads + 1, nodes + 1)), np.zeros((beads + 1, 4))
    state[:, 2] = static
    state[:, 0] = np.sqrt(REDUCED_RADIUS * static)
    if not oily:
        static = static.copy()
        static[first_wet:] /= stiffer ** (2 / 3)
    force = STIFFNESS * static**1.5
    rest = force.copy()
    rest[first_wet:] *= 1.0 if oily else stiffer
    acceleration = np.zeros(beads + 2)
    seen = np.zeros((count, 3))
    least = 0.0
    for i in range(count):
        x += step * v + 0.5 * step**2 * acceleration
        half = v + 0.5 * step * acceleration
        for c in range(beads + 1):
            overlap, rate = static[c] + x[c] - x[c + 1], half[c] - half[c + 1]
            wet = c >= first_wet
            a, b = (losses[2], losses[3]) if wet else (losses[0], losses[1])
            damping = 1.5 * a * STIFFNESS * np.sqrt(overlap) * rate + b * rate**3 if overlap > 0 else 0.0
            if wet and oily:
                # A contact that the wave has not reached stays as it is.
                if overlap != state[c, 2] or state[c, 1] != 0.0:
                    force[c] = law_step(state[c], film[c], volume[c], law, step, overlap)
                least = min(least, force[c])
                total = force[c] + damping
            else:
                total = STIFFNESS * (stiffer if wet else 1.0) * max(overlap, 0.0) ** 1.5 + damping
            seen[i, 0] = total if c == SENSOR - 1 else seen[i, 0]
            seen[i, 1] = total if c == SENSOR else seen[i, 1]
            seen[i, 2] = total if c == beads else seen[i, 2]
            acceleration[c] = (acceleration[c] if c > 0 else 0.0) - (total - rest[c]) / MASS
            acceleration[c + 1] = (total - rest[c]) / MASS
        acceleration[beads + 1] = 0.0
        v = half + 0.5 * step * acceleration
        v[beads + 1] = 0.0
    return seen, state[:, 3].sum(), least


def run_contacts(speed, static, first_wet, viscosity, losses, step, count, largest, beads, law=None, rings=70, thickness=np.inf):
    """The same with a Contact in each wet gap."""
    edge = np.sqrt(REDUCED_RADIUS * largest)
    grid = Grid(graded_faces(1.2 * edge, rings, 4 * edge, 1.1), MODULUS)
    wet = {c: Contact(grid, REDUCED_RADIUS, viscosity, law).start(static[c], thickness=thickness) for c in range(first_wet, beads + 1)}
    rest = STIFFNESS * static**1.5
    begun = {c: contact.force() for c, contact in wet.items()}
    x, v, acceleration = np.zeros(beads + 2), np.zeros(beads + 2), np.zeros(beads + 2)
    v[0], seen, total = speed, np.zeros((count, 3)), rest.copy()
    for i in range(count):
        x += step * v + 0.5 * step**2 * acceleration
        half = v + 0.5 * step * acceleration
        overlap, rate = static + x[:-1] - x[1:], half[:-1] - half[1:]
        root = np.sqrt(np.maximum(overlap, 0.0))
        a, b = np.full(beads + 1, losses[0]), np.full(beads + 1, losses[1])
        a[first_wet:], b[first_wet:] = losses[2], losses[3]
        total = STIFFNESS * root**3
        for c, contact in wet.items():
            # Contacts that have moved by less than 1e-5 of the largest overlap are as at rest.
            if abs(overlap[c] - contact.overlap) > 1e-5 * largest or contact.p.max() == 0 and overlap[c] > 0:
                contact.step((i + 1) * step - getattr(contact, "time", i * step), overlap[c], tolerance=1e-7)
                contact.time = (i + 1) * step
            elif not hasattr(contact, "time"):
                total[c] = rest[c]
                continue
            total[c] = contact.force() - begun[c] + rest[c]
        total += np.where(overlap > 0, 1.5 * a * STIFFNESS * root * rate + b * rate**3, 0.0)
        seen[i] = total[[SENSOR - 1, SENSOR, beads]]
        dynamic = total - np.append(0.0, rest[1:])
        acceleration[:-1] = (np.append(0.0, dynamic[:-1]) - dynamic) / MASS
        v = half + 0.5 * step * acceleration
        v[-1] = 0.0
    return seen


def peak(times, signal):
    """Time and height of the largest maximum, by a parabola through three samples."""
    i = int(np.argmax(signal))
    before, here, after = signal[i - 1 : i + 2]
    part = 0.5 * (before - after) / (before - 2 * here + after)
    return times[i] + part * (times[1] - times[0]), here - 0.25 * (before - after) * part


def shot(speed, viscosity=None, preload=0.0, first_wet=SENSOR, losses=(RELAXATION, CUBIC, RELAXATION, 0.0), step=5e-8, contacts=False,
         alpha=0.0, stiffer=None, constants=CONSTANTS, nodes=300, beads=BEADS, **options):
    """Incident time of flight in s, peaks of bead 7 and of the wall in N, energy lost to oil over the striker's, least force in N."""
    static = np.append(0.0, np.full(beads, (preload / STIFFNESS) ** (2 / 3)))
    largest = 2.2 * (348.6 * speed**1.2 / STIFFNESS) ** (2 / 3) + static[1]
    duration = (1.35 if stiffer is None else 2.0) * 631e-6 * speed**-0.2 * (beads + 1) / (BEADS + 1) + 150e-6
    count = int(duration / step)
    if viscosity is None and stiffer is None:
        first_wet = beads + 1
    if contacts:
        seen, lost, least = run_contacts(speed, static, first_wet, viscosity, losses, step, count, largest, beads, **options), np.nan, np.nan
    else:
        seen, lost, least = run_law(speed, static, first_wet, viscosity is not None, viscosity or 1.0, alpha, stiffer or 1.0, constants, losses,
                                    step, count, nodes, 1.5 * largest, beads)
    times = step * np.arange(1, count + 1)
    wall, wall_peak = peak(times, seen[:, 2])
    bead, bead_peak = peak(times, np.where(times < wall, 0.5 * (seen[:, 0] + seen[:, 1]), 0.0))
    return wall - bead, bead_peak, wall_peak, lost / (0.5 * MASS * speed**2), least
