"""Material constants to contact constants, as docs/explanation/physics.md writes them; and the paper's rig."""

import numpy as np

from integrate import row

YOUNG, POISSON, RADIUS, MASS = 213e9, 0.3, 6.35e-3, 8.54e-3
ETA, CUBIC, BEADS, SENSOR = 3.2e4, 77.0, 40, 7
GRAVITY = 9.80665  # m/s^2

# Effective values of the paper's table: Y, (factor, exponent) of eta and of nu over the impact speed in m/s.
OILS = {
    "motor": (193e9, (66177.1, -0.206), (0.360, -0.165)),
    "gear": (225e9, (107299.0, -0.640), (0.390, -0.127)),
    "pump": (216e9, (81405.3, -0.302), (0.314, -0.274)),
}


def compliance(young, poisson):
    return (1 - poisson**2) / young


def hertz(radius1, d1, radius2, d2):
    """K of an unlike pair; an infinite radius is a plane, a compliance 0 is rigid."""
    return 4 / 3 / np.sqrt(1 / radius1 + 1 / radius2) / (d1 + d2)


def hertz_same(young=YOUNG, poisson=POISSON, radius=RADIUS):
    return young * np.sqrt(2 * radius) / (3 * (1 - poisson**2))


def relaxation(young=YOUNG, poisson=POISSON, eta1=ETA, eta2=ETA):
    """A in seconds."""
    shear = 4 / 3 * eta1 * (1 - poisson + poisson**2) + eta2 * (1 - 2 * poisson) ** 2
    return (1 + poisson) / (1 - poisson) * shear / young


def sphere(radius, density):
    return 4 / 3 * np.pi * radius**3 * density


def dry_rig(a_visc=None, cubic=CUBIC, **options):
    """The paper's chain: striker, 40 beads, and a fixed half-bead."""
    a = relaxation() if a_visc is None else a_visc
    return row([MASS] * (BEADS + 1), hertz_same(), a_visc=a, cubic=cubic, **options)


def wet_rig(oil, speed, first_wet=SENSOR, cubic=CUBIC, eta2_over_eta1=1.0, largest_nu=1.0, **options):
    """Contacts from `first_wet` on wet with the oil's effective material on both sides, those before dry with the cubic term."""
    young, (eta, eta_exponent), (nu, nu_exponent) = OILS[oil]
    eta, nu = eta * speed**eta_exponent, min(nu * speed**nu_exponent, largest_nu)
    wet = np.arange(BEADS + 1) >= first_wet
    a_wet, a_dry = relaxation(young, nu, eta, eta2_over_eta1 * eta), relaxation(eta2=eta2_over_eta1 * ETA)
    return row([MASS] * (BEADS + 1), np.where(wet, hertz_same(young, nu), hertz_same()), a_visc=np.where(wet, a_wet, a_dry),
               cubic=np.where(wet, 0.0, cubic), **options)


def dry_rig_on_plane():
    """The paper's chain against an elastic plane of its own steel."""
    d = compliance(YOUNG, POISSON)
    stiff = np.append(np.full(BEADS, hertz_same()), hertz(RADIUS, d, np.inf, d))
    return row([MASS] * (BEADS + 1), stiff, a_visc=relaxation(), cubic=CUBIC)
