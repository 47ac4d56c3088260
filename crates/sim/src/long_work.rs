//! The expected work of a long shot, its progress, and the end of one that is cancelled or
//! takes too many steps.

use crate::accuracy;
use crate::duration::{self, End};
use crate::plan::Plan;
use crate::stop::{count_steps, note_shot, stopped};
use hertzchain_chain::System;
use hertzchain_chain::wave::{Flow, Observer, Piece};
use hertzchain_experiment::Method;
use std::fmt;
use std::time::Instant;

/// Steps a bead in the time of a pulse's way to the wall, on that way and behind it, at an accuracy of 1e-6: of order 5,
/// of order 8 in rows that keep their energy, whose wake rattles, and in others. They go as the accuracy to −1 over
/// the order.
const STEPS_A_BEAD: [([f64; 2], f64); 3] = [([25.0; 2], 5.0), ([6.0, 22.0], 5.0), ([2.7; 2], 8.0)];

/// A shot that ends by itself goes on until three times the pulse's way to the wall.
const WAYS: f64 = 3.0;

/// Bodies that a step computes, over those of the row, and the time of one of order 5 and of order 8, in s, with
/// the runs that estimate the error: dry rows of 1,000 to 4,000 beads.
const SHARE_OF_BODIES: f64 = 0.3;
const BODY_STEP_S: [f64; 3] = [1e-7, 1e-7, 2.5e-7];

/// Bodies that a step computes while a pulse without losses runs to the wall, as behind it all are asleep: 40, and
/// what a step costs besides.
const PULSE_BODIES: f64 = 140.0;

/// Time of a pulse to the wall over `crossing_s`, at most.
const MARGIN: f64 = 1.1;

/// Expected work of a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Steps of one run.
    pub steps: f64,
    /// Time that the shot takes, in s, to a factor of a few.
    pub time_s: f64,
}

impl Expected {
    /// The expected work of a plan.
    ///
    /// # Errors
    /// A chain that cannot be set up.
    pub fn of(plan: &Plan) -> Result<Self, crate::StudyError> {
        let system = System::new(&plan.chain)?;
        Ok(Self::of_system(plan, &system))
    }

    fn of_system(plan: &Plan, system: &System) -> Self {
        let crossing_s = system.scales().crossing_s;
        let duration_s = plan.duration_s.unwrap_or(WAYS * crossing_s);
        let bodies = system.bodies() as f64;
        let adaptive = plan.method == Method::Adaptive;
        let order = match adaptive && accuracy::is_of_order_8(plan) {
            true => 1 + usize::from(!keeps_energy(plan)),
            false => 0,
        };
        let steps = match (plan.method, plan.step_s) {
            (Method::Rk4 | Method::Verlet, Some(step_s)) => duration_s / step_s,
            _ => {
                let ([on_way, behind], order) = STEPS_A_BEAD[order];
                let ways = duration_s / crossing_s;
                let a_bead = on_way * ways.min(1.0) + behind * (ways - 1.0).max(0.0);
                a_bead * bodies * (plan.accuracy / 1e-6).powf(-1.0 / order)
            }
        };
        let steps = steps.min(duration::end(plan, system).most_steps);
        let awake = awake(plan, system, crossing_s / duration_s);
        let time_s = BODY_STEP_S[order] * steps * awake;
        Self { steps, time_s }
    }
}

/// Bodies that a step computes, on average over a shot; `crossing` is the part of its duration that the pulse
/// takes to the wall.
fn awake(plan: &Plan, system: &System, crossing: f64) -> f64 {
    let bodies = system.bodies() as f64;
    let alone = plan.step_s.is_none() && system.flies_free() && keeps_energy(plan);
    let on_its_way = if alone { (MARGIN * crossing).min(1.0) } else { 0.0 };
    let left_behind = (SHARE_OF_BODIES * bodies).max(1.0);
    on_its_way * PULSE_BODIES.min(bodies) + (1.0 - on_its_way) * left_behind
}

fn keeps_energy(plan: &Plan) -> bool {
    let mut laws = plan.chain.sections.iter().flat_map(|section| &section.laws);
    laws.all(|law| law.info().name.starts_with("elastic"))
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "about {:.1e} steps, {}", self.steps, rough(self.time_s))
    }
}

fn rough(time_s: f64) -> String {
    let units = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min")];
    let unit = units.into_iter().find(|(unit_s, _)| time_s >= 1.5 * unit_s);
    let (unit_s, name) = unit.unwrap_or((1.0, "s"));
    format!("{:.0} {name}", (time_s / unit_s).max(1.0))
}

/// Counts the steps of a shot, notes its progress, and ends it when it is cancelled or
/// takes more steps than allowed.
pub(crate) struct CountedShots {
    steps: u64,
    most_steps: f64,
    expected: Expected,
    begun: Instant,
}

/// Steps that are counted at a time: threads that share a counter wait for each other.
const COUNTED: u64 = 64;

/// Steps between notes of progress.
const NOTED: u64 = 1024;

impl CountedShots {
    pub(crate) fn new(plan: &Plan, system: &System, end: &End) -> Self {
        Self {
            steps: 0,
            most_steps: end.most_steps,
            expected: Expected::of_system(plan, system),
            begun: Instant::now(),
        }
    }

    pub(crate) fn is_long(&self) -> bool {
        self.steps as f64 >= self.most_steps
    }

    fn note(&self, time_s: f64) -> String {
        progress((self.steps, self.begun.elapsed().as_secs_f64()), time_s, self.expected)
    }
}

/// How far a run of so many steps and seconds is. The time left is at least its share of the estimate: later steps
/// take longer, as more bodies move.
fn progress((steps, elapsed_s): (u64, f64), time_s: f64, expected: Expected) -> String {
    let share = steps as f64 / expected.steps;
    let how_far = match share < 1.0 {
        true => {
            let left_s = (elapsed_s * (1.0 / share - 1.0)).max((1.0 - share) * expected.time_s);
            format!("about {:.0} % of this run, {} left", 100.0 * share, rough(left_s))
        }
        false => format!("more than the {:.1e} steps that were expected", expected.steps),
    };
    format!("{steps} steps, t = {time_s:.3e} s: {how_far}")
}

impl Observer for CountedShots {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        self.steps += 1;
        if self.steps.is_multiple_of(COUNTED) {
            count_steps(COUNTED);
        }
        if self.steps.is_multiple_of(NOTED) {
            note_shot(&self.note(piece.time_s(1.0)));
        }
        match stopped() || self.is_long() {
            true => Flow::Finished,
            false => Flow::Continue,
        }
    }
}

#[cfg(test)]
#[path = "tests/long_work.rs"]
mod tests;
