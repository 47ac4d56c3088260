"""The film, the stiffening and the loss of one contact over the incident pulse of a dry row, for the oils of the trial table."""

import functools

import numpy as np

from contact import Contact, Grid, drive, graded_faces
from pulse import MODULUS, REDUCED_RADIUS, STIFFNESS, pulse

# What a first trial found: largest overlap in m and viscosity in Pa s; mean film in nm, force over Hertz, work of loading over Hertz
# and loss over the work of loading, in per cent. Its pulses had a full width at half maximum of 47 and 30 µs.
TRIAL = {
    (1.5e-6, 0.048): (40, 5.6, 16.7, 9.7),
    (1.5e-6, 0.119): (64, 10.1, 28, 15.4),
    (6.7e-6, 0.048): (70, 1.8, 6.0, 3.5),
    (6.7e-6, 0.119): (116, 3.2, 10.6, 6.3),
}
# Static load in N whose pulses have these widths (46.2 and 30.5 µs); the trial's own is not stated.
PRELOAD = 0.12


@functools.cache
def motion(largest, preload=PRELOAD):
    """(times, overlaps) of the pulse from rest to rest."""
    times, overlaps, _, _ = pulse(largest, preload)
    peak = np.argmax(overlaps)
    least = max(1.02 * overlaps[0], 1e-3 * largest)
    first = np.flatnonzero(overlaps > least)[0]
    after = np.flatnonzero(overlaps[peak:] <= least)
    last = peak + (after[0] if len(after) else len(overlaps) - 1 - peak)
    return times, overlaps, (first, peak, last)


def through(largest, viscosity, rings=120, steps=400, preload=PRELOAD, law=None, trapped=0.0, thickness=np.inf, outer=4.0):
    """A contact after the pulse, with `summary`: mean film at full load in m, and per cent of force, work and loss; and its rows."""
    times, overlaps, (first, peak, last) = motion(largest, preload)
    t = np.concatenate([np.linspace(times[first], times[peak], steps + 1), np.linspace(times[peak], times[last], steps // 2 + 1)[1:]])
    d = np.interp(t, times, overlaps)
    edge = np.sqrt(REDUCED_RADIUS * largest)
    grid = Grid(graded_faces(1.25 * edge, rings, outer * edge), MODULUS)
    contact = Contact(grid, REDUCED_RADIUS, viscosity, law).start(d[0], thickness=thickness, trapped=trapped)
    contact.started = contact.m.copy()
    rows = drive(contact, t, d)
    work = np.concatenate([[0], np.cumsum(0.5 * (rows[1:, 2] + rows[:-1, 2]) * np.diff(rows[:, 1]))])
    hertz = 0.4 * STIFFNESS * largest**2.5
    begun = 0.4 * STIFFNESS * d[0] ** 2.5
    contact.summary = {
        "film": rows[steps, 3],
        "force": 100 * (rows[steps, 2] / (STIFFNESS * largest**1.5) - 1),
        "work": 100 * ((work[steps] + begun) / hertz - 1),
        "loss": 100 * work[-1] / work[steps],
    }
    return contact, rows


def main():
    print("| δmax, µm | η, Pa s | film, nm | trial | force % | trial | work % | trial | loss % | trial |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for (largest, viscosity), trial in TRIAL.items():
        found = through(largest, viscosity)[0].summary
        values = [1e9 * found["film"], found["force"], found["work"], found["loss"]]
        cells = " | ".join(f"{value:.3g} | {known}" for value, known in zip(values, trial))
        print(f"| {largest * 1e6:.1f} | {viscosity} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
