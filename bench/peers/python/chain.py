"""The shots, in units of mass, striker speed and dry stiffness 1; and what all Python peers share.

State: overlaps of contacts 0..40 and a cell of padding, then velocities of striker, beads and wall (always 0).

In compiled loops everything lies in one array at constant places: so the compiler sees that nothing overlaps, and
vectorises without asking at run time.
"""

import math
import sys
from pathlib import Path

import numpy as np
from numba import njit

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "reference"))
import physics as rig  # noqa: E402  (the material constants of the reference numbers)

CONTACTS, SENSOR = rig.BEADS + 1, rig.SENSOR
V = CONTACTS + 1  # where velocities start
STATE = 2 * V
FAST = dict(error_model="numpy", fastmath={"contract", "nsz"})
FLUSH = 1e-60  # overlaps below are none: far below anything printed, far above denormal numbers
FALLEN = 0.05  # a shot ends when the bead's signal has fallen below this fraction of the reflected peak,
SOONEST, LATEST = 0.8, 3.0  # which comes between these many incident ToFs after the wall's
LONGEST = 400.0  # in units of the shot; one that has not ended by then has gone wrong


hertz_same, relaxation = njit(rig.hertz_same), njit(rig.relaxation)
DRY = rig.hertz_same()


def law(case):
    """A and B of dry contacts, and of wet ones Y and the factors and exponents of eta and nu; Y = 0 where none is wet."""
    young, eta, nu = rig.OILS.get(case, (0.0, (0.0, 0.0), (0.0, 0.0)))
    relax = 0.0 if case == "hertz" else rig.relaxation()
    return relax, 0.0 if case.startswith("hertz") else rig.CUBIC, young, *eta, *nu


@njit
def coefficients(law, speed):
    """K, (3/2) A K and B of all contacts in SI units."""
    relax, cubic, young, eta, eta_power, nu, nu_power = law
    k, a, b = np.full(CONTACTS, DRY), np.full(CONTACTS, 1.5 * relax * DRY), np.full(CONTACTS, cubic)
    if young > 0.0:
        eta, nu = eta * speed**eta_power, nu * speed**nu_power
        stiff = hertz_same(young, nu)
        k[SENSOR:], b[SENSOR:] = stiff, 0.0
        a[SENSOR:] = 1.5 * relaxation(young, nu, eta, eta) * stiff
    return k, a, b


@njit
def shot(law, speed):
    """K, (3/2) A K, B without units, and the unit of time in s."""
    k, a, b = coefficients(law, speed)
    length = (rig.MASS * speed**2 / DRY) ** 0.4
    time = length / speed
    force = rig.MASS * length / time**2
    return k * length**1.5 / force, a * math.sqrt(length) * speed / force, b * speed**3 / force, time


@njit(inline="always")
def contact(d, rate, k, a, b):
    """Force; the gate is closed at overlap 0 while approaching. Without branches, so that loops vectorise."""
    pressed = d > FLUSH
    overlap = d if pressed else 0.0
    gated = rate if (pressed or (d >= 0.0 and rate > FLUSH)) else 0.0
    return math.sqrt(overlap) * (k * overlap + a * rate) + b * gated * gated * gated


# The work array: coefficients, forces (the first one 0), then rows of states and slopes.
ROW = 96
K, A, B, FORCE, ROWS = 0, 48, 96, 144, 192


@njit
def work(k, a, b, rows):
    """A work array with `rows` rows."""
    w = np.zeros(ROWS + rows * ROW)
    w[K : K + CONTACTS], w[A : A + CONTACTS], w[B : B + CONTACTS] = k, a, b
    return w


@njit(forceinline=True, **FAST)
def slopes(w, y, out):
    """dy/dt of the state at place y of the work array to place `out`."""
    for c in range(CONTACTS):
        w[out + c] = w[y + V + c] - w[y + V + c + 1]
    for c in range(CONTACTS):
        w[FORCE + 1 + c] = contact(w[y + c], w[out + c], w[K + c], w[A + c], w[B + c])
    for c in range(CONTACTS):
        w[out + V + c] = w[FORCE + c] - w[FORCE + 1 + c]


@njit(**FAST)
def derivative(w, y, out):
    """dy/dt of a state of an integrator."""
    for i in range(STATE):
        w[ROWS + i] = y[i]
    slopes(w, ROWS, ROWS + ROW)
    for i in range(STATE):
        out[i] = w[ROWS + ROW + i]


@njit
def start():
    y = np.zeros(STATE)
    y[V] = 1.0
    return y


@njit
def rate_of(y, c):
    return y[V + c] - y[V + c + 1]


@njit
def force_of(y, c, k, a, b):
    return contact(y[c], rate_of(y, c), k[c], a[c], b[c])


@njit
def acceleration(y, body, k, a, b):
    if body == CONTACTS:
        return 0.0
    behind = force_of(y, body - 1, k, a, b) if body > 0 else 0.0
    return behind - force_of(y, body, k, a, b)


@njit
def signal(y, first, last, k, a, b):
    """Mean force of contacts first..last and its rate by the chain rule."""
    value, slope = 0.0, 0.0
    for c in range(first, last + 1):
        d, rate = y[c], rate_of(y, c)
        value += force_of(y, c, k, a, b)
        if d > FLUSH:
            change = acceleration(y, c, k, a, b) - acceleration(y, c + 1, k, a, b)
            root = math.sqrt(d)
            slope += 1.5 * k[c] * root * rate + a[c] * (0.5 * rate * rate / root + root * change)
            slope += 3.0 * b[c] * rate * rate * change
    return value / (last - first + 1), slope / (last - first + 1)


@njit
def hermite_peak(h, f0, s0, f1, s1):
    """Where in 0..h the cubic through two values and slopes has its maximum, and the value."""
    d = (f1 - f0) / h
    c2, c3 = (3 * d - 2 * s0 - s1) / h, (s0 + s1 - 2 * d) / (h * h)
    root = math.sqrt(max(c2 * c2 - 3 * c3 * s0, 0.0))
    t = s0 / (root - c2) if root - c2 > 0.0 else 0.5 * h
    return t, f0 + t * (s0 + t * (c2 + t * c3))


Y, S, R, T = ROWS, ROWS + ROW, ROWS + 2 * ROW, ROWS + 3 * ROW


@njit(**FAST)
def rk4(w, h):
    """One classical step of the state at Y, in place."""
    half, third, sixth = 0.5 * h, h / 3.0, h / 6.0
    slopes(w, Y, R)
    for i in range(STATE):
        w[T + i] = w[Y + i] + sixth * w[R + i]
        w[S + i] = w[Y + i] + half * w[R + i]
    slopes(w, S, R)
    for i in range(STATE):
        w[T + i] += third * w[R + i]
        w[S + i] = w[Y + i] + half * w[R + i]
    slopes(w, S, R)
    for i in range(STATE):
        w[T + i] += third * w[R + i]
        w[S + i] = w[Y + i] + h * w[R + i]
    slopes(w, S, R)
    for i in range(STATE):
        w[Y + i] = w[T + i] + sixth * w[R + i]


@njit
def resolved_peak(y0, h, first, last, parts, w, k, a, b):
    """The maximum of a signal within a long step from y0: the step again by `parts` steps of RK4, and the cubic
    through values and slopes. Cheaper and closer than the dense output of most integrators. Overwrites rows Y to T."""
    w[Y : Y + STATE] = y0
    y = w[Y : Y + STATE]
    part = h / parts
    f0, s0 = signal(y, first, last, k, a, b)
    t, value = 0.0, f0
    for i in range(parts):
        rk4(w, part)
        f1, s1 = signal(y, first, last, k, a, b)
        if s0 > 0.0 and s1 <= 0.0:
            offset, top = hermite_peak(part, f0, s0, f1, s1)
            if top > value:
                t, value = i * part + offset, top
        elif f1 > value:
            t, value = (i + 1) * part, f1
        f0, s0 = f1, s1
    return t, value


@njit
def quartic(h, f):
    """Top of the quartic through five values a step apart; time from the middle one."""
    c1 = (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / 12
    c2 = (-f[0] + 16 * f[1] - 30 * f[2] + 16 * f[3] - f[4]) / 24
    c3 = (-f[0] + 2 * f[1] - 2 * f[3] + f[4]) / 12
    c4 = (f[0] - 4 * f[1] + 6 * f[2] - 4 * f[3] + f[4]) / 24
    t = -0.5 * c1 / c2
    for _ in range(4):
        t -= (c1 + t * (2 * c2 + t * (3 * c3 + t * 4 * c4))) / (2 * c2 + t * (6 * c3 + t * 12 * c4))
    return t * h, f[2] + t * (c1 + t * (c2 + t * (c3 + t * c4)))


# What a watch remembers: times and values of the three peaks, and the slopes at the end of the step before.
INCIDENT, WALL, REFLECTED, BEFORE = 0, 2, 4, 6


@njit
def new_watch():
    watch = np.zeros(8)
    watch[:6] = np.nan
    return watch


@njit
def note(watch, slot, t, value):
    if not watch[slot + 1] >= value:
        watch[slot], watch[slot + 1] = t, value
        return True
    return False


@njit
def over(watch, t, bead):
    """Whether the reflected pulse has passed: it was seen, and the bead, whose signal is given, is quiet again."""
    if math.isnan(watch[WALL]):
        return t > LONGEST
    flight = watch[WALL] - watch[INCIDENT]
    if watch[REFLECTED] > watch[WALL] + SOONEST * flight and bead < FALLEN * watch[REFLECTED + 1]:
        return True
    return t > watch[WALL] + LATEST * flight


@njit
def found(watch, sensor, t, value):
    if sensor == 1:
        if note(watch, WALL, t, value):
            watch[REFLECTED], watch[REFLECTED + 1] = np.nan, np.nan
    else:
        note(watch, INCIDENT if math.isnan(watch[WALL]) else REFLECTED, t, value)


@njit
def watch_step(watch, t0, y0, t1, y1, parts, w, k, a, b):
    """Takes in one long accepted step; True once the shot is over."""
    for sensor in range(2):
        first, last = (SENSOR - 1, SENSOR) if sensor == 0 else (CONTACTS - 1, CONTACTS - 1)
        before, now = watch[BEFORE + sensor], 0.0
        if y1[first] > FLUSH or y1[last] > FLUSH:
            now = signal(y1, first, last, k, a, b)[1]
            if before > 0.0 and now <= 0.0:
                t, value = resolved_peak(y0, t1 - t0, first, last, parts, w, k, a, b)
                found(watch, sensor, t0 + t, value)
        watch[BEFORE + sensor] = now
    if math.isnan(watch[REFLECTED]):
        return over(watch, t1, 0.0)
    return over(watch, t1, signal(y1, SENSOR - 1, SENSOR, k, a, b)[0])


@njit
def tofs(watch, time):
    """Incident and reflected ToF in s."""
    return (watch[WALL] - watch[INCIDENT]) * time, (watch[REFLECTED] - watch[WALL]) * time
