"""SciPy: its stepper classes and its compiled Hairer and ODEPACK codes, with a NumPy or a numba right-hand side."""

import numpy as np
import scipy
from scipy.integrate import DOP853, LSODA, RK45, ode

import chain as p

CLASSES = {"DOP853": DOP853, "RK45": RK45, "LSODA": LSODA}
COMPILED = {"ode-dop853": "dop853", "ode-dopri5": "dopri5"}
PARTS = 24  # RK4 steps into which the three steps that hold a peak are split


def version():
    return scipy.__version__


def numpy_derivative(k, a, b):
    """The right-hand side in NumPy: every array preallocated, ufuncs write in place."""
    n, first, size, flush = p.CONTACTS, p.V, p.STATE, p.FLUSH
    rate, d, root, force, cube = (np.empty(n) for _ in range(5))
    force_behind = np.zeros(n + 1)
    has_damping, has_cubic = a.any(), b.any()

    def of(t, y):
        out = np.zeros(size)
        v = y[first:]
        np.subtract(v[:-1], v[1:], out=rate)
        np.maximum(y[:n], 0.0, out=d)
        np.sqrt(d, out=root)
        np.multiply(k, d, out=force)
        if has_damping:
            np.multiply(a, rate, out=cube)
            np.add(force, cube, out=force)
        np.multiply(force, root, out=force_behind[1:])
        if has_cubic:
            closed = (y[:n] > flush) | ((y[:n] >= 0.0) & (rate > flush))
            np.multiply(rate, rate, out=cube)
            np.multiply(cube, rate, out=cube)
            np.multiply(cube, b, out=cube)
            np.multiply(cube, closed, out=cube)
            np.add(force_behind[1:], cube, out=force_behind[1:])
        out[:n] = rate
        np.subtract(force_behind[:-1], force_behind[1:], out=out[first:-1])
        return out

    return of


def numba_derivative(k, a, b):
    w, size = p.work(k, a, b, 2), p.STATE

    def of(t, y):
        out = np.empty(size)
        p.derivative(w, y, out)
        return out

    return of


def by_class(solver, fun, tolerance, laws):
    """Steps by hand: `solve_ivp` would store every state."""
    watch, y = p.new_watch(), p.start()
    stepper = solver(fun, 0.0, y, p.LONGEST, rtol=1e-13, atol=tolerance, first_step=1e-3)
    while stepper.status == "running":
        t0, y0 = stepper.t, stepper.y
        stepper.step()
        if p.watch_step(watch, t0, y0.copy() if solver is LSODA else y0, stepper.t, stepper.y, PARTS, *laws):
            break
    return watch


def by_compiled(name, fun, tolerance, laws):
    """The compiled codes call back once a step."""
    watch = p.new_watch()
    last = [0.0, p.start()]

    def step(t, y):
        done = p.watch_step(watch, last[0], last[1], t, y, PARTS, *laws)
        last[0], last[1] = t, y.copy()
        return -1 if done else 0

    solver = ode(fun).set_integrator(name, rtol=1e-14, atol=tolerance, nsteps=1_000_000, first_step=1e-3)
    solver.set_solout(step)
    solver.set_initial_value(p.start(), 0.0)
    solver.integrate(p.LONGEST)
    return watch


def shot(method, case, tolerance, speed):
    name, _, side = method.partition("/")
    *laws, time = p.shot(p.law(case), speed)
    fun = (numba_derivative if side == "numba" else numpy_derivative)(*laws)
    laws = (p.work(*laws, 4), *laws)
    if name in CLASSES:
        watch = by_class(CLASSES[name], fun, tolerance, laws)
    else:
        watch = by_compiled(COMPILED[name], fun, tolerance, laws)
    return p.tofs(watch, time)


def run(method, case, tolerance, speeds):
    return [shot(method, case, tolerance, v) for v in speeds]
