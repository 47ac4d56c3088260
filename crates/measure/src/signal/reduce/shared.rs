//! The part of errors that repeated shots have in common.

use crate::signal::Moved;

/// Error of a mean time that lies between two pulses by what may have moved either in all shots
/// alike, one pair a shot: noise among what lies under them, which has signs, averages out, what
/// stands there in every shot and what is open of the shapes does not. 0 without shots.
#[must_use]
pub fn shared(moved: &[[Moved; 2]]) -> f64 {
    let count = moved.len().max(1) as f64;
    let mean = |of: &dyn Fn(&[Moved; 2]) -> f64| moved.iter().map(of).sum::<f64>() / count;
    let under = |pulse: usize| mean(&|both| both[pulse].under_s);
    let shape = |pulse: usize| mean(&|both| both[pulse].shape_s);
    let parts = [under(0), under(1), shape(0), shape(1)];
    parts.into_iter().fold(0.0, f64::hypot)
}

/// A shot's error without what may have moved its two pulses.
#[must_use]
pub fn alone(sigma: f64, moved: [Moved; 2]) -> f64 {
    let of = |one: Moved| one.under_s.powi(2) + one.shape_s.powi(2);
    (sigma.powi(2) - of(moved[0]) - of(moved[1]))
        .max(0.0)
        .sqrt()
}
