"""What a careful physicist writes in numba: fixed-step RK4, and an adaptive Dormand-Prince pair, all of it compiled."""

import math

import numba
import numpy as np
from numba import njit

import chain as p
from chain import CONTACTS, FLUSH, SENSOR

BODIES = CONTACTS
FAST = dict(error_model="numpy", fastmath={"contract", "nsz"})


def version():
    return numba.__version__


@njit(inline="always")
def slopes(d, v, hi, dd, dv, force, k, a, b):
    """Rates of overlaps and velocities of contacts and bodies below `hi`; those beyond are at rest."""
    for c in range(hi):
        dd[c] = v[c] - v[c + 1]
    for c in range(hi):
        force[c + 1] = p.contact(d[c], dd[c], k[c], a[c], b[c])
    for c in range(hi):
        dv[c] = force[c] - force[c + 1]


@njit(**FAST)
def rk4_step(y, z, hi, h, work, force, k, a, b):
    """One classical step of the moving part, from y to z; the wall's velocity is the last cell."""
    d, v, nd, nv = y[0], y[1], z[0], z[1]
    sd, sv, rd, rv, td, tv = work[0], work[1], work[2], work[3], work[4], work[5]
    slopes(d, v, hi, rd, rv, force, k, a, b)
    half = 0.5 * h
    for i in range(hi):
        td[i], tv[i] = rd[i], rv[i]
        sd[i], sv[i] = d[i] + half * rd[i], v[i] + half * rv[i]
    slopes(sd, sv, hi, rd, rv, force, k, a, b)
    for i in range(hi):
        td[i] += 2.0 * rd[i]
        tv[i] += 2.0 * rv[i]
        sd[i], sv[i] = d[i] + half * rd[i], v[i] + half * rv[i]
    slopes(sd, sv, hi, rd, rv, force, k, a, b)
    for i in range(hi):
        td[i] += 2.0 * rd[i]
        tv[i] += 2.0 * rv[i]
        sd[i], sv[i] = d[i] + h * rd[i], v[i] + h * rv[i]
    slopes(sd, sv, hi, rd, rv, force, k, a, b)
    sixth = h / 6.0
    for i in range(hi):
        nd[i] = d[i] + sixth * (td[i] + rd[i])
        nv[i] = v[i] + sixth * (tv[i] + rv[i])


@njit(**FAST)
def farther(y, hi):
    """One more than the last contact that may act in the next step: in one step of four stages the front, which falls
    off faster than any power, gains at most four contacts above the flush."""
    while hi < CONTACTS and (y[0][hi] > 1e-30 or hi < 8 or y[0][max(hi - 4, 0)] > 1e-30):
        hi += 1
    return hi


@njit
def signal(y, sensor, k, a, b):
    first, last = (SENSOR - 1, SENSOR) if sensor == 0 else (CONTACTS - 1, CONTACTS - 1)
    f, s = 0.0, 0.0
    for c in range(first, last + 1):
        d, rate = y[0][c], y[1][c] - y[1][c + 1]
        f += p.contact(d, rate, k[c], a[c], b[c])
    return f / (last - first + 1)


@njit
def rk4_shot(k, a, b, h):
    """Fixed steps; forces of both sensors in short memories of five steps, peaks by the quartic through them."""
    y, z = np.zeros((2, CONTACTS + 1)), np.zeros((2, CONTACTS + 1))
    work, force = np.zeros((6, 2, CONTACTS + 1))[:, 0], np.zeros(CONTACTS + 1)
    y[1][0] = 1.0
    watch, past = p.new_watch(), np.zeros((2, 5))
    hi, step = 8, 0
    while True:
        hi = farther(y, hi)
        rk4_step(y, z, hi, h, work, force, k, a, b)
        y, z = z, y
        z[:, hi:] = y[:, hi:]
        step += 1
        for sensor in range(2):
            f = past[sensor]
            contact = SENSOR if sensor == 0 else CONTACTS - 1
            if y[0][contact] <= 0.0 and y[0][contact - (sensor == 0)] <= 0.0 and f[4] == 0.0:
                continue
            f[:4] = f[1:]
            f[4] = signal(y, sensor, k, a, b)
            if f[2] > 0.0 and f[1] < f[2] >= f[3]:
                t, value = p.quartic(h, f)
                p.found(watch, sensor, (step - 2) * h + t, value)
        if p.over(watch, step * h):
            return watch


# Dormand and Prince's pair of orders 5 and 4.
A21 = 1 / 5
A31, A32 = 3 / 40, 9 / 40
A41, A42, A43 = 44 / 45, -56 / 15, 32 / 9
A51, A52, A53, A54 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A61, A62, A63, A64, A65 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
B1, B3, B4, B5, B6 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E1, E3, E4, E5, E6, E7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40


@njit(**FAST)
def pair_step(y, k1, h, s, k2, k3, k4, k5, k6, k7, force, k, a, b):
    """One trial step: the new state in s, its slope in k7, the largest error returned."""
    n = len(y)
    for i in range(n):
        s[i] = y[i] + h * (A21 * k1[i])
    p.derivative(s, k2, force, k, a, b)
    for i in range(n):
        s[i] = y[i] + h * (A31 * k1[i] + A32 * k2[i])
    p.derivative(s, k3, force, k, a, b)
    for i in range(n):
        s[i] = y[i] + h * (A41 * k1[i] + A42 * k2[i] + A43 * k3[i])
    p.derivative(s, k4, force, k, a, b)
    for i in range(n):
        s[i] = y[i] + h * (A51 * k1[i] + A52 * k2[i] + A53 * k3[i] + A54 * k4[i])
    p.derivative(s, k5, force, k, a, b)
    for i in range(n):
        s[i] = y[i] + h * (A61 * k1[i] + A62 * k2[i] + A63 * k3[i] + A64 * k4[i] + A65 * k5[i])
    p.derivative(s, k6, force, k, a, b)
    for i in range(n):
        s[i] = y[i] + h * (B1 * k1[i] + B3 * k3[i] + B4 * k4[i] + B5 * k5[i] + B6 * k6[i])
    p.derivative(s, k7, force, k, a, b)
    error = 0.0
    for i in range(n):
        e = h * (E1 * k1[i] + E3 * k3[i] + E4 * k4[i] + E5 * k5[i] + E6 * k6[i] + E7 * k7[i])
        error += e * e
    return math.sqrt(error / n)


@njit
def pair_shot(k, a, b, tolerance):
    """Adaptive; the three steps that hold a peak are resolved once more by short RK4 steps."""
    n = 2 * CONTACTS
    w, force, watch = np.zeros((9, n)), np.zeros(CONTACTS + 1), p.new_watch()
    y, s, k1, k7 = p.start(), w[0], w[1], w[2]
    k2, k3, k4, k5, k6 = w[3], w[4], w[5], w[6], w[7]
    p.derivative(y, k1, force, k, a, b)
    t, h, refused = 0.0, 1e-3, False
    while True:
        ratio = pair_step(y, k1, h, s, k2, k3, k4, k5, k6, k7, force, k, a, b) / tolerance
        factor = min(5.0, max(0.2, 0.9 * max(ratio, 1e-10) ** -0.2))
        if ratio <= 1.0:
            done = p.watch_step(watch, t, y, t + h, s, 8, k, a, b)
            t += h
            y, s, k1, k7 = s, y, k7, k1
            if done:
                return watch
            factor = min(factor, 1.0) if refused else factor
        refused = ratio > 1.0
        h *= factor


def run(method, case, setting, speeds):
    """`setting` is the step in units of the contact's own time scale for RK4, the tolerance for the pair."""
    one = rk4_shot if method == "rk4" else pair_shot
    out = []
    for v in speeds:
        *laws, time = p.shot(case, v)
        out.append(p.tofs(one(*laws, setting), time))
    return out
