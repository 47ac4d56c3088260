"""A reduced law of one oily contact: a trapped spacer that stores, and a squeezed rim that loses.

Contact of radius a between spheres of reduced radius R and modulus E*. The film H(s) that the edge left at radius s is a part of the
punch's shape, so that with V(a) = ∫ H ds

    F = 2 E* (a δ − a³/(3R) + V(a)) + 2 E* κ a y,   edge at δ + H(a) = a²/R,   H = β y where it advances,

and the rim y, an overlap that the oil at the edge still has to give way to, relaxes as an inlet of speed ȧ would:

    ẏ = δ̇ − (2E*/η) (κ a y / (c R^1.4 (R y/a²)^g (R/a)^e))^{5/3} − y ȧ/(2a) where y > 0; oil that is drawn cavitates: y = 0.

At a steady rate κ y = c (η δ̇/(2E*))^0.6 R^1.4/a (R y/a²)^g (R/a)^e: with g = e = 0, c times the inlet film (η ȧ/E*)^0.6 R^0.8 a^−0.4; a rim that is
narrow beside the contact, or around a wide one, resists less. The last term keeps the energy E* κ a y² of the rim from growing with a alone.
An oil that thickens with pressure, η exp(α p), leaves more film and squeezes out less: with G(x) = x/(1 − e^−x), x = α k E* (β a y/R²)^{1/3} (the
pressure of an inlet of such a film), β becomes β G^n and η becomes η G^m (1 + l α E* a/R), the last by the pressure in the contact.
Energy: F δ̇ = d/dt {E* ∫ (δ − s²/R + H)² ds + E* κ a y²} + 2 E* κ a y (2E*/η) (...)^{5/3}, whose last part is never negative.
"""

import numpy as np
from numba import njit

# c, β, κ, g; k, m, n, l; e. Pure numbers, the same for every contact, fitted to contact.py alone by fit.py.
CONSTANTS = (3.125, 0.4871, 0.6664, 0.0389, 2.47, -0.2138, 0.5311, 0.01202, 0.05852)
# Where the numbers of one contact's state are.
RADIUS_A, RIM, OVERLAP, DISSIPATED = range(4)


@njit
def at(values, a, width):
    """`values`, given at multiples of `width`, at a."""
    i = min(int(a / width), len(values) - 2)
    part = a / width - i
    return values[i] + part * (values[i + 1] - values[i])


@njit
def relaxed(trial, dt, speed, power):
    """y with y + dt · speed · y^power = trial, by Newton from the side on which it converges monotonically."""
    y = trial
    for _ in range(50):
        rate = dt * speed * y ** (power - 1)
        change = (y + rate * y - trial) / (1 + power * rate)
        y -= change
        if change <= 1e-14 * trial:
            break
    return y


@njit
def law_step(state, film, volume, law, dt, overlap):
    """Moves one contact to a new overlap over `dt`; returns its force."""
    radius, modulus, viscosity, alpha, width, (squeezed, beta, kappa, narrow, inlet, rise, thickening, deep, wide) = law
    a = max(state[RADIUS_A], 1e-3 * width)
    trial = state[RIM] + overlap - state[OVERLAP]
    y, stiff = 0.0, 1.0
    if trial > 0:
        thick = viscosity * (1 + deep * alpha * modulus * a / radius)
        resistance = squeezed * radius**1.4 * (radius / a**2) ** narrow * (radius / a) ** wide
        speed = 2 * modulus / thick * (kappa * a / resistance) ** (5 / 3)
        power = 5 / 3 * (1 - narrow)
        y = relaxed(trial, dt, speed, power)
        # A contraction: y falls with G^m by less than G falls with y.
        for _ in range(20 if alpha > 0 else 0):
            x = alpha * inlet * modulus * (a * beta * y / radius**2) ** (1 / 3)
            before, stiff = stiff, x / -np.expm1(-x) if x > 1e-9 else 1.0
            y = relaxed(trial, dt, speed * stiff**-rise, power)
            if abs(stiff - before) < 1e-10:
                break
    state[DISSIPATED] += 2 * modulus * kappa * a * y * (trial - y)
    state[OVERLAP] = overlap
    move_edge(state, film, volume, radius, overlap, beta * stiff**thickening * y, width)
    # Where nothing touches any more, the rim is gone with its energy.
    state[RIM] = y * np.sqrt(min(1.0, a / max(state[RADIUS_A], 1e-3 * width))) if state[RADIUS_A] > 0 else 0.0
    return law_force(state, volume, law)


@njit
def move_edge(state, film, volume, radius, overlap, fresh, width):
    """Advances the edge and leaves a fresh film, or draws it back along the film that is there."""
    a = state[RADIUS_A]
    reach = np.sqrt(radius * max(overlap + fresh, 0.0))
    if reach > a:
        first, last = int(a / width) + 1, min(int(reach / width) + 1, len(film) - 1)
        for i in range(first, last + 1):
            film[i] = fresh
            volume[i] = volume[i - 1] + 0.5 * width * (film[i] + film[i - 1])
        a = reach
    while a > 0 and a**2 / radius - at(film, a, width) > overlap:
        inner = int(a / width - 1e-9) * width
        if inner**2 / radius - at(film, inner, width) > overlap and inner > 0:
            a = inner
            continue
        low, high = inner, a
        for _ in range(30):
            middle = 0.5 * (low + high)
            if middle**2 / radius - at(film, middle, width) > overlap:
                high = middle
            else:
                low = middle
        a = low
        break
    state[RADIUS_A] = a


@njit
def law_force(state, volume, law):
    """Force of one contact as it is."""
    radius, modulus, kappa, width = law[0], law[1], law[5][2], law[4]
    a = state[RADIUS_A]
    spacer = a * state[OVERLAP] - a**3 / (3 * radius) + at(volume, a, width)
    return 2 * modulus * (spacer + kappa * a * state[RIM])


class FilmLaw:
    """One contact by this law, from rest on a dry contact."""

    def __init__(self, radius, modulus, viscosity, largest, alpha=0.0, constants=CONSTANTS, nodes=400):
        width = np.sqrt(radius * largest * 1.5) / nodes
        self.law = (radius, modulus, viscosity, alpha, width, tuple(constants))
        self.s = width * np.arange(nodes + 1)
        self.film, self.volume = np.zeros(nodes + 1), np.zeros(nodes + 1)
        self.state = np.zeros(4)

    def start(self, overlap):
        self.state[:] = np.sqrt(self.law[0] * max(overlap, 0.0)), 0.0, overlap, 0.0
        return self

    def step(self, dt, overlap):
        """Moves to a new overlap; returns the force."""
        return law_step(self.state, self.film, self.volume, self.law, dt, overlap)

    def force(self):
        return law_force(self.state, self.volume, self.law)

    @property
    def dissipated(self):
        return self.state[DISSIPATED]

    def stored(self):
        """Energy of the bodies and of the rim."""
        a, y, overlap, _ = self.state
        inside = self.s < a
        part = np.append((overlap - self.s**2 / self.law[0] + self.film)[inside] ** 2, 0.0)
        ends = np.append(self.s[inside], a)
        return self.law[1] * (np.sum(0.5 * (part[1:] + part[:-1]) * np.diff(ends)) + self.law[5][2] * a * y**2)
