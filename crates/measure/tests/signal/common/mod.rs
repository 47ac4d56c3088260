//! Synthetic records: three bells in noise.
#![allow(dead_code, reason = "each test file uses a part of it")]

use crate::signal::{Channels, Shape};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A shot whose pulses' times, heights and widths are known.
#[derive(Clone, Debug)]
pub struct Scene {
    pub interval_s: f64,
    pub samples: usize,
    /// Time in s, height, full width at half maximum in s; passing, wall, returning.
    pub pulses: [(f64, f64, f64); 3],
    pub shape: Shape,
    pub offset: f64,
    pub sign: f64,
    pub noise: f64,
    pub seed: u64,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            interval_s: 1e-6,
            samples: 4000,
            pulses: [
                (0.800_123e-3, 1.0, 60e-6),
                (1.500_457e-3, 1.6, 52e-6),
                (2.280_789e-3, 0.45, 66e-6),
            ],
            shape: Shape::cos_power(6.0),
            offset: 0.0,
            sign: 1.0,
            noise: 0.0,
            seed: 1,
        }
    }
}

impl Scene {
    fn channel(&self, which: &[usize], stream: u64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(stream);
        let pulse = |t: f64| -> f64 {
            let one = |k: &usize| {
                let (at, height, width) = self.pulses[*k];
                height * self.shape.value((t - at) / width)
            };
            which.iter().map(one).sum()
        };
        let sample = |i: usize| {
            let clean = pulse(i as f64 * self.interval_s);
            self.offset + self.sign * clean + self.noise * normal(&mut rng)
        };
        (0..self.samples).map(sample).collect()
    }

    pub fn summed(&self) -> Vec<f64> {
        self.channel(&[0, 1, 2], 0)
    }

    /// Sensor and wall.
    pub fn separate(&self) -> (Vec<f64>, Vec<f64>) {
        (self.channel(&[0, 2], 0), self.channel(&[1], 1))
    }

    pub fn incident_s(&self) -> f64 {
        self.pulses[1].0 - self.pulses[0].0
    }

    pub fn reflected_s(&self) -> f64 {
        self.pulses[2].0 - self.pulses[1].0
    }
}

pub fn channels(pair: &(Vec<f64>, Vec<f64>)) -> Channels<'_> {
    Channels::Separate { sensor: &pair.0, wall: &pair.1 }
}

/// A standard normal number, by Box and Muller.
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let uniform = |rng: &mut ChaCha8Rng| (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let radius = (-2.0 * (1.0 - uniform(rng)).ln()).sqrt();
    radius * (std::f64::consts::TAU * uniform(rng)).cos()
}
