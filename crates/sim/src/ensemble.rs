//! Many plans at once.
//!
//! Plans that ask for times of flight alone run in the ensemble loop, side by
//! side on every thread; what that loop does not have, or does not finish
//! well, runs one by one in the wave loop.

use crate::accuracy;
use crate::duration::{self, has_wall};
use crate::error::StudyError;
use crate::flight::Flight;
use crate::gun::{closed_gaps, is_ambiguous};
use crate::plan::{Pick, Plan, Solver};
use crate::shot::{Shot, ambiguous, reported, shoot, shoot_checked};
use crate::stop::stopped;
use crate::tuned::Tuned;
use hertzchain_chain::ensemble::{self, End, Flown, Precision};
use hertzchain_chain::observe::{Passage, Passages};
use hertzchain_chain::{InstructionSet, Sensor, Start, System};
use rayon::prelude::*;

/// Runs plans on all threads of the current rayon pool; results are in order
/// and have the same bits whatever the number of threads and whatever else is
/// fired along.
///
/// `progress` is called once a plan, from any thread. In the ensemble loop every
/// shot is computed three times and carries the accuracy it reached; so it does in the wave
/// loop, but one that follows its striker only with `checked`.
pub fn shoot_all(
    plans: &[Plan],
    set: InstructionSet,
    checked: bool,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    in_blocks(plans, progress, |block| {
        shoot_block(block, judged(block, set), checked)
    })
}

/// Runs plans like those that pilots have tuned a setting for, several times as
/// fast as [`shoot_all`], in order and with the same bits whatever the number of
/// threads.
///
/// The accuracy that shots carry is that of the pilots. A shot that longer steps
/// change by more than the accuracy asked is unlike them, and computed as by
/// [`shoot_all`].
pub fn shoot_tuned(
    plans: &[Plan],
    tuned: &Tuned,
    set: InstructionSet,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    in_blocks(plans, progress, |block| {
        let judged_alone = |plan: &&Plan| judged(&[*plan], set).pop().flatten();
        let fired = tuned.fired(block, set).into_iter().zip(block);
        let fired = fired.map(|(shot, plan)| shot.or_else(|| judged_alone(plan)));
        shoot_block(block, fired.collect(), true)
    })
}

/// The same as [`shoot_all`] for who needs many shots at known accuracy more than the accuracy of
/// each, such as a fit: nothing is computed twice, and no shot reports what it
/// reached. Whatever the ensemble loop does not have, or loses, the wave loop
/// computes, and checks where another maximum could be the reflected pulse's peak.
pub fn shoot_unjudged(plans: &[Plan], set: InstructionSet) -> Vec<Result<Shot, StudyError>> {
    in_blocks(plans, &|| {}, |block| {
        let own = block.first().and_then(|plan| Setting::of(plan));
        let once = |own: Setting| {
            let bare = Setting {
                shapes: false,
                ..own
            };
            fire(block, &load(block), set, &bare)
        };
        let shots = own.map_or_else(|| vec![None; block.len()], once);
        let shots = block.iter().zip(shots);
        shots
            .map(|(plan, shot)| shot.map_or_else(|| shoot_unambiguous(plan), Ok))
            .collect()
    })
}

/// A shot computed once, or checked where its peaks could be others.
fn shoot_unambiguous(plan: &Plan) -> Result<Shot, StudyError> {
    let shot = shoot(plan)?;
    match is_ambiguous(&shot) {
        true => shoot_checked(plan),
        false => Ok(shot),
    }
}

/// Plans in blocks over threads, each block as `fired` has it.
fn in_blocks(
    plans: &[Plan],
    progress: &(dyn Fn() + Sync),
    fired: impl Fn(&[&Plan]) -> Vec<Result<Shot, StudyError>> + Sync,
) -> Vec<Result<Shot, StudyError>> {
    let mut results: Vec<Option<Result<Shot, StudyError>>> = vec![None; plans.len()];
    let shots: Vec<_> = blocks(plans)
        .par_iter()
        .flat_map_iter(|block| {
            let together: Vec<&Plan> = block.iter().map(|&at| &plans[at]).collect();
            let shots = match stopped() {
                true => vec![Err(StudyError::Stopped); block.len()],
                false => fired(&together),
            };
            together.iter().for_each(|_| progress());
            block.iter().copied().zip(shots).collect::<Vec<_>>()
        })
        .collect();
    for (at, shot) in shots {
        results[at] = Some(shot);
    }
    results.into_iter().flatten().collect()
}

/// Plans to be fired together: alike in accuracy, sensor, length and what ends them.
fn blocks(plans: &[Plan]) -> Vec<Vec<usize>> {
    let mut blocks = Vec::new();
    let mut open: Vec<Vec<usize>> = Vec::new();
    for (at, plan) in plans.iter().enumerate() {
        if !suits(plan) {
            blocks.push(vec![at]);
            continue;
        }
        let together = |block: &&mut Vec<usize>| fire_together(&plans[block[0]], plan);
        match open.iter_mut().find(together) {
            Some(block) => block.push(at),
            None => open.push(vec![at]),
        }
        let full = open
            .iter()
            .position(|block| block.len() == Precision::Single.lanes());
        blocks.extend(full.map(|at| open.swap_remove(at)));
    }
    blocks.extend(open);
    blocks
}

pub(crate) fn fire_together(one: &Plan, other: &Plan) -> bool {
    one.accuracy == other.accuracy
        && one.sensor_bead == other.sensor_bead
        && one.picks().eq(other.picks())
        && one.chain.beads.len() == other.chain.beads.len()
        && one.duration_s.is_none() == other.duration_s.is_none()
}

/// Whether the ensemble loop can run a plan to the accuracy asked.
pub(crate) fn suits(plan: &Plan) -> bool {
    plan.solver == Solver::Adaptive
        && !plan.rebound
        && !plan.budget
        && plan.watch.is_none()
        && plan.chain.suspension_m.is_none()
        && !matches!(plan.chain.start, Start::Driven { .. })
        && has_wall(&plan.chain.far)
        && accuracy::equal_steps(plan).is_some()
}

/// Steps by which a shot is judged, over its own, and what the change that they
/// make counts. Two: one alone agrees by chance with what is wrong in one row of
/// a hundred. The accuracy reached is the larger of both: an error of order 1,
/// which closings leave now and then, is three times the change by the first
/// and once and a half that by the second.
pub const JUDGES: [(f64, f64); 2] = [(1.3, 3.0), (1.69, 1.5)];

/// Rows of which forces are cut, or begin and end otherwise than the paper's, are up
/// to 2.5 times as wrong as the changes say.
const OF_SHARP: f64 = 3.0;

/// Shots of plans that go together, or of one that goes alone: what was fired,
/// and the rest by the wave loop.
fn shoot_block(
    plans: &[&Plan],
    fired: Vec<Option<Shot>>,
    checked: bool,
) -> Vec<Result<Shot, StudyError>> {
    // Times of flight are always checked.
    let alone = |plan: &Plan| match checked || !plan.rebound {
        true => shoot_checked(plan),
        false => shoot(plan),
    };
    let shots = plans.iter().zip(fired);
    shots
        .map(|(plan, shot)| shot.map_or_else(|| alone(plan), Ok))
        .collect()
}

/// Shots of plans by the ensemble loop, each with the accuracy it reached;
/// `None` where the wave loop must have a look, because that is not what was
/// asked or if only to say what is wrong.
fn judged(plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
    let Some(own) = plans.first().and_then(|plan| Setting::of(plan)) else {
        return vec![None; plans.len()];
    };
    let loaded = load(plans);
    let shots = fire(plans, &loaded, set, &own).into_iter();
    let [near, far] = JUDGES.map(|(longer, _)| fire(plans, &loaded, set, &own.longer(longer)));
    let judges = near.into_iter().zip(far);
    let shots = plans.iter().zip(shots).zip(judges);
    shots
        .map(|((plan, shot), (near, far))| kept(plan, shot?, [&near?, &far?]))
        .collect()
}

/// Chains of plans, set up; `None` for those that the ensemble loop can't fire.
pub(crate) fn load(plans: &[&Plan]) -> Vec<Option<System>> {
    let load = |plan: &&Plan| {
        let suits = suits(plan) && plan.check().is_ok();
        suits.then(|| System::new(&plan.chain).ok()).flatten()
    };
    plans.iter().map(load).collect()
}

/// A shot with the accuracy it reached, if that is what was asked.
fn kept(plan: &Plan, mut shot: Shot, judges: [&Shot; 2]) -> Option<Shot> {
    let [near, far] = [0, 1].map(|at| JUDGES[at].1 * shot.change(judges[at]));
    let reached = near.max(far)
        * if accuracy::is_gentle(plan) {
            1.0
        } else {
            OF_SHARP
        };
    // Both changes may be small by chance: they confirm the accuracy asked and no better one.
    shot.accuracy_reached = Some(reached.max(shot.accuracy_asked));
    (reached <= shot.accuracy_asked).then_some(shot)
}

/// How plans that go together are fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting {
    /// In contact times.
    pub step: f64,
    /// That of each plan's accuracy if `None`; where a load presses beads
    /// together never single.
    pub precision: Option<Precision>,
    /// Whether openings are found.
    pub openings: bool,
    /// Pulses have widths, whether or not a pick needs their shape.
    pub shapes: bool,
    /// Shots end once the reflected pulse has passed, not when none can come
    /// any more.
    pub passed: bool,
}

impl Setting {
    /// For a plan whose shots are judged one by one.
    pub(crate) fn of(plan: &Plan) -> Option<Self> {
        let (step, openings) = accuracy::equal_steps(plan)?;
        Some(Self {
            step,
            precision: None,
            openings,
            shapes: true,
            passed: false,
        })
    }

    fn precision(&self, plan: &Plan, system: &System) -> Precision {
        match self.precision {
            Some(Precision::Single) if !system.flies_free() => Precision::Double,
            Some(precision) => precision,
            None => accuracy::precision(plan, system),
        }
    }

    /// The same with longer steps, for judges; they wait for whatever may come.
    pub(crate) fn longer(self, times: f64) -> Self {
        Self {
            step: times * self.step,
            shapes: false,
            passed: false,
            ..self
        }
    }

    fn end(&self, plan: &Plan) -> End {
        match (plan.duration_s, self.passed) {
            (Some(_), _) => End::Duration,
            (None, true) => End::Passed,
            (None, false) => End::Reflected,
        }
    }
}

/// Fires plans that are alike in sensor and length, those whose chain is set up.
pub(crate) fn fire(
    plans: &[&Plan],
    loaded: &[Option<System>],
    set: InstructionSet,
    setting: &Setting,
) -> Vec<Option<Shot>> {
    let ready = || {
        plans
            .iter()
            .zip(loaded)
            .filter_map(|(plan, system)| Some((*plan, system.as_ref()?)))
    };
    let Some((first, system)) = ready().next() else {
        return vec![None; plans.len()];
    };
    let shots: Vec<ensemble::Shot<'_>> = ready()
        .map(|(plan, system)| ensemble::Shot {
            system,
            step: setting.step,
            duration_s: duration::with_equal_steps_s(plan, system, setting.step),
            precision: setting.precision(plan, system),
        })
        .collect();
    let wall = system.contacts() - 1;
    let shaped = |plan: &Plan| plan.picks().any(|pick| pick != Pick::Peak);
    let settings = ensemble::Settings {
        sensors: vec![Sensor::Bead(first.sensor_bead), Sensor::Contact(wall)],
        end: setting.end(first),
        set,
        shapes: setting.shapes || ready().any(|(plan, _)| shaped(plan)),
        whole_chain: false,
        openings: setting.openings,
    };
    let fired: Vec<(&Plan, &System)> = ready().collect();
    let kept = |at: usize, flown: Result<Flown, _>| {
        let (plan, system) = fired[at];
        shot(plan, (system, settings.end), flown.ok()?)
    };
    let mut kept = ensemble::fire_each(&shots, &settings, &|| !stopped(), kept).into_iter();
    let one = |system: &Option<System>| system.as_ref().and_then(|_| kept.next()?);
    loaded.iter().map(one).collect()
}

/// A single step may correct a velocity by this fraction of the shot's speed:
/// more, and something happens that equal steps do not resolve.
const MOST_CORRECTION: f64 = 0.01;

/// Errors of heights of equal steps over the accuracy asked: 19 of 20 random rows have less.
const OF_HEIGHTS: f64 = 10.0;

/// Whether the reflected peak may be another maximum than the largest sample: one that two
/// runs with equal steps can both miss, because the sensor's signal is above it since the
/// wall's peak and falls with hardly a rise, or where there is none at all.
fn may_hide(plan: &Plan, passage: &Passage, (time_s, at_wall_n): (f64, f64)) -> bool {
    let error = OF_HEIGHTS * plan.accuracy * passage.incident.value.max(passage.wall.value);
    match passage.reflected {
        Some(reflected) => at_wall_n > reflected.value - error,
        None => time_s >= passage.search_ends_s,
    }
}

/// What a plan asks for, from what its sensors showed.
fn shot(plan: &Plan, (system, end): (&System, End), flown: Flown) -> Option<Shot> {
    if flown.correction > MOST_CORRECTION {
        return None;
    }
    let Ok([sensor, wall]) = <[_; 2]>::try_from(flown.signals) else {
        return None;
    };
    let passages = Passages::from_signals(sensor, wall, flown.time_s);
    let passage = passages.passage().ok()?;
    // Where what came last changes what came first, looks between steps are too coarse.
    let unfinished = match (end, plan.duration_s) {
        (End::Duration, Some(duration_s)) => flown.time_s < duration_s,
        (End::Reflected, _) => flown.time_s < passage.search_ends_s,
        _ => false,
    };
    if unfinished {
        return None;
    }
    if may_hide(plan, &passage, (flown.time_s, flown.at_wall_n)) {
        return None;
    }
    let between = (plan.chain.beads.len() - plan.sensor_bead) as f64 + 0.5;
    Some(Shot {
        flight: Flight::picked(plan.pick, &passages, &passage),
        compared: (plan.compare.iter())
            .map(|&pick| Flight::picked(pick, &passages, &passage))
            .collect(),
        sensor_maxima: reported(passages.sensor().maxima()),
        pulse_speed_beads_s: Some(between / passage.tof_incident_s()),
        rebound: None,
        budget: None,
        trace: None,
        duration_s: flown.time_s,
        finished: flown.finished,
        velocity_m_s: flown.velocity_m_s,
        work: flown.work,
        accuracy_asked: plan.accuracy,
        accuracy_reached: None,
        solver: "predictor–corrector of order 4, equal steps".to_owned(),
        tolerance: None,
        step_s: Some(flown.step_s),
        other_picks: Vec::new(),
        notes: (closed_gaps(plan, system).into_iter())
            .chain(ambiguous(&passage, plan.accuracy))
            .collect(),
        passage: Ok(passage),
    })
}
