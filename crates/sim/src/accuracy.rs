//! From the accuracy that is asked to a solver that delivers it.

use crate::duration::has_wall;
use crate::plan::Plan;
use hertzchain_chain::ensemble::Precision;
use hertzchain_chain::wave::Method;
use hertzchain_chain::{Start, System, Tension};
use hertzchain_experiment::{self as experiment, Pick};
use std::sync::Arc;

/// Tightest tolerance per step: below it rounding, not the step, decides.
pub(crate) const TIGHTEST: f64 = 1e-13;

/// Times of flight are twice as wrong as one step is allowed to be, up to
/// thirteen times behind a strong loss, whose loosened chain amplifies errors.
const OF_TIMES: f64 = 10.0;

/// The residual of the energy budget sums over steps and is this much worse: many of order 5, few of order 8.
const OF_BUDGET: [f64; 2] = [200.0, 30.0];

/// Chains longer than this take so many more steps that the sum needs more.
const LONG_CHAIN: f64 = 200.0;

/// A pulse loses a little energy, and with it speed, in every bead that it
/// passes: in chains longer than this it shows. Measured: 1,000 Hertz beads at
/// a tenth of 1e-6 are off by 5e-6.
const FAR: f64 = 100.0;

/// Errors of peak times go with the time of a contact, not with the time of flight:
/// a flight over fewer beads than these asks for tighter steps.
const NEAR: f64 = 10.0;

/// The length of the flight in beads over [`NEAR`], at most 1.
fn nearness(plan: &Plan) -> f64 {
    if !has_wall(&plan.chain.far) {
        return 1.0;
    }
    let beads = plan.chain.beads.len().saturating_sub(plan.sensor_bead) as f64;
    ((beads + 0.5) / NEAR).min(1.0)
}

/// First step of a fixed-step method, in contact times.
const FIRST_STEP: f64 = 1.0 / 20.0;

/// Tolerance per step that gives a plan's accuracy, and whether rounding forbids it.
pub fn tolerance(plan: &Plan) -> (f64, bool) {
    let beads = plan.chain.beads.len() as f64;
    let share = if plan.budget {
        OF_BUDGET[usize::from(is_of_order_8(plan))] * (beads / LONG_CHAIN).max(1.0)
    } else {
        OF_TIMES * (beads / FAR).max(1.0)
    };
    let wanted = plan.accuracy * nearness(plan) / share;
    (wanted.max(TIGHTEST), wanted < TIGHTEST)
}

/// A result is at most this many times as wrong as a finer run changes it, and
/// as one that is ten times finer still: half the step at the lowest order, 1,
/// leaves as much as it takes away.
const OF_CHANGES: [f64; 2] = [2.0, 1.25];

/// Runs may agree by chance; no result is trusted to less than this many
/// tolerances of a step. Measured over the paper's chains and speeds: with both
/// no error is larger than the estimate, `docs/explanation/numerics.md`.
const OF_TOLERANCE: f64 = 5.0;

/// Laws of the rows on which margins of estimates were measured.
const MEASURED: [&str; 3] = ["elastic_hertz", "damping_viscoelastic", "damping_cubic"];

/// Whether a row has no other laws than those, no cut forces and no gaps.
pub(crate) fn is_gentle(plan: &Plan) -> bool {
    let chain = &plan.chain;
    let mut laws = chain.sections.iter().flat_map(|section| &section.laws);
    chain.tension == Tension::Allowed
        && chain.gaps.is_empty()
        && laws.all(|law| MEASURED.contains(&law.info().name))
}

/// Whether a row is gentle and of equal beads.
pub(crate) fn is_gentle_and_equal(plan: &Plan) -> bool {
    plan.chain.beads.windows(2).all(|pair| pair[0] == pair[1]) && is_gentle(plan)
}

/// Losses of the first contact over its elastic force beyond which steps in contact times are too long for it and
/// errors of like shots are not alike: of 5,172 shots of maps with up to 10 none is more wrong than it states, from
/// 10 on 134 of 1,028 are, by up to 13 times.
const MOST_DAMPED: f64 = 3.0;

/// Whether a row is gentle, of equal beads, hit by one of them, held by nothing but a wall and not damped beyond
/// measure, and timed by peaks: shots of such rows that differ in numbers have errors that are alike.
pub(crate) fn is_uniform(plan: &Plan) -> bool {
    let chain = &plan.chain;
    let struck = match &chain.start {
        Start::Striker { bead, .. } => Some(bead),
        _ => None,
    };
    let fits = |system: Arc<System>| system.flies_free() && system.damping_share() <= MOST_DAMPED;
    plan.duration_s.is_none()
        && plan.picks().all(|pick| pick == Pick::Peak)
        && is_gentle(plan)
        && chain.initial.is_empty()
        && chain.beads.iter().all(|bead| Some(bead) == struck)
        && chain.system().is_ok_and(fits)
}

/// Other rows are more wrong than the changes say in 14 to 19 of 10,000 results; with this margin
/// in 3 to 6, by 1.6 times or less but for one (`docs/notes/2026-11-23-error-control.md`).
const OF_SHARP: f64 = 2.0;

/// Margin of an estimate of a plan's error.
pub(crate) fn margin(plan: &Plan) -> f64 {
    if is_gentle(plan) { 1.0 } else { OF_SHARP }
}

/// Margin of an estimate by finer runs: also of gentle rows of unlike beads, one of which, with a light
/// stop, is 1.8 and 1.4 times as wrong as without.
pub(crate) fn margin_of_finer(plan: &Plan) -> f64 {
    if is_gentle_and_equal(plan) { 1.0 } else { OF_SHARP }
}

/// The accuracy reached, from the changes that finer runs make, with a margin, and the
/// tolerance per step, 0 for fixed steps.
pub fn reached(changes: [f64; 2], margin: f64, tolerance: f64) -> f64 {
    let bounds = changes.iter().zip(OF_CHANGES).map(|(change, of)| margin * of * change);
    bounds.fold(OF_TOLERANCE * tolerance, f64::max)
}

/// Tolerances of the runs that estimate the error of a shot, over its own.
pub(crate) const LOOSER: [f64; 2] = [10.0, 40.0];

/// Error of a run over that of one with a tenth of its tolerance, at least: errors
/// mostly go with the tolerance, and with its third root in short rows with laws
/// whose force begins with an infinite slope.
const LEAST_GAIN: f64 = 2.0;

/// The error of a run, from the changes to runs that are this many times looser, with a
/// margin, and from its own tolerance per step.
pub(crate) fn estimated(changes: &[(f64, f64)], margin: f64, tolerance: f64) -> f64 {
    let share = |(looseness, change): &(f64, f64)| {
        let gain = LEAST_GAIN.powf(looseness.log10());
        margin * change / (gain - 1.0)
    };
    let changes = changes.iter().map(share);
    changes.fold(OF_TOLERANCE * tolerance, f64::max)
}

/// Tolerance per step with which errors that do not sum along a chain leave
/// times of flight as right as a plan asks.
pub(crate) fn of_times(plan: &Plan) -> f64 {
    plan.accuracy / OF_TIMES
}

/// Steps of the ensemble loop, in contact times, with which rows of alike
/// beads mostly reach an accuracy, and whether openings must be found: measured,
/// `docs/explanation/numerics.md`. Two longer steps show whether each shot has.
const EQUAL_STEPS: [(f64, f64, bool); 5] = [
    (1e-3, 0.13, false),
    (1e-4, 0.1, false),
    (1e-5, 0.07, true),
    (1e-6, 0.036, true),
    (1e-7, 0.013, true),
];

/// Chains longer than this lose more on the way than [`EQUAL_STEPS`] allows for.
const EQUAL_STEPS_FOR: f64 = 60.0;

/// The step of the ensemble loop for a plan's accuracy, and whether openings
/// must be found; `None` below what it can do.
pub(crate) fn equal_steps(plan: &Plan) -> Option<(f64, bool)> {
    let length = plan.chain.beads.len() as f64 / EQUAL_STEPS_FOR;
    let accuracy = plan.accuracy * nearness(plan) / length.max(1.0);
    let [(loosest, longest, _), ..] = EQUAL_STEPS;
    if accuracy >= loosest {
        return Some((longest, false));
    }
    let between = |pair: &[(f64, f64, bool)]| {
        let [(looser, longer, _), (tighter, shorter, openings)] = *pair else {
            return None;
        };
        let share = (accuracy / tighter).ln() / (looser / tighter).ln();
        (0.0..=1.0).contains(&share).then(|| (shorter * (longer / shorter).powf(share), openings))
    };
    EQUAL_STEPS.windows(2).find_map(between)
}

/// Accuracies from this on are computed in single precision, whose rounding is
/// measured in `docs/explanation/numerics.md`.
const SINGLE_FROM: f64 = 5e-5;

/// How long the numbers of the ensemble loop are for a plan: where a load
/// presses beads together, single precision would lose the wave in it.
pub(crate) fn precision(plan: &Plan, system: &System) -> Precision {
    match plan.accuracy >= SINGLE_FROM && system.flies_free() {
        true => Precision::Single,
        false => Precision::Double,
    }
}

/// Accuracy below which, and in longer rows at any, long steps of order 8 pay where contacts keep their modes.
const FINE: f64 = 1e-6;

pub(crate) fn is_of_order_8(plan: &Plan) -> bool {
    let is_long = plan.chain.beads.len() as f64 >= LONG_CHAIN;
    (is_long || plan.accuracy < FINE) && is_gentle(plan)
}

/// The adaptive solver of a plan at a tolerance.
pub fn adaptive(plan: &Plan, tolerance: f64) -> Method {
    match is_of_order_8(plan) {
        true => Method::prince_dormand(tolerance),
        false => Method::dormand_prince(tolerance),
    }
}

/// The step in s that a search for a fixed step begins with.
pub(crate) fn first_step_s(system: &System) -> f64 {
    FIRST_STEP * system.scales().time_s
}

pub(crate) fn fixed(method: experiment::Method, step_s: f64) -> Method {
    match method {
        experiment::Method::Verlet => Method::verlet(step_s),
        experiment::Method::Rk4 | experiment::Method::Adaptive => Method::rk4(step_s),
    }
}

/// A search for a fixed step halves it at most this often, down to some 1e-5
/// of the contact time: beyond, adaptive steps are the only sane choice.
pub(crate) const MOST_HALVINGS: u32 = 11;

/// Changes of a result from which an order of convergence is read: the runs
/// behind them take a hundredth of the time of the whole search.
const SEEN: usize = 4;

/// At impact an order of 1 is what every method has; less is scatter.
const LEAST_ORDER: f64 = 1.0;

/// How a result changes as a fixed step is halved again and again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Halvings {
    changes: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Forecast {
    /// Observed order of convergence, at least 1.
    pub order: f64,
    /// Halvings still to be made.
    pub halvings: f64,
}

impl Halvings {
    /// Notes the relative change that the latest halving made.
    pub(crate) fn note(&mut self, change: f64) {
        self.changes.push(change);
    }

    pub(crate) fn last(&self) -> f64 {
        self.changes.last().copied().unwrap_or(f64::INFINITY)
    }

    /// The larger of the latest two changes: one small change may be two errors
    /// that happen to be alike.
    pub(crate) fn standing(&self) -> f64 {
        match self.changes[..] {
            [.., one, two] => one.max(two),
            _ => f64::INFINITY,
        }
    }

    /// Halvings that an accuracy still takes at the order seen so far (Richardson);
    /// `None` as long as too few changes are known.
    pub(crate) fn forecast(&self, accuracy: f64) -> Option<Forecast> {
        let seen = self.changes.get(self.changes.len().checked_sub(SEEN)?..)?;
        let (first, last) = (seen.first()?, seen.last()?);
        let order = (first / last).log2() / (SEEN - 1) as f64;
        let order = order.is_finite().then_some(order.max(LEAST_ORDER))?;
        let halvings = ((last / accuracy).log2() / order).ceil();
        Some(Forecast { order, halvings })
    }
}

#[cfg(test)]
#[path = "tests/accuracy.rs"]
mod tests;
