//! Records of a computed shot, with noise and what instruments do to it.

use crate::row::{FINE_S, Row};
use hertzchain_measure::signal::Bandwidth;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// Quiet before the touch in s.
const LEAD_S: f64 = 500e-6;
/// Deviation of strikers' speeds in m/s within a series, measured without error.
const SPEED_STD: f64 = 0.003;
/// Times of flight go as speed to this power within a series.
const EXPONENT: f64 = -0.2;

/// How an amplifier saturates: from the voltage and the level where it ends.
pub(crate) type Clip = fn(f64, f64) -> f64;

pub(crate) const HARD: Clip = |volts, end| volts.min(end);
pub(crate) const TANH: Clip = |volts, end| end * (volts / end).tanh();
pub(crate) const SHORT_KNEE: Clip = |volts, end| {
    let rest = 0.1 * end;
    volts.min(0.9 * end) + rest * ((volts - 0.9 * end).max(0.0) / rest).tanh()
};
pub(crate) const KNEE: Clip = |volts, end| match volts > 0.0 {
    true => volts / (1.0 + (volts / end).powi(8)).powf(0.125),
    false => volts,
};

/// What lies under the pulses, over the incident pulse's height: amplitude of the mains' hum of 50 Hz,
/// with a fifth as much of its third harmonic; steepest ramp in 1/s; step. Phases, slopes and
/// moments are each shot's own.
#[derive(Clone, Copy, Default)]
pub(crate) struct Drift {
    pub hum: f64,
    pub ramp_per_s: f64,
    pub step: f64,
}

impl Drift {
    /// The drift of a record of this length in s, over time in s.
    fn drawn(self, length_s: f64, rng: &mut ChaCha8Rng) -> impl Fn(f64) -> f64 + use<> {
        let [first, third, slope, moment] = [(); 4].map(|()| uniform(rng));
        let step_s = moment * length_s;
        move |time_s| {
            let wave = |harmonic: f64, phase: f64| (TAU * (50.0 * harmonic * time_s + phase)).sin();
            let hum = self.hum * (wave(1.0, first) + 0.2 * wave(3.0, third));
            let step = if time_s > step_s { self.step } else { 0.0 };
            hum + (2.0 * slope - 1.0) * self.ramp_per_s * time_s + step
        }
    }

    fn is_none(self) -> bool {
        [self.hum, self.ramp_per_s, self.step] == [0.0; 3]
    }
}

fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX)
}

/// What is done to a shot's signals.
#[derive(Clone)]
pub(crate) struct Fault {
    pub rate_hz: f64,
    pub noise_db: f64,
    /// The saturation, and the share of the wall's pulse at which it ends.
    pub clip: Option<(Clip, f64)>,
    pub separate: bool,
    /// Sensitivity of the wall's sensor over the sensor bead's.
    pub wall_gain: f64,
    pub crosstalk: f64,
    /// Height over that of its pulse, and lead in s, of a bell half as wide before each.
    pub precursor: (f64, f64),
    pub without_return: bool,
    pub low_pass: Option<Bandwidth>,
    /// Whether the low-pass is given to the measurement.
    pub corrected: bool,
    /// Whether strikers' speeds differ from shot to shot.
    pub speeds_differ: bool,
    pub drift: Drift,
}

impl Default for Fault {
    fn default() -> Self {
        Self {
            rate_hz: 1e6,
            noise_db: 40.0,
            clip: None,
            separate: false,
            wall_gain: 1.0,
            crosstalk: 0.0,
            precursor: (0.0, 0.0),
            without_return: false,
            low_pass: None,
            corrected: false,
            speeds_differ: false,
            drift: Drift::default(),
        }
    }
}

/// Voltages of the channels without noise, at the trace's interval.
pub(crate) fn volts(row: &Row, fault: &Fault) -> Vec<Vec<f64>> {
    let [mut sensor, mut wall] = row.forces.clone();
    if fault.without_return {
        let half = 0.5 * (row.maxima_s[0] + row.maxima_s[1]);
        let gone = sensor.iter_mut().skip((half / FINE_S) as usize);
        gone.for_each(|volts| *volts = 0.0);
    }
    let (share, lead_s) = fault.precursor;
    let bell = |at_s: f64, i: usize| (-((i as f64 * FINE_S - at_s + lead_s) / 20e-6).powi(2)).exp();
    for i in 0..sensor.len() {
        sensor[i] += share * bell(row.maxima_s[0], i);
        wall[i] += share * row.wall_height * bell(row.maxima_s[1], i);
        wall[i] *= fault.wall_gain;
        let both = (sensor[i], wall[i]);
        sensor[i] += fault.crosstalk * both.1;
        wall[i] += fault.crosstalk * both.0;
    }
    let mut channels = match fault.separate {
        true => vec![sensor, wall],
        false => vec![sensor.iter().zip(&wall).map(|(a, b)| a + b).collect()],
    };
    for channel in &mut channels {
        if let Some((clip, share)) = fault.clip {
            let end = share * row.wall_height * fault.wall_gain;
            channel.iter_mut().for_each(|volts| *volts = clip(*volts, end));
        }
        if let Some(low_pass) = fault.low_pass {
            filter(low_pass, channel);
        }
    }
    channels
}

/// A low-pass, by differences with an error of second order in the trace's interval: one of first order
/// shifts pulses by up to 13 ns against each other.
fn filter(low_pass: Bandwidth, channel: &mut [f64]) {
    let ratio = TAU * low_pass.corner_hz * FINE_S;
    let damping = ratio / 2.0_f64.sqrt();
    let (mut before, mut value) = (0.0, 0.0);
    for volts in channel {
        let push = ratio * (*volts - value);
        let next = if low_pass.order == 1 {
            value + push / (1.0 + 0.5 * ratio)
        } else {
            (ratio * push + 2.0 * value - (1.0 - damping) * before) / (1.0 + damping)
        };
        // Half a step's delay of the first order is left out: the mean of both ends.
        *volts = if low_pass.order == 1 { 0.5 * (value + next) } else { value };
        (before, value) = (value, next);
    }
}

/// One shot's samples a channel, from a random moment on and in noise, and its striker's speed.
pub(crate) fn record(
    row: &Row,
    volts: &[Vec<f64>],
    fault: &Fault,
    rng: &mut ChaCha8Rng,
) -> (Vec<Vec<f64>>, f64) {
    let phase = uniform(rng);
    let off: f64 = StandardNormal.sample(rng);
    let speed_m_s = match fault.speeds_differ {
        true => row.speed_m_s + SPEED_STD * off,
        false => row.speed_m_s,
    };
    let slower = (speed_m_s / row.speed_m_s).powf(EXPONENT);
    let channels = volts.iter();
    let samples = channels.map(|volts| sampled(volts, fault, (phase, slower), rng));
    (samples.collect(), speed_m_s)
}

fn sampled(
    volts: &[f64],
    fault: &Fault,
    (phase, slower): (f64, f64),
    rng: &mut ChaCha8Rng,
) -> Vec<f64> {
    let per = (fault.rate_hz * FINE_S).recip();
    let noise = 10_f64.powf(-fault.noise_db / 20.0);
    let lead = LEAD_S / FINE_S;
    let count = ((volts.len() as f64 * slower.min(1.0) + lead) / per) as usize - 2;
    // Records without drift keep their random numbers.
    let length_s = count as f64 / fault.rate_hz;
    let drift = (!fault.drift.is_none()).then(|| fault.drift.drawn(length_s, rng));
    let sample = |i: usize| {
        let at = ((i as f64 + phase) * per - lead) / slower;
        let first = at.floor().max(0.0) as usize;
        let part = at - first as f64;
        let clean = match (at >= 0.0, volts.get(first), volts.get(first + 1)) {
            (true, Some(left), Some(right)) => left + part * (right - left),
            _ => 0.0,
        };
        let error: f64 = StandardNormal.sample(rng);
        let under = drift.as_ref().map_or(0.0, |drift| drift(i as f64 / fault.rate_hz));
        0.3 + clean + under + noise * error
    };
    (0..count).map(sample).collect()
}
