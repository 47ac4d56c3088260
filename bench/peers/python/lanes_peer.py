"""The idea of hertzchain's ensembles by hand, in numba: classical Runge-Kutta with sixteen shots side by side in single
precision. No tool that anybody offers works so; it shows how much of the distance is the idea."""

import numba
import numpy as np
from numba import njit

import chain as p
from chain import CONTACTS, FAST, SENSOR, STATE, V

LANES, LOOK = 16, 32
# One flat array: coefficients, forces (the first one 0), then states and slopes; lane by lane, so that neighbours in the
# chain are LANES apart.
ALL = CONTACTS * LANES
K, A, B, FORCE = 0, ALL, 2 * ALL, 3 * ALL
Y = FORCE + ALL + LANES
SIZE, RATES = STATE * LANES, V * LANES
S, R, T = Y + SIZE, Y + 2 * SIZE, Y + 3 * SIZE
ZERO, FLUSH = np.float32(0), np.float32(1e-12)


def version():
    return numba.__version__


@njit(inline="always")
def contact(d, rate, k, a, b):
    pressed = d > FLUSH
    overlap = d if pressed else ZERO
    gated = rate if (pressed or (d >= ZERO and rate > FLUSH)) else ZERO
    return np.sqrt(overlap) * (k * overlap + a * gated) + b * gated * gated * gated


@njit(forceinline=True, **FAST)
def slopes(w, y, out):
    for i in range(ALL):
        w[out + i] = w[y + RATES + i] - w[y + RATES + LANES + i]
    for i in range(ALL):
        w[FORCE + LANES + i] = contact(w[y + i], w[out + i], w[K + i], w[A + i], w[B + i])
    for i in range(ALL):
        w[out + RATES + i] = w[FORCE + i] - w[FORCE + LANES + i]


@njit(**FAST)
def step(w, h):
    half, third, sixth = np.float32(0.5 * h), np.float32(h / 3.0), np.float32(h / 6.0)
    full = np.float32(h)
    slopes(w, Y, R)
    for i in range(SIZE):
        w[T + i] = w[Y + i] + sixth * w[R + i]
        w[S + i] = w[Y + i] + half * w[R + i]
    slopes(w, S, R)
    for i in range(SIZE):
        w[T + i] += third * w[R + i]
        w[S + i] = w[Y + i] + half * w[R + i]
    slopes(w, S, R)
    for i in range(SIZE):
        w[T + i] += third * w[R + i]
        w[S + i] = w[Y + i] + full * w[R + i]
    slopes(w, S, R)
    for i in range(SIZE):
        w[Y + i] = w[T + i] + sixth * w[R + i]


@njit(**FAST)
def force(w, c, lane):
    i = c * LANES + lane
    rate = w[Y + RATES + i] - w[Y + RATES + LANES + i]
    return contact(w[Y + i], rate, w[K + i], w[A + i], w[B + i])


@njit(**FAST)
def note_signals(w, seen):
    """Forces at the sensors, as of the state at Y, to a row of `seen`."""
    for lane in range(LANES):
        seen[0, lane] = np.float32(0.5) * (force(w, SENSOR - 1, lane) + force(w, SENSOR, lane))
        seen[1, lane] = force(w, CONTACTS - 1, lane)


@njit(error_model="numpy")
def look(seen, first, last, h, lane, watch):
    """Maxima among samples first..last of a lane; whether its shot is over."""
    f = np.empty(5)
    for n in range(max(first, 5), last):
        for sensor in range(2):
            for i in range(5):
                f[i] = seen[n - 4 + i, sensor, lane]
            if f[2] > 0.0 and f[1] < f[2] >= f[3]:
                t, top = p.quartic(h, f)
                p.found(watch, sensor, (n - 1) * h + t, top)
        if p.over(watch, (n + 1) * h, seen[n, 0, lane]):
            return True
    return False


@njit(error_model="numpy")
def block(w, h):
    """Sixteen shots to their ends; what each one's watch has seen."""
    w[Y + RATES : Y + RATES + LANES] = np.float32(1.0)
    watches = np.empty((LANES, 8))
    for lane in range(LANES):
        watches[lane] = p.new_watch()
    over = np.zeros(LANES, dtype=np.bool_)
    seen = np.zeros((int(p.LONGEST / h) + 2 * LOOK, 2, LANES), dtype=np.float32)
    steps = 0
    while not over.all():
        for _ in range(LOOK):
            step(w, h)
            note_signals(w, seen[steps])
            steps += 1
        for lane in range(LANES):
            over[lane] = over[lane] or look(seen, steps - LOOK, steps, h, lane, watches[lane])
    return watches


@njit(error_model="numpy")
def shots(law, h, speeds):
    out, w = [], np.empty(T + SIZE, dtype=np.float32)
    times = np.empty(LANES)
    for first in range(0, len(speeds), LANES):
        count = min(LANES, len(speeds) - first)
        w[:] = ZERO
        for lane in range(LANES):
            k, a, b, times[lane] = p.shot(law, speeds[first + min(lane, count - 1)])
            for c in range(CONTACTS):
                i = c * LANES + lane
                w[K + i], w[A + i], w[B + i] = k[c], a[c], b[c]
        watches = block(w, h)
        for lane in range(count):
            out.append(p.tofs(watches[lane], times[lane]))
    return out


def run(method, case, setting, speeds):
    """`setting` is the step in units of the shot's own time scale."""
    return shots(p.law(case), setting, np.array(speeds))
