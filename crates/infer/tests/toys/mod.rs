//! Problems whose answers are known.
#![allow(dead_code, reason = "each test file takes the toys it needs")]

use hertzchain_infer::{ModelError, Parameter, Problem, Residuals};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// A curve y(x; θ) with measured points.
pub struct Curve<F> {
    pub parameters: Vec<Parameter>,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub sigma: Vec<f64>,
    pub model: F,
}

impl<F: Fn(&[f64], f64) -> f64 + Sync> Problem for Curve<F> {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn residual_count(&self) -> usize {
        self.y.len()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let at = |point: &Vec<f64>| {
            let rows = self.x.iter().zip(&self.y).zip(&self.sigma);
            let rows = rows.map(|((x, y), sigma)| (y - (self.model)(point, *x)) / sigma);
            Ok(Residuals::new(rows.collect()))
        };
        points.iter().map(at).collect()
    }
}

impl<F: Fn(&[f64], f64) -> f64 + Sync> Curve<F> {
    /// Points of the curve at `truth` with normal errors from a seed.
    pub fn drawn(
        parameters: Vec<Parameter>,
        x: &[f64],
        sigma: f64,
        truth: &[f64],
        seed: u64,
        model: F,
    ) -> Self {
        let noise = normals(seed, x.len());
        let y = x.iter().zip(noise).map(|(x, e)| model(truth, *x) + sigma * e);
        Self { parameters, x: x.to_vec(), y: y.collect(), sigma: vec![sigma; x.len()], model }
    }
}

/// Standard normal numbers from a seed.
pub fn normals(seed: u64, count: usize) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| StandardNormal.sample(&mut generator)).collect()
}

/// Equally spaced numbers.
pub fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    let step = (to - from) / (count - 1) as f64;
    (0..count).map(|i| from + step * i as f64).collect()
}

/// θ₀ + θ₁ x.
pub fn straight(point: &[f64], x: f64) -> f64 {
    point[0] + point[1] * x
}

/// θ₀ exp(−θ₁ x).
pub fn decay(point: &[f64], x: f64) -> f64 {
    point[0] * (-point[1] * x).exp()
}

/// Intercept, slope and their covariance by the normal equations, equal σ.
pub fn regression(x: &[f64], y: &[f64], sigma: f64) -> ([f64; 2], [[f64; 2]; 2]) {
    let n = x.len() as f64;
    let (sx, sy): (f64, f64) = (x.iter().sum(), y.iter().sum());
    let sxx: f64 = x.iter().map(|x| x * x).sum();
    let sxy: f64 = x.iter().zip(y).map(|(x, y)| x * y).sum();
    let determinant = n * sxx - sx * sx;
    let slope = (n * sxy - sx * sy) / determinant;
    let factor = sigma * sigma / determinant;
    let off = -sx * factor;
    ([(sy - slope * sx) / n, slope], [[sxx * factor, off], [off, n * factor]])
}
