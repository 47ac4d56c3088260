//! Many plans at once.
//!
//! Plans that ask for times of flight alone run in the loop with equal steps, side by
//! side on every thread; what that loop does not have, or does not finish
//! well, runs one by one in the adaptive loop.

use crate::accuracy;
use crate::calibration::Calibration;
use crate::duration::{self, has_wall};
use crate::error::StudyError;
use crate::plan::Plan;
use crate::prepared::{closed_gaps, is_ambiguous};
use crate::shot::{Conditioning, Shot, ambiguous, shoot, shoot_checked, shoot_confirmed};
use crate::stop::stopped;
use hertzchain_chain::ensemble::{self, End, LaneResult, Precision};
use hertzchain_chain::laws::{Law, Nature};
use hertzchain_chain::observe::{Maximum, Passage, Passages, Shape, Signal};
use hertzchain_chain::{InstructionSet, Sensor, Start, System};
use hertzchain_experiment::{Method, Pick};
use rayon::prelude::*;
use std::sync::Arc;

/// How the errors of shots are controlled, with what that needs.
#[derive(Clone, Copy, Debug)]
pub enum Control<'a> {
    /// Shots with equal steps are compared with two more, with longer steps, those of the adaptive
    /// loop with two at tighter tolerances; where it follows the striker with one with equal steps.
    PerShot {
        /// Compare shots that follow their striker with two at tighter tolerances.
        checked: bool,
    },
    /// With the steps that calibration shots chose, ten times as fast. Each shot carries its
    /// own estimate; one whose estimate is above the accuracy asked takes the adaptive loop.
    Calibrated(&'a Calibration),
    /// By the step for the accuracy alone, as a fit needs them: nothing is computed twice, but
    /// in the adaptive loop where another maximum could be the reflected pulse's peak.
    None,
}

/// Runs plans on all threads of the current rayon pool; results are in order
/// and have the same bits whatever the number of threads and whatever else is
/// run along. `progress` is called once a plan, from any thread.
pub fn run_plans(
    plans: &[Plan],
    control: Control<'_>,
    set: InstructionSet,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    let all: Vec<&Plan> = plans.iter().collect();
    let Control::Calibrated(calibration) = control else {
        return one_by_one(&all, control, set, progress);
    };
    let (like, unlike): (Vec<usize>, Vec<usize>) =
        (0..plans.len()).partition(|&at| calibration.suits(&plans[at]));
    let of = |places: &[usize]| places.iter().map(|&at| all[at]).collect::<Vec<_>>();
    let shots = calibrated(&of(&like), calibration, set, progress);
    let others = one_by_one(&of(&unlike), Control::PerShot { checked: false }, set, progress);
    let mut shots: Vec<(usize, _)> =
        like.into_iter().zip(shots).chain(unlike.into_iter().zip(others)).collect();
    shots.sort_unstable_by_key(|(at, _)| *at);
    shots.into_iter().map(|(_, shot)| shot).collect()
}

/// Runs plans of which each has a control of its own.
fn one_by_one(
    plans: &[&Plan],
    control: Control<'_>,
    set: InstructionSet,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    let shots = in_blocks(plans, &|block| {
        let shots = run_block(block, control, set);
        block.iter().for_each(|_| progress());
        shots
    });
    shots.into_iter().map(|(_, shot)| shot).collect()
}

/// Runs plans of a calibrated family: what one setting leaves open takes the next, and at last the
/// adaptive loop.
fn calibrated(
    plans: &[&Plan],
    calibration: &Calibration,
    set: InstructionSet,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    let mut shots: Vec<Option<Shot>> = vec![None; plans.len()];
    let mut open: Vec<usize> = (0..plans.len()).collect();
    for tier in calibration.tiers() {
        let (here, mut later): (Vec<usize>, Vec<usize>) =
            open.into_iter().partition(|&at| tier.serves(plans[at]));
        let together: Vec<&Plan> = here.iter().map(|&at| plans[at]).collect();
        let run = in_blocks(&together, &|block| tier.run(block, set));
        for (at, (_, shot)) in here.into_iter().zip(run) {
            let Some(mut shot) = shot else {
                later.push(at);
                continue;
            };
            match tier.is_right(plans[at], &mut shot, shots[at].as_ref()) {
                true => progress(),
                false => later.push(at),
            }
            shots[at] = Some(shot);
        }
        open = later;
    }
    let mut right = vec![true; plans.len()];
    for at in open {
        right[at] = false;
    }
    let closer = |((plan, shot), right): ((&&Plan, Option<Shot>), bool)| match (shot, right) {
        (Some(shot), true) => Ok(shot),
        (shot, _) => {
            let shot = match shot {
                Some(near) => shoot_confirmed(plan, &near),
                None => shoot_checked(plan),
            };
            progress();
            shot
        }
    };
    plans.par_iter().zip(shots).zip(right).map(closer).collect()
}

/// Runs plans that go together block by block, on all threads; results are in order.
fn in_blocks<T: Send>(
    plans: &[&Plan],
    run: &(dyn Fn(&[&Plan]) -> Vec<T> + Sync),
) -> Vec<(usize, T)> {
    let mut results: Vec<(usize, T)> = blocks(plans)
        .par_iter()
        .flat_map_iter(|block| {
            let together: Vec<&Plan> = block.iter().map(|&at| plans[at]).collect();
            block.iter().copied().zip(run(&together)).collect::<Vec<_>>()
        })
        .collect();
    results.sort_unstable_by_key(|(at, _)| *at);
    results
}

/// Shots of plans that go together, or of one that goes alone: with equal steps, and the
/// rest in the adaptive loop.
fn run_block(
    plans: &[&Plan],
    control: Control<'_>,
    set: InstructionSet,
) -> Vec<Result<Shot, StudyError>> {
    if stopped() {
        return vec![Err(StudyError::Stopped); plans.len()];
    }
    let fast = match control {
        Control::None => unchecked(plans, set),
        _ => compared(plans, set),
    };
    let alone = |plan: &Plan| match control {
        Control::PerShot { checked: false } if plan.rebound => followed(plan, set),
        Control::None => {
            let shot = shoot(plan)?;
            match is_ambiguous(&shot) {
                true => shoot_checked(plan),
                false => Ok(shot),
            }
        }
        // Times of flight are always checked.
        _ => shoot_checked(plan),
    };
    let shots = plans.iter().zip(fast);
    shots.map(|(plan, shot)| shot.map_or_else(|| alone(plan), Ok)).collect()
}

/// A shot that follows its striker, confirmed by one with equal steps that ends with the pulse.
fn followed(plan: &Plan, set: InstructionSet) -> Result<Shot, StudyError> {
    let flights = plan.clone().for_flights();
    match compared(&[&flights], set).pop().flatten() {
        Some(other) => shoot_confirmed(plan, &other),
        None => shoot_checked(plan),
    }
}

/// Shots with the step for their accuracy alone.
pub(crate) fn unchecked(plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
    let once = |own: Setting| {
        let bare = Setting { shapes: false, ..own };
        run_lanes(plans, &systems(plans), set, &bare)
    };
    let own = plans.first().and_then(|plan| Setting::of(plan));
    own.map_or_else(|| vec![None; plans.len()], once)
}

/// Plans that run side by side: equal in accuracy, sensor, length and what ends them.
fn blocks(plans: &[&Plan]) -> Vec<Vec<usize>> {
    let mut blocks = Vec::new();
    let mut open: Vec<Vec<usize>> = Vec::new();
    for (at, plan) in plans.iter().enumerate() {
        if !suits(plan) {
            blocks.push(vec![at]);
            continue;
        }
        let together = |block: &&mut Vec<usize>| fit_together(plans[block[0]], plan);
        match open.iter_mut().find(together) {
            Some(block) => block.push(at),
            None => open.push(vec![at]),
        }
        let full = open.iter().position(|block| block.len() == Precision::Single.lanes());
        blocks.extend(full.map(|at| open.swap_remove(at)));
    }
    blocks.extend(open);
    blocks
}

pub(crate) fn fit_together(one: &Plan, other: &Plan) -> bool {
    one.accuracy == other.accuracy
        && one.sensor_bead == other.sensor_bead
        && one.picks().eq(other.picks())
        && one.chain.beads.len() == other.chain.beads.len()
        && one.duration_s.is_none() == other.duration_s.is_none()
}

/// Whether the loop with equal steps can run a plan to the accuracy asked.
pub(crate) fn suits(plan: &Plan) -> bool {
    plan.method == Method::Adaptive
        && !plan.rebound
        && !plan.budget
        && plan.watch.is_none()
        && plan.chain.suspension_m.is_none()
        && !matches!(plan.chain.start, Start::Driven { .. })
        && has_wall(&plan.chain.far)
        && plan.chain.sections.iter().flat_map(|section| &section.laws).all(has_no_state)
        && accuracy::equal_steps(plan).is_some()
}

/// Whether a law is a function of overlap, rate and the largest overlap.
fn has_no_state(law: &Arc<dyn Law>) -> bool {
    !matches!(law.info().nature, Nature::WithState | Nature::Adhesive)
}

/// Steps with which a shot is compared, over its own, and the weight of the change that they
/// make. Two: one alone agrees by chance with what is wrong in one row of
/// a hundred. The accuracy reached is the larger of both: an error of order 1,
/// which closings leave now and then, is three times the change by the first
/// and once and a half that by the second.
pub const LONGER_STEPS: [(f64, f64); 2] = [(1.3, 3.0), (1.69, 1.5)];

/// Rows of which forces are cut, or begin and end otherwise than the paper's, are up
/// to 2.5 times as wrong as the changes say.
const OF_SHARP: f64 = 3.0;

/// Errors of a flat top's time over what the change of its height explains: pump oil at 0.185 to
/// 0.189 m/s, where two reflected maxima become one.
const OF_FLAT: f64 = 3.0;

/// Shots with equal steps and the accuracy they reached; `None` where that is not what was
/// asked, or where the adaptive loop must say what is wrong.
fn compared(plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
    let Some(own) = plans.first().and_then(|plan| Setting::of(plan)) else {
        return vec![None; plans.len()];
    };
    let mut systems = systems(plans);
    let mut run = |setting: Setting| {
        let shots = run_lanes(plans, &systems, set, &setting);
        // What one setting can't run is not compared.
        for (system, shot) in systems.iter_mut().zip(&shots) {
            *system = system.take().filter(|_| shot.is_some());
        }
        shots.into_iter()
    };
    let shots = plans.iter().zip(run(own));
    let [near, far] = LONGER_STEPS.map(|(longer, _)| run(own.longer(longer)));
    shots
        .zip(near.zip(far))
        .map(|((plan, shot), (near, far))| accurate(plan, shot?, [&near?, &far?]))
        .collect()
}

/// The systems of plans; `None` for those that can't run with equal steps.
pub(crate) fn systems(plans: &[&Plan]) -> Vec<Option<Arc<System>>> {
    let system = |plan: &&Plan| {
        let suits = suits(plan) && plan.check().is_ok();
        suits.then(|| plan.chain.system().ok()).flatten()
    };
    plans.iter().map(system).collect()
}

/// A shot with the accuracy it reached, if that is what was asked.
fn accurate(plan: &Plan, mut shot: Shot, longer: [&Shot; 2]) -> Option<Shot> {
    let step = Setting::of(plan)?.step;
    let [near, far] = [0, 1].map(|at| {
        // Both may move the top of a flat pulse alike, but hardly its height.
        let flat = OF_FLAT * shot.peaks_change(longer[at]) * step * shot.conditioning.forces;
        LONGER_STEPS[at].1 * shot.change(longer[at]).max(flat)
    });
    let margin = if accuracy::is_gentle(plan) { 1.0 } else { OF_SHARP };
    let reached = near.max(far) * margin;
    // Both changes may be small by chance: they confirm the accuracy asked and no better one.
    shot.accuracy_reached = Some(reached.max(shot.accuracy_asked));
    (reached <= shot.accuracy_asked).then_some(shot)
}

/// Step size and precision of plans that run side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting {
    /// In contact times.
    pub step: f64,
    /// That of each plan's accuracy if `None`; where a load presses beads
    /// together never single.
    pub precision: Option<Precision>,
    pub openings: bool,
    /// Pulses have widths, whether or not a pick needs their shape.
    pub shapes: bool,
    /// When shots without a duration of their own are over.
    pub end: End,
    /// Shots that last longer fail.
    pub longest_s: f64,
}

impl Setting {
    pub(crate) fn of(plan: &Plan) -> Option<Self> {
        let (step, openings) = accuracy::equal_steps(plan)?;
        Some(Self {
            step,
            precision: None,
            openings,
            shapes: true,
            end: End::Reflected,
            longest_s: f64::INFINITY,
        })
    }

    fn precision(&self, plan: &Plan, system: &System) -> Precision {
        match self.precision {
            Some(Precision::Single) if !system.flies_free() => Precision::Double,
            Some(precision) => precision,
            None => accuracy::precision(plan, system),
        }
    }

    /// The same with longer steps, to compare with; these shots wait for whatever may come.
    pub(crate) fn longer(self, times: f64) -> Self {
        Self { step: times * self.step, shapes: false, end: End::Reflected, ..self }
    }

    fn end(&self, plan: &Plan) -> End {
        plan.duration_s.map_or(self.end, |_| End::Duration)
    }
}

/// Runs plans of one sensor and length side by side, those that have a system.
pub(crate) fn run_lanes(
    plans: &[&Plan],
    systems: &[Option<Arc<System>>],
    set: InstructionSet,
    setting: &Setting,
) -> Vec<Option<Shot>> {
    let ready = plans.iter().zip(systems);
    let ready: Vec<(&Plan, &System)> =
        ready.filter_map(|(plan, system)| Some((*plan, &**system.as_ref()?))).collect();
    let Some((first, system)) = ready.first() else {
        return vec![None; plans.len()];
    };
    let shots: Vec<ensemble::Shot<'_>> = ready
        .iter()
        .map(|(plan, system)| ensemble::Shot {
            system,
            step: setting.step,
            duration_s: duration::with_equal_steps_s(plan, system, setting.step)
                .min(setting.longest_s),
            precision: setting.precision(plan, system),
        })
        .collect();
    let wall = system.contacts() - 1;
    let shaped = |plan: &Plan| plan.picks().any(|pick| pick != Pick::Peak);
    let settings = ensemble::Settings {
        sensors: vec![Sensor::Bead(first.sensor_bead), Sensor::Contact(wall)],
        end: setting.end(first),
        set,
        shapes: setting.shapes || ready.iter().any(|(plan, _)| shaped(plan)),
        whole_chain: false,
        openings: setting.openings,
    };
    let picked = |at: usize, lane: Result<LaneResult, _>| {
        let (plan, system) = ready[at];
        shot(plan, (system, settings.end), lane.ok()?)
    };
    let mut shots = ensemble::fire_each(&shots, &settings, &|| !stopped(), picked).into_iter();
    let one = |system: &Option<Arc<System>>| system.as_ref().and_then(|_| shots.next()?);
    systems.iter().map(one).collect()
}

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
fn shot(plan: &Plan, (system, end): (&System, End), lane: LaneResult) -> Option<Shot> {
    let Ok([sensor, wall]) = <[_; 2]>::try_from(lane.signals) else {
        return None;
    };
    let passages = Passages::from_signals(sensor, wall, lane.time_s);
    let passage = passages.passage().ok()?;
    // Where what came last changes what came first, looks between steps are too coarse.
    let unfinished = match (end, plan.duration_s) {
        // The wave loop notes what a shorter duration leaves open.
        (End::Duration, Some(duration_s)) => {
            lane.time_s < duration_s || duration_s < passage.search_ends_s
        }
        (End::Reflected, _) => lane.time_s < passage.search_ends_s,
        _ => false,
    };
    if unfinished || may_hide(plan, &passage, (lane.time_s, lane.at_wall_n)) {
        return None;
    }
    let mut notes = Vec::from_iter(closed_gaps(plan, system));
    notes.extend(ambiguous(&passage, plan.accuracy));
    let shot = Shot {
        finished: lane.finished,
        velocity_m_s: lane.velocity_m_s,
        work: lane.work,
        step_s: Some(lane.step_s),
        conditioning: conditioning(&passages, &passage, lane.step_s),
        notes,
        ..Shot::picked(plan, &passages, Ok(passage), lane.time_s, EQUAL_STEPS)
    };
    // A flank of bead 1 may rise within the first steps, before what is kept of its signal.
    let is_picked = shot.flight.is_some() && shot.compared.iter().all(Option::is_some);
    is_picked.then_some(shot)
}

/// How well the times of flight of a pulse with these peaks are conditioned.
fn conditioning(seen: &Passages, passage: &Passage, step_s: f64) -> Conditioning {
    let shape = |signal: &Signal, peak: &Maximum| signal.shape(peak);
    let wall = shape(seen.wall(), &passage.wall);
    let over = |shape: Shape, time_s: f64| {
        let of = |get: fn(&Shape) -> f64| (get(&shape) + get(&wall)) / time_s;
        let moves_s = |it: &Shape| 1.0 / it.sharpness_per_s2.max(0.0);
        Conditioning {
            forces: (moves_s(&shape) + moves_s(&wall)) / (step_s * time_s),
            interpolation: of(|it| it.interpolation_s),
        }
    };
    let incident = over(shape(seen.sensor(), &passage.incident), passage.tof_incident_s());
    let reflected = passage.reflected.map(|peak| {
        let time_s = peak.time_s - passage.wall.time_s;
        over(shape(seen.sensor(), &peak), time_s)
    });
    reflected.map_or(incident, |reflected| Conditioning {
        forces: incident.forces.max(reflected.forces),
        interpolation: incident.interpolation.max(reflected.interpolation),
    })
}

/// The method's name.
const EQUAL_STEPS: &str = "predictor–corrector of order 4, equal steps";
