"""Shapes of computed pulses as a prior of the default pick: what correlated ones are worth.

usage: shapes.py [SHOTS]      (needs the package hertzchain, NumPy)

Computes pulses of presets and of chains of other lengths, sizes and losses, fits the logarithm of
each by a polynomial of degree 10 as the default pick does, and prints the mean coefficients c3 to
c10 and their correlated deviations. Then it times pulses in noise, each sensor in a channel of its
own, of chains that were not fitted: by the present prior (independent coefficients), by a mixture
of correlated normal distributions, and by a quartic over 54 µs. Root mean squares in ns are medians
over chains; ratios to the best of the present prior and the quartic are taken chain by chain. The
last table is of fast dry shots, whose stated errors are too small.
"""

import math
import pathlib
import re
import sys
import tempfile
import warnings

import hertzchain as hc
import numpy as np

STEP_S = 2.5e-7
TERMS = 11
SHARE = 1.1
# Deviation of each coefficient by itself; kinds of incident pulses, and how far beyond the fastest
# shot the last one is: up to 2.5 m/s their rise begins with a kink.
ALONE = 0.06
KINDS = 6
BEYOND = 1.25
WHERE = ("incident", "wall", "reflected")
OLD = [
    ([0.11, -0.22, -0.21, 0.22, 0.19, -0.17, -0.06, 0.05], 0.25),
    ([0.07, -0.02, 0.01, 0, 0, 0, 0, 0], 0.17),
    ([-0.03, -0.26, 0.01, 0.07, 0, 0.04, 0, -0.03], 0.23),
]
KINK = np.array([0.26, 0, -0.43, 0, 0.35, 0, -0.1, 0])
HEADER = """
| dB | time | independent, ns | mixture | quartic | independent/best: median, most | within 1.1 \
| in 1.96, % | bias/error | mixture/best: median, most | within 1.1 | in 1.96, % | bias/error |
|---|---|---|---|---|---|---|---|---|---|---|---|---|"""
DRY = (pathlib.Path(__file__).parents[2] / "experiments/dry.toml").read_text()


def chain(beads, sensor, radius_mm, young_gpa, viscosity, cubic):
    """The dry row with other numbers."""
    text = re.sub(r"\[rig\].*", "", DRY, flags=re.DOTALL)
    mass = 7.8e-3 * 4 / 3 * math.pi * radius_mm**3
    for old, new in [
        ("count = 40", f"count = {beads}"),
        ("bead = 7", f"bead = {sensor}"),
        ("6.35 mm", f"{radius_mm} mm"),
        ("8.54 g", f"{mass} g"),
        ("213 GPa", f"{young_gpa} GPa"),
        ("3.2e4", f"{viscosity}"),
        ("77 kg", f"{cubic} kg"),
    ]:
        text = text.replace(old, new)
    with tempfile.NamedTemporaryFile("w", suffix=".toml", delete=False) as file:
        file.write(text)
    return hc.load(file.name), sensor, beads


def chains(count, seed):
    """Chains at random, each with a speed in m/s."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        beads = int(rng.integers(14, 70))
        radius_mm = round(rng.uniform(3, 12), 3)
        losses = 10 ** rng.uniform(-0.6, 0.4, 2)
        yield (
            chain(
                beads,
                int(rng.integers(3, max(4, beads // 2))),
                radius_mm,
                rng.choice([110, 213]),
                3.2e4 * losses[0],
                77 * losses[1] * radius_mm / 6.35,
            ),
            10 ** rng.uniform(math.log10(0.06), math.log10(2.5)),
        )


def pulses(of, speed):
    """Signal, place in samples, rise and fall in µs and height of each pulse, if all are there."""
    experiment, bead, wall = of
    shot = hc.shot(
        experiment,
        speed,
        trace=[f"bead_{bead}", ("contact", wall)],
        interval_s=STEP_S,
        accuracy=1e-7,
    )
    sensor, last = (np.array(signal) for signal in shot.trace.signals.values())
    at_wall = int(np.argmax(last))
    there = at_wall - round(shot.tof_incident_s / STEP_S)
    back = at_wall + round((shot.tof_reflected_s or math.nan) / STEP_S)
    found = []
    for signal, at in [(sensor, there), (last, at_wall), (sensor, back)]:
        if not 4 < at < len(signal) - 4:
            return None
        at += int(np.argmax(signal[at - 3 : at + 4])) - 3
        a, height, c = signal[at - 1 : at + 2]
        left = at - np.argmax(signal[at::-1] < height / 2)
        right = at + np.argmax(signal[at:] < height / 2)
        top = at + 0.5 * (a - c) / (a - 2 * height + c)
        found.append(
            (signal, top, (top - left) * STEP_S * 1e6, (right - top) * STEP_S * 1e6, height)
        )
    return found


def asymmetry(rise, fall):
    return min(max((fall / rise - 1.2) / 0.8, 0), 1)


def bell(u, y, noise, mean, root, start):
    """Coefficients of the likeliest bell, the inverse of its normal matrix, and its squares."""
    powers = np.vander(u, TERMS, increasing=True)
    prior = np.zeros((8, TERMS))
    prior[:, 3:] = root * noise

    def evaluated(c):
        model = np.exp(np.clip(powers @ c, -50, 50))
        miss, off = y - model, -prior @ (c - np.r_[0, 0, 0, mean])
        return miss, off, powers * model[:, None], miss @ miss + off @ off

    c, damping = start, 1e-3
    miss, off, slopes, squares = evaluated(c)
    while damping < 1e8:
        matrix = slopes.T @ slopes + prior.T @ prior
        step = np.linalg.solve(
            matrix + damping * np.diag(np.diag(matrix)), slopes.T @ miss + prior.T @ off
        )
        tried = evaluated(c + step)
        if tried[3] > squares:
            damping *= 10
            continue
        c, damping = c + step, 0.1 * damping
        miss, off, slopes, squares = tried
        if np.abs(step).max() < 1e-7:
            break
    return c, np.linalg.inv(slopes.T @ slopes + prior.T @ prior), squares


def maximum(c):
    """Where the polynomial is largest near 0, and its rows of slope and curvature there."""
    k = np.arange(TERMS)
    u, step = 0.0, 1.0
    while abs(step) > 1e-9:
        powers = u**k
        slope = np.r_[0, k[1:] * powers[:-1]]
        curvature = c[2:] @ (k[2:] * k[1:-1] * powers[:-2])
        if curvature >= 0 or abs(u) > 1:
            return None
        step = min(max(-(c @ slope) / curvature, -0.3), 0.3)
        u += step
    return u, slope, curvature


def window(samples, centre, half):
    at = np.arange(
        max(0, math.ceil(centre - half)), min(len(samples), math.floor(centre + half) + 1)
    )
    return (at - centre) / half, samples[at]


def picked(samples, at, height, steep, noise, kinds):
    """Time and standard deviation in samples, by kinds of shapes (mean, root, log probability)."""
    half = max(0.5 * SHARE * steep, 4)
    for _ in range(4):
        u, y = window(samples, at, half)
        start = np.zeros(TERMS)
        start[0], start[2] = math.log(height), -4 * math.log(2) * (half / steep) ** 2
        found = []
        for mean, root, likely in kinds:
            c, inverse, squares = bell(u, y, noise, mean, root, start)
            if top := maximum(c):
                error = noise * math.sqrt(top[1] @ inverse @ top[1]) / -top[2] * half
                evidence = likely - 0.5 * squares / noise**2 + 0.5 * np.linalg.slogdet(inverse)[1]
                found.append((at + half * top[0], error, evidence))
        if not found:
            return math.nan, math.nan
        times, errors, evidence = np.array(found).T
        weights = np.exp(evidence - evidence.max())
        weights /= weights.sum()
        time = weights @ times
        if abs(round(time) - at) <= 0.1 * half:
            return time, math.sqrt(weights @ (errors**2 + (times - time) ** 2))
        at = round(time)
    return math.nan, math.nan


def quartic(samples, at, half=27):
    for _ in range(6):
        u, y = window(samples, at, half)
        c = np.zeros(TERMS)
        c[:5] = np.linalg.lstsq(np.vander(u, 5, increasing=True), y, rcond=None)[0]
        top = maximum(c)
        if top is None:
            return math.nan
        time = at + half * top[0]
        if round(time) == at:
            return time
        at = round(time)
    return time


def root(covariance):
    return np.linalg.inv(np.linalg.cholesky(covariance))


def shapes(fitted):
    """Kinds of shapes of each place: means along the first direction of incident pulses."""
    all_kinds = []
    for place in range(3):
        rows = []
        for three in fitted:
            signal, at, rise, fall, height = three[place]
            steep = 2 * min(rise, fall) / (STEP_S * 1e6)
            u, y = window(signal / height, at, 0.5 * SHARE * steep)
            start = np.zeros(TERMS)
            start[2] = -4 * math.log(2) * (0.5 * SHARE) ** 2
            c = bell(u, y, 1e-4, np.zeros(8), np.eye(8) / 3, start)[0][3:]
            if asymmetry(rise, fall) < 0.05 and np.abs(c).max() < 1.2:
                rows.append(c)
        rows = np.array(rows)
        mean = rows.mean(0)
        value, vector = np.linalg.eigh(np.cov(rows.T))
        means, together = [mean], [1.3 * math.sqrt(value[-i]) * vector[:, -i] for i in (1, 2, 3)]
        if place == 0:
            along = vector[:, -1] * np.sign(vector[0, -1])
            low, high = np.percentile((rows - mean) @ along, [5, 100])
            line = BEYOND * (high - low) * along
            share = np.clip((rows - mean) @ along - low, 0, None) / (BEYOND * (high - low))
            rest = rows - mean - low * along - share[:, None] * line
            value, vector = np.linalg.eigh(np.cov(rest.T))
            means = [
                mean + low * along + rest.mean(0) + line * i / (KINDS - 1) for i in range(KINDS)
            ]
            together = [1.3 * math.sqrt(value[-i]) * vector[:, -i] for i in (1, 2)] + [
                line / (KINDS - 1) / 12**0.5
            ]
        print(WHERE[place], *(f"\n  mean {one.round(2).tolist()}" for one in means), end="")
        print(*(f"\n  together {one.round(2).tolist()}" for one in together))
        covariance = sum(np.outer(one, one) for one in together) + ALONE**2 * np.eye(8)
        likely = [0.4] + [0.6 / (len(means) - 1 or 1)] * (len(means) - 1)
        all_kinds.append(
            [(one, covariance, math.log(p)) for one, p in zip(means, likely, strict=True)]
        )
    return all_kinds


def kinds_of(place, asymmetric, correlated):
    """Kinds by the present prior, or by the correlated ones, widened for an asymmetric pulse."""
    if correlated:
        return [(m, root(c + asymmetric**2 * np.eye(8)), p) for m, c, p in correlated[place]]
    mean, deviation = OLD[place]
    covariance = (deviation + (1 - deviation) * asymmetric) ** 2 * np.eye(8)
    covariance += np.outer(KINK, KINK) if place == 0 else 0
    return [(np.array(mean), root(covariance), 0.0)]


def errors(three, noise, kinds, rng):
    """Errors in samples of both times of flight, and stated ones, by each pick."""
    found = np.empty((3, 3, 2))
    phase, unit = rng.integers(4), three[0][4]
    for place, (signal, at, rise, fall, height) in enumerate(three):
        first = max(0, int(at / 4) - 150)
        samples = signal[phase::4][first : first + 300] / unit
        samples = samples + noise * rng.standard_normal(len(samples))
        true, steep, height = (at - phase) / 4 - first, 2 * min(rise, fall), height / unit
        smooth = np.ones(max(3, int(steep / 4) | 1))
        near = np.convolve(np.convolve(samples, smooth, "same"), smooth, "same")
        begun = max(0, int(true - steep))
        begun += int(np.argmax(near[begun : int(true + steep)]))
        modelled = math.hypot(noise, 1.6e-4 * height)
        for which, correlated in enumerate([None, kinds]):
            of = kinds_of(place, asymmetry(rise, fall), correlated)
            found[which, place] = picked(samples, begun, height, steep, modelled, of)
            found[which, place, 0] -= true
        found[2, place] = quartic(samples, begun) - true, math.nan
    time, stated = found[..., 0], found[..., 1]
    return np.diff(time, axis=1), np.hypot(stated[:, 1:], stated[:, :-1])


def fast(kinds, shots):
    """Prints bias, spread and coverage of incident times of fast dry shots."""
    print("\n| dry, m/s | dB | independent, ns | in 1.96, % | mixture, ns | in 1.96, % |")
    print("|---|---|---|---|---|---|")
    for speed in (1.2, 2.0, 2.5):
        three = pulses((hc.preset("dry"), 7, 40), speed)
        for noise_db in (40, 60, 80):
            rng = np.random.default_rng(noise_db)
            each = [errors(three, 10 ** (-noise_db / 20), kinds, rng) for _ in range(shots)]
            made, stated = (np.array(of)[:, :2, 0] for of in zip(*each, strict=True))
            within = 100 * np.mean(np.abs(made / stated) < 1.96, axis=0)
            mean, spread = 1e3 * made.mean(0), 1e3 * made.std(0)
            cells = (f"{mean[i]:+.0f} ± {spread[i]:.0f} | {within[i]:.0f}" for i in (0, 1))
            print(f"| {speed} | {noise_db} | {' | '.join(cells)} |")


def main(shots):
    warnings.simplefilter("ignore")
    speeds = [0.08, 0.14, 0.25, 0.5, 0.8, 1.2, 1.7, 2.3]
    presets = ["dry", "pump", "gear", "motor", "hertz", "hertz-viscoelastic"]
    fitted = [pulses((hc.preset(name), 7, 40), v) for name in presets for v in speeds]
    fitted += [pulses(*one) for one in chains(60, 11)]
    others = [three for three in (pulses(*one) for one in chains(30, 12)) if three]
    kinds = shapes([three for three in fitted if three])
    print(HEADER)
    for noise_db in (20, 30, 40, 50, 60):
        rng = np.random.default_rng(noise_db)
        noise = 10 ** (-noise_db / 20)
        of_chains = [[errors(three, noise, kinds, rng) for _ in range(shots)] for three in others]
        made = np.array([[shot[0] for shot in chain] for chain in of_chains])
        stated = np.array([[shot[1] for shot in chain] for chain in of_chains])
        for time, name in enumerate(["incident", "reflected"]):
            errors_ns = 1e3 * made[..., time]
            spread = np.sqrt(np.nanmean(errors_ns**2, axis=1))
            bias = np.abs(np.nanmean(errors_ns, axis=1)) / spread
            best = np.fmin(spread[:, 0], spread[:, 2])
            pulls = np.abs(made[..., time] / stated[..., time])
            cells = [f"{value:.0f}" for value in np.nanmedian(spread, axis=0)]
            for which in (0, 1):
                ratio = spread[:, which] / best
                cells.append(f"{np.median(ratio):.2f}, {ratio.max():.2f}")
                cells.append(f"{np.sum(ratio <= 1.1)} of {len(ratio)}")
                own = pulls[..., which][np.isfinite(pulls[..., which])]
                cells.append(f"{100 * np.mean(own < 1.96):.1f}")
                cells.append(f"{np.median(bias[:, which]):.2f}")
            print(f"| {noise_db} | {name} | {' | '.join(cells)} |")
    fast(kinds, 5 * shots)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
