//! The multistep method as numbers: a schedule of weights.
//!
//! A step knows the acceleration at its start, computed at predicted
//! positions and velocities, and those of the steps before. The polynomial
//! through them corrects the step that has just been made and predicts the
//! next one; both are double integrals, so that positions keep the order of
//! velocities (the predictor–corrector pairs of Adams and Störmer–Cowell
//! [HairerNorsettWanner1993, III.1 and III.10], one evaluation a step).

use std::sync::LazyLock;

/// Accelerations of earlier steps that a step uses.
pub(super) const EARLIER: usize = 4;

/// Accelerations that a step uses: its own and earlier ones.
pub(super) const USED: usize = EARLIER + 1;

/// The first step in units of the full one: an impact begins with forces that
/// grow as the root of time.
const FIRST_STEP: f64 = 1e-3;

/// Each step at the start is longer than the one before it by this factor.
const GROWTH: f64 = 1.2;

/// In long steps a pulse runs ahead of the exact one, whatever the law, by about
/// as much as this times the fourth power of the step (in contact times), times
/// the newest acceleration less what earlier ones extrapolate to, takes back
/// from a velocity. That is four orders beyond the method's own.
const RUNS_AHEAD: f64 = -2.6;

pub(super) fn ahead_of(step: f64) -> f64 {
    RUNS_AHEAD * step.powi(4)
}

/// How a step turns accelerations into motion. With vp, xp predicted for now
/// and accelerations a_0 (now), a_1, … (earlier), in units of the full step h:
/// vp' = vp + h Σ velocity[k] a_k, xp' = xp + drift h vp + h² Σ position[k] a_k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weights {
    pub velocity: [f64; USED],
    pub position: [f64; USED],
    /// Length of the step to come.
    pub drift: f64,
    /// The newest acceleration less what earlier ones extrapolate to, for
    /// [`ahead_of`]: what this sum times that adds to a velocity.
    pub surprise: [f64; USED],
    /// h Σ residual[k] a_k is what correcting changes a velocity by.
    pub residual: [f64; USED],
    /// The prediction alone: vp' = v + h Σ ahead[k] a_k from a corrected v,
    /// and the same with h² for positions.
    pub ahead: [[f64; USED]; 2],
}

impl Weights {
    /// Weights of velocities in steps that are `ahead` of the exact motion.
    pub(super) fn velocity(&self, ahead: f64) -> [f64; USED] {
        std::array::from_fn(|k| self.velocity[k] + ahead * self.surprise[k])
    }
}

/// The weights of every step from rest: growing steps first, then the last
/// row for ever.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    rows: Vec<Weights>,
    /// Times of the rows' steps, in full steps.
    times: Vec<f64>,
}

impl Schedule {
    pub(super) fn shared() -> &'static Self {
        static SCHEDULE: LazyLock<Schedule> = LazyLock::new(Schedule::new);
        &SCHEDULE
    }

    pub(super) fn new() -> Self {
        let lengths = step_lengths();
        let mut times = vec![0.0];
        for length in &lengths {
            times.push(times[times.len() - 1] + length);
        }
        let rows = lengths.iter().enumerate();
        let rows = rows.map(|(n, &length)| weights(&times[..=n], length)).collect();
        Self { rows, times }
    }

    pub(super) fn row(&self, n: usize) -> &Weights {
        &self.rows[n.min(self.rows.len() - 1)]
    }

    pub(super) fn steady(&self) -> &Weights {
        &self.rows[self.rows.len() - 1]
    }

    /// From this row on they are all the same.
    pub(super) fn last_row(&self) -> usize {
        self.rows.len() - 1
    }

    pub(super) fn first_full_step(&self) -> usize {
        self.rows.len() - USED - 1
    }

    pub(super) fn time(&self, n: usize) -> f64 {
        let last = self.times.len() - 1;
        match self.times.get(n) {
            Some(&time) => time,
            None => self.times[last] + (n - last) as f64,
        }
    }
}

/// Growing steps, then full ones until all that are used are full.
fn step_lengths() -> Vec<f64> {
    let growing = (0..).map(|j| FIRST_STEP * GROWTH.powi(j));
    let mut lengths: Vec<f64> = growing.take_while(|&length| length < 1.0).collect();
    lengths.extend([1.0; USED + 1]);
    lengths
}

/// Weights at the last of the times given, for a next step of some length.
fn weights(times: &[f64], length: f64) -> Weights {
    let now = times[times.len() - 1];
    // Nodes relative to now, newest first.
    let nodes: Vec<f64> = times.iter().rev().take(USED).map(|t| t - now).collect();
    let mut weights = Weights {
        velocity: [0.0; USED],
        position: [0.0; USED],
        drift: length,
        surprise: [0.0; USED],
        residual: [0.0; USED],
        ahead: [[0.0; USED]; 2],
    };
    if nodes.len() > 1 {
        correct(&mut weights, &nodes);
    }
    predict(&mut weights, &nodes[..nodes.len().min(EARLIER)]);
    weights
}

/// Adds the correction of the step that ends now: what the new acceleration
/// differs from its extrapolation by, times integrals of its basis polynomial.
fn correct(weights: &mut Weights, nodes: &[f64]) {
    let basis = basis(nodes, 0);
    let (sped, moved) = integrals(&basis, nodes[1], 0.0);
    let drifted = moved + weights.drift * sped;
    let earlier = &nodes[1..];
    for k in 0..nodes.len() {
        let difference = match k {
            0 => 1.0,
            _ => -value(&self::basis(earlier, k - 1), 0.0),
        };
        weights.surprise[k] = weights.drift.powi(5) * difference;
        weights.residual[k] = sped * difference;
        weights.velocity[k] += sped * difference;
        weights.position[k] += drifted * difference;
    }
}

/// Adds the prediction of the step that begins now.
fn predict(weights: &mut Weights, nodes: &[f64]) {
    for k in 0..nodes.len() {
        let (sped, moved) = integrals(&basis(nodes, k), 0.0, weights.drift);
        weights.velocity[k] += sped;
        weights.position[k] += moved;
        weights.ahead[0][k] = sped;
        weights.ahead[1][k] = moved;
    }
}

/// Coefficients of the polynomial that is 1 at one node and 0 at the others.
fn basis(nodes: &[f64], at: usize) -> Vec<f64> {
    let mut coefficients = vec![1.0];
    for (k, node) in nodes.iter().enumerate().filter(|(k, _)| *k != at) {
        let scale = (nodes[at] - nodes[k]).recip();
        let mut product = vec![0.0; coefficients.len() + 1];
        for (power, c) in coefficients.iter().enumerate() {
            product[power + 1] += c * scale;
            product[power] -= c * node * scale;
        }
        coefficients = product;
    }
    coefficients
}

fn value(coefficients: &[f64], at: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * at + c)
}

/// ∫ p(s) ds and ∫ (to − s) p(s) ds between two times, one of which is 0.
fn integrals(coefficients: &[f64], from: f64, to: f64) -> (f64, f64) {
    let (mut once, mut moment) = (0.0, 0.0);
    for (power, c) in coefficients.iter().enumerate() {
        let n = power as i32;
        once += c * (to.powi(n + 1) - from.powi(n + 1)) / f64::from(n + 1);
        moment += c * (to.powi(n + 2) - from.powi(n + 2)) / f64::from(n + 2);
    }
    (once, to * once - moment)
}

#[cfg(test)]
#[path = "tests/weights.rs"]
mod tests;
