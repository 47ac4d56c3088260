//! Error control of a step, and when there is no going on.

use super::Control;
use super::outcome::SolveError;
use super::run::Wave;
use super::step::{LANES, error_norm};

/// Steps below this fraction of the contact time mean that accuracy is out of
/// reach: at the first touch of a contact and the least tolerance 1e-9 is enough.
const SMALLEST_STEP: f64 = 1e-13;

/// Errors are measured against the speed at which closed contacts move now,
/// but never less than this fraction of the speed that set the chain in motion.
const LEAST_SCALE: f64 = 1e-2;

impl Wave<'_> {
    /// A smaller step, unless it is too small.
    pub(super) fn shrunk(&self, h: f64, near: usize) -> Result<f64, SolveError> {
        let time_s = self.state.time_s;
        if h > SMALLEST_STEP * self.system.scales().time_s && time_s + h > time_s {
            return Ok(h);
        }
        match self.first_not_finite() {
            Some(body) => Err(self.not_finite(body)),
            None => {
                let contact = near.min(self.system.contacts() - 1);
                Err(SolveError::StepTooSmall { time_s, step_s: h, contact })
            }
        }
    }

    pub(super) fn check_work(&self) -> Result<(), SolveError> {
        match self.work.force_passes < self.most_passes {
            true => Ok(()),
            false => Err(SolveError::TooMuchWork {
                time_s: self.state.time_s,
                force_passes: self.work.force_passes,
                step_s: match self.control {
                    Control::Fixed { step_s } => step_s,
                    Control::Adaptive { .. } => self.proposed_s,
                },
                contact: self.worst.min(self.system.contacts() - 1),
            }),
        }
    }

    pub(super) fn first_not_finite(&self) -> Option<usize> {
        let bodies = self.moving();
        bodies.into_iter().find(|&i| !(self.x[i].is_finite() && self.v[i].is_finite()))
    }

    pub(super) fn not_finite(&self, body: usize) -> SolveError {
        let contact = body.min(self.system.contacts() - 1);
        SolveError::NotFinite {
            time_s: self.state.time_s,
            body,
            contact,
            step_s: match self.control {
                Control::Fixed { step_s } => Some(step_s),
                Control::Adaptive { .. } => None,
            },
        }
    }

    /// Error of the step just tried, relative to the motion's scales.
    pub(super) fn error(&self, h: f64) -> (f64, usize) {
        let Some(weights) = &self.table.error else {
            return (0.0, 0);
        };
        let speed = self.speed_scale();
        let length = speed * self.system.scales().time_s;
        let bodies = self.owned();
        let (set, scales) = (self.pass.set, (speed, length));
        let (error, body) =
            error_norm(set, bodies, h, weights, &self.a[..self.table.stages()], scales);
        let (moved, contact) = self.state.states.error_m(h, &weights[0]);
        let (error, body) = match moved / length > error || moved.is_nan() {
            true => (moved / length, contact),
            false => (error, body),
        };
        let work = self.meter.as_ref().map_or(0.0, |meter| meter.error(h, &weights[0]));
        (if work > error { work } else { error }, body)
    }

    /// Largest rate of a touching contact, within bounds.
    pub(super) fn speed_scale(&self) -> f64 {
        let bodies = self.owned();
        let contacts = bodies.start..bodies.end - 1;
        let (left, right) =
            (&self.state.v[contacts.clone()], &self.state.v[contacts.start + 1..=contacts.end]);
        let rows = left.chunks(LANES).zip(right.chunks(LANES));
        let mut largest = [LEAST_SCALE * self.system.scales().speed_m_s; LANES];
        for ((left, right), touching) in rows.zip(self.state.touching[contacts].chunks(LANES)) {
            let rates = left.iter().zip(right).zip(touching);
            for (largest, ((left, right), on)) in largest.iter_mut().zip(rates) {
                let rate = on * (left - right).abs();
                *largest = if rate > *largest { rate } else { *largest };
            }
        }
        largest.into_iter().fold(0.0, f64::max)
    }
}
