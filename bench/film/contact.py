"""Transient elastohydrodynamic contact of two elastic spheres with oil between them, axisymmetric, in SI units.

Gap: h(r) = r²/(2R) − δ + ∫ C(r, s) p(s) ds, with δ > 0 for overlap as in docs/reference/conventions.md and C the exact deflection
of two half-spaces under uniformly loaded rings. Oil content m = h − c per unit area, where c ≥ 0 is the thickness of vapour and
p ≥ 0 the pressure: p c = 0 (mass-conserving cavitation at ambient pressure). Reynolds: ∂m/∂t = (1/r) ∂/∂r (r h³/(12 η(p)) ∂p/∂r).
A ring without oil (m = 0) has either vapour (c = h) or solid contact (h = 0, p > 0), so the dry contact is the same problem.

Backward Euler in time and full Newton on the pressures of the wet rings; c follows from its own ring. Nothing is shared with the Rust program.
"""

import numpy as np
from scipy.linalg import lapack
from scipy.special import ellipe, ellipk


class NoConvergence(RuntimeError):
    """Newton's iteration did not converge within one step."""


def disc_deflection(r, radius, modulus):
    """Deflection at r of half-spaces of combined modulus E* = 1/(D1 + D2) under unit pressure on a disc [Johnson 1985, 3.29]."""
    r, radius = np.broadcast_arrays(np.asarray(r, float), np.asarray(radius, float))
    out = np.zeros(r.shape)
    inside = (r < radius) & (radius > 0)
    k = (r[inside] / radius[inside]) ** 2
    out[inside] = radius[inside] * ellipe(k)
    outside = (r >= radius) & (radius > 0)
    k = (radius[outside] / r[outside]) ** 2
    with np.errstate(invalid="ignore"):
        tail = np.where(k < 1, (1 - k) * ellipk(k), 0.0)
    out[outside] = r[outside] * (ellipe(k) - tail)
    return 4 / (np.pi * modulus) * out


class Isoviscous:
    """η independent of pressure."""

    def potential(self, p):
        """(q, dq/dp) with dq = η(0)/η(p) dp, so that the flux is exactly proportional to the gradient of q."""
        return p, np.ones_like(p)


class Barus:
    """η = η0 exp(α p)."""

    def __init__(self, alpha):
        self.alpha = alpha

    def potential(self, p):
        return -np.expm1(-self.alpha * p) / self.alpha, np.exp(-self.alpha * p)


class Roelands:
    """η = η0 exp{(ln η0 + 9.67) [(1 + p/0.196 GPa)^Z − 1]}, with Z from the slope α at ambient pressure."""

    def __init__(self, alpha, viscosity, largest=2e10):
        self.log = np.log(viscosity) + 9.67
        self.z = alpha * 0.1961e9 / self.log
        self.nodes = np.concatenate([[0], np.geomspace(1e3, largest, 20000)])
        slope = self.slope(self.nodes)
        # Simpson on each interval: nodes are 1 ‰ apart, so the potential is right to about 1e-12.
        middle = self.slope(0.5 * (self.nodes[1:] + self.nodes[:-1]))
        parts = np.diff(self.nodes) / 6 * (slope[1:] + slope[:-1] + 4 * middle)
        self.sums = np.concatenate([[0], np.cumsum(parts)])

    def slope(self, p):
        return np.exp(-self.log * ((1 + p / 0.1961e9) ** self.z - 1))

    def potential(self, p):
        i = np.clip(np.searchsorted(self.nodes, p, side="right") - 1, 0, len(self.nodes) - 2)
        left = self.nodes[i]
        ends, middle = self.slope(left) + self.slope(p), self.slope(0.5 * (left + p))
        return self.sums[i] + (p - left) / 6 * (ends + 4 * middle), self.slope(p)


def graded_faces(inner, rings, outer, growth=1.06):
    """Ring edges: `rings` equal ones up to `inner`, then each wider by `growth` until `outer`."""
    width = inner / rings
    faces = list(np.linspace(0, inner, rings + 1))
    while faces[-1] < outer:
        width *= growth
        faces.append(faces[-1] + width)
    return np.array(faces)


class Grid:
    """Rings, their elastic influence and the geometry of their faces."""

    def __init__(self, faces, modulus):
        self.faces = np.asarray(faces, float)
        self.r = 0.5 * (self.faces[1:] + self.faces[:-1])
        self.area = np.pi * np.diff(self.faces**2)
        discs = disc_deflection(self.r[:, None], self.faces[None, :], modulus)
        self.influence = np.ascontiguousarray(np.diff(discs, axis=1))
        # 2π r_f / (r_{i+1} − r_i) of the faces between rings, and of the outer edge, which is at ambient pressure.
        self.conductance = 2 * np.pi * self.faces[1:-1] / np.diff(self.r)
        self.outer = 2 * np.pi * self.faces[-1] / (self.faces[-1] - self.r[-1])


class Contact:
    """One contact and its state: pressure p, vapour thickness c and oil content m of every ring."""

    def __init__(self, grid, radius, viscosity, law=None, open_edge=True, cavitates=True):
        self.grid, self.radius, self.viscosity = grid, radius, viscosity
        self.law = law or Isoviscous()
        self.open_edge, self.cavitates = open_edge, cavitates
        self.sphere = grid.r**2 / (2 * radius)
        self.p = np.zeros_like(grid.r)
        self.m = np.zeros_like(grid.r)
        self.overlap = None
        self.lost = self.dissipated = 0.0
        self.iterations = 0

    def gap(self, p=None, overlap=None):
        p = self.p if p is None else p
        overlap = self.overlap if overlap is None else overlap
        return self.sphere - overlap + self.grid.influence @ p

    def force(self, p=None):
        return self.grid.area @ (self.p if p is None else p)

    def elastic_energy(self):
        """½ ∫ p w dA: energy of both bodies."""
        return 0.5 * (self.grid.area * self.p) @ (self.grid.influence @ self.p)

    def start(self, overlap, thickness=np.inf, trapped=0.0, volume=np.inf):
        """Rest at an overlap (negative: separated) on a film of `trapped` in the contact, oil up to `thickness` outside.

        `volume` of oil fills the gap from the contact's edge outward; beyond it there is none.
        """
        self.overlap = overlap
        self.p = np.zeros_like(self.p)
        self.m = np.full_like(self.p, trapped)
        if overlap > 0:
            inside = self.grid.r**2 < self.radius * overlap
            self.p[inside] = 2 * np.sqrt(overlap / self.radius - (self.grid.r[inside] / self.radius) ** 2) / np.pi / self.grid_compliance()
            self.step(1.0, self.overlap, still=True)
        self.m = np.minimum(self.gap(), np.maximum(thickness, trapped))
        self.m = np.maximum(self.m, 0.0)
        if volume < np.inf:
            inner = np.concatenate([[0.0], np.cumsum(self.m * self.grid.area)])
            self.m = np.clip(volume - inner[:-1], 0.0, self.m * self.grid.area) / self.grid.area
        return self

    def grid_compliance(self):
        """1/E*, from the deflection under the outermost disc."""
        return self.grid.influence[0].sum() / disc_deflection(self.grid.r[0], self.grid.faces[-1], 1.0)

    def fluxes(self, p, h):
        """Flux outward through inner faces, with its derivatives by the h and p of both sides, and through the outer edge."""
        q, slope = self.law.potential(p)
        cubes = np.maximum(h, 0.0)
        between = 0.5 * (cubes[1:] + cubes[:-1])
        factor = self.grid.conductance / (12 * self.viscosity)
        drop = q[:-1] - q[1:]
        flux = factor * between**3 * drop
        by_h = 1.5 * factor * between**2 * drop
        by_left, by_right = factor * between**3 * slope[:-1], -factor * between**3 * slope[1:]
        edge = self.grid.outer / (12 * self.viscosity) * cubes[-1] ** 3 * self.open_edge
        return flux, by_h * (h[:-1] > 0), by_h * (h[1:] > 0), by_left, by_right, edge * q[-1], edge * slope[-1]

    def residual(self, p, h, content, dt, still):
        """Gain of oil less inflow of each ring if it has no vapour, in m³/s."""
        parts = None if still else self.fluxes(p, h)
        out = self.grid.area * (h - content) / dt
        if parts:
            flux = parts[0]
            out[:-1] += flux
            out[1:] -= flux
            out[-1] += parts[5]
        return out, parts

    def jacobian(self, parts, dt):
        """d residual / d p."""
        grid = self.grid
        j = grid.influence * (grid.area / dt)[:, None]
        if parts:
            _, by_h0, by_h1, by_left, by_right, _, edge = parts
            change = by_h0[:, None] * grid.influence[:-1] + by_h1[:, None] * grid.influence[1:]
            j[:-1] += change
            j[1:] -= change
            n = len(grid.r)
            i = np.arange(n - 1)
            j[i, i] += by_left
            j[i + 1, i] -= by_left
            j[i, i + 1] += by_right
            j[i + 1, i + 1] -= by_right
            j[-1, -1] += edge
        return j

    def step(self, dt, overlap=None, still=False, motion=None, tolerance=1e-11, most=60):
        """One backward Euler step to `overlap`, or with `motion` = (mass, velocity) to where the force and inertia put it.

        `motion` uses the trapezoidal rule for the body. Returns the new velocity then.
        """
        grid, content = self.grid, self.m
        p, d = self.p.copy(), self.overlap if overlap is None else overlap
        if motion:
            mass, velocity = motion
            before = self.force()
            d = self.overlap + dt * velocity - 0.5 * dt**2 * before / mass
        wet = (p > 0) | (not self.cavitates)
        scale = grid.area * max(abs(self.overlap), abs(d), 1e-9) / dt
        for count in range(most):
            h = self.gap(p, d)
            full, parts = self.residual(p, h, content, dt, still)
            # A ring with vapour has c = residual/area·dt ≥ 0; one whose vapour would be negative is full.
            wet_now = wet | (full < -1e-13 * scale)
            error = np.abs(full[wet_now] / scale[wet_now]).max() if wet_now.any() else 0.0
            slack = 0.0
            if motion:
                slack = d - self.overlap - dt * velocity + 0.25 * dt**2 * (before + self.force(p)) / mass
                error = max(error, abs(slack) / max(abs(d), 1e-9))
            if error < tolerance and np.array_equal(wet, wet_now):
                break
            wet = wet_now
            change, move = self.newton(full, parts, wet, dt, motion and (0.25 * dt**2 / mass, slack), still)
            p = p + change
            d = d + move
            dry = wet & (p <= 0) & self.cavitates
            p[dry] = 0.0
            wet = wet & ~dry
        else:
            raise NoConvergence(f"Newton's iteration: error {error:.1e} after {most} iterations at overlap {d:.3e} m, step {dt:.1e} s")
        self.iterations += count
        self.p = p
        self.m = np.maximum(np.where(wet, self.gap(p, d), self.gap(p, d) - full / grid.area * dt), 0.0)
        self.overlap = d
        if parts:
            self.lost += parts[5] * dt
            self.dissipated += dt * (parts[0] @ (p[:-1] - p[1:]) + parts[5] * p[-1])
        if motion:
            return velocity - 0.5 * dt * (before + self.force()) / mass
        return None

    def newton(self, full, parts, wet, dt, motion, still):
        """Changes of the pressures of full rings and of the overlap."""
        change = np.zeros_like(full)
        j = self.jacobian(parts, dt)
        index = np.flatnonzero(wet)
        a = j[np.ix_(index, index)]
        columns = -full[index][:, None]
        if motion:
            by_overlap = -self.grid.area / dt
            if parts:
                by_h = parts[1] + parts[2]
                by_overlap[:-1] -= by_h
                by_overlap[1:] += by_h
            columns = np.column_stack([-full[index], -by_overlap[index]])
        solved = lapack.dgesv(a, columns)[2] if len(index) else columns
        if not motion:
            change[index] = solved[:, 0]
            return change, 0.0
        # d is eliminated: slack + move + weight · area · change = 0, change = s0 + s1 · move.
        weight, slack = motion
        area = weight * self.grid.area[index]
        move = -(slack + area @ solved[:, 0]) / (1 + area @ solved[:, 1])
        change[index] = solved[:, 0] + solved[:, 1] * move
        return change, move


def drive(contact, times, overlaps, watch=None):
    """Steps along overlaps(t); returns rows of time, overlap, force, mean film within √(Rδ), central film, elastic energy."""
    rows = [report(contact, times[0])]
    for before, now, overlap in zip(times[:-1], times[1:], overlaps[1:]):
        advance(contact, before, now, overlap)
        rows.append(report(contact, now))
        if watch:
            watch(contact, now)
    return np.array(rows)


def advance(contact, before, now, overlap, depth=0):
    """One step; halved where Newton's iteration fails."""
    kept = contact.p, contact.m, contact.overlap
    try:
        contact.step(now - before, overlap)
    except NoConvergence:
        if depth > 8:
            raise
        contact.p, contact.m, contact.overlap = kept
        middle = 0.5 * (contact.overlap + overlap)
        advance(contact, before, 0.5 * (before + now), middle, depth + 1)
        advance(contact, 0.5 * (before + now), now, overlap, depth + 1)


def collide(contact, mass, speed, step, apart):
    """Restitution of a body that meets the contact at `speed`, from the contact's overlap until −overlap exceeds `apart`; and all rows."""
    time, velocity, rows = 0.0, speed, []
    while velocity > 0 or contact.overlap > -apart:
        velocity = contact.step(step, motion=(mass, velocity))
        time += step
        rows.append((*report(contact, time), velocity))
        if abs(velocity) < 1e-4 * speed and contact.overlap < -0.5 * apart:
            break
    return -velocity / speed, np.array(rows)


def report(contact, time):
    h = contact.gap()
    inside = contact.grid.r**2 < contact.radius * contact.overlap
    area = contact.grid.area[inside]
    mean = area @ h[inside] / area.sum() if inside.any() else h[0]
    return time, contact.overlap, contact.force(), mean, h[0], contact.elastic_energy()
