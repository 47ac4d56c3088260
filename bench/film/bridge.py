"""A liquid bridge between equal spheres by the Young-Laplace equation: force against gap, and rupture.

Lengths in radii of the spheres, forces over 2 pi gamma R. The meniscus goes from the neck, where its angle f to the
axis is 0, to its edge on the sphere at the filling angle b, where f = pi/2 - b - theta. Its mean curvature H/2 is
constant, so r cos f - H r^2/2 = C is too, and C is the force:

    r = 2 C/(cos f + w),   dz/df = r cos f/w,   w = sqrt(cos^2 f - 2 H C).

Writes bridge.json, which the Rust law `capillary_bridge` is held against.
"""

import json
import math
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

NODES, WEIGHTS = np.polynomial.legendre.leggauss(80)


def bridge(filling, curvature, angle):
    """Gap, volume and force of the bridge with this filling angle and curvature."""
    edge, wet = math.sin(filling), math.sin(filling + angle)
    force = edge * wet - 0.5 * curvature * edge**2
    last = math.pi / 2 - filling - angle
    f = 0.5 * last * (1 + NODES)
    root = np.sqrt(np.cos(f) ** 2 - 2 * curvature * force)
    r = 2 * force / (np.cos(f) + root)
    rise = 0.5 * last * WEIGHTS * r * np.cos(f) / root
    height, body = rise.sum(), (math.pi * r * r * rise).sum()
    cap = math.pi * (2 + math.cos(filling)) * (1 - math.cos(filling)) ** 2 / 3
    return 2 * (height - (1 - math.cos(filling))), 2 * (body - cap), force


def stable(volume, degrees):
    """Gap and force from touch to the largest gap of which there is a bridge."""
    angle, rows = math.radians(degrees), []
    for filling in np.geomspace(0.2, 2.5, 400) * volume**0.25:
        widest = math.sin(filling + angle) / math.sin(filling)

        def excess(power):
            return bridge(filling, widest - 10**power, angle)[1] - volume

        powers = np.linspace(-4, 7, 45)
        values = [excess(power) for power in powers]
        for low, high, one, other in zip(powers, powers[1:], values, values[1:]):
            if one * other < 0:
                gap, _, force = bridge(filling, widest - 10 ** brentq(excess, low, high, xtol=1e-13), angle)
                rows.append((gap, force))
    longest = max(rows)
    # Beyond the fold a gap has two bridges: the stable one pulls more.
    rows = sorted(row for row in rows if row[0] > 0 and row[1] >= longest[1])
    return rows


def willett(gap, volume, degrees):
    reduced = gap / math.sqrt(volume)
    return math.cos(math.radians(degrees)) / (1 + 1.05 * reduced + 2.5 * reduced**2)


def main():
    cases = []
    for volume in [1e-5, 1e-4, 1e-3]:
        for degrees in [0.0, 20.0, 40.0]:
            rows = stable(volume, degrees)
            apart = [(willett(gap, volume, degrees) - force) / willett(0.0, volume, degrees) for gap, force in rows]
            gaps, forces = np.array(rows).T
            closed = [willett(gap, volume, degrees) for gap in gaps]
            work = np.trapezoid(closed, gaps) / np.trapezoid(forces, gaps) - 1
            lian = (1 + math.radians(degrees) / 2) * volume ** (1 / 3)
            longest = max(rows)[0]
            print(f"V {volume:.0e} R^3, {degrees:.0f} degrees: closed form off by {min(apart):+.3f} to {max(apart):+.3f} "
                  f"of the pull at touch, work {work:+.3f}; rupture at {longest:.5f} R, Lian's form {lian / longest - 1:+.3f}")
            some = rows[:: max(1, len(rows) // 8)]
            cases.append({
                "volume": volume, "angle_deg": degrees, "rupture": longest,
                "gap": [round(gap, 9) for gap, _ in some], "force": [round(force, 7) for _, force in some],
            })
    text = json.dumps({"unit": "lengths in R, force in 2 pi gamma R", "cases": cases}, indent=1)
    Path(__file__).with_name("bridge.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
