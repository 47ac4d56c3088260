"""Independent integrator of bead chains, for reference numbers.

SciPy's DOP853 (order 8) runs at a tight tolerance and is stopped and restarted at every opening, closing or
loss of tension of a contact, which is located as a root of the dense output. Peaks are roots of dF/dt, formed
from the equations of motion, not from samples. Conventions: see README.md beside this file. SI units, or K = m = 1.
"""

from dataclasses import dataclass, field

import numpy as np
from numba import njit
from scipy.integrate import DOP853
from scipy.optimize import brentq

OPEN, CLOSED, SLACK = 0, 1, 2  # SLACK: in contact, but the clipped force is zero
WALL = -1  # the far wall (fixed), or as the left partner the near wall, which may be driven


@njit(cache=True)
def contact_kinematics(t, x, v, left, right, rest, drive):
    """Overlap and overlap rate of every contact. The near wall moves as drive[0] sin(drive[1] t)."""
    overlap, rate = rest.copy(), np.zeros(len(rest))
    for c in range(len(rest)):
        if left[c] >= 0:
            overlap[c] += x[left[c]]
            rate[c] += v[left[c]]
        else:
            overlap[c] += drive[0] * np.sin(drive[1] * t)
            rate[c] += drive[0] * drive[1] * np.cos(drive[1] * t)
        if right[c] >= 0:
            overlap[c] -= x[right[c]]
            rate[c] -= v[right[c]]
    return overlap, rate


@njit(cache=True)
def raw_forces(overlap, rate, stiff, power, visc, cubic):
    """K d^n + (3/2) A K sqrt(d) d' + B d'^3, whatever the state of the contact."""
    force = np.zeros(len(overlap))
    for c in range(len(overlap)):
        d = max(overlap[c], 0.0)
        if d > 0.0:
            force[c] = stiff[c] * d ** power[c] + visc[c] * np.sqrt(d) * rate[c]
        force[c] += cubic[c] * rate[c] ** 3
    return force


@njit(cache=True)
def derivative(t, y, mode, inverse_mass, push, left, right, rest, stiff, power, visc, cubic, drive):
    n = len(inverse_mass)
    overlap, rate = contact_kinematics(t, y[:n], y[n:], left, right, rest, drive)
    force = raw_forces(overlap, rate, stiff, power, visc, cubic)
    out = np.empty(2 * n)
    out[:n] = y[n:]
    total = push.copy()
    for c in range(len(force)):
        if mode[c] == CLOSED:
            if left[c] >= 0:
                total[left[c]] -= force[c]
            if right[c] >= 0:
                total[right[c]] += force[c]
    out[n:] = total * inverse_mass
    return out


@njit(cache=True)
def force_rates(overlap, rate, rate_dot, stiff, power, visc, cubic):
    """dF/dt by the chain rule."""
    out = 3 * cubic * rate**2 * rate_dot
    for c in range(len(overlap)):
        d = overlap[c]
        if d > 0.0:
            root = np.sqrt(d)
            out[c] += stiff[c] * power[c] * d ** (power[c] - 1) * rate[c]
            out[c] += visc[c] * (0.5 * rate[c] ** 2 / root + root * rate_dot[c])
    return out


@dataclass
class Chain:
    """Bodies in a row (the striker first) and contacts c between bodies left[c] and right[c]."""

    mass: np.ndarray
    left: np.ndarray
    right: np.ndarray
    stiff: np.ndarray
    power: np.ndarray
    visc: np.ndarray  # (3/2) A K
    cubic: np.ndarray
    load: np.ndarray  # static force of each contact
    push: np.ndarray  # constant outer force on each body; balances the loads at rest
    drive: np.ndarray = field(default_factory=lambda: np.zeros(2))
    clipped: bool = False
    gap: np.ndarray | None = None  # initial gaps of unloaded contacts

    def __post_init__(self):
        self.rest = (self.load / self.stiff) ** (1 / self.power)
        if self.gap is not None:
            self.rest = self.rest - self.gap

    def laws(self):
        return self.stiff, self.power, self.visc, self.cubic

    def kinematics(self, t, y):
        n = len(self.mass)
        return contact_kinematics(t, y[:n], y[n:], self.left, self.right, self.rest, self.drive)

    def forces(self, t, y, mode):
        return np.where(mode == CLOSED, raw_forces(*self.kinematics(t, y), *self.laws()), 0.0)

    def acceleration(self, t, y, mode):
        return self.rhs(mode)(t, y)[len(self.mass):]

    def rhs(self, mode):
        inverse = 1 / self.mass
        return lambda t, y: derivative(t, y, mode, inverse, self.push, self.left, self.right, self.rest,
                                       *self.laws(), self.drive)

    def rates(self, t, y, mode):
        """dF/dt of all contacts."""
        a = self.acceleration(t, y, mode)
        amplitude, omega = self.drive
        near = -amplitude * omega**2 * np.sin(omega * t)
        rate_dot = np.where(self.left >= 0, a[self.left], near) - np.where(self.right >= 0, a[self.right], 0.0)
        overlap, rate = self.kinematics(t, y)
        return np.where(mode == CLOSED, force_rates(overlap, rate, rate_dot, *self.laws()), 0.0)


def row(mass, stiff, power=1.5, a_visc=0.0, cubic=0.0, push=0.0, g=0.0, stop_mass=None, wall=True, clipped=False, gap=None,
        strike=True):
    """A striker (if `strike`) and beads in a row, contact c between bodies c and c+1; the last one is the wall's.

    `push` is the constant force on bead 1, `g` the gravity component along the row. `stop_mass` puts a body, held
    by its static load, behind the last contact instead of the fixed wall; without `wall` the far end is free."""
    mass = np.array(mass, float)
    count = len(mass) if wall else len(mass) - 1
    fill = lambda value: np.ascontiguousarray(np.broadcast_to(np.array(value, float), count))
    first = 1 if strike else 0
    load = push + g * np.cumsum(np.where(np.arange(len(mass)) >= first, mass, 0.0))[:count]
    load[:first] = 0.0
    if not wall and (push or g):
        raise ValueError("a preload needs a far end")
    outer = mass * g
    outer[first] += push
    left, right = np.arange(count), np.arange(1, count + 1)
    if wall and stop_mass:
        mass, outer = np.append(mass, stop_mass), np.append(outer, -load[-1])
    elif wall:
        right[-1] = WALL
    stiff, power = fill(stiff), fill(power)
    return Chain(mass, left, right, stiff, power, 1.5 * fill(a_visc) * stiff, fill(cubic), load, outer, clipped=clipped,
                 gap=None if gap is None else fill(gap))


@dataclass
class Piece:
    """One accepted step with its dense output."""

    start: float
    end: float
    state: object
    mode: np.ndarray


@dataclass
class Run:
    chain: Chain
    pieces: list
    evaluations: int

    def final(self):
        last = self.pieces[-1]
        return last.state(last.end)

    def at(self, t):
        ends = [p.end for p in self.pieces]
        return self.pieces[min(np.searchsorted(ends, t), len(ends) - 1)].state(t)


def switch_values(chain, t, y, mode, tiny):
    """One value per contact that turns positive where its mode must change."""
    overlap, rate = chain.kinematics(t, y)
    value = np.where(mode == OPEN, overlap, -overlap - tiny[0])
    if chain.clipped:
        force = raw_forces(overlap, rate, *chain.laws())
        value = np.where(mode == CLOSED, np.maximum(value, -force - tiny[1]), value)
        value = np.where(mode == SLACK, np.maximum(value, force), value)
    return value


def next_mode(chain, t, y, mode, c, tiny):
    if mode[c] == OPEN:
        return CLOSED
    overlap, _ = chain.kinematics(t, y)
    if not chain.clipped or overlap[c] <= -0.5 * tiny[0]:
        return OPEN
    return SLACK if mode[c] == CLOSED else CLOSED


def integrate(chain, velocity, t_end, rtol=1e-12, displacement=None, scale=None):
    """`scale` = (typical overlap, typical speed): sets the absolute tolerance and the threshold of the gate."""
    n = len(chain.mass)
    y = np.concatenate([np.zeros(n) if displacement is None else displacement, velocity]).astype(float)
    size, speed = scale or typical(chain, velocity)
    tiny = (1e-12 * size, 1e-12 * np.median(chain.stiff * size**chain.power))
    atol = rtol * 1e-2 * np.concatenate([np.full(n, size), np.full(n, speed)])
    overlap, rate = chain.kinematics(0.0, y)
    mode = np.where(overlap >= 0, CLOSED, OPEN)
    mode[(overlap == 0) & (rate < 0)] = OPEN
    t, pieces, count = 0.0, [], 0
    while t < t_end:
        # A quarter of a contact time at most, so that no contact closes and opens again unseen within a step.
        solver = DOP853(chain.rhs(mode), t, y, t_end, rtol=rtol, atol=atol, max_step=size / speed)
        while solver.status == "running":
            solver.step()
            t, y, dense = solver.t, solver.y, solver.dense_output()
            hit = np.nonzero(switch_values(chain, t, y, mode, tiny) > 0)[0]
            if len(hit) == 0:
                pieces.append(Piece(solver.t_old, t, dense, mode))
                continue
            t, c = min((root_of_switch(chain, solver, dense, mode, c, tiny), c) for c in hit)
            y = dense(t)
            if t > solver.t_old:
                pieces.append(Piece(solver.t_old, t, dense, mode))
            new = mode.copy()
            new[c] = next_mode(chain, t, y, mode, c, tiny)
            mode = new
            break
        count += solver.nfev
    return Run(chain, pieces, count)


def root_of_switch(chain, solver, dense, mode, c, tiny):
    value = lambda t: switch_values(chain, t, dense(t), mode, tiny)[c]
    if value(solver.t_old) >= 0:
        return solver.t_old
    return brentq(value, solver.t_old, solver.t, xtol=1e-300, rtol=1e-15)


def typical(chain, velocity):
    """Overlap and speed of the hardest two-body impact in the row."""
    speed = np.max(np.abs(velocity)) or 1.0
    mass, stiff, power = np.median(chain.mass), np.median(chain.stiff), np.median(chain.power)
    return (0.5 * (power + 1) * mass * speed**2 / stiff) ** (1 / (power + 1)), speed


class Signal:
    """A weighted sum of contact forces, minus its static value; `velocity` takes a body's velocity instead."""

    def __init__(self, chain, weights=None, body=None):
        self.chain, self.body = chain, body
        self.weights = np.zeros(len(chain.load))
        for c, w in (weights or {}).items():
            self.weights[c] = w

    def value(self, t, y, mode):
        if self.body is not None:
            return y[len(self.chain.mass) + self.body]
        return self.weights @ (self.chain.forces(t, y, mode) - self.chain.load)

    def slope(self, t, y, mode):
        if self.body is not None:
            return self.chain.acceleration(t, y, mode)[self.body]
        return self.weights @ self.chain.rates(t, y, mode)


def bead_sensor(chain, n):
    return Signal(chain, {n - 1: 0.5, n: 0.5})


def contact_sensor(chain, c):
    return Signal(chain, {c: 1.0})


def velocity_sensor(chain, body):
    return Signal(chain, body=body)


def maxima(run, signal):
    """All local maxima (time, value), those at force jumps included."""
    found, before = [], None
    for p in run.pieces:
        first, last = ((t, p.state(t)) for t in (p.start, p.end))
        start = signal.value(*first, p.mode), signal.slope(*first, p.mode)
        end = signal.value(*last, p.mode), signal.slope(*last, p.mode)
        if before is not None and before[2] is not p.mode:
            (left, left_slope), (right, right_slope) = before[:2], start
            jump = right - left
            small = 1e-9 * max(abs(left), abs(right))
            if jump < -small and left_slope > 0:
                found.append((p.start, left))
            elif jump > small and right_slope < 0 or abs(jump) <= small and left_slope > 0 >= right_slope:
                found.append((p.start, right))
        if start[1] > 0 and end[1] <= 0:
            t = brentq(lambda s: signal.slope(s, p.state(s), p.mode), p.start, p.end, xtol=1e-300, rtol=1e-15)
            found.append((t, signal.value(t, p.state(t), p.mode)))
        before = (*end, p.mode)
    return found


def crossings(run, signal, level, t_from, t_to):
    """Times at which the signal crosses `level`."""
    found = []
    for p in run.pieces:
        a, b = max(p.start, t_from), min(p.end, t_to)
        if a >= b:
            continue
        gap = lambda s: signal.value(s, p.state(s), p.mode) - level
        if gap(a) * gap(b) < 0:
            found.append(brentq(gap, a, b, xtol=1e-300, rtol=1e-15))
    return found


def largest(peaks):
    return max(peaks, key=lambda p: p[1])


def flight(run, sensor, wall):
    """t7, tw, t7r and their heights, as docs/reference/conventions.md defines them."""
    at_wall, at_sensor = maxima(run, wall), maxima(run, sensor)
    tw, wall_peak = largest(at_wall)
    t7, peak = largest([p for p in at_sensor if p[0] < tw])
    until = tw + 3 * (tw - t7)
    assert run.pieces[-1].end >= until, "the run is too short for the window of the returning pulse"
    t7r, back = largest([p for p in at_sensor if tw < p[0] <= until])
    return {"t_sensor_s": t7, "t_wall_s": tw, "t_return_s": t7r, "tof_incident_s": tw - t7, "tof_reflected_s": t7r - tw,
            "sensor_peak_n": peak, "wall_peak_n": wall_peak, "returning_peak_n": back}


def full_width(run, signal, peak):
    """Full width at half maximum in time around a peak (time, value)."""
    t, height = peak
    first, last = run.pieces[0].start, run.pieces[-1].end
    before = [s for s in crossings(run, signal, height / 2, first, t)]
    after = [s for s in crossings(run, signal, height / 2, t, last)]
    return after[0] - before[-1]


def first_separation(run, contact=0):
    """Time and state at which a contact opens for the first time."""
    for p, q in zip(run.pieces, run.pieces[1:]):
        if p.mode[contact] != OPEN and q.mode[contact] == OPEN:
            return q.start, q.state(q.start)
    return None


def energy(chain, y, mode, t=0.0):
    """Kinetic + elastic + potential of the outer forces."""
    n = len(chain.mass)
    overlap, _ = chain.kinematics(t, y)
    elastic = chain.stiff * np.maximum(overlap, 0) ** (chain.power + 1) / (chain.power + 1)
    return 0.5 * chain.mass @ y[n:] ** 2 + elastic.sum() - chain.push @ y[:n]
