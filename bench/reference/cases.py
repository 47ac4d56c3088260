"""The cases: what is set up, what is observed. Each takes a relative tolerance and gives a dict of values."""

import numpy as np
from scipy.special import jv

import physics as p
from integrate import (Chain, Signal, bead_sensor, contact_sensor, first_separation, flight, full_width, integrate, largest, maxima,
                       row, velocity_sensor)

TAU = 2 * np.pi
G = p.GRAVITY


def start(chain, **speeds):
    """Velocities by body: b0=1.0 is the striker's."""
    v = np.zeros(len(chain.mass))
    for body, speed in speeds.items():
        v[int(body[1:])] = speed
    return v


def shot(chain, speed, t_end, rtol):
    return integrate(chain, start(chain, b0=speed), t_end, rtol)


def rig_observables(chain, speed, t_end, rtol, sensor=p.SENSOR, beads=p.BEADS):
    """ToFs, peaks and rebound, all as docs/reference/conventions.md says."""
    run = shot(chain, speed, t_end, rtol)
    out = flight(run, bead_sensor(chain, sensor), contact_sensor(chain, beads))
    apart = first_separation(run)
    n = len(chain.mass)
    if apart:
        out["striker_first_separation_s"] = apart[0]
        out["striker_at_first_separation_m_s"] = apart[1][n]
    out["striker_at_end_of_run_m_s"], out["run_ends_s"] = run.final()[n], run.pieces[-1].end
    return out


def leading_peak(run, signal):
    """The first maximum above half of the largest."""
    peaks = maxima(run, signal)
    height = largest(peaks)[1]
    return next(q for q in peaks if q[1] > 0.5 * height)


def leading_speed(run, chain, first, last):
    """Beads per second between the leading velocity peaks of two beads."""
    t = [leading_peak(run, velocity_sensor(chain, b))[0] for b in (first, last)]
    return (last - first) / (t[1] - t[0])


# --- validation -----------------------------------------------------------------------------------------------------


def equal_striker(rtol):
    """K = m = 1, 120 beads, free far end; read at beads 80 to 100."""
    chain = row(np.ones(121), 1.0, wall=False)
    run = shot(chain, 1.0, 115 / 0.84, rtol)
    peak = leading_peak(run, velocity_sensor(chain, 100))[1]
    c, force = leading_speed(run, chain, 80, 100), leading_peak(run, contact_sensor(chain, 100))[1]
    return {"v_max_over_v0": peak, "speed_beads_per_time": c, "peak_contact_force": force,
            "speed_over_force_to_one_sixth": c * force ** (-1 / 6), "speed_over_v_max_to_one_fifth": c * peak**-0.2}


def linear_chain(rtol):
    """Exponent 1: bead 1 of a half-infinite row starts at speed 1; v_n = J_{2n-2}(2t) + J_{2n}(2t), t before any reflection."""
    chain = row(np.ones(60), 1.0, power=1.0, push=10.0, strike=False)
    run = integrate(chain, start(chain, b0=1.0), 20.0, rtol)
    v = run.final()[60:]
    n = np.arange(1, 61)
    return {"largest_deviation_from_bessel": float(np.max(np.abs(v - jv(2 * n - 2, 40.0) - jv(2 * n, 40.0)))),
            "bead_10_velocity_at_20": v[9], "bead_15_velocity_at_20": v[14]}


# --- examples -------------------------------------------------------------------------------------------------------

STEEL_316 = dict(young=193e9, poisson=0.3, density=8000.0)
PTFE = dict(young=1.46e9, poisson=0.46, density=2178.0)


def dimer(rtol, speed=0.5):
    """Striker and odd beads steel, even beads PTFE; all R = 4.76 mm; 40 beads, fixed steel half-bead."""
    radius = 4.76e-3
    d = [p.compliance(m["young"], m["poisson"]) for m in (STEEL_316, PTFE)]
    mixed, steel = p.hertz(radius, d[0], radius, d[1]), p.hertz(radius, d[0], radius, d[0])
    mass = [p.sphere(radius, (STEEL_316, PTFE)[b % 2 == 0 and b > 0]["density"]) for b in range(41)]
    stiff = [steel] + [mixed] * 40  # contact 0 steel on steel; bead 40 is PTFE against the steel half-bead
    chain = row(mass, stiff)
    run = shot(chain, speed, 20e-3, rtol)
    contact = contact_sensor(chain, 20)
    peak = leading_peak(run, contact)
    t = [leading_peak(run, velocity_sensor(chain, b))[0] for b in (15, 31)]
    out = {"K_steel_ptfe": mixed, "mass_steel_kg": mass[0], "mass_ptfe_kg": mass[2], "contact_20_peak_n": peak[1],
           "contact_20_peak_time_s": peak[0], "contact_20_width_s": full_width(run, contact, peak),
           "bead_21_peak_velocity_m_s": leading_peak(run, velocity_sensor(chain, 21))[1],
           "speed_beads_15_to_31_per_s": 16 / (t[1] - t[0])}
    out["contact_20_width_beads"] = out["contact_20_width_s"] * out["speed_beads_15_to_31_per_s"]
    return out | {k: v for k, v in flight(run, bead_sensor(chain, 7), contact_sensor(chain, 40)).items() if k.startswith("tof")}


def dimer_decay(mass_ratio, rtol, beads=121):
    """K = m = 1, odd bodies of mass `mass_ratio`: loss of the heavy beads' leading velocity peak from bead 40 to bead 100."""
    mass = np.where(np.arange(beads) % 2 == 0, 1.0, mass_ratio)
    chain = row(mass, 1.0, wall=False)
    run = shot(chain, 1.0, 130.0, rtol)
    early, late = (leading_peak(run, velocity_sensor(chain, b))[1] for b in (40, 100))
    return {"peak_velocity_bead_40": early, "peak_velocity_bead_100": late, "loss_40_to_100": 1 - late / early}


def tapered(rtol, shrink=0.05, beads=20, speed=1.0):
    """Radii R_i = R_0 (1 - q)^i from the striker on, steel of the paper's rig with density 7960; far end free."""
    radius = p.RADIUS * (1 - shrink) ** np.arange(beads + 1)
    mass = p.sphere(radius, 7960.0)
    d = p.compliance(p.YOUNG, p.POISSON)
    chain = row(mass, p.hertz(radius[:-1], d, radius[1:], d), wall=False)
    run = shot(chain, speed, 1.2e-3, rtol)
    v = run.final()[beads + 1:]
    ratio = 1 / (1 - shrink) ** 3
    return {"last_bead_m_s": v[-1], "second_last_bead_m_s": v[-2], "third_last_bead_m_s": v[-3], "striker_m_s": v[0],
            "bead_10_peak_velocity_m_s": leading_peak(run, velocity_sensor(chain, 10))[1],
            "contact_19_peak_n": leading_peak(run, contact_sensor(chain, 19))[1],
            "contact_19_peak_time_s": leading_peak(run, contact_sensor(chain, 19))[0],
            "ballistic_last_bead_m_s": speed * (2 / (1 + 1 / ratio)) ** beads,
            "momentum_over_initial": mass @ v / (mass[0] * speed)}


def light_intruder(rtol, ratio=0.5, at=20, speed=0.5):
    """The paper's steel; bead 20 of 40 has half the radius (an eighth of the mass); Hertz only."""
    radius = np.full(41, p.RADIUS)
    radius[at] *= ratio
    mass = p.MASS * (radius / p.RADIUS) ** 3
    d = p.compliance(p.YOUNG, p.POISSON)
    stiff = p.hertz(radius, d, np.append(radius[1:], p.RADIUS), d)
    chain = row(mass, stiff)
    run = shot(chain, speed, 3.2e-3, rtol)
    intruder, before, after = (velocity_sensor(chain, b) for b in (at, at - 5, at + 5))
    at_wall = largest(maxima(run, contact_sensor(chain, 40)))[0]
    peaks = [q for q in maxima(run, intruder) if q[0] < at_wall and q[1] > 0.05 * speed]
    contact = leading_peak(run, contact_sensor(chain, at))
    out = {"K_intruder": stiff[at], "intruder_mass_kg": mass[at], "contact_20_peak_n": contact[1], "contact_20_peak_time_s": contact[0],
           "bead_15_peak_velocity_m_s": leading_peak(run, before)[1], "bead_25_peak_velocity_m_s": leading_peak(run, after)[1]}
    out["transmitted_over_incident_velocity"] = out["bead_25_peak_velocity_m_s"] / out["bead_15_peak_velocity_m_s"]
    for i, (t, v) in enumerate(peaks[:4], 1):
        out[f"intruder_velocity_maximum_{i}_s"], out[f"intruder_velocity_maximum_{i}_m_s"] = t, v
    f = flight(run, bead_sensor(chain, 7), contact_sensor(chain, 40))
    out |= {"tof_incident_s": f["tof_incident_s"], "tof_reflected_s": f["tof_reflected_s"]}
    squeeze = np.sqrt(3 * stiff[at] ** (2 / 3) * contact[1] ** (1 / 3) / mass[at]) / TAU
    out["quasi_static_intruder_frequency_hz"] = squeeze
    out["intruder_frequency_first_to_second_maximum_hz"] = 1 / (peaks[1][0] - peaks[0][0])
    return out


COSTE = dict(young=2.26e11, poisson=0.3, density=7780.0, radius=4e-3, beads=51)


def precompressed_small(rtol, load=30.0, speed=1e-5):
    """51 beads under 30 N against a fixed half-bead; bead 1 starts with a tiny velocity (no striker)."""
    c = COSTE
    mass, stiff = p.sphere(c["radius"], c["density"]), p.hertz_same(c["young"], c["poisson"], c["radius"])
    chain = row([mass] * c["beads"], stiff, push=load, strike=False)
    slope = 1.5 * stiff ** (2 / 3) * load ** (1 / 3)
    omega = np.sqrt(slope / mass)
    chain_scale = (speed / omega, speed)
    run = integrate(chain, start(chain, b0=speed), 58 / omega, rtol, scale=chain_scale)
    out = {"K": stiff, "mass_kg": mass, "linear_stiffness_n_m": slope, "linear_speed_beads_per_s": omega,
           "linear_speed_m_s": 2 * c["radius"] * omega, "cutoff_frequency_hz": omega / np.pi}
    for bead in (10, 20, 40):
        t, v = leading_peak(run, velocity_sensor(chain, bead - 1))
        out[f"bead_{bead}_peak_time_s"], out[f"bead_{bead}_peak_over_initial_velocity"] = t, v / speed
        out |= {f"bessel_bead_{bead}_peak_{k}": x for k, x in bessel_peak(bead, omega).items()}
    return out


def bessel_peak(n, omega):
    """First maximum of J_{2n-2}(2wt) + J_{2n}(2wt): the half-infinite linear row."""
    from scipy.optimize import brentq
    slope = lambda s: jv(2 * n - 3, s) - jv(2 * n + 1, s)  # twice the derivative
    first = 2 * n - 2 + np.linspace(0, 3 * n ** (1 / 3) + 2, 400)
    change = next(i for i in range(1, 400) if slope(first[i]) < 0)
    s = brentq(slope, first[change - 1], first[change], xtol=1e-14)
    return {"time_s": s / (2 * omega), "over_initial_velocity": jv(2 * n - 2, s) + jv(2 * n, s)}


def precompressed_shot(rtol, load=30.0, speed=0.3):
    """The same row hit by an equal striker."""
    c = COSTE
    mass, stiff = p.sphere(c["radius"], c["density"]), p.hertz_same(c["young"], c["poisson"], c["radius"])
    chain = row([mass] * (c["beads"] + 1), stiff, push=load)
    run = shot(chain, speed, 2.2e-3, rtol)
    contact = leading_peak(run, contact_sensor(chain, 30))
    f = flight(run, bead_sensor(chain, 7), contact_sensor(chain, c["beads"]))
    pulse = leading_speed(run, chain, 20, 40)
    total = (contact[1] + load) / load
    theory = coste_speed(stiff, mass, load, contact[1] + load)
    return {"static_overlap_m": (load / stiff) ** (2 / 3), "speed_beads_20_to_40_per_s": pulse, "contact_30_dynamic_peak_n": contact[1],
            "contact_30_peak_time_s": contact[0], "total_over_static_force": total, "long_wave_speed_beads_per_s": theory,
            "tof_incident_s": f["tof_incident_s"], "tof_reflected_s": f["tof_reflected_s"]}


def coste_speed(stiff, mass, load, peak_total):
    """Nesterenko's long-wave solitary wave over a static force, as [Coste1997] uses it, in beads per second:
    V/c0 = (1/(r - 1)) sqrt(4/15 (3 + 2 r^{5/2} - 5 r)), r = (F_m/F_0)^{2/3}."""
    r = (peak_total / load) ** (2 / 3)
    sound = np.sqrt(1.5 * stiff ** (2 / 3) * load ** (1 / 3) / mass)
    return sound / (r - 1) * np.sqrt(4 / 15 * (3 + 2 * r**2.5 - 5 * r))


def heavy_striker(rtol, ratio=5.0, speed=0.5, beads=150):
    """A striker of five bead masses (radius by the cube root) on the paper's beads, Hertz only; free far end."""
    radius = np.full(beads + 1, p.RADIUS)
    radius[0] *= ratio ** (1 / 3)
    d = p.compliance(p.YOUNG, p.POISSON)
    stiff = p.hertz(radius[:-1], d, radius[1:], d)
    mass = np.full(beads + 1, p.MASS)
    mass[0] *= ratio
    chain = row(mass, stiff, wall=False)
    run = shot(chain, speed, 3.5e-3, rtol)
    sensor = contact_sensor(chain, 60)
    peaks = [q for q in maxima(run, sensor)]
    top = largest(peaks)[1]
    kept = [q for q in peaks if q[1] > 0.01 * top]
    out = {"K_striker": stiff[0], "K": stiff[1], "pulses_above_1_percent": len(kept)}
    for i, (t, f) in enumerate(kept[:6], 1):
        out[f"pulse_{i}_time_s"], out[f"pulse_{i}_force_n"] = t, f
    out["leading_bead_60_velocity_over_v0"] = leading_peak(run, velocity_sensor(chain, 60))[1] / speed
    return out


def exponent_section(rtol, speed=0.5, k=2.5e12):
    """The paper's rig, Hertz only, but contacts 15..=25 have F = k d^2, k = 2.5e12 N/m^2."""
    section = (np.arange(41) >= 15) & (np.arange(41) <= 25)
    chain = row([p.MASS] * 41, np.where(section, k, p.hertz_same()), power=np.where(section, 2.0, 1.5))
    out = rig_observables(chain, speed, 3.5e-3, rtol)
    run = shot(chain, speed, 3.5e-3, rtol)
    for c in (10, 20, 30):
        out[f"contact_{c}_peak_time_s"], out[f"contact_{c}_peak_n"] = leading_peak(run, contact_sensor(chain, c))
    return out


def uniform_square_law(rtol):
    """K = m = 1, F = d^2 throughout: speed of the pulse of an equal striker."""
    chain = row(np.ones(121), 1.0, power=2.0, wall=False)
    run = shot(chain, 1.0, 170.0, rtol)
    c, v = leading_speed(run, chain, 70, 90), leading_peak(run, velocity_sensor(chain, 90))[1]
    return {"speed_beads_per_time": c, "v_max_over_v0": v, "speed_over_v_max_to_one_third": c * v ** (-1 / 3)}


SPECIMENS = {"steel": (193e9, 0.3), "aluminium": (72e9, 0.33), "pmma": (3.1e9, 0.35), "rubber-like": (0.1e9, 0.45)}


def vertical_on_specimen(rtol, speed=0.31):
    """20 steel beads R = 9.525 mm standing on a half-space; equal striker from above; sensor bead 10."""
    radius, steel = 9.525e-3, p.compliance(193e9, 0.3)
    mass, bead = p.sphere(radius, 7800.0), p.hertz(radius, steel, radius, steel)
    out = {"mass_kg": mass, "K_bead_bead": bead}
    for name, (young, poisson) in SPECIMENS.items():
        wall = p.hertz(radius, steel, np.inf, p.compliance(young, poisson))
        chain = row([mass] * 21, [bead] * 20 + [wall], g=G)
        run = shot(chain, speed, 5e-3 if name == "rubber-like" else 3e-3, rtol)
        f = flight(run, bead_sensor(chain, 10), contact_sensor(chain, 20))
        back = [q for q in maxima(run, bead_sensor(chain, 10)) if q[0] > f["t_wall_s"] and q[1] > 0.05 * f["sensor_peak_n"]]
        out |= {f"{name}/K_wall": wall, f"{name}/delay_s": f["t_return_s"] - f["t_sensor_s"], f"{name}/tof_incident_s": f["tof_incident_s"],
                f"{name}/tof_reflected_s": f["tof_reflected_s"], f"{name}/wall_peak_n": f["wall_peak_n"],
                f"{name}/sensor_peak_n": f["sensor_peak_n"], f"{name}/returning_peak_n": f["returning_peak_n"],
                f"{name}/first_returning_maximum_s": back[0][0], f"{name}/first_returning_maximum_n": back[0][1]}
    out["static_overlap_contact_1_m"], out["static_overlap_contact_19_m"] = chain.rest[1], chain.rest[19]
    return out


def cradle(rtol, balls=5, power=1.5):
    """Balls just touching, ball 1 arrives at speed 1 (K = m = 1); velocities when all have parted for good."""
    chain = row(np.ones(balls), 1.0, power=power, wall=False)
    run = shot(chain, 1.0, 200.0, rtol)
    return {f"ball_{i}_velocity": v for i, v in enumerate(run.final()[balls:], 1)}


# --- further checks -------------------------------------------------------------------------------------------------


def dry(speed, t_end=None, **options):
    return lambda rtol: rig_observables(p.dry_rig(**options), speed, t_end or 3.4e-3 * speed**-0.2, rtol)


def wet(oil, speed, **options):
    return lambda rtol: rig_observables(p.wet_rig(oil, speed, **options), speed, 3.4e-3 * speed**-0.2, rtol)


def reading(build, speed, **where):
    """A rig by a function, so that a reading is one line."""
    return lambda rtol: rig_observables(build(), speed, 3.4e-3 * speed**-0.2, rtol, **where)


def ring(rtol):
    """Ten beads K = m = 1 on a ring, just touching; bead 1 starts at speed 1; state at t = 10 and 20."""
    n = 10
    zero, one = np.zeros(n), np.ones(n)
    chain = Chain(one, np.arange(n), (np.arange(n) + 1) % n, one, 1.5 * one, zero, zero, zero, zero)
    run = integrate(chain, start(chain, b0=1.0), 20.0, rtol)
    v10, v20 = run.at(10.0)[n:], run.final()[n:]
    return {f"bead_{b + 1}_velocity_at_10": v10[b] for b in range(n)} | {f"bead_{b + 1}_velocity_at_20": v20[b] for b in range(n)}


def driven(power, amplitude, omega):
    """Ten beads K = m = 1 under a static force 1 between a near wall moving as a sin(wt) and a fixed wall."""
    def measure(rtol):
        n, c = 10, 11
        one = np.ones(c)
        chain = Chain(np.ones(n), np.arange(c) - 1, np.append(np.arange(n), -1), one, power * one, 0 * one, 0 * one, one, np.zeros(n),
                      drive=np.array([amplitude, omega]))
        run = integrate(chain, np.zeros(n), 20.0, rtol, scale=(amplitude, amplitude * omega))
        y = run.final()
        contact = largest(maxima(run, contact_sensor(chain, 10)))
        return {"bead_1_position_at_20": y[0], "bead_5_position_at_20": y[4], "bead_1_velocity_at_20": y[n], "bead_10_velocity_at_20": y[-1],
                "contact_10_largest_dynamic_force": contact[1], "contact_10_largest_time": contact[0]}
    return measure


def head_on(rtol):
    """Two equal pulses meet: 41 free beads K = m = 1, the outer ones start at +1 and -1; the middle stays at rest."""
    chain = row(np.ones(41), 1.0, wall=False)
    run = integrate(chain, start(chain, b0=1.0, b40=-1.0), 60.0, rtol)
    v = run.final()[41:]
    return {"first_bead_velocity": v[0], "last_bead_velocity": v[-1],
            "middle_contact_peak_force": largest(maxima(run, contact_sensor(chain, 20)))[1]}
