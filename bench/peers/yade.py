"""YADE: the paper's row with Hertz contacts alone, which is the one of its laws that YADE has.

Run by YADE (Debian: apt-get install yade): yade -n -x -j1 bench/peers/yade.py
Prints, for steps that shrink by the square root of 2, the error of both times of flight at 0.5 m/s and the processor
time of a shot, until both errors are below 1e-5; then the rate there. Reference values: bench/reference, by scaling
with speed ** -0.2.
"""

import math
import time

from yade import *  # noqa: F403  (YADE puts its names there)

BEADS, SENSOR, SPEED = 40, 7, 0.5
RADIUS, MASS, YOUNG, POISSON = 6.35e-3, 8.54e-3, 213e9, 0.3
EXACT_S = [value * 1e-6 * SPEED**-0.2 for value in (630.841591, 632.265715)]
SAMPLE_S = 0.45e-6
# Well after the reflected pulse at this speed.
LONGEST_S = 2.0e-3


def force(i):
    """Normal force of contact i, between bodies i and i + 1, in N."""
    contact = O.interactions[i, i + 1] if O.interactions.has(i, i + 1) else None
    return abs(contact.phys.normalForce[0]) if contact and contact.isReal else 0.0


def sample():
    samples.append((O.time, 0.5 * (force(SENSOR - 1) + force(SENSOR)), force(BEADS)))


def row(step_s):
    O.reset()
    density = MASS / (4 / 3 * math.pi * RADIUS**3)
    O.materials.append(FrictMat(young=YOUNG, poisson=POISSON, frictionAngle=0, density=density))
    for i in range(BEADS + 2):
        O.bodies.append(sphere((2 * RADIUS * i, 0, 0), RADIUS, fixed=i == BEADS + 1))
    O.bodies[0].state.vel = (SPEED, 0, 0)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1 * RADIUS),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_MindlinPhys()],
            [Law2_ScGeom_MindlinPhys_Mindlin()],
        ),
        NewtonIntegrator(damping=0, gravity=(0, 0, 0)),
        PyRunner(iterPeriod=max(1, round(SAMPLE_S / step_s)), command="sample()"),
    ]
    O.dt = step_s


def peak(times, values):
    """Time of the maximum, by the parabola through the three largest neighbours."""
    k = max(range(1, len(values) - 1), key=values.__getitem__)
    a, b, c = values[k - 1 : k + 2]
    return times[k] + 0.5 * (a - c) / (a - 2 * b + c) * (times[k + 1] - times[k])


def flights():
    times, sensor, wall = zip(*samples)
    at_wall = peak(times, wall)
    first = [value if t < at_wall else 0.0 for t, value in zip(times, sensor)]
    back = [value if t > at_wall else 0.0 for t, value in zip(times, sensor)]
    return at_wall - peak(times, first), peak(times, back) - at_wall


def shot(step_s):
    """Times of flight of a shot, and its processor time in s, set-up not counted."""
    samples.clear()
    row(step_s)
    begin = time.process_time()
    O.run(math.ceil(LONGEST_S / step_s), True)
    return flights(), time.process_time() - begin


samples = []
step_s, errors = 1e-6, [1.0]
while max(errors) > 1e-5:
    found, took_s = shot(step_s)
    errors = [abs(value / exact - 1) for value, exact in zip(found, EXACT_S)]
    print(f"step {1e6 * step_s:.4f} us: errors {errors[0]:.1e}, {errors[1]:.1e}; {took_s:.2f} s", flush=True)
    step_s /= math.sqrt(2)
rates = sorted(1 / shot(step_s * math.sqrt(2))[1] for _ in range(7))
print(f"shots/s at the last step: median {rates[3]:.1f} of seven, {rates[0]:.1f} to {rates[-1]:.1f}")
