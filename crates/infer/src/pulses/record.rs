//! One shot's samples, ready to be fitted.

use crate::InferError;
use hertzchain_measure::MeasureError;
use hertzchain_measure::signal::{
    Channels, Estimate, Flight, Normalisation, Polarity, QualityFlag, SignalOptions, measure,
    normalisation, without_spikes,
};

/// Samples are used from so many incident times of flight before the first maximum.
const BEFORE: f64 = 0.3;

/// And to so many after it: to the wall and back, and the reflected pulse's tail.
const AFTER: f64 = 2.5;

/// Means of neighbouring samples in an incident ToF: thirty in a pulse of the paper's chain.
const PER_FLIGHT: f64 = 300.0;

/// Quiet samples that determine a channel's offset and noise.
const QUIET: usize = 32;

/// Noise over the digitiser's step above which rounding is noise too, and least noise over the pulse's height.
const DITHERED: f64 = 0.5;
const LEAST_NOISE: f64 = 1e-9;

/// Numbers of each channel's baseline: offset, slope and curvature.
pub(super) const BASELINE: usize = 3;

/// Highest order of the autoregression of a record's noise, quiet means that determine one, and standard errors
/// by which its last coefficient differs from 0.
const MOST_ORDER: usize = 10;
const FOR_ONE: usize = 16;
const CLEAR: f64 = 3.0;

/// Makes correlated noise white: the error of the prediction of a mean from those before it, by
/// autoregressions of the orders 0, 1, …, each with its error over the noise [Durbin1960].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Whitening(Vec<(Vec<f64>, f64)>);

impl Whitening {
    /// Of noise like these means.
    fn of(quiet: &[f64]) -> Self {
        let count = quiet.len() as f64;
        let mean = quiet.iter().sum::<f64>() / count;
        let lagged = |k: usize| -> f64 {
            let pairs = quiet.iter().zip(quiet.iter().skip(k));
            pairs.map(|(a, b)| (a - mean) * (b - mean)).sum()
        };
        let mut all: Vec<(Vec<f64>, f64)> = vec![(Vec::new(), 1.0)];
        let mut order = 0;
        for m in 1..=MOST_ORDER.min(quiet.len() / FOR_ONE) {
            let (before, error) = &all[m - 1];
            let known: f64 = before.iter().zip((1..m).rev()).map(|(a, k)| a * lagged(k)).sum();
            let own = (lagged(m) - known) / (lagged(0) * error * error);
            if own.is_nan() || own.abs() >= 1.0 {
                break;
            }
            let reversed = before.iter().rev();
            let mut next: Vec<f64> =
                before.iter().zip(reversed).map(|(a, b)| a - own * b).collect();
            next.push(own);
            let error = error * (1.0 - own * own).sqrt();
            if own.abs() > CLEAR / count.sqrt() {
                order = m;
            }
            all.push((next, error));
        }
        all.truncate(order + 1);
        Self(all)
    }

    /// The prediction of a value from those before it, and its error.
    fn predicted(&self, values: &[f64], at: usize) -> (f64, f64) {
        let (of, error) = &self.0[at.min(self.0.len() - 1)];
        let before = values[..at].iter().rev();
        (of.iter().zip(before).map(|(a, value)| a * value).sum(), *error)
    }

    pub(super) fn apply(&self, values: &mut [f64]) {
        for at in (0..values.len()).rev() {
            let (predicted, error) = self.predicted(values, at);
            values[at] = (values[at] - predicted) / error;
        }
    }

    /// The values of which [`Self::apply`] made these.
    pub(super) fn undo(&self, values: &mut [f64]) {
        for at in 0..values.len() {
            let (predicted, error) = self.predicted(values, at);
            values[at] = values[at] * error + predicted;
        }
    }
}

/// The samples of one shot around its pulses, as means of neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulses {
    /// Which record, as it is reported to people.
    pub source: String,
    /// Speed of the striker in m/s, as measured.
    pub speed_m_s: Estimate,
    /// Programmed speed of the striker in m/s: shots of one such speed share values a speed.
    pub programmed_m_s: f64,
    /// Time between samples in s.
    pub interval_s: f64,
    /// Samples in a mean.
    pub width: usize,
    /// Time of the first sample, in s from the record's beginning.
    pub start_s: f64,
    /// Means in V, pulses up, the quiet offset taken off; a row a channel: one that sums both
    /// sensors, or the bead's and the wall's.
    pub means_v: Vec<Vec<f64>>,
    /// Standard error of each channel's means in V.
    pub sigma_v: Vec<f64>,
    /// What makes each channel's noise white.
    pub(super) whitening: Vec<Whitening>,
    /// When the incident pulse is highest, in s from the record's beginning.
    pub passing_s: f64,
    /// Its height in V.
    pub height_v: f64,
}

impl Pulses {
    /// From a record's channels in V.
    pub fn of(
        source: &str,
        (speed_m_s, programmed_m_s): (Option<Estimate>, Option<f64>),
        interval_s: f64,
        volts: &[Vec<f64>],
    ) -> Result<Self, InferError> {
        let speed_m_s = speed_m_s.ok_or_else(|| InferError::Input(format!("{source}: no speed of the striker: add a line of this record to the table of --shots")))?;
        let flight = flight(source, interval_s, volts)?;
        let incident = flight.incident_s.value / interval_s;
        let passing = flight.picks.incident.time_s / interval_s;
        let from = (passing - BEFORE * incident).max(0.0) as usize;
        let to = (passing + AFTER * incident) as usize;
        let width = ((incident / PER_FLIGHT) as usize).max(1);
        let no_noise = || {
            InferError::Input(format!(
                "{source}: fewer than 32 quiet samples before the first pulse, or no noise in them: their scatter is what samples are weighed by"
            ))
        };
        let mut pulses = Self {
            source: source.to_owned(),
            speed_m_s,
            programmed_m_s: programmed_m_s.unwrap_or(speed_m_s.value),
            interval_s,
            width,
            start_s: from as f64 * interval_s,
            means_v: Vec::new(),
            sigma_v: Vec::new(),
            whitening: Vec::new(),
            passing_s: flight.picks.incident.time_s,
            height_v: flight.picks.incident.height,
        };
        for samples in volts {
            let samples = &without_spikes(samples).0[..];
            let up = normalisation(samples, Polarity::default()).map_err(|_| no_noise())?;
            let window = samples.get(from..to.min(samples.len())).unwrap_or(&[]);
            let step_v = step(window);
            let sigma_v = sigma(&up, width, step_v);
            let sigma_v = sigma_v.filter(|sigma| *sigma > LEAST_NOISE * pulses.height_v);
            let sigma_v = sigma_v.ok_or_else(no_noise)?;
            let mean = |chunk: &[f64]| {
                let sum: f64 = chunk.iter().map(|sample| up.height(*sample)).sum();
                sum / width as f64
            };
            pulses.means_v.push(window.chunks_exact(width).map(mean).collect());
            pulses.sigma_v.push(sigma_v);
            let is_dithered = up.baseline.noise >= DITHERED * step_v;
            let quiet = samples.get(..up.baseline.quiet_samples).filter(|_| is_dithered);
            let quiet = quiet.unwrap_or(&[]);
            let quiet: Vec<f64> = quiet.chunks_exact(width).map(mean).collect();
            pulses.whitening.push(Whitening::of(&quiet));
        }
        Ok(pulses)
    }

    /// Time in s from the incident maximum to the last sample.
    pub(super) fn after_s(&self) -> f64 {
        let samples = self.means_v.first().map_or(0, Vec::len) * self.width;
        self.start_s + samples as f64 * self.interval_s - self.passing_s
    }

    /// Standard error of the logarithm of the speed; 0 if it is exact.
    pub(super) fn ln_speed_error(&self) -> f64 {
        self.speed_m_s.sigma / self.speed_m_s.value
    }

    /// Residuals of its own: one a mean, and one for the speed if that has an error.
    pub(super) fn residual_count(&self) -> usize {
        let means: usize = self.means_v.iter().map(Vec::len).sum();
        means + usize::from(self.ln_speed_error() > 0.0)
    }

    /// Numbers that are fitted to this record alone.
    pub(super) fn nuisance_count(&self) -> usize {
        BASELINE * self.means_v.len() + 1 + usize::from(self.ln_speed_error() > 0.0)
    }
}

/// Where the pulses are.
fn flight(source: &str, interval_s: f64, volts: &[Vec<f64>]) -> Result<Flight, InferError> {
    let channels = match volts {
        [sensor, wall, ..] => Channels::Separate { sensor, wall },
        one => Channels::Summed(one.first().map_or(&[], Vec::as_slice)),
    };
    let named = |error: MeasureError| InferError::Input(format!("{source}: {error}"));
    let found = measure(channels, interval_s, &SignalOptions::default()).map_err(named)?;
    let grave = found.found.flags.iter().copied().find(QualityFlag::is_grave);
    if let Some(flag) = grave {
        return InferError::input(format!("{source}: {flag}"));
    }
    found.flight.map_err(named)
}

/// The digitiser's step: the least difference of neighbours, if all are multiples of it.
fn step(samples: &[f64]) -> f64 {
    let differences = || samples.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let step = differences().filter(|off| *off > 0.0).fold(f64::INFINITY, f64::min);
    let whole = |off: f64| (off / step - (off / step).round()).abs() < 0.01;
    if step.is_finite() && differences().all(whole) { step } else { 0.0 }
}

/// Standard error of a mean of so many samples: their noise, as much correlated as it is before the
/// pulses; without noise to dither the digitiser's steps, that of rounding, which no mean makes less.
fn sigma(up: &Normalisation, width: usize, step_v: f64) -> Option<f64> {
    let noise = up.baseline.noise;
    let known = up.baseline.quiet_samples >= QUIET && noise.is_finite();
    let over = up.baseline.correlation.clamp(1.0, width as f64) / width as f64;
    known.then(|| match noise < DITHERED * step_v {
        true => noise.hypot(step_v / 12_f64.sqrt()),
        false => noise * over.sqrt(),
    })
}
