//! Where a template correlates best with the signal.

use super::local_model;
use super::{Moved, Picked, Sight, Template};
use crate::signal::Pulse;
use crate::signal::delay::{largest, quartic_maximum};
use crate::signal::error::SignalError;
use crate::signal::running;

/// Half the length of a template, in full widths at half maximum: a bell is
/// down to some 10⁻⁴ there.
const REACH: f64 = 1.4;
/// Length of the running means that smooth a noisy template, in full widths: without
/// them noise of the template times noise of the signal spoils the correlation,
/// and with them hardly any of the pulse is lost.
const SMOOTHING: f64 = 0.2;
/// Lags, as a share of a template's length, between which the bend of a correlation is taken: a
/// third of a width or so, over which noise does not hide it and a bell's falls short of it by 6 %.
const APART: f64 = 0.3 / (2.0 * REACH);
/// Least share of a template's slopes squared that is taken for the pulse's, not noise's.
const LEAST: f64 = 0.25;

/// A template. An offset of the signal adds the same to its correlation at all
/// lags, and so does not matter.
pub(super) struct Correlator {
    template: Vec<f64>,
    /// Samples from the template's first to its own maximum.
    top: f64,
    /// Σ t'² over its samples.
    slopes: f64,
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
        Self::of(samples.collect(), half)
    }

    fn passing(sensor: &Sight<'_>, pulse: &Pulse) -> Result<Self, SignalError> {
        let picked = local_model::roughly(sensor, pulse)?;
        let reach = REACH * pulse.width_samples;
        let at = picked.time_s;
        let (first, heights) = sensor.window(at - reach, at + reach);
        let length = (SMOOTHING * pulse.width_samples) as usize | 1;
        let smooth = running::triangle(&heights, length);
        let correlator = Self::of(smooth, at - first as f64);
        let noise = sensor.broad_noise(pulse);
        // Slopes of the smoothed noise have 2/length³ of its variance a sample.
        let of_noise = 2.0 * heights.len() as f64 * noise * noise / (length as f64).powi(3);
        let of_pulse = (correlator.slopes - of_noise).max(LEAST * correlator.slopes);
        let picked = Picked {
            sigma_s: noise / of_pulse.sqrt(),
            moved: Moved::default(),
            misfit: None,
            ..picked
        };
        Ok(Self {
            own: Some(Own {
                at: pulse.at,
                picked,
            }),
            ..correlator
        })
    }

    fn of(samples: Vec<f64>, top: f64) -> Self {
        let slopes = samples.windows(3).map(|three| 0.5 * (three[2] - three[0]));
        Self {
            slopes: slopes.map(|s| s * s).sum(),
            template: samples,
            top,
            own: None,
        }
    }

    /// Time in samples. Variance: noise² Σ t'²/(Σ t' s')², with t the template, its own noise
    /// included, and s the signal, Σ t' s' being the bend of their correlation. What noise of the
    /// record's own pulse does is counted at the passing pulse, as it is common to all delays
    /// against it: noise²/Σ t'², without the noise in t.
    pub(super) fn pick(&self, sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
        if let Some(own) = self.own.as_ref().filter(|own| own.at == pulse.at) {
            return Ok(own.picked);
        }
        let at_top = local_model::roughly(sight, pulse)?;
        let (time_s, bend) = self.best(sight, pulse).ok_or(SignalError::NoPick {
            place: pulse.place,
            what: "largest correlation",
        })?;
        Ok(Picked {
            time_s,
            sigma_s: sight.broad_noise(pulse) * self.slopes.sqrt() / bend,
            moved: Moved::default(),
            misfit: None,
            ..at_top
        })
    }

    /// Where the template's maximum lies when the correlation is largest, and how much that bends
    /// there, a sample squared.
    fn best(&self, sight: &Sight<'_>, pulse: &Pulse) -> Option<(f64, f64)> {
        let search = (0.5 * pulse.width_samples).ceil() + 3.0;
        let length = self.template.len();
        let start = (pulse.at as f64 - self.top - search).round();
        let lags = 2 * search as usize + 1;
        let apart = ((APART * length as f64) as usize).max(1);
        let heights = padded(sight, start - apart as f64, length + lags + 2 * apart);
        let at = |lag: usize| product(&self.template, &heights[lag..]);
        let correlations: Vec<f64> = (apart..apart + lags).map(at).collect();
        let best = largest(&correlations)?;
        let around = best.checked_sub(2)?..best + 3;
        let five: [f64; 5] = correlations.get(around)?.try_into().ok()?;
        let bend = 2.0 * five[2] - at(best) - at(best + 2 * apart);
        let bend = bend / (apart * apart) as f64;
        let time = start + best as f64 + quartic_maximum(five) + self.top;
        (bend > 0.0).then_some((time, bend))
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
