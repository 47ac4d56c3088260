//! The part of errors that repeated shots have in common.

/// Error of a mean time that lies between two pulses by what may have moved either, one pair
/// a shot with its signs: noise among these averages out, what stands under the pulses of
/// every shot does not. 0 without shots.
#[must_use]
pub fn shared(moved: &[[f64; 2]]) -> f64 {
    let count = moved.len().max(1) as f64;
    let mean = |pulse: usize| moved.iter().map(|both| both[pulse]).sum::<f64>() / count;
    mean(0).hypot(mean(1))
}

/// A shot's error without what may have moved its two pulses.
#[must_use]
pub fn alone(sigma: f64, moved: [f64; 2]) -> f64 {
    let squares = sigma.powi(2) - moved[0].powi(2) - moved[1].powi(2);
    squares.max(0.0).sqrt()
}
