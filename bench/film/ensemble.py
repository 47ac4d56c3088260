"""The reduced law beside the whole contact over random pulses of random oils that no constant was fitted to: the distribution of errors."""

import sys

import numpy as np

from contact import Barus, NoConvergence
from law import FilmLaw
from pulse import MODULUS, REDUCED_RADIUS
from table import through


def draw(random):
    """Largest overlap in m, viscosity in Pa s, static load in N, α in 1/Pa; one in three oils has α = 0."""
    largest, viscosity = 1e-6 * 1.2 * 12.5 ** random.uniform(), 0.03 * 10 ** random.uniform()
    preload = random.uniform(0.02, 0.3)
    return largest, viscosity, preload, random.uniform(4e-9, 22e-9) if random.uniform() > 1 / 3 else 0.0


def errors(largest, viscosity, preload, alpha):
    """Worst force error over the peak, with its sign, and the relative error of the loss."""
    _, rows = through(largest, viscosity, rings=70, steps=200, preload=preload, law=Barus(alpha) if alpha else None)
    times, overlaps, forces = rows.T[:3]
    law = FilmLaw(REDUCED_RADIUS, MODULUS, viscosity, 1.3 * largest, alpha).start(overlaps[0])
    found = np.array([law.force()] + [law.step(b - a, d) for a, b, d in zip(times, times[1:], overlaps[1:])])
    off = (found - forces) / forces.max()
    work = lambda force: np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(overlaps))
    return off[np.argmax(np.abs(off))], work(found) / work(forces) - 1


def main():
    count, seed = (int(word) for word in (sys.argv[1:] + ["24", "7"][len(sys.argv) - 1 :])[:2])
    random, rows = np.random.default_rng(seed), []
    for _ in range(count):
        case = draw(random)
        try:
            rows.append((*case, *errors(*case)))
        except NoConvergence as mistake:
            print("not converged:", case, mistake)
            continue
        print("δmax %.2f µm, η %.3f Pa s, %.2f N, α %4.1f 1/GPa: force %+.4f, loss %+.3f"
              % (case[0] * 1e6, case[1], case[2], case[3] * 1e9, *rows[-1][-2:]), flush=True)
    force, loss = np.abs(np.array(rows)[:, -2:]).T
    for name, values in (("force", force), ("loss", loss)):
        print(f"{name}: median {np.median(values):.4f}, 90 % {np.quantile(values, 0.9):.4f}, worst {values.max():.4f}")


if __name__ == "__main__":
    main()
