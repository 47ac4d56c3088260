//! From forces to a record: amplifier, trigger, noise, converter.

use crate::rig::amplifier::Amplifier;
use crate::rig::chance::Chance;
use crate::rig::converter::Converter;
use crate::rig::tape::Tape;
use hertzchain_experiment::{Amplifier as AmplifierNumbers, Channels, Recorder, Trigger};

/// Forces are taped this many times as densely as they are sampled: at 500 kHz records
/// are then right to 1e-6 of a pulse, at 100 kHz to 1e-4.
const DENSER: usize = 4;

/// A level that is not passed within this time in s after the striker's touch
/// triggers nothing: the recorder gives up waiting, the record starts as if the touch
/// had been the trigger, and says so.
const TRIGGER_WITHIN_S: f64 = 0.02;

/// When the samples of a shot are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    start_s: f64,
    interval_s: f64,
    samples: usize,
    before: usize,
    /// Further samples in which a level may be passed.
    spare: usize,
}

/// What the recorder has stored of a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Readings of the converter, channel after channel.
    pub samples: Vec<i16>,
    /// Time in s from the first sample to the striker's touch.
    pub touch_s: f64,
    /// Whether the trigger fired: false if its level was never passed.
    pub triggered: bool,
}

impl Window {
    /// Of a shot whose striker passed the gate at this time in s, 0 being the
    /// touch. The sampling clock knows nothing of the shot.
    #[must_use]
    pub fn new(recorder: &Recorder, gate_s: f64, chance: &mut Chance) -> Self {
        let interval_s = recorder.sampling_hz.recip();
        let samples = recorder.samples();
        let before = (recorder.before_s * recorder.sampling_hz).round() as usize;
        let phase = chance.uniform();
        let (trigger_s, spare) = match recorder.trigger {
            Trigger::Photogate => (gate_s, 0),
            Trigger::Level(_) => (0.0, (TRIGGER_WITHIN_S * recorder.sampling_hz) as usize),
        };
        Self {
            start_s: trigger_s - (before as f64 + phase) * interval_s,
            interval_s,
            samples,
            before: before.min(samples),
            spare,
        }
    }

    /// A tape for all of it.
    #[must_use]
    pub fn tape(&self) -> Tape {
        let length = (self.samples + self.spare).max(1) * DENSER;
        Tape::new(self.start_s, self.interval_s / DENSER as f64, length)
    }

    /// The record of a tape.
    #[must_use]
    pub fn record(
        &self,
        tape: Tape,
        amplifier: &AmplifierNumbers,
        recorder: &Recorder,
        noise: &mut Chance,
    ) -> Record {
        let forces_n = tape.into_forces_n();
        let volts = |shares: &[f64; 2]| {
            let mut volts = self.amplified(&forces_n, *shares, amplifier);
            if amplifier.noise_v > 0.0 {
                let noisy = volts.iter_mut();
                noisy.for_each(|v| *v += amplifier.noise_v * noise.normal());
            }
            volts
        };
        let channels: Vec<Vec<f64>> = shares(recorder.channels).iter().map(volts).collect();
        let passed = match (recorder.trigger, channels.first()) {
            (Trigger::Level(level_v), Some(volts)) => {
                self.passed(volts, level_v - recorder.offset_v)
            }
            _ => Some(0),
        };
        let first = passed.unwrap_or(0);
        let converter = Converter::new(recorder);
        let stored = channels
            .iter()
            .flat_map(|volts| volts.iter().skip(first).take(self.samples));
        Record {
            samples: stored.map(|v| converter.reading(*v)).collect(),
            touch_s: -(self.start_s + first as f64 * self.interval_s),
            triggered: passed.is_some(),
        }
    }

    /// The amplifier's voltage at every sample of a channel that has these shares
    /// of the sensor bead and of the wall.
    fn amplified(
        &self,
        forces_n: &[[f64; 2]],
        [sensor, wall]: [f64; 2],
        amplifier: &AmplifierNumbers,
    ) -> Vec<f64> {
        let mut amplifier = Amplifier::new(amplifier, self.interval_s / DENSER as f64);
        let shared = |at: usize| {
            let [sensor_n, wall_n] = forces_n.get(at).copied().unwrap_or_default();
            [sensor * sensor_n, wall * wall_n]
        };
        let volts = amplifier.follow(forces_n.len(), shared);
        volts.into_iter().step_by(DENSER).collect()
    }

    /// The first sample of a record that a level triggers; `None` if it never does.
    fn passed(&self, volts: &[f64], level_v: f64) -> Option<usize> {
        let after = volts.iter().skip(self.before).take(self.spare);
        let mut below = false;
        for (first, v) in after.enumerate() {
            if below && *v >= level_v {
                return Some(first);
            }
            below = *v < level_v;
        }
        None
    }
}

/// Shares of the sensor bead and of the wall in each channel.
fn shares(channels: Channels) -> &'static [[f64; 2]] {
    match channels {
        Channels::Summed => &[[1.0, 1.0]],
        Channels::Separate => &[[1.0, 0.0], [0.0, 1.0]],
    }
}
