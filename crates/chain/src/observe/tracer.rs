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

/// Samples a shot while it runs.
#[derive(Clone, Debug)]
pub struct Tracer {
    interval_s: f64,
    budget_interval_s: f64,
    next: usize,
    trace: Trace,
}

impl Tracer {
    /// Samples sensors every `interval_s`, and energy about every
    /// `budget_interval_s` (at the starts of steps).
    #[must_use]
    pub fn new(sensors: Vec<Sensor>, interval_s: f64, budget_interval_s: f64) -> Self {
        let columns = vec![Vec::new(); sensors.len()];
        let trace = Trace {
            sensors,
            columns,
            ..Trace::default()
        };
        Self {
            interval_s,
            budget_interval_s,
            next: 0,
            trace,
        }
    }

    /// What was sampled.
    #[must_use]
    pub fn into_trace(self) -> Trace {
        self.trace
    }

    fn sample(&mut self, piece: &Piece<'_>, time_s: f64) {
        let theta = (time_s - piece.start_s()) / piece.step_s();
        self.trace.time_s.push(time_s);
        for (sensor, column) in self.trace.sensors.iter().zip(&mut self.trace.columns) {
            column.push(piece.signal(*sensor, theta));
        }
    }
}

impl Observer for Tracer {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let end = piece.time_s(1.0);
        loop {
            let time = self.next as f64 * self.interval_s;
            let never = self.interval_s.is_nan() || self.interval_s <= 0.0;
            if time >= end || never {
                break;
            }
            self.sample(piece, time);
            self.next += 1;
        }
        let due = self
            .trace
            .budgets
            .last()
            .map_or(0.0, |last| last.time_s + self.budget_interval_s);
        if piece.start_s() >= due {
            self.trace.budgets.extend(piece.budget());
        }
        Flow::Continue
    }
}
