"""What a careful physicist writes in numba: fixed-step RK4, and an adaptive Dormand-Prince pair, all of it compiled."""

import math

import numba
import numpy as np
from numba import njit

import chain as p
from chain import CONTACTS, ROW, ROWS, SENSOR, STATE, V


def version():
    return numba.__version__


@njit
def value(w, first, last):
    """Mean force of contacts first..last of the state at Y."""
    f = 0.0
    for c in range(first, last + 1):
        d, rate = w[p.Y + c], w[p.Y + V + c] - w[p.Y + V + c + 1]
        f += p.contact(d, rate, w[p.K + c], w[p.A + c], w[p.B + c])
    return f / (last - first + 1)


@njit
def rk4_shot(w, h):
    """Fixed steps; forces of both sensors in short memories of five steps, peaks by the quartic through them."""
    w[p.Y + V] = 1.0
    watch, past, step = p.new_watch(), np.zeros((2, 5)), 0
    while True:
        p.rk4(w, h)
        step += 1
        for sensor in range(2):
            f = past[sensor]
            first, last = (SENSOR - 1, SENSOR) if sensor == 0 else (CONTACTS - 1, CONTACTS - 1)
            if w[p.Y + first] <= 0.0 and w[p.Y + last] <= 0.0 and f[4] == 0.0:
                continue
            f[0], f[1], f[2], f[3] = f[1], f[2], f[3], f[4]
            f[4] = value(w, first, last)
            if f[2] > 0.0 and f[1] < f[2] >= f[3]:
                t, top = p.quartic(h, f)
                p.found(watch, sensor, (step - 2) * h + t, top)
        if p.over(watch, step * h, past[0, 4]):
            return watch


# Dormand and Prince's pair of orders 5 and 4.
A21 = 1 / 5
A31, A32 = 3 / 40, 9 / 40
A41, A42, A43 = 44 / 45, -56 / 15, 32 / 9
A51, A52, A53, A54 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A61, A62, A63, A64, A65 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
B1, B3, B4, B5, B6 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E1, E3, E4, E5, E6, E7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40

# Rows 4 to 12: the state, the trial state, slopes. Rows 0 to 3 are RK4's.
Q, S, K1, K2, K3, K4, K5, K6, K7 = (ROWS + (4 + i) * ROW for i in range(9))


@njit(**p.FAST)
def pair_step(w, h):
    """One trial step from Q: the new state to S, its slope to K7; returns the error's root mean square."""
    for i in range(STATE):
        w[S + i] = w[Q + i] + h * (A21 * w[K1 + i])
    p.slopes(w, S, K2)
    for i in range(STATE):
        w[S + i] = w[Q + i] + h * (A31 * w[K1 + i] + A32 * w[K2 + i])
    p.slopes(w, S, K3)
    for i in range(STATE):
        w[S + i] = w[Q + i] + h * (A41 * w[K1 + i] + A42 * w[K2 + i] + A43 * w[K3 + i])
    p.slopes(w, S, K4)
    for i in range(STATE):
        w[S + i] = w[Q + i] + h * (A51 * w[K1 + i] + A52 * w[K2 + i] + A53 * w[K3 + i] + A54 * w[K4 + i])
    p.slopes(w, S, K5)
    for i in range(STATE):
        w[S + i] = w[Q + i] + h * (
            A61 * w[K1 + i] + A62 * w[K2 + i] + A63 * w[K3 + i] + A64 * w[K4 + i] + A65 * w[K5 + i]
        )
    p.slopes(w, S, K6)
    for i in range(STATE):
        w[S + i] = w[Q + i] + h * (
            B1 * w[K1 + i] + B3 * w[K3 + i] + B4 * w[K4 + i] + B5 * w[K5 + i] + B6 * w[K6 + i]
        )
    p.slopes(w, S, K7)
    return h * math.sqrt(squares(w) / STATE)


@njit(error_model="numpy", fastmath=True)
def squares(w):
    """Sum of squares of the error's slope."""
    total = 0.0
    for i in range(STATE):
        e = E1 * w[K1 + i] + E3 * w[K3 + i] + E4 * w[K4 + i] + E5 * w[K5 + i] + E6 * w[K6 + i] + E7 * w[K7 + i]
        total += e * e
    return total


@njit
def pair_shot(w, k, a, b, tolerance):
    """Adaptive; the three steps that hold a peak are resolved once more by short RK4 steps."""
    watch = p.new_watch()
    w[Q + V] = 1.0
    p.slopes(w, Q, K1)
    old, new = w[Q : Q + STATE], w[S : S + STATE]
    t, h, refused = 0.0, 1e-3, False
    while True:
        ratio = pair_step(w, h) / tolerance
        factor = min(5.0, max(0.2, 0.9 * max(ratio, 1e-10) ** -0.2))
        if ratio <= 1.0:
            if p.watch_step(watch, t, old, t + h, new, 8, w, k, a, b):
                return watch
            t += h
            for i in range(STATE):
                w[Q + i] = w[S + i]
                w[K1 + i] = w[K7 + i]
            factor = min(factor, 1.0) if refused else factor
        refused = ratio > 1.0
        h *= factor


@njit
def rk4_shots(law, h, speeds):
    out = []
    for v in speeds:
        k, a, b, time = p.shot(law, v)
        out.append(p.tofs(rk4_shot(p.work(k, a, b, 4), h), time))
    return out


@njit
def pair_shots(law, tolerance, speeds):
    out = []
    for v in speeds:
        k, a, b, time = p.shot(law, v)
        out.append(p.tofs(pair_shot(p.work(k, a, b, 13), k, a, b, tolerance), time))
    return out


def run(method, case, setting, speeds):
    """`setting` is the step in units of the shot's own time scale for RK4, the tolerance for the pair."""
    shots = rk4_shots if method == "rk4" else pair_shots
    return shots(p.law(case), setting, np.array(speeds))
