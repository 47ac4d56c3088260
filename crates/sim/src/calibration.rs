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
use crate::similar::{Places, speed_m_s};
use hertzchain_chain::ensemble::{End, Precision};
use hertzchain_chain::observe::{Competing, Maximum, Passage, Pulse};
use hertzchain_chain::{InstructionSet, System};
use rayon::prelude::*;
use std::fmt::{Display, Formatter, Result as Formatted};
use std::sync::Arc;

/// Least and most calibration shots of a batch: most where other numbers than the speed differ, and of large batches
/// at 1e-5 and looser, as errors may be larger in narrow ranges of speed. Of 2,000 shots of a row whose losses begin
/// with a quarter of its forces 18 were up to 1.5 times as wrong as stated with 48, and none with 96 and two settings
/// next to those in doubt.
const CALIBRATION_SHOTS: [usize; 2] = [48, 96];

/// Shots of a large batch for each calibration shot, between those.
const CALIBRATION_SHARE: usize = 8;

/// Batches of fewer shots are computed sooner with control per shot.
const WORTH_CALIBRATION: usize = 160;

/// What calibration shots are compared with is this many times as right as asked.
const TIGHTER: f64 = 20.0;

/// Most times that steps are halved for that.
const MOST_HALVINGS: usize = 6;

/// What batches need for calibration.
const NOT_UNIFORM: &str =
    "calibration is for uniform rows that fly free, damped moderately, timed by peaks";

/// Estimates are this many times the largest error over the condition of the calibration shots most
/// like one: in between others may be worse.
const MARGIN: f64 = 2.0;

/// And so many times as large where reflected maxima compete, because what contacts do behind the pulse
/// scatters errors: with 1.5, 3 of 601 shots of pump oil at 1e-6 were wrong by up to 1.4 times what was asked.
const COMPETING_MARGIN: f64 = 2.5;

/// From 1e-5 on so many times where maxima that compete are much lower than the pulse: with 1, 5 of 2,001
/// shots of 25 beads in gear oil were up to 1.15 times as wrong as they stated.
const LOWER_MAXIMA_MARGIN: f64 = 1.5;

/// And so many times as large where other numbers than the speed vary and less than 1e-5 is asked: with 1,
/// 2 of 345 shots of a map of damping at 1e-6 were more wrong than they stated, by up to 1.13 times.
const MAPS_MARGIN: f64 = 1.25;

/// Below this accuracy errors of rows whose maxima compete, and of those in which other numbers than the speed
/// vary, scatter more than calibration shots show: at 1e-7 14 of 1,501 shots of motor oil and 6 of 1,035 of maps
/// of damping were wrong by up to 2.3 times what was asked. Two settings must then agree.
const LEAST_OF_SCATTERED: f64 = 1e-6;

/// From this accuracy on two settings must agree on shots next to calibration shots that say nothing of theirs: those
/// with a kink or with other peaks. Below it that would leave 1 of 10 dry shots to the adaptive loop.
const LEAST_IN_DOUBT: f64 = 1e-5;

/// So many times their difference is at most what was asked.
const SECOND_SETTING_FACTOR: f64 = 2.0;

/// A peak whose interpolations differ by more than this many times what is usual has a kink near its
/// top, or another maximum, and may be wrong by so many times what is above that: pump and motor oil,
/// where two maxima become one.
const KINK_THRESHOLD: f64 = 2.0;
const KINK_ERROR_FACTOR: f64 = 40.0;

/// Share of the accuracy asked by which interpolations of smooth peaks differ at most.
const SMOOTH: f64 = 0.01;

/// Share of calibration shots that must be of the family, and converge.
const CONVERGED: f64 = 0.75;

/// Halving a step leaves at most a quarter of an error: what that changes is three times what is
/// left. Forces that begin or end within a step leave errors of order two.
const HALVING_FACTOR: f64 = 3.0;

/// Errors fall at most with this power of the step: settings that this shows to be too coarse
/// are not tried.
const HIGHEST_ORDER: f64 = 6.0;

/// Two maxima of which one is lower by no more than this many errors of heights may change places.
const HEIGHT_MARGIN: f64 = 4.0;

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
fn settings((end, longest_s): (End, f64)) -> Vec<Setting> {
    let of = |steps: &[f64], precision: Precision, openings: bool| {
        let setting = |&step: &f64| {
            let precision = Some(precision);
            Setting { step, precision, openings, shapes: false, end, longest_s }
        };
        steps.iter().map(setting).collect::<Vec<_>>()
    };
    let mut all = of(&SINGLE, Precision::Single, false);
    all.extend(of(&DOUBLE, Precision::Double, false));
    all.extend(of(&WITH_OPENINGS, Precision::Double, true));
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    all
}

/// Cost of a step in double precision and of one that locates openings over that of a step in
/// single precision.
const DOUBLE_COST: f64 = 2.0;
const OPENINGS_COST: f64 = 1.2;

/// Cost of a shot that waits for whatever may come over that of one that ends with its pulse.
const WAITING_COST: f64 = 1.8;

/// Time at which a pulse has passed the sensor on its way back, in times from the wall's peak to it.
const PASSED: f64 = 1.1;

/// Shots of a family wait so many times as long as its calibration shots take for all maxima of at least
/// a share of the reflected pulse's height; those of half of it compete.
const WATCHED: (f64, f64) = (1.05, 0.35);

/// Share of wall²/incident from which on the batch loop may take a maximum for the reflected pulse, until a
/// higher one comes, and end its wait behind it; less a tenth for errors of heights.
const TAKEN: f64 = 0.09;

/// Highest share of a pulse's peak that a competing maximum may have for errors to be those of a smooth
/// family: rounding, and what contacts do behind the pulse, move and merge higher ones.
const CLEAR: f64 = 0.8;

/// Below this accuracy openings are located where maxima compete: with single precision at 1e-5, 4 to 9 of
/// 6,001 wet shots, at speeds at which a contact opens while the sensor is at its peak, were wrong by up to 1.4
/// times what was asked.
const LEAST_WITHOUT_OPENINGS: f64 = 5e-5;

/// Cost of a shot of the adaptive loop, with two more to compare with, in steps of single precision
/// a contact time.
const ADAPTIVE_COST: f64 = 5000.0;

/// Shots may last this many times as long as the longest calibration shot.
const LONGEST: f64 = 1.5;

/// Calibration shots are computed first with steps of at least so many contact times, at any accuracy.
const FIRST: f64 = 0.036;

/// Shortest step that is tried on what longer ones leave open, before the adaptive loop: of pump oil, 2 of
/// 10,001 shots more are right with a quarter of it.
const SHORTEST: f64 = 0.017;

/// Share of the calibration shots for which the first setting looked for is right enough.
const NEARLY_ALL: f64 = 0.97;

/// A setting is added if it leaves at most this share of the cost.
const LESS: f64 = 0.95;

/// Settings of the loop with equal steps that calibration shots have shown to be right enough,
/// cheapest first: what one leaves open is computed with the next.
#[derive(Clone, Debug)]
pub struct Calibration {
    tiers: Vec<Tier>,
    /// One of the family, and its system.
    first: (Plan, Arc<System>),
    /// Largest estimate of a relative error of a time of flight among the calibration shots that
    /// are right enough.
    pub reached: f64,
    /// Number of calibration shots.
    pub shots: usize,
}

/// A setting, and how wrong its shots are.
#[derive(Clone, Debug)]
pub(crate) struct Tier {
    setting: Setting,
    places: Arc<Places>,
    /// One of each calibration shot.
    records: Vec<Record>,
    /// Relative error of a peak's height, with a margin.
    height_error: f64,
}

/// What the calibration shots like one show.
#[derive(Clone, Copy, Debug)]
struct Record {
    /// Relative error of a time of flight over the shot's condition, with a margin.
    error: f64,
    margin: f64,
    /// By how much interpolations of peaks usually differ.
    usual: f64,
    /// Whether any of them is right enough.
    serves: bool,
    /// Shots are right only where another setting agrees with them.
    needs_second: bool,
}

/// Shots of one setting.
type Tried = (Setting, Vec<Option<Shot>>);

/// Calibration shots, by speed, with what they are compared with.
struct Sample<'a> {
    plans: Vec<&'a Plan>,
    systems: Vec<Option<Arc<System>>>,
    /// The tightest, without kinks near their peaks, with bounds on their errors.
    exact: Vec<Option<(Shot, f64)>>,
    /// Which are far from exchanging maxima, converged or not.
    clear: Vec<bool>,
    /// Settings with which that was found, the longest step first.
    halved: Vec<Tried>,
    set: InstructionSet,
    places: Arc<Places>,
}

impl Calibration {
    /// The settings with which the plans' family is computed soonest, those shots counted that are
    /// not right enough and take a later one or the adaptive loop.
    ///
    /// The plans should span what the family spans: speeds, coefficients of laws; `by_speed` where
    /// all follows from the speed.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn new(
        plans: &[Plan],
        by_speed: bool,
        set: InstructionSet,
    ) -> Result<Self, &'static str> {
        let all = plans.len();
        let uniform = |plan: &&Plan| suits(plan) && accuracy::is_uniform(plan);
        let plans: Vec<&Plan> = plans.iter().filter(uniform).collect();
        let first = *plans.first().ok_or(NOT_UNIFORM)?;
        let system = first.chain.system().map_err(|_| "no shot can be computed")?;
        let family = |plan: &&Plan| belongs(plan, (first, &system));
        if (plans.len() as f64) < CONVERGED * all as f64 || !plans.iter().all(family) {
            return Err(NOT_UNIFORM);
        }
        let own = Setting::of(first).ok_or("equal steps do not reach this accuracy")?;
        let shots = plans.len();
        let sample = Sample::new(plans, own, (by_speed, set))?;
        let mut chosen =
            Self { tiers: Vec::new(), first: (first.clone(), system), reached: 0.0, shots };
        let mut rest = vec![ADAPTIVE_COST; shots];
        for tried in sample.halved.iter().rev() {
            let trial = sample.trial(tried, &rest);
            if trial.expected < LESS * mean(&rest) {
                rest = chosen.add(trial);
            }
        }
        // Errors over the condition are no larger with shorter steps.
        while let Some(last) = chosen.tiers.last().cloned()
            && 0.5 * last.setting.step >= SHORTEST
        {
            let setting = Setting { step: 0.5 * last.setting.step, ..last.setting };
            chosen.tiers.push(Tier { setting, ..last });
        }
        let mut tried = Vec::new();
        // First the cheapest that serves nearly all, then what is cheaper for some.
        if !sample.clear.contains(&false)
            && let Some(trial) = sample.cheaper_setting(&rest, &mut tried, NEARLY_ALL)
        {
            rest = chosen.add(trial);
        }
        while let Some(trial) = sample.cheaper_setting(&rest, &mut tried, 0.0) {
            rest = chosen.add(trial);
        }
        match chosen.tiers.is_empty() {
            true => Err("no setting that is right enough costs less"),
            false => Ok(chosen),
        }
    }

    /// Places from 0 of the calibration shots in a batch: the least and the largest value of each
    /// column, and others spread evenly. `None` if the batch is too small to be worth it.
    pub(crate) fn places(columns: &[&[f64]], accuracy: f64) -> Option<Vec<usize>> {
        let batch = columns.first()?.len();
        if batch < WORTH_CALIBRATION {
            return None;
        }
        let [least, most] = CALIBRATION_SHOTS;
        let count = match columns.len() > 1 {
            true => most,
            false if accuracy < LEAST_IN_DOUBT => least,
            false => (batch / CALIBRATION_SHARE).clamp(least, most),
        };
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

    /// Adds a setting in front of the others; what each calibration shot then costs.
    fn add(&mut self, trial: Trial) -> Vec<f64> {
        if self.tiers.is_empty() {
            self.reached = trial.reached;
        }
        self.reached = self.reached.max(trial.reached);
        self.tiers.insert(0, trial.tier);
        trial.costs
    }

    /// What is tried on shots, in this order.
    pub(crate) fn tiers(&self) -> &[Tier] {
        &self.tiers
    }

    /// Whether a plan is of the family.
    pub(crate) fn suits(&self, plan: &Plan) -> bool {
        let (first, system) = &self.first;
        belongs(plan, (first, system))
    }
}

impl Record {
    /// The relative error of a shot's times of flight.
    fn estimate(&self, Conditioning { forces, interpolation }: &Conditioning) -> f64 {
        self.error * forces + self.margin * interpolation + kink(*interpolation, self.usual)
    }
}

/// How wrong a kink may make times of flight.
fn kink(interpolation: f64, usual: f64) -> f64 {
    KINK_ERROR_FACTOR * (interpolation - KINK_THRESHOLD * usual).max(0.0)
}

impl Tier {
    /// Shots of plans with equal steps; `None` of those that fail.
    pub(crate) fn run(&self, plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
        run_lanes(plans, &systems(plans), set, &self.setting)
    }

    /// Whether it is worth trying at a plan's speed.
    pub(crate) fn serves(&self, plan: &Plan) -> bool {
        let at_speed = || self.places.closest(plan, None).is_some_and(|at| self.records[at].serves);
        !self.places.by_speed || at_speed()
    }

    /// Estimates the error of a shot. Whether it is what was asked, and does not differ by more
    /// than both estimates from the shot of another setting: what a kink near a peak does depends
    /// on where steps lie.
    pub(crate) fn is_right(&self, plan: &Plan, shot: &mut Shot, other: Option<&Shot>) -> bool {
        let is_small = self.is_small(plan, shot);
        let at = self.places.closest(plan, Some(shot));
        let needs_second = at.is_none_or(|at| self.records[at].needs_second);
        let own = shot.accuracy_reached.unwrap_or(f64::INFINITY);
        let agrees = |other: &Shot| {
            let most = match needs_second {
                true => shot.accuracy_asked / SECOND_SETTING_FACTOR,
                false => own + other.accuracy_reached.unwrap_or(f64::INFINITY),
            };
            shot.change(other) <= most
        };
        let agrees = other.map_or(!needs_second, agrees);
        if needs_second && agrees {
            // Two settings confirm the accuracy asked and no better one.
            shot.accuracy_reached = Some(own.max(shot.accuracy_asked));
        }
        is_small && agrees
    }

    /// Estimates the error of a shot, and whether it is at most what was asked.
    fn is_small(&self, plan: &Plan, shot: &mut Shot) -> bool {
        let Some(at) = self.places.closest(plan, Some(shot)) else {
            return false;
        };
        let record = &self.records[at];
        let reached = record.estimate(&shot.conditioning);
        shot.accuracy_reached = Some(reached);
        let passage = shot.passage.as_ref();
        reached <= shot.accuracy_asked
            && record.serves
            && (self.setting.end != End::Passed || is_alone(shot))
            && (self.setting.precision != Some(Precision::Single) || is_clear(shot))
            && passage.is_ok_and(|passage| !may_flip(passage, self.height_error))
    }
}

impl Display for Calibration {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        let precision = |tier: &Tier| match tier.setting.precision {
            Some(Precision::Single) => "single",
            _ => "double",
        };
        let tier = |tier: &Tier| {
            format!("{} precision, steps of {} contact times", precision(tier), tier.setting.step)
        };
        let tiers: Vec<String> = self.tiers.iter().map(tier).collect();
        write!(
            f,
            "{}, chosen by {} calibration shots that are right to {:.0e}",
            tiers.join(", then "),
            self.shots,
            self.reached
        )
    }
}

/// Whether interpolations of a shot's peaks agree to a small share of what is asked: no kink is near.
fn is_smooth(shot: &Shot) -> bool {
    shot.conditioning.interpolation <= SMOOTH * shot.accuracy_asked
}

impl<'a> Sample<'a> {
    /// With times of flight right to a small share of what is asked: steps are halved until that
    /// changes none by more, but those of a few shots with kinks near their peaks.
    fn new(
        mut plans: Vec<&'a Plan>,
        own: Setting,
        (by_speed, set): (bool, InstructionSet),
    ) -> Result<Self, &'static str> {
        plans.sort_by(|a, b| speed_m_s(a).total_cmp(&speed_m_s(b)));
        let systems = systems(&plans);
        let run = |setting: Setting| {
            let shots = side_by_side(&plans, &systems, set, &setting);
            (setting, shots)
        };
        let precision = Some(Precision::Double);
        let own = Setting { step: own.step.max(FIRST), ..own };
        let mut setting = Setting { precision, openings: true, shapes: false, ..own };
        let mut halved = vec![run(setting)];
        let first = &halved[0].1;
        // Shorter steps need not wait for whatever may come.
        setting.end = end(first);
        let clear: Vec<bool> =
            first.iter().map(|shot| shot.as_ref().is_none_or(is_clear)).collect();
        for halving in 1..=MOST_HALVINGS {
            let step = own.step * 0.5_f64.powi(halving as i32);
            if clear.contains(&false) && !by_speed {
                return Err("several maxima compete for the reflected pulse");
            }
            halved.push(run(Setting { step, ..setting }));
            let [.., (_, coarse), (_, fine)] = &halved[..] else { break };
            let smooth = |(coarse, fine): (&Option<Shot>, &Option<Shot>)| {
                let (coarse, fine) = (coarse.as_ref()?, fine.as_ref()?);
                let error = fine.change(coarse) / HALVING_FACTOR;
                (is_smooth(coarse) && is_smooth(fine)).then(|| (fine.clone(), error))
            };
            let mut exact: Vec<Option<(Shot, f64)>> = coarse.iter().zip(fine).map(smooth).collect();
            let rest = plans[0].accuracy / TIGHTER;
            let converged =
                exact.iter().flatten().filter(|(_, error)| *error <= rest).count() as f64;
            exact.iter_mut().flatten().for_each(|(_, error)| *error = error.max(rest));
            if converged >= CONVERGED * plans.len() as f64 {
                let places = Arc::new(Places::new(&plans, &halved[0].1, by_speed));
                return Ok(Self { plans, systems, exact, clear, halved, set, places });
            }
        }
        Err("calibration shots do not converge")
    }

    /// What a setting is worth, in front of others with which each shot costs `rest`.
    fn trial(&self, (setting, shots): &Tried, rest: &[f64]) -> Trial {
        let mut tier = self.tier(setting, shots);
        let right = |at: usize| {
            let mut shot = shots[at].clone()?;
            tier.is_small(self.plans[at], &mut shot).then_some(shot)
        };
        let right: Vec<Option<Shot>> = (0..shots.len()).map(right).collect();
        let hidden = |(shot, (exact, error)): (&Shot, &(Shot, f64))| {
            shot.change(exact) > shot.accuracy_asked + error
        };
        let hides = pairs(&right, &self.exact).any(hidden);
        let single = setting.precision == Some(Precision::Single);
        for (at, record) in tier.records.iter_mut().enumerate() {
            let near = self.places.near(at);
            let clear = near.iter().all(|&at| self.clear[at]);
            record.serves = (clear || !single) && near.iter().any(|&at| right[at].is_some());
        }
        let cost = |((record, right), rest): ((&Record, &Option<Shot>), &f64)| {
            let own = if record.serves { cost(setting) } else { 0.0 };
            own + if right.is_some() { 0.0 } else { *rest }
        };
        let costs: Vec<f64> = tier.records.iter().zip(&right).zip(rest).map(cost).collect();
        let expected = if hides { f64::INFINITY } else { mean(&costs) };
        let estimates = |shots: &[Option<Shot>]| -> Vec<f64> {
            shots.iter().flatten().filter_map(|shot| shot.accuracy_reached).collect()
        };
        let reached = estimates(&right).into_iter().fold(0.0, f64::max);
        let all = shots.iter().zip(&tier.records).filter_map(|(shot, record)| {
            let shot = shot.as_ref()?;
            Some(record.error * shot.conditioning.forces / shot.accuracy_asked)
        });
        let share = right.iter().flatten().count() as f64 / right.len() as f64;
        Trial { expected, share, costs, reached, excess: quantile(all.collect(), 0.25), tier }
    }

    /// A setting with what its shots show.
    fn tier(&self, setting: &Setting, shots: &[Option<Shot>]) -> Tier {
        let accuracy = self.plans[0].accuracy;
        let rest = accuracy / TIGHTER;
        let same = |at: usize| {
            let (shot, (exact, error)) = (shots[at].as_ref()?, self.exact[at].as_ref()?);
            shot.has_peaks_of(exact, SAME_PEAK).then(|| (shot, shot.change(exact) + error))
        };
        let by_speed = self.places.by_speed;
        let scattered = accuracy < LEAST_OF_SCATTERED && (!by_speed || self.clear.contains(&false));
        let of_maps = if !by_speed && accuracy < 1e-5 { MAPS_MARGIN } else { 1.0 };
        let record = |at: usize| {
            let near = self.places.near(at);
            let clear = accuracy >= 1e-5 && near.iter().all(|&at| self.clear[at]);
            let competing = match setting.end {
                End::Passed => 1.0,
                _ if clear => LOWER_MAXIMA_MARGIN,
                _ => COMPETING_MARGIN,
            };
            let margin = competing * of_maps * MARGIN;
            let known = near.iter().filter_map(|&at| shots[at].as_ref());
            let usual = quantile(known.map(|shot| shot.conditioning.interpolation).collect(), 0.5);
            let smooth =
                |(shot, _): &(&Shot, f64)| kink(shot.conditioning.interpolation, usual) <= rest;
            let known = |at: usize| same(at).filter(smooth);
            let errors = near.iter().filter_map(|&at| known(at));
            let errors = errors.map(|(shot, error)| error / shot.conditioning.forces);
            let error = margin * errors.reduce(f64::max).unwrap_or(f64::INFINITY);
            let says_nothing = self.places.next_to(at).any(|at| known(at).is_none());
            let in_doubt = by_speed && accuracy >= LEAST_IN_DOUBT && says_nothing;
            Record { error, margin, usual, serves: true, needs_second: scattered || in_doubt }
        };
        let heights = pairs(shots, &self.exact)
            .filter(|(shot, (exact, _))| shot.has_peaks_of(exact, SAME_PEAK));
        let heights = heights.map(|(shot, (exact, _))| shot.peaks_change(exact));
        Tier {
            setting: *setting,
            places: Arc::clone(&self.places),
            records: (0..shots.len()).map(record).collect(),
            height_error: HEIGHT_MARGIN * heights.fold(rest, f64::max),
        }
    }

    /// The setting that makes shots cheapest in front of others with which each costs `rest`, of
    /// those that are right enough for a least share of them.
    fn cheaper_setting(
        &self,
        rest: &[f64],
        tried: &mut Vec<Tried>,
        least_share: f64,
    ) -> Option<Trial> {
        let end = self.halved.last().map_or(End::Reflected, |(setting, _)| setting.end);
        // Steps too long for strong losses make motion that never ends.
        let durations_s = self.exact.iter().flatten().map(|(shot, _)| shot.duration_s);
        let longest_s = LONGEST * durations_s.fold(0.0, f64::max);
        let mut best: Option<Trial> = None;
        // The longest step worth trying, of each kind of setting.
        let mut longest: Vec<(Setting, f64)> = Vec::new();
        let sharp = self.plans[0].accuracy < LEAST_WITHOUT_OPENINGS && end != End::Passed;
        let right = |setting: &Setting| setting.openings || !sharp;
        for setting in settings((end, longest_s)).into_iter().filter(right) {
            let least = best.as_ref().map_or(LESS * mean(rest), |best| best.expected);
            if cost(&setting) >= least {
                break;
            }
            let too_long = |(tried, longest): &(Setting, f64)| {
                setting.step > *longest && *tried == Setting { step: tried.step, ..setting }
            };
            if longest.iter().any(too_long) {
                continue;
            }
            let at = tried.iter().position(|(known, _)| *known == setting).unwrap_or_else(|| {
                let shots = side_by_side(&self.plans, &self.systems, self.set, &setting);
                tried.push((setting, shots));
                tried.len() - 1
            });
            let trial = self.trial(&tried[at], rest);
            let shorter = trial.excess.max(1.0).powf(-HIGHEST_ORDER.recip());
            longest.extend((shorter > 0.0).then_some((setting, setting.step * shorter)));
            let serves = trial.share >= least_share && trial.expected < least;
            best = Some(trial).filter(|_| serves).or(best);
        }
        best
    }
}

/// What calibration shots give with one setting.
struct Trial {
    tier: Tier,
    /// Cost of each calibration shot.
    costs: Vec<f64>,
    /// Their mean; infinite where one is wrong and does not show it.
    expected: f64,
    /// Share of them that are right enough.
    share: f64,
    /// Largest estimate of those that are right enough.
    reached: f64,
    /// Lower quartile of the estimates over the accuracy asked.
    excess: f64,
}

/// What both of two computations have.
fn pairs<'a, T>(
    one: &'a [Option<Shot>],
    other: &'a [Option<T>],
) -> impl Iterator<Item = (&'a Shot, &'a T)> {
    one.iter().zip(other).filter_map(|(one, other)| Some((one.as_ref()?, other.as_ref()?)))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get((share * values.len() as f64) as usize).copied().unwrap_or(f64::INFINITY)
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

/// Share of the highest maximum that competes with the reflected pulse of a shot.
fn competing_share(shot: &Shot) -> f64 {
    let Ok(passage) = &shot.passage else { return f64::INFINITY };
    passage.highest_competing(&[Pulse::Reflected]).map_or(0.0, |other| other.share)
}

/// Whether nothing competes with the reflected pulse of a shot, which is then over when it has
/// passed. Small errors exchange and merge maxima that compete, and runs with equal steps may
/// have the same errors.
fn is_alone(shot: &Shot) -> bool {
    competing_share(shot) == 0.0
}

/// Whether nothing nearly as high as the reflected pulse competes with it.
fn is_clear(shot: &Shot) -> bool {
    competing_share(shot) <= CLEAR
}

/// When shots like these, which were followed to the end, are over.
fn end(shots: &[Option<Shot>]) -> End {
    let found: Vec<&Shot> = shots.iter().flatten().collect();
    if found.iter().all(|shot| is_alone(shot) && waiting(shot, 1.0) == 1.0) {
        return End::Passed;
    }
    let last = found.iter().map(|shot| waiting(shot, WATCHED.1)).fold(PASSED, f64::max);
    if last.is_finite() { End::Behind(WATCHED.0 * last) } else { End::Reflected }
}

/// The time of the last returning maximum of at least a share of the reflected pulse's height, from the wall's
/// peak, over that of the first one that could be taken for the pulse until a higher one comes; infinite
/// without one.
fn waiting(shot: &Shot, share: f64) -> f64 {
    let Some((passage, peak)) =
        shot.passage.as_ref().ok().and_then(|passage| Some((passage, passage.reflected?)))
    else {
        return f64::INFINITY;
    };
    let at_least = |height: f64| {
        let high = move |maximum: &&Maximum| maximum.value >= height;
        passage.returning_maxima.iter().filter(high).map(|it| it.time_s - passage.wall.time_s)
    };
    let taken = (TAKEN * passage.wall.value.powi(2) / passage.incident.value).min(peak.value);
    match (at_least(taken).next(), at_least(share * peak.value).next_back()) {
        (Some(first_s), Some(last_s)) => last_s / first_s,
        _ => f64::INFINITY,
    }
}

/// Cost of a shot, in steps of single precision a contact time.
fn cost(setting: &Setting) -> f64 {
    let double = if setting.precision == Some(Precision::Single) { 1.0 } else { DOUBLE_COST };
    let openings = if setting.openings { OPENINGS_COST } else { 1.0 };
    let waiting = match setting.end {
        End::Behind(ways) => (1.0 + ways) / (1.0 + PASSED),
        End::Reflected => WAITING_COST,
        End::Passed | End::Duration => 1.0,
    };
    double * openings * waiting / setting.step
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
