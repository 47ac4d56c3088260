"""Shapes of computed pulses: a prior for the default pick, and what picks are worth by theory.

usage: shapes.py FOLDER [OTHERS]      (needs NumPy)

Both folders hold rows that `hertzchain-picking` has written with `--write`. Fits the logarithm of
each pulse of FOLDER by a polynomial of degree 10, as the default pick does, and prints a prior of
correlated coefficients (docs/notes/2026-11-26-picking.md): mean, directions of the largest deviations,
and the deviations along the directions beyond. With OTHERS, prints the median error of its times of flight, each sensor in a
channel of its own at 1 MS/s, by bias and noise to first order: of the default pick, of a quartic
over 54 µs, and of a shot whose shape 20 shots have in common; asymmetric pulses aside.
"""

import math
import pathlib
import sys

import numpy as np

STEP_US = 0.1
TERMS = 11
SHARE = 1.1
DIRECTIONS = 4
ALONE = (0.04, 0.04, 0.05)
# The first two directions of incident and wall's pulses cover their range evenly: shift of the mean along
# the first, and factors of both deviations, by the percentiles that are printed.
EVENLY = ((0.8, 1.4, 1.3), (-0.6, 1.7, 1.0))
INEXACT = 1.4e-4
WHERE = ("incident", "wall", "reflected")


def pulses(path):
    """Signal, place in samples, rise and fall in samples and height of the three pulses."""
    values = np.fromfile(path, "<f4").astype(float)
    sensor, wall = np.split(values[4:], 2)
    for signal, at_s in zip((sensor, wall, sensor), values[1:4], strict=True):
        at = at_s / STEP_US * 1e6
        near = round(at)
        height = signal[near - 5 : near + 6].max()
        rise = at - (near - np.argmax(signal[near::-1] < height / 2))
        fall = near + np.argmax(signal[near:] < height / 2) - at
        yield signal / height, at, rise, fall, height


def asymmetry(pulse):
    return min(max((pulse[3] / pulse[2] - 1.2) / 0.8, 0), 1)


def steep(pulse):
    return 2 * min(pulse[2:4])


def samples(pulse, half, step):
    signal, at = pulse[:2]
    places = at + np.arange(-int(half / step), int(half / step) + 1) * step
    return (places - at) / half, np.interp(places, np.arange(len(signal)), signal)


def bell(pulse, half, noise, mean, covariance, step=10):
    """Coefficients of the likeliest bell, its slopes by them, and the prior's root."""
    u, y = samples(pulse, half, step)
    powers = np.vander(u, TERMS, increasing=True)
    root = np.zeros((8, TERMS))
    root[:, 3:] = noise * np.linalg.inv(np.linalg.cholesky(covariance))
    centre = np.r_[0, 0, 0, mean]
    c = np.zeros(TERMS)
    c[2] = -4 * math.log(2) * (half / steep(pulse)) ** 2
    damping, squares = 1e-3, math.inf
    while damping < 1e8:
        model = np.exp(np.clip(powers @ c, -50, 50))
        slopes, miss, off = powers * model[:, None], y - model, -root @ (c - centre)
        matrix = slopes.T @ slopes + root.T @ root
        right = slopes.T @ miss + root.T @ off
        squares = miss @ miss + off @ off
        while damping < 1e8:
            step_by = np.linalg.solve(
                matrix + damping * np.diag(np.diag(matrix)), right
            )
            tried = y - np.exp(np.clip(powers @ (c + step_by), -50, 50))
            prior = root @ (c + step_by - centre)
            if tried @ tried + prior @ prior <= squares:
                break
            damping *= 10
        c, damping = c + step_by, 0.1 * damping
        if np.abs(step_by).max() < 1e-8:
            break
    return c, slopes, root


def maximum(c):
    """Where the polynomial is largest near 0, and its rows of slope and curvature there."""
    k, u = np.arange(len(c)), 0.0
    for _ in range(30):
        slope = np.r_[0, k[1:] * u ** k[:-1]]
        curvature = c[2:] @ (k[2:] * k[1:-1] * u ** k[:-2])
        u -= (c @ slope) / curvature
    return u, slope, curvature


def by_bell(pulse, noise, shapes):
    """Bias and deviation in µs by noise of the default pick."""
    noise, half = noise / pulse[4], 0.5 * SHARE * steep(pulse)
    mean, covariance = shapes
    covariance = covariance + asymmetry(pulse) ** 2 * np.eye(8)
    c, slopes, root = bell(pulse, half, math.hypot(noise, INEXACT), mean, covariance)
    u, slope, curvature = maximum(c)
    along = np.linalg.solve(slopes.T @ slopes + root.T @ root, slope)
    unit = half * STEP_US
    return unit * u, -unit * noise * np.linalg.norm(slopes @ along) / curvature


def by_quartic(pulse, noise):
    signal, at, *_ = pulse
    for _ in range(8):
        u, y = samples((signal, at), 270, 10)
        powers = np.vander(u, 5, increasing=True)
        top, slope, curvature = maximum(np.linalg.lstsq(powers, y, rcond=None)[0])
        at += 270 * top
    spread = math.sqrt(slope @ np.linalg.solve(powers.T @ powers, slope))
    return (at - pulse[1]) * STEP_US, -noise / pulse[
        4
    ] * spread / curvature * 270 * STEP_US


def by_known_shape(pulse, noise):
    """The bound of Cramér and Rao in µs where all but time and height is known."""
    half = SHARE * steep(pulse)
    u, y = samples(pulse, half, 10)
    slopes = np.stack([np.gradient(y, u), y], axis=1)
    return (
        noise
        / pulse[4]
        * math.sqrt(np.linalg.inv(slopes.T @ slopes)[0, 0])
        * half
        * STEP_US
    )


def by_shots(pulse, noise, shapes, shots=20):
    """As by_bell, of a shot whose shape so many have in common."""
    bias, spread = by_bell(pulse, noise / math.sqrt(shots), shapes)
    return bias, math.hypot(spread, by_known_shape(pulse, noise))


def prior(rows):
    """Mean and covariance of each place's coefficients, printed as the library has them."""
    found = []
    for place, name in enumerate(WHERE):
        fits = []
        for row in rows:
            if asymmetry(row[place]) < (0.3 if place == 0 else 0.05):
                half = 0.5 * SHARE * steep(row[place])
                fits.append(
                    bell(
                        row[place],
                        half,
                        1e-4,
                        np.zeros(8),
                        np.eye(8),
                        max(1, half / 100),
                    )[0][3:]
                )
        fits = np.array([c for c in fits if np.abs(c).max() < 1.2])
        value, vector = np.linalg.eigh(np.cov(fits.T))
        deviations = np.sqrt(np.maximum(value[::-1], 0))
        along = (vector[:, ::-1] * np.sign(vector[0, ::-1]) * deviations).T
        mean = fits.mean(0)
        print(
            f"{name}: {len(fits)} pulses\n  deviations {deviations.round(3).tolist()}"
        )
        for direction in range(2):
            score = (fits - mean) @ along[direction] / deviations[direction] ** 2
            print(
                f"  percentiles 2, 98: {np.percentile(score, [2, 98]).round(1).tolist()}"
            )
        if place < 2:
            shift, *factors = EVENLY[place]
            mean = mean + shift * along[0]
            along[:2] *= np.array(factors)[:, None]
        print(f"  mean {mean.round(2).tolist()}")
        for direction in along[:DIRECTIONS]:
            print(f"  together {direction.round(2).tolist()}")
        together = along[:DIRECTIONS]
        found.append((mean, together.T @ together + ALONE[place] ** 2 * np.eye(8)))
    return found


def errors(row, shapes, time, noise):
    """Errors in ns of one time of flight: default, quartic, with a shape of 20 shots."""
    both = [(row[place], shapes[place]) for place in (time, time + 1)]
    picks = [
        [by_bell(pulse, noise, of) for pulse, of in both],
        [by_quartic(pulse, noise) for pulse, _ in both],
        [by_shots(pulse, noise, of) for pulse, of in both],
    ]
    return [1e3 * math.hypot(b[0] - a[0], a[1], b[1]) for a, b in picks]


def compare(rows, shapes):
    print(
        "\n| dB | time | default, ns | quartic | 20 shots | default within 1.1 of quartic, most |"
    )
    print("|---|---|---|---|---|---|")
    rows = [row for row in rows if max(asymmetry(pulse) for pulse in row) < 0.3]
    for noise_db in (20, 30, 40, 50, 60):
        for time, name in enumerate(("incident", "reflected")):
            noise = 10 ** (-noise_db / 20)
            all_errors = np.array([errors(row, shapes, time, noise) for row in rows])
            ratio = all_errors[:, 0] / all_errors[:, :2].min(axis=1)
            medians = " | ".join(f"{of:.0f}" for of in np.median(all_errors, axis=0))
            within = f"{np.sum(ratio <= 1.1)} of {len(ratio)}, {ratio.max():.1f}"
            print(f"| {noise_db} | {name} | {medians} | {within} |")


def main(folders):
    rows = [
        [tuple(pulses(path)) for path in sorted(pathlib.Path(folder).glob("*.f32"))]
        for folder in folders
    ]
    shapes = prior([list(row) for row in rows[0]])
    if len(rows) > 1:
        compare(rows[1], shapes)


if __name__ == "__main__":
    main(sys.argv[1:3])
