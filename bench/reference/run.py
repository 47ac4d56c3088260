"""Writes numbers.json, table.md and tof.csv beside this file. See README.md.

    python run.py            all cases (a few minutes)
    python run.py tapered    only the named ones, printed, nothing written
"""

import json
import sys
from pathlib import Path

import numpy as np

import cases as c
import physics as p
import restitution as r
from sources import EARLIER, PUBLISHED

HERE = Path(__file__).parent
FINE, COARSE = 1e-12, 1e-10
INCLINE = c.G * np.sin(np.radians(0.5))

RIG = dict(beads=p.BEADS, striker="equal ball", radius_m=p.RADIUS, mass_kg=p.MASS, young_pa=p.YOUNG, poisson_ratio=p.POISSON,
           sensor_bead=p.SENSOR, far_end="fixed half-bead, same sphere", hertz_stiffness=p.hertz_same())
DRY = RIG | dict(eta1_pa_s=p.ETA, eta2_pa_s=p.ETA, relaxation_s=p.relaxation(), cubic_kg_s_m2=p.CUBIC)
UNIT = dict(hertz_stiffness=1, mass=1, contact="just touching")


def damped(law):
    """Restitution at two speeds; tolerances ten times finer, for e is near 1 and cheap."""
    return lambda rtol: {f"{k}_at_{v}_m_s": x for v in (0.1, 0.5) for k, x in r.collide(law, v, rtol / 10).items()}


def constant(values):
    return lambda rtol: values


def law_cases():
    base = dict(mass_of_each_kg=p.MASS, radius_m=p.RADIUS, hertz_stiffness=r.K, reduced_mass_kg=r.REDUCED)
    for law, (parameters, _) in r.DAMPED.items():
        yield f"restitution/{law}", base | parameters, damped(law)
    yield "restitution/tsuji_closed_form", {"alpha": 0.1}, constant({"restitution": r.tsuji_exact(0.1)})
    yield ("restitution/elastic_plastic_thornton", base | dict(young_pa=p.YOUNG, poisson_ratio=p.POISSON, yield_pressure_pa=3e9),
           constant({f"{k}_at_{v}_m_s": x for v in (0.5, 1.0) for k, x in r.thornton(v, 3e9).items()}))
    yield "hertz_contact_time", base | dict(speed_m_s=1.0), constant(r.hertz_contact_time(1.0))


def rig_cases():
    hertz = dict(a_visc=0.0, cubic=0.0)
    yield "rig/hertz_1", RIG | dict(speed_m_s=1.0), c.dry(1.0, **hertz)
    yield "rig/hertz_viscoelastic_0.5", RIG | dict(speed_m_s=0.5, relaxation_s=p.relaxation()), c.dry(0.5, cubic=0.0)
    for speed in (0.075, 0.5, 1.0, 1.23):
        yield f"rig/dry_{speed}", DRY | dict(speed_m_s=speed), c.dry(speed)
    at = DRY | dict(speed_m_s=0.5)
    yield "rig/dry_clipped_0.5", at | dict(tension="clipped"), c.dry(0.5, clipped=True)
    yield "rig/dry_stop_4.5kg_0.5", at | dict(stop_mass_kg=4.5), c.dry(0.5, stop_mass=4.5)
    yield "rig/dry_push_0.24N_0.5", at | dict(constant_push_n=0.24), c.dry(0.5, push=0.24)
    yield "rig/dry_incline_0.5deg_0.5", at | dict(incline_deg=0.5, gravity_m_s2=c.G), c.dry(0.5, g=INCLINE)
    yield ("rig/dry_push_and_incline_0.5", at | dict(constant_push_n=0.24, incline_deg=0.5, gravity_m_s2=c.G),
           c.dry(0.5, push=0.24, g=INCLINE))
    yield ("rig/dry_push_incline_stop_0.5", at | dict(constant_push_n=0.24, incline_deg=0.5, gravity_m_s2=c.G, stop_mass_kg=4.5),
           c.dry(0.5, push=0.24, g=INCLINE, stop_mass=4.5))
    for oil, speed in (("pump", 0.5), ("motor", 1.0), ("gear", 0.5), ("motor", 0.075)):
        yield f"rig/{oil}_{speed}", DRY | dict(speed_m_s=speed, oil=oil, wet_contacts="7..=40, no cubic term there"), c.wet(oil, speed)
    yield "rig/pump_clipped_0.5", DRY | dict(speed_m_s=0.5, oil="pump", tension="clipped"), c.wet("pump", 0.5, clipped=True)


def reading_cases():
    """Single switches away from the default reading."""
    at = DRY | dict(speed_m_s=0.5)
    yield "reading/dry_wall_plane_0.5", at | dict(far_end="plane of the same steel"), c.reading(p.dry_rig_on_plane, 0.5)
    yield ("reading/dry_eta2_zero_0.5", at | dict(eta2_pa_s=0.0, relaxation_s=p.relaxation(eta2=0.0)),
           c.dry(0.5, a_visc=p.relaxation(eta2=0.0)))
    yield "reading/dry_sensor_6_0.5", at | dict(sensor_bead=6), c.reading(p.dry_rig, 0.5, sensor=6)
    for name, switches in (("contact_6_wet", dict(first_wet=6)), ("all_wet", dict(first_wet=0)), ("no_cubic", dict(cubic=0.0)),
                           ("eta2_zero", dict(eta2_over_eta1=0.0))):
        yield (f"reading/pump_{name}_0.5", at | dict(oil="pump") | switches, c.reading(lambda s=switches: p.wet_rig("pump", 0.5, **s), 0.5))
    yield ("reading/motor_nu_half_0.075", DRY | dict(speed_m_s=0.075, oil="motor", largest_nu=0.5),
           c.reading(lambda: p.wet_rig("motor", 0.075, largest_nu=0.5), 0.075))


def example_cases():
    free = dict(far_end="free")
    yield ("dimer-steel-ptfe", dict(beads=40, radius_m=4.76e-3, steel=c.STEEL_316, ptfe=c.PTFE, striker="steel", odd_beads="steel",
           even_beads="ptfe", far_end="fixed half-bead of steel", speed_m_s=0.5, sensor_bead=7, laws="Hertz"), c.dimer)
    for ratio in (0.3428, 0.1548, 0.59):
        yield (f"dimer-mass-ratio-{ratio}", UNIT | dict(mass_of_odd_beads=ratio, beads=120, striker_mass=1, speed=1) | free,
               lambda rtol, ratio=ratio: c.dimer_decay(ratio, rtol))
    yield ("tapered", dict(beads=20, striker_radius_m=p.RADIUS, radius_shrinks_by=0.05, density_kg_m3=7960.0, young_pa=p.YOUNG,
           poisson_ratio=p.POISSON, speed_m_s=1.0, laws="Hertz") | free, c.tapered)
    yield ("light-intruder", RIG | dict(speed_m_s=0.5, laws="Hertz", intruder="bead 20: half the radius, an eighth of the mass"),
           c.light_intruder)
    coste = c.COSTE | dict(constant_push_n=30.0, far_end="fixed half-bead, same sphere", laws="Hertz")
    yield "precompressed/small", coste | dict(start="no striker; bead 1 starts at 1e-5 m/s", speed_m_s=1e-5), c.precompressed_small
    yield "precompressed/shot", coste | dict(striker="equal ball", speed_m_s=0.3, sensor_bead=7), c.precompressed_shot
    yield ("heavy-striker", RIG | dict(beads=150, speed_m_s=0.5, striker="5 bead masses, radius by 5^(1/3), same steel", laws="Hertz",
           observed="force of contact 60") | free, c.heavy_striker)
    yield ("exponent-section", RIG | dict(speed_m_s=0.5, section="contacts 15..=25: F = k d^2", k_n_m2=2.5e12, laws="Hertz elsewhere"),
           c.exponent_section)
    yield "exponent-2-uniform", dict(law="F = d^2", mass=1, beads=120, speed=1) | free, c.uniform_square_law
    yield ("vertical-on-specimen", dict(beads=20, radius_m=9.525e-3, density_kg_m3=7800.0, young_pa=193e9, poisson_ratio=0.3,
           striker="equal ball, from above, its weight acting", speed_m_s=0.31, incline_deg=90, gravity_m_s2=c.G, sensor_bead=10,
           laws="Hertz", far_end="elastic half-space", specimens_young_pa_and_poisson=c.SPECIMENS), c.vertical_on_specimen)
    for balls in (3, 5):
        yield f"newtons-cradle/{balls}", UNIT | dict(balls=balls, speed=1) | free, lambda rtol, balls=balls: c.cradle(rtol, balls)


def other_cases():
    yield "equal-striker", UNIT | dict(beads=120, speed=1, far_end="free"), c.equal_striker
    yield "linear-chain", dict(law="F = d", mass=1, beads=60, push=10, start="bead 1 at speed 1"), c.linear_chain
    yield "ring", UNIT | dict(beads=10, far_end="periodic", start="bead 1 at speed 1"), c.ring
    drive = dict(beads=10, mass=1, static_force=1, near_end="wall at 0.1 sin(t), contact 0 to bead 1", far_end="fixed half-bead")
    yield "driven/linear", drive | dict(law="F = d"), c.driven(1.0, 0.1, 1.0)
    yield "driven/hertz", drive | dict(law="F = d^1.5"), c.driven(1.5, 0.1, 1.0)
    yield "head-on", UNIT | dict(bodies=41, far_end="free", start="first at +1, last at -1"), c.head_on


def all_cases():
    yield from example_cases()
    yield from rig_cases()
    yield from reading_cases()
    yield from other_cases()
    yield from law_cases()


def measure(name, observe):
    """Every quantity with the change from a hundred times coarser tolerance as its error."""
    fine, coarse = observe(FINE), observe(COARSE)
    rows = []
    for quantity, value in fine.items():
        value, other = float(value), float(coarse[quantity])
        error = max(abs(value - other) / abs(value), 1e-13) if value else abs(other)
        row = {"quantity": quantity, "value": value, "relative_error": float(f"{error:.1e}")}
        known = {**EARLIER, **PUBLISHED}.get((name, quantity))
        rows.append(row | ({"compare": known} if known else {}))
    return rows


TOF_SPEEDS = (0.075, 0.1, 0.1368, 0.1396, 0.25, 0.3993, 0.5, 0.75, 1.0, 1.152, 1.23)


def tof_table():
    """The paper's six chains at the speeds that matter, in the default reading."""
    chains = {"hertz": lambda v: c.dry(v, a_visc=0.0, cubic=0.0), "hertz-viscoelastic": lambda v: c.dry(v, cubic=0.0), "dry": c.dry}
    chains |= {oil: lambda v, oil=oil: c.wet(oil, v) for oil in p.OILS}
    columns = ("tof_incident_s", "tof_reflected_s", "sensor_peak_n", "wall_peak_n", "returning_peak_n", "striker_at_end_of_run_m_s")
    lines = ["case,speed_m_s," + ",".join(columns)]
    for name, chain in chains.items():
        for speed in TOF_SPEEDS:
            out = chain(speed)(1e-11)
            lines.append(f"{name},{speed}," + ",".join(f"{out[k]:.12e}" for k in columns))
    return "\n".join(lines) + "\n"


def markdown(results):
    lines = ["| case | quantity | value | rel. error | compare |", "|---|---|---|---|---|"]
    for case in results:
        for row in case["results"]:
            known = row.get("compare")
            note = f"{known['value']} {known['what']}" if known else ""
            lines.append(f"| {case['case']} | {row['quantity']} | {row['value']:.12g} | {row['relative_error']:.0e} | {note} |")
    return "\n".join(lines) + "\n"


def main():
    wanted, results = sys.argv[1:], []
    for name, parameters, observe in all_cases():
        if wanted and not any(w in name for w in wanted):
            continue
        results.append({"case": name, "parameters": parameters, "results": measure(name, observe)})
        print(name, flush=True)
    if wanted:
        print(markdown(results))
        return
    (HERE / "numbers.json").write_text(json.dumps(results, indent=1, default=float) + "\n")
    (HERE / "table.md").write_text(markdown(results))
    (HERE / "tof.csv").write_text(tof_table())


if __name__ == "__main__":
    main()
