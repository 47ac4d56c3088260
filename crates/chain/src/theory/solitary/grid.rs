//! Even functions on a periodic window, as samples and as cosine coefficients.
//!
//! The solitary wave falls off double-exponentially, so a window a few beads
//! wide is periodic to rounding, and the cosine series converges faster than
//! any power of the spacing.

use std::f64::consts::PI;

/// A window of `2 * half_window` beads with `per_bead` points a bead; only the
/// half with position >= 0 is stored.
pub(super) struct CosineGrid {
    half_window: usize,
    intervals: usize,
    per_bead: usize,
    /// cos(pi k / intervals) for k in 0..2 intervals.
    cosines: Vec<f64>,
}

impl CosineGrid {
    pub(super) fn new(half_window: usize, per_bead: usize) -> Self {
        let intervals = half_window * per_bead;
        let cosines =
            (0..2 * intervals).map(|k| (PI * k as f64 / intervals as f64).cos()).collect();
        Self { half_window, intervals, per_bead, cosines }
    }

    /// Positions of the samples, in beads from the centre.
    pub(super) fn positions(&self) -> impl Iterator<Item = f64> + '_ {
        (0..=self.intervals).map(|j| j as f64 / self.per_bead as f64)
    }

    /// Wave number of a mode, radians per bead.
    pub(super) fn wavenumber(&self, mode: usize) -> f64 {
        PI * mode as f64 / self.half_window as f64
    }

    /// Coefficients a_m of f(x) = sum a_m cos(k_m x) through the samples.
    pub(super) fn coefficients(&self, samples: &[f64]) -> Vec<f64> {
        let weighted = self.halve_ends(samples);
        let mut coefficients = self.cosine_sums(&weighted);
        let scale = 2.0 / self.intervals as f64;
        coefficients.iter_mut().for_each(|a| *a *= scale);
        self.halve_ends(&coefficients)
    }

    /// Samples of the function with the given coefficients.
    pub(super) fn samples(&self, coefficients: &[f64]) -> Vec<f64> {
        self.cosine_sums(coefficients)
    }

    /// Integral over the whole window; the trapezoidal rule is spectrally
    /// exact here because the integrand is smooth and vanishes at the ends.
    pub(super) fn integral(&self, samples: impl Iterator<Item = f64>) -> f64 {
        let ends = self.intervals;
        let sum: f64 =
            samples.enumerate().map(|(j, f)| if j == 0 || j == ends { f } else { 2.0 * f }).sum();
        sum / self.per_bead as f64
    }

    fn halve_ends(&self, values: &[f64]) -> Vec<f64> {
        let last = self.intervals;
        let half_at_ends = |(j, f): (usize, &f64)| if j == 0 || j == last { 0.5 * f } else { *f };
        values.iter().enumerate().map(half_at_ends).collect()
    }

    /// sum_j g_j cos(pi m j / intervals) for every m. Direct: a few hundred
    /// points do not repay a fast transform.
    fn cosine_sums(&self, values: &[f64]) -> Vec<f64> {
        let period = self.cosines.len();
        (0..=self.intervals)
            .map(|mode| {
                let mut phase = 0;
                let mut sum = 0.0;
                for value in values {
                    sum += value * self.cosines[phase];
                    phase += mode;
                    if phase >= period {
                        phase -= period;
                    }
                }
                sum
            })
            .collect()
    }
}
