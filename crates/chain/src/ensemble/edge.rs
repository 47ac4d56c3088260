//! A force that ends between two steps.
//!
//! Sums over samples integrate a smooth force to the order of the method, but
//! not one with an edge. Near an opening a contact force is
//! F = F₀ + c₁ s^{1/2} + c₃ s^{3/2} + …, s the time from the edge in steps. This
//! leading part is integrated exactly instead: each step that the edge
//! disturbs gets the difference between the exact integrals of the leading part and what the
//! method makes of its samples. What is left is smooth enough for the method.

use super::weights::{USED, Weights};

/// F₀, c₁, c₃ of a force near its edge, with s in steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leading {
    at_once: f64,
    root: f64,
    high: f64,
}

impl Leading {
    /// From the force as a function of the distance from its edge, in steps.
    pub(super) fn new(force: impl Fn(f64) -> f64) -> Self {
        let at_once = force(0.0);
        let (near, far) = (force(0.25) - at_once, force(1.0) - at_once);
        // near = c₁/2 + c₃/8, far = c₁ + c₃.
        let root = (8.0 * near - far) / 3.0;
        Self { at_once, root, high: far - root }
    }

    /// How large the force is a step from its edge.
    pub(super) fn size(&self) -> f64 {
        self.at_once.abs() + self.root.abs() + self.high.abs()
    }

    fn force(&self, s: f64) -> f64 {
        self.at_once + s.sqrt() * (self.root + self.high * s)
    }

    fn integral(&self, s: f64) -> f64 {
        s * (self.at_once + s.sqrt() * (self.root / 1.5 + self.high * s / 2.5))
    }

    /// ∫ (s − to) F(s) ds between two distances: how far a force that ends
    /// moves a body from one time to the other.
    fn moment(&self, from: f64, to: f64) -> f64 {
        let about_edge = |s: f64| {
            s * s * (self.at_once / 2.0 + s.sqrt() * (self.root / 2.5 + self.high * s / 3.5))
        };
        about_edge(from) - about_edge(to) - to * (self.integral(from) - self.integral(to))
    }
}

/// What disturbed steps lack, in units of h and h²: sums of force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Velocity and position of the step that holds the edge, then of those after it.
    pub lacking: [[f64; 2]; USED],
}

impl Edge {
    /// A force that ended `before` steps after the last sample that saw it, in
    /// steps that are `ahead` of the exact motion ([`super::weights::ahead_of`]).
    pub(super) fn ending(
        leading: &Leading,
        before: f64,
        (weights, ahead): (&Weights, f64),
    ) -> Self {
        let velocity = weights.velocity(ahead);
        let samples: [f64; USED] = std::array::from_fn(|k| leading.force(before + k as f64));
        let mut lacking = [[0.0; 2]; USED];
        for (age, lacking) in lacking.iter_mut().enumerate() {
            // Sample k is `age + k` steps old.
            for (k, sample) in samples.iter().enumerate().take(USED - age) {
                lacking[0] -= velocity[age + k] * sample;
                lacking[1] -= weights.position[age + k] * sample;
            }
        }
        // The step before it was predicted from samples nearer to the edge
        // than the method can see through.
        let [now, earlier] = [before, before + 1.0].map(|s| leading.integral(s));
        let mut predicted = [now - earlier, -leading.moment(before + 1.0, before)];
        for k in 0..USED {
            let sample = leading.force(before + 1.0 + k as f64);
            predicted[0] += weights.ahead[0][k] * sample;
            predicted[1] += weights.ahead[1][k] * sample;
        }
        let exact = [now, leading.moment(before, 0.0) + now * (1.0 - before)];
        lacking[0][0] += exact[0] - predicted[0];
        lacking[0][1] += exact[1] - predicted[1] - predicted[0];
        Self { lacking }
    }
}

#[cfg(test)]
#[path = "tests/edge.rs"]
mod tests;
