"""Restitution of two equal bodies, law by law: the overlap's own equation m* d'' = -F(d, d')."""

import numpy as np
from scipy.integrate import quad, solve_ivp

import physics as p

REDUCED = p.MASS / 2
K, A = p.hertz_same(), p.relaxation()

# name: (parameters, force of overlap and rate); an elastic Hertz contact of the paper's steel underlies each.
DAMPED = {
    "damping_viscoelastic": ({"A_s": A}, lambda d, v: 1.5 * A * K * np.sqrt(d) * v),
    "damping_kuwabara_kono": ({"gamma": 4000.0}, lambda d, v: 4000.0 * np.sqrt(d) * v),
    "damping_tsuji": ({"alpha": 0.1}, lambda d, v: 0.1 * np.sqrt(REDUCED * K) * d**0.25 * v),
    "damping_linear": ({"c": 5.0}, lambda d, v: 5.0 * v),
    "damping_power": ({"c": 4000.0, "overlap_exponent": 0.5, "rate_exponent": 1.5},
                      lambda d, v: 4000.0 * np.sqrt(d) * np.sign(v) * abs(v) ** 1.5),
    "damping_power_rate_only": ({"c": 6.0, "overlap_exponent": 0.0, "rate_exponent": 1.75}, lambda d, v: 6.0 * np.sign(v) * abs(v) ** 1.75),
    "damping_cubic": ({"B": p.CUBIC}, lambda d, v: p.CUBIC * v**3),
    "dry_viscoelastic_and_cubic": ({"A_s": A, "B": p.CUBIC}, lambda d, v: 1.5 * A * K * np.sqrt(d) * v + p.CUBIC * v**3),
}


def collide(law, speed, rtol):
    """(e at d = 0, duration, peak force, e where the total force reaches 0 on the way out)."""
    damping = DAMPED[law][1]
    force = lambda d, v: K * max(d, 0.0) ** 1.5 + damping(max(d, 0.0), v)
    rhs = lambda t, y: [y[1], -force(*y) / REDUCED]
    closed = lambda t, y: y[0]
    slack = lambda t, y: force(*y) if y[1] < 0 else 1.0
    closed.direction = slack.direction = -1
    closed.terminal = True
    size = (1.25 * REDUCED * speed**2 / K) ** 0.4
    # The first step is taken by hand, so that d = 0 at the start is no event.
    h = 1e-9 * size / speed
    first = [speed * h, speed - force(0.0, speed) / REDUCED * h]
    run = solve_ivp(rhs, (h, 10 * size / speed), first, method="DOP853", rtol=rtol, atol=[rtol * size, rtol * speed], events=[closed, slack],
                    dense_output=True)
    (end,), after = run.y_events[0], run.y_events[1]
    return {"restitution": -end[1] / speed, "contact_time_s": run.t_events[0][0],
            "restitution_clipped": -after[0][1] / speed if len(after) else -end[1] / speed}


def tsuji_exact(alpha):
    """d^{5/4} obeys a damped linear oscillator: e = exp(-pi a / sqrt(5 - a^2)), ended at d = 0 [Antypov2011]."""
    return float(np.exp(-np.pi * alpha / np.sqrt(5 - alpha**2)))


def viscoelastic_series(speed):
    x = 1.5 * A * (K / REDUCED) ** 0.4 * speed**0.2
    return 1 - 1.15344885809 * x + 0.79827 * x**2


def thornton(speed, pressure):
    """Elastic, perfectly plastic spheres: closed form of [Thornton1997] and the same from the work of the force law."""
    radius, modulus = p.RADIUS / 2, 1 / (2 * p.compliance(p.YOUNG, p.POISSON))
    yielding = radius * (np.pi * pressure / (2 * modulus)) ** 2
    v_yield = np.sqrt(2 * 0.4 * K * yielding**2.5 / REDUCED)
    q = v_yield / speed
    root = np.sqrt(6 / 5 - q**2 / 5)
    closed_form = np.sqrt(6 * np.sqrt(3) / 5) * np.sqrt(1 - q**2 / 6) * (q / (q + 2 * root)) ** 0.25
    f_yield, slope = K * yielding**1.5, np.pi * pressure * radius
    plastic = 0.5 * REDUCED * (speed**2 - v_yield**2)
    further = (-f_yield + np.sqrt(f_yield**2 + 2 * slope * plastic)) / slope
    peak = f_yield + slope * further
    flat = 4 * modulus / (3 * peak) * ((2 * peak + f_yield) / (2 * np.pi * pressure)) ** 1.5
    unload = 4 / 3 * modulus * np.sqrt(flat)
    depth = (peak / unload) ** (2 / 3)
    work = quad(lambda d: unload * d**1.5, 0, depth, epsabs=0, epsrel=1e-13)[0]
    return {"yield_speed_m_s": v_yield, "restitution_closed_form": closed_form, "restitution": np.sqrt(2 * work / REDUCED) / speed,
            "peak_force_n": peak, "largest_overlap_m": yielding + further, "left_overlap_m": yielding + further - depth}


def hertz_contact_time(speed):
    """3.21806545971904 (m*/K)^{2/5} v^{-1/5}, the constant by the beta function."""
    from scipy.special import gamma
    constant = 2 * (5 / 4) ** 0.4 * np.sqrt(np.pi) * gamma(7 / 5) / gamma(9 / 10)
    return {"constant": constant, "contact_time_s": constant * (REDUCED / K) ** 0.4 * speed**-0.2}
