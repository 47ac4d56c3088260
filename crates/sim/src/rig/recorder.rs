//! From forces to a record: force trace, amplifier, trigger, noise, converter.

use crate::rig::instruments::{Amplifier, Converter, RandomStream};
use hertzchain_chain::Sensor;
use hertzchain_chain::wave::{Flow, Observer, Piece};
use hertzchain_experiment::{Amplifier as AmplifierSettings, Channels, Recorder, Trigger};

/// Points of a force trace for each sample: at 500 kHz records are then right to 1e-6 of a
/// pulse, at 100 kHz to 1e-4.
const DENSER: usize = 4;

/// A level that is not passed within this time in s after the striker's touch triggers
/// nothing: the record then starts as if the touch had been the trigger.
const TRIGGER_WITHIN_S: f64 = 0.02;

/// Forces in N of sensor bead and wall at equal times; none before the first touch at t = 0.
#[derive(Clone, Debug)]
pub(crate) struct ForceTrace {
    start_s: f64,
    interval_s: f64,
    length: usize,
    forces_n: Vec<[f64; 2]>,
    last: (f64, [f64; 2]),
}

impl ForceTrace {
    fn new(start_s: f64, interval_s: f64, length: usize) -> Self {
        let mut trace = Self {
            start_s,
            interval_s,
            length,
            forces_n: Vec::with_capacity(length),
            last: (0.0, [0.0; 2]),
        };
        trace.push(0.0, [0.0; 2]);
        trace
    }

    /// The next time of the grid in s; `None` once the trace is full.
    fn next_s(&self) -> Option<f64> {
        let next = self.forces_n.len();
        (next < self.length).then_some(self.start_s + next as f64 * self.interval_s)
    }

    /// Appends forces at a time in s, with straight lines from the time before.
    pub(crate) fn push(&mut self, time_s: f64, forces_n: [f64; 2]) {
        let (before_s, before_n) = self.last;
        while let Some(next_s) = self.next_s().filter(|next_s| *next_s <= time_s) {
            let whole = time_s - before_s;
            let part = match whole > 0.0 {
                true => ((next_s - before_s) / whole).clamp(0.0, 1.0),
                false => 1.0,
            };
            let between = |at: usize| before_n[at] + part * (forces_n[at] - before_n[at]);
            self.forces_n.push([between(0), between(1)]);
        }
        self.last = (time_s, forces_n);
    }

    /// The whole trace, the last force to its end.
    fn into_forces_n(mut self) -> Vec<[f64; 2]> {
        let (_, forces_n) = self.last;
        self.forces_n.resize(self.length, forces_n);
        self.forces_n
    }
}

/// Traces the forces of sensor bead and wall as a wave runs.
#[derive(Debug)]
pub(super) struct TraceObserver<'a> {
    pub trace: &'a mut ForceTrace,
    pub sensors: [Sensor; 2],
}

impl Observer for TraceObserver<'_> {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let end_s = piece.time_s(1.0);
        let forces = |theta: f64| self.sensors.map(|sensor| piece.signal(sensor, theta));
        while let Some(time_s) = self.trace.next_s().filter(|time_s| *time_s < end_s) {
            let theta = (time_s - piece.start_s()) / piece.step_s();
            let forces_n = forces(theta.clamp(0.0, 1.0));
            self.trace.forces_n.push(forces_n);
        }
        self.trace.last = (end_s, forces(1.0));
        Flow::Continue
    }
}

/// When the samples of a shot are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
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
    /// Returns the window of a shot whose striker passed the gate at this time in s, 0 being
    /// the touch. The phase of the sampling clock is random.
    pub(crate) fn new(recorder: &Recorder, gate_s: f64, random: &mut RandomStream) -> Self {
        let interval_s = recorder.sampling_hz.recip();
        let samples = recorder.samples();
        let before = (recorder.before_s * recorder.sampling_hz).round() as usize;
        let phase = random.uniform();
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

    /// Returns an empty force trace for the whole window.
    pub(crate) fn trace(&self) -> ForceTrace {
        let length = (self.samples + self.spare).max(1) * DENSER;
        ForceTrace::new(self.start_s, self.interval_s / DENSER as f64, length)
    }

    /// Returns the record of a force trace.
    pub(crate) fn record(
        &self,
        trace: ForceTrace,
        amplifier: &AmplifierSettings,
        recorder: &Recorder,
        noise: &mut RandomStream,
    ) -> Record {
        let forces_n = trace.into_forces_n();
        let volts = |shares: &[f64; 2]| {
            let mut volts = self.amplified(&forces_n, *shares, amplifier);
            if amplifier.noise_v > 0.0 {
                let noisy = volts.iter_mut();
                noisy.for_each(|v| *v += amplifier.noise_v * noise.normal());
            }
            volts
        };
        // Shares of the sensor bead and of the wall in each channel.
        let shares: &[[f64; 2]] = match recorder.channels {
            Channels::Summed => &[[1.0, 1.0]],
            Channels::Separate => &[[1.0, 0.0], [0.0, 1.0]],
        };
        let channels: Vec<Vec<f64>> = shares.iter().map(volts).collect();
        let passed = match (recorder.trigger, channels.first()) {
            (Trigger::Level(level_v), Some(volts)) => {
                self.passed(volts, level_v - recorder.offset_v)
            }
            _ => Some(0),
        };
        let first = passed.unwrap_or(0);
        let converter = Converter::new(recorder);
        let stored = channels.iter().flat_map(|volts| volts.iter().skip(first).take(self.samples));
        Record {
            samples: stored.map(|v| converter.reading(*v)).collect(),
            touch_s: -(self.start_s + first as f64 * self.interval_s),
            triggered: passed.is_some(),
        }
    }

    /// Amplified voltage at every sample of a channel with these shares of both discs.
    fn amplified(
        &self,
        forces_n: &[[f64; 2]],
        [sensor, wall]: [f64; 2],
        amplifier: &AmplifierSettings,
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
