//! Shots without noise as functions of time, and the methods that time them.

use super::common::{Scene, normal};
use super::dry::Dry;
use crate::signal::{Method, Shape};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// From the record's start to the incident pulse's maximum.
const LEAD_S: f64 = 0.5e-3;
const DURATION_S: f64 = 2.6e-3;

/// A shot without noise, and when its maxima are after the incident one.
pub struct Source {
    pub name: &'static str,
    /// Signal at a time after the incident maximum, that maximum being 1 high.
    pub signal: Box<dyn Fn(f64) -> f64>,
    pub times_s: [f64; 3],
}

pub fn bells() -> Source {
    let scene = Scene::default();
    let pulses = [(0.0, 1.0, 46e-6), (760e-6, 1.6, 40e-6), (1560e-6, 0.47, 52e-6)];
    Source {
        name: "Bells, cos⁶, unlike in width (46, 40 and 52 µs)",
        signal: Box::new(move |t| {
            let one = |(at, height, width): &(f64, f64, f64)| {
                height * scene.shape.value((t - at) / width)
            };
            pulses.iter().map(one).sum()
        }),
        times_s: pulses.map(|pulse| pulse.0),
    }
}

pub fn dry_shot() -> Source {
    let dry = Dry::load();
    let first = Dry::MAXIMA_S[0];
    Source {
        name: "A computed dry shot at 0.5 m/s (46, 40 and 52 µs, skewed)",
        signal: Box::new(move |t| dry.summed(t + first)),
        times_s: Dry::MAXIMA_S.map(|t| t - first),
    }
}

/// As the command line has them.
pub fn methods() -> [(&'static str, Method); 4] {
    [
        ("local", Method::default()),
        ("onset", Method::Onset { fraction: 0.5 }),
        ("correlation", Method::CrossCorrelation),
        ("shape", Method::MatchedShape { shape: Shape::cos_power(6.0), width: 2.0 }),
    ]
}

impl Source {
    /// Samples in noise, the pulses anywhere between them.
    pub fn recorded(&self, interval_s: f64, noise: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
        let part = f64::from(rng.next_u32()) / f64::from(u32::MAX);
        let lead_s = LEAD_S + part * interval_s;
        let count = (DURATION_S / interval_s) as usize;
        let sample = |i: usize| {
            let clean = (self.signal)(i as f64 * interval_s - lead_s);
            clean + noise * normal(rng)
        };
        (0..count).map(sample).collect()
    }
}
