//! Where a template correlates best with the signal.

use super::local_model;
use super::{Moved, Picked, Sight, Template};
use crate::Pulse;
use crate::delay::{largest, quartic_maximum};
use crate::error::SignalError;
use crate::running;

/// Half the length of a template, in full widths at half maximum: a bell is
/// down to some 10⁻⁴ there.
const REACH: f64 = 1.4;
/// Length of the running means that smooth a noisy template, in full widths: without
/// them noise of the template times noise of the signal spoils the correlation,
/// and with them hardly any of the pulse is lost.
const SMOOTHING: f64 = 0.2;

/// A template. An offset of the signal adds the same to its correlation at all
/// lags, and so does not matter.
pub(super) struct Correlator {
    template: Vec<f64>,
    /// Samples from the template's first to its own maximum.
    top: f64,
    /// Slope energy Σ s'² of a template scaled to height 1, per sample squared.
    energy: f64,
    /// Deviation of the delay by products of noises, for a pulse and noise of 1.
    products: f64,
    /// The record's own pulse, and so as noisy: its time is its maximum's.
    own: Option<Own>,
}

struct Own {
    at: usize,
    picked: Picked,
}

impl Correlator {
    pub(super) fn new(
        template: &Template,
        sensor: &Sight<'_>,
        passing: &Pulse,
        interval_s: f64,
    ) -> Result<Self, SignalError> {
        match template {
            Template::Passing => Self::passing(sensor, passing),
            Template::Shape(shape) => Ok(Self::shape(shape, passing.width_samples)),
            Template::Fixed(shape, width_s) => {
                let width = width_s / interval_s;
                let longest = sensor.samples.len() as f64;
                let good = (2.0..longest).contains(&width);
                good.then(|| Self::shape(shape, width))
                    .ok_or(SignalError::Option {
                        name: "width of the template in samples",
                        value: width,
                        expected: "from 2 to the length of the record",
                    })
            }
        }
    }

    fn shape(shape: &super::Shape, width: f64) -> Self {
        let half = (REACH * width).ceil();
        let count = 2 * half as usize + 1;
        let samples = (0..count).map(|i| shape.value((i as f64 - half) / width));
        Self::of(samples.collect(), half, 1.0)
    }

    fn passing(sensor: &Sight<'_>, pulse: &Pulse) -> Result<Self, SignalError> {
        let picked = local_model::roughly(sensor, pulse)?;
        let reach = REACH * pulse.width_samples;
        let at = picked.time_s;
        let (first, heights) = sensor.window(at - reach, at + reach);
        let length = (SMOOTHING * pulse.width_samples) as usize | 1;
        let smooth = running::triangle(&heights, length);
        let correlator = Self::of(smooth, at - first as f64, picked.height);
        let noise = sensor.upright.level.noise / picked.height;
        // Slopes of the smoothed noise have 2/length³ of its variance a sample.
        let slopes = noise * (2.0 * heights.len() as f64).sqrt() / (length as f64).powf(1.5);
        Ok(Self {
            products: slopes / correlator.energy,
            own: Some(Own {
                at: pulse.at,
                picked,
            }),
            ..correlator
        })
    }

    fn of(samples: Vec<f64>, top: f64, height: f64) -> Self {
        let slopes = samples.windows(3).map(|three| 0.5 * (three[2] - three[0]));
        let squares: f64 = slopes.map(|s| s * s).sum();
        Self {
            energy: squares / (height * height),
            template: samples,
            top,
            products: 0.0,
            own: None,
        }
    }

    /// Time in samples. Variance: noise²/Σ s'² of the pulse; as much again of
    /// the template if that is the record's own, counted at the passing pulse,
    /// whose noise is common to all delays against it; and what noise of the
    /// one times noise of the other adds.
    pub(super) fn pick(&self, sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
        let at_top = local_model::roughly(sight, pulse)?;
        let noise = sight.broad_noise(pulse);
        let sigma_s = noise / (at_top.height.abs() * self.energy.sqrt());
        if let Some(own) = self.own.as_ref().filter(|own| own.at == pulse.at) {
            return Ok(Picked {
                sigma_s,
                moved: Moved::default(),
                misfit: None,
                ..own.picked
            });
        }
        let time_s = self.best(sight, pulse).ok_or(SignalError::NoPick {
            place: pulse.place,
            what: "largest correlation",
        })?;
        Ok(Picked {
            time_s,
            sigma_s: sigma_s.hypot(noise * self.products / at_top.height.abs()),
            moved: Moved::default(),
            misfit: None,
            ..at_top
        })
    }

    /// Where the template's maximum lies when the correlation is largest.
    fn best(&self, sight: &Sight<'_>, pulse: &Pulse) -> Option<f64> {
        let search = (0.5 * pulse.width_samples).ceil() + 3.0;
        let length = self.template.len();
        let start = (pulse.at as f64 - self.top - search).round();
        let lags = 2 * search as usize + 1;
        let heights = padded(sight, start, length + lags);
        let correlations: Vec<f64> = (0..lags)
            .map(|lag| product(&self.template, &heights[lag..]))
            .collect();
        let best = largest(&correlations)?;
        let around = best.checked_sub(2)?..best + 3;
        let five: [f64; 5] = correlations.get(around)?.try_into().ok()?;
        Some(start + best as f64 + quartic_maximum(five) + self.top)
    }
}

/// Heights from sample `start` on; 0 outside the record.
fn padded(sight: &Sight<'_>, start: f64, count: usize) -> Vec<f64> {
    let height = |i: usize| {
        let at = start + i as f64;
        let sample = (at >= 0.0)
            .then(|| sight.samples.get(at as usize))
            .flatten();
        sample.map_or(0.0, |x| sight.upright.height(*x))
    };
    (0..count).map(height).collect()
}

fn product(template: &[f64], heights: &[f64]) -> f64 {
    template.iter().zip(heights).map(|(a, b)| a * b).sum()
}
