//! Calibration: one setting of the loop with equal steps for a family of shots.
//!
//! Uniform rows that differ in speeds and coefficients alone err alike if their steps are
//! alike in contact times. Calibration shots, compared with ones at much shorter steps,
//! say how much: the relative error of a time of flight over the shot's *condition*, which
//! says how far an error of the forces moves its peaks. Every other shot then estimates its
//! error from its own condition (`docs/explanation/numerics.md`).

use crate::accuracy;
use crate::engine::{Setting, fit_together, run_lanes, suits, systems};
use crate::plan::Plan;
use crate::shot::{Conditioning, Shot};
use hertzchain_chain::ensemble::Precision;
use hertzchain_chain::observe::{Competing, Passage, Pulse};
use hertzchain_chain::{InstructionSet, System};
use rayon::prelude::*;
use std::fmt::{Display, Formatter, Result as Formatted};
use std::sync::Arc;

/// Calibration shots of a batch over speeds, and of one in which other numbers differ too.
const CALIBRATION_SHOTS: [usize; 2] = [48, 96];

/// Batches of fewer shots are computed sooner with control per shot.
const WORTH_CALIBRATION: usize = 160;

/// What calibration shots are compared with is this many times as right as asked.
const TIGHTER: f64 = 20.0;

/// Most times that steps are halved for that.
const MOST_HALVINGS: usize = 6;

/// Estimates are this many times the largest error of calibration shots of the same condition: in
/// between others may be worse.
const MARGIN: f64 = 1.5;

/// Halving a step leaves at most a quarter of an error: what that changes is three times what is
/// left. Forces that begin or end within a step leave errors of order two.
const OF_HALVING: f64 = 3.0;

/// Errors fall at most with this power of the step: settings that this shows to be too coarse
/// are not tried.
const HIGHEST_ORDER: f64 = 6.0;

/// Two maxima of which one is lower by no more than this many errors of heights may change places.
const OF_HEIGHTS: f64 = 4.0;

/// Two computations of a peak that differ by less than this many steps have the same peak.
const SAME_PEAK: f64 = 1.0;

/// Steps in contact times that are tried: in single precision, in double, and where openings are
/// located too.
const SINGLE: [f64; 16] = [
    0.36, 0.33, 0.3, 0.27, 0.24, 0.22, 0.2, 0.18, 0.16, 0.145, 0.13, 0.115, 0.107, 0.1, 0.092,
    0.085,
];
const DOUBLE: [f64; 5] = [0.2, 0.17, 0.15, 0.135, 0.12];
const WITH_OPENINGS: [f64; 21] = [
    0.12, 0.11, 0.1, 0.092, 0.085, 0.077, 0.07, 0.063, 0.057, 0.052, 0.047, 0.042, 0.038, 0.034,
    0.03, 0.026, 0.022, 0.019, 0.016, 0.0135, 0.011,
];

/// Settings, cheapest first.
fn settings() -> Vec<(Setting, Precision)> {
    let of = |steps: &[f64], precision: Precision, openings: bool| {
        let setting = |&step: &f64| {
            let precision = Some(precision);
            Setting { step, precision, openings, shapes: false, passed: true }
        };
        steps.iter().map(setting).map(|setting| (setting, precision)).collect::<Vec<_>>()
    };
    let mut all = of(&SINGLE, Precision::Single, false);
    all.extend(of(&DOUBLE, Precision::Double, false));
    all.extend(of(&WITH_OPENINGS, Precision::Double, true));
    all.sort_by(|(a, of_a), (b, of_b)| cost(a, *of_a).total_cmp(&cost(b, *of_b)));
    all
}

/// Cost of a step in double precision, of one that locates openings, and of control per shot with
/// its three runs that wait for whatever may come, over that of a step in single precision.
const OF_DOUBLE: f64 = 2.0;
const OF_OPENINGS: f64 = 1.2;
const OF_PER_SHOT: f64 = 5.0;

/// A setting of the loop with equal steps that calibration shots have shown to be right enough.
#[derive(Clone, Debug)]
pub struct Calibration {
    setting: Setting,
    /// One of the family, and its system.
    first: (Plan, Arc<System>),
    /// Relative error of a time of flight over the shot's condition, with a margin.
    error: f64,
    /// Relative error of a peak's height, with a margin.
    height_error: f64,
    /// Largest estimate of a relative error of a time of flight among the calibration shots that
    /// are right enough.
    pub reached: f64,
    /// Number of calibration shots.
    pub shots: usize,
}

/// Calibration shots with what they are compared with.
struct Sample<'a> {
    plans: Vec<&'a Plan>,
    systems: Vec<Option<Arc<System>>>,
    exact: Vec<Shot>,
    set: InstructionSet,
}

impl Calibration {
    /// The setting with which the plans' family is computed soonest, those shots counted that are
    /// not right enough and take the adaptive loop.
    ///
    /// The plans should span what the family spans: speeds, coefficients of laws.
    ///
    /// # Errors
    /// Why there is none.
    pub fn new(plans: &[Plan], set: InstructionSet) -> Result<Self, &'static str> {
        let first = plans.first().ok_or("no shot can be computed")?;
        let system = first.chain.system().map_err(|_| "no shot can be computed")?;
        let family = |plan: &Plan| belongs(plan, (first, &system));
        if !plans.iter().all(family) {
            return Err("calibration is for uniform rows that fly free, timed by peaks");
        }
        let own = Setting::of(first).ok_or("equal steps do not reach this accuracy")?;
        let per_shot = OF_PER_SHOT * cost(&own, Precision::Double);
        let sample = Sample::new(plans, own, set)?;
        let mut best: Option<(f64, Self)> = None;
        // The longest step worth trying, of each kind of setting.
        let mut longest: Vec<(Setting, f64)> = Vec::new();
        for (setting, precision) in settings() {
            let step = setting.step;
            let least = best.as_ref().map_or(per_shot, |(least, _)| *least);
            if cost(&setting, precision) >= least {
                break;
            }
            let too_long = |(tried, longest): &(Setting, f64)| {
                step > *longest && *tried == Setting { step: tried.step, ..setting }
            };
            if longest.iter().any(too_long) {
                continue;
            }
            let trial = sample.try_setting(setting, (first, &system));
            let shorter = trial.excess.max(1.0).powf(-HIGHEST_ORDER.recip());
            longest.extend((shorter > 0.0).then_some((setting, step * shorter)));
            let expected = cost(&setting, precision) + trial.missed * per_shot;
            if let Some(calibration) = trial.calibration.filter(|_| expected < least) {
                best = Some((expected, calibration));
            }
        }
        let best = best.map(|(_, calibration)| calibration);
        best.ok_or("no setting that is right enough costs less")
    }

    /// Places from 0 of the calibration shots in a batch: the least and the largest value of each
    /// column, and others spread evenly. `None` if the batch is too small to be worth it.
    pub(crate) fn places(columns: &[&[f64]]) -> Option<Vec<usize>> {
        let batch = columns.first()?.len();
        if batch < WORTH_CALIBRATION {
            return None;
        }
        let count = CALIBRATION_SHOTS[usize::from(columns.len() > 1)];
        let mut places: Vec<usize> = columns.iter().flat_map(|column| extremes(column)).collect();
        // Multiples of the golden ratio leave no gap and no period.
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let spread = (1..).map(|i| ((f64::from(i) * golden).fract() * batch as f64) as usize);
        for place in spread.take(4 * count) {
            if places.len() < count && !places.contains(&place) {
                places.push(place);
            }
        }
        places.sort_unstable();
        places.dedup();
        Some(places)
    }

    /// Shots of plans with equal steps; `None` of those that are not right enough or not of
    /// the family.
    pub(crate) fn run(&self, plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
        let (first, system) = &self.first;
        let mut systems = systems(plans);
        for (plan, own) in plans.iter().zip(&mut systems) {
            *own = own.take().filter(|_| belongs(plan, (first, system)));
        }
        let shots = run_lanes(plans, &systems, set, &self.setting).into_iter();
        shots.map(|shot| self.right_enough(shot?)).collect()
    }

    /// The relative error of a shot's times of flight.
    fn estimate(&self, shot: &Shot) -> f64 {
        let Conditioning { forces, interpolation } = shot.conditioning;
        self.error * forces + MARGIN * interpolation
    }

    /// The shot with its estimate, if that is what was asked.
    fn right_enough(&self, mut shot: Shot) -> Option<Shot> {
        let reached = self.estimate(&shot);
        let sure = is_alone(&shot) && !may_flip(shot.passage.as_ref().ok()?, self.height_error);
        let right = reached <= shot.accuracy_asked && sure;
        shot.accuracy_reached = Some(reached);
        right.then_some(shot)
    }
}

impl Display for Calibration {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        let precision = match self.setting.precision {
            Some(Precision::Single) => "single",
            _ => "double",
        };
        write!(
            f,
            "{precision} precision, steps of {} contact times, chosen by {} calibration shots that are right to {:.0e}",
            self.setting.step, self.shots, self.reached
        )
    }
}

impl<'a> Sample<'a> {
    /// With times of flight right to a small share of what is asked: steps are halved until that
    /// changes none by more.
    fn new(plans: &'a [Plan], own: Setting, set: InstructionSet) -> Result<Self, &'static str> {
        let plans: Vec<&Plan> = plans.iter().collect();
        let systems = systems(&plans);
        let run = |step: f64| {
            let setting =
                Setting { step, precision: Some(Precision::Double), openings: true, ..own };
            let shots = side_by_side(&plans, &systems, set, &setting).into_iter();
            let shots: Option<Vec<Shot>> = shots.collect();
            shots.ok_or("calibration shots are not finished by equal steps")
        };
        let mut step = own.step;
        let mut exact = run(step)?;
        for _ in 0..MOST_HALVINGS {
            if !exact.iter().all(is_alone) {
                return Err("several maxima compete for the reflected pulse");
            }
            step *= 0.5;
            let coarse = std::mem::replace(&mut exact, run(step)?);
            let right = |(fine, coarse): (&Shot, &Shot)| {
                fine.change(coarse) <= OF_HALVING * fine.accuracy_asked / TIGHTER
            };
            if exact.iter().zip(&coarse).all(right) {
                return Ok(Self { plans, systems, exact, set });
            }
        }
        Err("calibration shots do not converge")
    }

    /// What the shots give with a setting.
    fn try_setting(&self, setting: Setting, (first, system): (&Plan, &Arc<System>)) -> Trial {
        let shots = side_by_side(&self.plans, &self.systems, self.set, &setting);
        let pairs = || shots.iter().zip(&self.exact);
        let known = || pairs().filter_map(|(shot, exact)| Some((shot.as_ref()?, exact)));
        let same = || known().filter(|(shot, exact)| shot.has_peaks_of(exact, SAME_PEAK));
        let heights = same().map(|(shot, exact)| shot.peaks_change(exact));
        let height_error = OF_HEIGHTS * heights.fold(first.accuracy / TIGHTER, f64::max);
        let rest = first.accuracy / TIGHTER;
        let errors =
            same().map(|(shot, exact)| (shot.change(exact) + rest) / shot.conditioning.forces);
        let calibration = Calibration {
            setting,
            first: (first.clone(), system.clone()),
            error: MARGIN * errors.fold(0.0, f64::max),
            height_error,
            reached: 0.0,
            shots: self.plans.len(),
        };
        let estimates = known().map(|(shot, _)| calibration.estimate(shot));
        let excess = median(estimates.collect()) / first.accuracy;
        let right = |shot: &Shot| calibration.right_enough(shot.clone());
        let hidden = |(shot, exact): (&Shot, &Shot)| {
            right(shot).is_some_and(|shot| shot.change(exact) > shot.accuracy_asked)
        };
        let is_hidden = known().any(hidden);
        let right: Vec<Shot> = shots.iter().flatten().filter_map(right).collect();
        let reached = right.iter().filter_map(|shot| shot.accuracy_reached);
        let reached = reached.fold(0.0, f64::max);
        let missed = 1.0 - right.len() as f64 / self.plans.len() as f64;
        let calibration = (!is_hidden).then_some(Calibration { reached, ..calibration });
        Trial { calibration, missed, excess }
    }
}

/// What calibration shots give with one setting.
struct Trial {
    /// `None` where a shot is wrong and does not show it.
    calibration: Option<Calibration>,
    /// Share of shots that are not right enough.
    missed: f64,
    /// Median of the estimates over the accuracy asked.
    excess: f64,
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Shots of all plans with a setting, on all threads.
fn side_by_side(
    plans: &[&Plan],
    systems: &[Option<Arc<System>>],
    set: InstructionSet,
    setting: &Setting,
) -> Vec<Option<Shot>> {
    let lanes = Precision::Single.lanes();
    let parts = plans.par_chunks(lanes).zip(systems.par_chunks(lanes));
    parts.flat_map_iter(|(plans, systems)| run_lanes(plans, systems, set, setting)).collect()
}

/// Whether nothing competes with the reflected pulse of a shot, which is then over when it has
/// passed. Small errors exchange and merge maxima that compete, and runs with equal steps may
/// have the same errors.
fn is_alone(shot: &Shot) -> bool {
    let of_return = |other: &Competing| other.pulse == Pulse::Reflected;
    let passage = shot.passage.as_ref();
    passage.is_ok_and(|passage| !passage.competing.iter().any(of_return))
}

/// Cost of a shot, in steps of single precision a contact time.
fn cost(setting: &Setting, precision: Precision) -> f64 {
    let double = if precision == Precision::Double { OF_DOUBLE } else { 1.0 };
    let openings = if setting.openings { OF_OPENINGS } else { 1.0 };
    double * openings / setting.step
}

/// Whether a plan is of a family.
fn belongs(plan: &Plan, (first, system): (&Plan, &System)) -> bool {
    let like = || plan.chain.system().is_ok_and(|own| own.has_shape_of(system));
    suits(plan) && accuracy::is_uniform(plan) && fit_together(first, plan) && like()
}

/// Whether another maximum could be a pulse's peak if heights are so wrong.
fn may_flip(passage: &Passage, height_error: f64) -> bool {
    let near = |other: &Competing| (1.0 - other.share).abs() <= height_error;
    passage.competing.iter().any(near)
}

/// Places of the least and the largest value that is a number.
fn extremes(column: &[f64]) -> impl Iterator<Item = usize> {
    let places = || (0..column.len()).filter(|&at| column[at].is_finite());
    let by = |&a: &usize, &b: &usize| column[a].total_cmp(&column[b]);
    [places().min_by(by), places().max_by(by)].into_iter().flatten()
}
