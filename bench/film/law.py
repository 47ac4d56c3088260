"""A reduced law of one oily contact: a trapped spacer that stores, and a squeezed rim that loses.

Contact of radius a between spheres of reduced radius R and modulus E*. The film H(s) that the edge left at radius s is a part of the
punch's shape, so that with V(a) = ∫ H ds

    F = 2 E* (a δ − a³/(3R) + V(a)) + 2 E* κ a y,   edge at δ + H(a) = a²/R,   H = β y where it advances,

and the rim y, an overlap that the oil at the edge still has to give way to, relaxes as an inlet of speed ȧ would:

    ẏ = δ̇ − (2E*/η) (κ a |y| / (c R^1.4))^{5/3} sign(y) − y ȧ/(2a),

with c = c₊ for y > 0 (squeezed) and c₋ for y < 0 (drawn). At a steady rate κ y = c (η δ̇/(2E*))^0.6 R^1.4/a = c times the inlet film
(η ȧ/E*)^0.6 R^0.8 a^−0.4. The last term keeps the energy E* κ a y² of the rim from growing with a alone.
Energy: F δ̇ = d/dt {E* ∫ (δ − s²/R + H)² ds + E* κ a y²} + 2 E* κ a y (2E*/η) (...)^{5/3}, whose last part is never negative.
"""

import numpy as np


# c₊, c₋, β and κ, fitted to contact.py over pulses of 1.5 to 12 µm in oils of 0.048 to 0.119 Pa s; pure numbers, the same for every contact.
CONSTANTS = (3.47, 0.185, 2.04, 2.41)


class FilmLaw:
    """State of one contact: radius, rim and trapped profile on fixed radii."""

    def __init__(self, radius, modulus, viscosity, largest, constants=CONSTANTS, nodes=400):
        self.radius, self.modulus, self.viscosity = radius, modulus, viscosity
        self.squeezed, self.drawn, self.beta, self.kappa = constants
        self.s = np.sqrt(radius * largest * 1.5) * np.arange(nodes + 1) / nodes
        self.width = self.s[1]
        self.film = np.zeros(nodes + 1)
        self.volume = np.zeros(nodes + 1)
        self.y, self.dissipated = 0.0, 0.0

    def start(self, overlap):
        self.overlap = overlap
        self.a = np.sqrt(self.radius * max(overlap, 0.0))
        return self

    def at(self, values, a):
        i = min(int(a / self.width), len(self.s) - 2)
        part = a / self.width - i
        return values[i] + part * (values[i + 1] - values[i])

    def relaxation(self, y, a):
        c = self.squeezed if y > 0 else self.drawn
        return np.sign(y) * 2 * self.modulus / self.viscosity * (self.kappa * a * abs(y) / (c * self.radius**1.4)) ** (5 / 3)

    def step(self, dt, overlap):
        """Moves to a new overlap; returns the force."""
        a = max(self.a, 1e-3 * self.width)
        move = overlap - self.overlap
        # Implicit in the relaxation, by bisection on a monotonic function.
        trial = self.y + move
        low, high = min(trial, 0.0), max(trial, 0.0)
        for _ in range(40):
            y = 0.5 * (low + high)
            if y + dt * self.relaxation(y, a) < trial:
                low = y
            else:
                high = y
        self.dissipated += dt * 2 * self.modulus * self.kappa * a * y * self.relaxation(y, a)
        self.y = y
        self.overlap = overlap
        self.move_edge()
        self.y *= np.sqrt(a / max(self.a, 1e-3 * self.width)) if self.a > a else 1.0
        return self.force()

    def move_edge(self):
        r, d = self.radius, self.overlap
        fresh = self.beta * max(self.y, 0.0)
        reach = np.sqrt(r * max(d + fresh, 0.0))
        if reach > self.a:
            first, last = int(self.a / self.width) + 1, min(int(reach / self.width) + 1, len(self.s) - 1)
            self.film[first : last + 1] = fresh
            for i in range(first, last + 1):
                self.volume[i] = self.volume[i - 1] + 0.5 * self.width * (self.film[i] + self.film[i - 1])
            self.a = reach
        while self.a > 0 and self.a**2 / r - self.at(self.film, self.a) > d:
            i = int(self.a / self.width - 1e-9)
            inner = self.s[i]
            if inner**2 / r - self.film[i] > d:
                self.a = inner
                continue
            low, high = inner, self.a
            for _ in range(30):
                middle = 0.5 * (low + high)
                low, high = (low, middle) if middle**2 / r - self.at(self.film, middle) > d else (middle, high)
            self.a = low

    def force(self):
        a, e = self.a, self.modulus
        return 2 * e * (a * self.overlap - a**3 / (3 * self.radius) + self.at(self.volume, a)) + 2 * e * self.kappa * a * self.y

    def stored(self):
        """Energy of the bodies and of the rim."""
        inside = self.s < self.a
        part = np.append((self.overlap - self.s**2 / self.radius + self.film)[inside] ** 2, 0.0)
        ends = np.append(self.s[inside], self.a)
        return self.modulus * (np.sum(0.5 * (part[1:] + part[:-1]) * np.diff(ends)) + self.kappa * self.a * self.y**2)
