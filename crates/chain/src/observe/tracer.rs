//! Sensors sampled at equal times, and energy over time.

use crate::sensor::Sensor;
use crate::wave::{Budget, Flow, Observer, Piece};

/// Signals of several sensors at equal times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Times in s.
    pub time_s: Vec<f64>,
    /// The sensors.
    pub sensors: Vec<Sensor>,
    /// One column a sensor, in SI.
    pub columns: Vec<Vec<f64>>,
    /// Energy terms at the starts of steps, when a budget is kept.
    pub budgets: Vec<Budget>,
}

/// Samples a shot while it runs, and ends it before a trace fills the memory.
#[derive(Clone, Debug)]
pub struct Tracer {
    interval_s: f64,
    next: usize,
    trace: Trace,
    full_s: Option<f64>,
}

/// Numbers of an energy budget beside its losses.
const OF_BUDGET: usize = 10;

/// Share of an interval by which a sample's time may be after the end of a step.
const ROUNDING: f64 = 1e-9;

impl Tracer {
    /// Most numbers of a trace, times and energies included: 0.24 GB, and as much again where
    /// they are copied to be written.
    pub const MOST_NUMBERS: usize = 30_000_000;

    /// Samples sensors every `interval_s`, and energy about as often (at the starts of steps).
    pub fn new(sensors: Vec<Sensor>, interval_s: f64) -> Self {
        let columns = vec![Vec::new(); sensors.len()];
        let trace = Trace { sensors, columns, ..Trace::default() };
        Self { interval_s, next: 0, trace, full_s: None }
    }

    /// When the trace would have had more than [`Self::MOST_NUMBERS`] numbers, in
    /// s; the shot ended there.
    pub fn full_s(&self) -> Option<f64> {
        self.full_s
    }

    /// What was sampled.
    pub fn into_trace(self) -> Trace {
        self.trace
    }

    /// Numbers that the trace has once it is sampled until a time, with one
    /// more energy budget.
    fn numbers(&self, until_s: f64) -> f64 {
        let due = if self.samples() { until_s / self.interval_s } else { 0.0 };
        let losses = self.trace.budgets.last().map_or(0, |it| it.dissipated.len());
        let budgets = (self.trace.budgets.len() + 1) * (OF_BUDGET + losses);
        due.max(self.next as f64) * (self.trace.sensors.len() + 1) as f64 + budgets as f64
    }

    fn samples(&self) -> bool {
        self.interval_s > 0.0
    }

    fn sample(&mut self, piece: &Piece<'_>, time_s: f64) {
        let theta = ((time_s - piece.start_s()) / piece.step_s()).min(1.0);
        self.trace.time_s.push(time_s);
        for (sensor, column) in self.trace.sensors.iter().zip(&mut self.trace.columns) {
            column.push(piece.signal(*sensor, theta));
        }
    }
}

impl Observer for Tracer {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let end = piece.time_s(1.0);
        if self.numbers(end) > Self::MOST_NUMBERS as f64 {
            self.full_s = Some(piece.start_s());
            return Flow::Finished;
        }
        loop {
            let time = self.next as f64 * self.interval_s;
            // The sample at the end of the shot belongs to its last step, whatever
            // rounding makes of either time.
            if time > end + ROUNDING * self.interval_s || !self.samples() {
                break;
            }
            self.sample(piece, time);
            self.next += 1;
        }
        let due = self.trace.budgets.last().map_or(0.0, |last| last.time_s + self.interval_s);
        if piece.start_s() >= due {
            self.trace.budgets.extend(piece.budget());
        }
        Flow::Continue
    }
}
