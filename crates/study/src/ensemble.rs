//! Many plans at once.
//!
//! Plans that ask for times of flight alone run in the ensemble loop, side by
//! side on every thread; what that loop does not have, or does not finish
//! well, runs one by one in the wave loop.

use crate::accuracy;
use crate::duration::{self, has_wall};
use crate::error::StudyError;
use crate::flight::Flight;
use crate::gun::closed_gaps;
use crate::plan::{Pick, Plan, Solver};
use crate::shot::{Shot, reported, shoot, shoot_checked, tie};
use hertzchain_chain::ensemble::{self, End, Flown, Precision};
use hertzchain_chain::observe::{Passages, RETURN_WITHIN};
use hertzchain_chain::{InstructionSet, Sensor, Start, System};
use rayon::prelude::*;

/// Runs plans on all threads of the current rayon pool; results are in order
/// and have the same bits whatever the number of threads and whatever else is
/// fired along.
///
/// `progress` is called once a plan, from any thread. In the ensemble loop every
/// shot is computed three times and carries the accuracy it reached; in the wave loop
/// only with `checked`.
pub fn shoot_all(
    plans: &[Plan],
    set: InstructionSet,
    checked: bool,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    each_block(plans, |block| {
        let shots = shoot_block(block, set, checked);
        block.iter().for_each(|_| progress());
        shots
    })
}

/// The same for who needs many shots at known accuracy more than the accuracy of
/// each, such as a fit: nothing is computed twice, and no shot tells what it
/// reached. Whatever the ensemble loop does not have, or loses, the wave loop
/// computes.
pub fn shoot_unjudged(plans: &[Plan], set: InstructionSet) -> Vec<Result<Shot, StudyError>> {
    each_block(plans, |block| {
        let (systems, shots) = loaded(block, |ready| fire(ready, set, (1.0, false)));
        let shots = in_place(&systems, shots.into_iter());
        let shots = block.iter().zip(shots);
        shots
            .map(|(plan, shot)| shot.map_or_else(|| shoot(plan), Ok))
            .collect()
    })
}

/// Results of a function of plans that go together, in the order of all plans.
fn each_block(
    plans: &[Plan],
    of: impl Fn(&[&Plan]) -> Vec<Result<Shot, StudyError>> + Sync,
) -> Vec<Result<Shot, StudyError>> {
    let mut results: Vec<Option<Result<Shot, StudyError>>> = vec![None; plans.len()];
    let blocks = blocks(plans);
    let fired: Vec<_> = blocks
        .par_iter()
        .flat_map_iter(|block| {
            let together: Vec<&Plan> = block.iter().map(|&at| &plans[at]).collect();
            block.iter().copied().zip(of(&together)).collect::<Vec<_>>()
        })
        .collect();
    for (at, shot) in fired {
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

fn fire_together(one: &Plan, other: &Plan) -> bool {
    one.accuracy == other.accuracy
        && one.sensor_bead == other.sensor_bead
        && one.chain.beads.len() == other.chain.beads.len()
        && one.duration_s.is_none() == other.duration_s.is_none()
}

/// Whether the ensemble loop can run a plan to the accuracy asked.
fn suits(plan: &Plan) -> bool {
    plan.solver == Solver::Adaptive
        && !plan.rebound
        && !plan.budget
        && plan.watch.is_none()
        && plan.chain.suspension_m.is_none()
        && !matches!(plan.chain.start, Start::Driven { .. })
        && has_wall(&plan.chain.far)
        && accuracy::equal_steps(plan).is_some()
}

/// Steps by which a shot is judged, over its own. Two: one alone agrees by
/// chance with what is wrong in one row of a hundred.
const LONGER: [f64; 2] = [1.3, 1.69];

/// The accuracy reached is what the longer steps change, times these: an error
/// of order 1, which closings leave now and then, is three times the change by
/// the first and once and a half that by the second.
const OF_CHANGE: [f64; 2] = [3.0, 1.5];

/// Shots of plans that go together, or of one that goes alone.
fn shoot_block(
    plans: &[&Plan],
    set: InstructionSet,
    checked: bool,
) -> Vec<Result<Shot, StudyError>> {
    // What was too hard for equal steps deserves a check in the wave loop too.
    let alone = |plan: &Plan| match checked || suits(plan) {
        true => shoot_checked(plan),
        false => shoot(plan),
    };
    let shots = fired(plans, set);
    let shots = plans.iter().zip(shots);
    shots
        .map(|(plan, shot)| shot.map_or_else(|| alone(plan), Ok))
        .collect()
}

/// Shots of plans by the ensemble loop, each with the accuracy it reached;
/// `None` where the wave loop must have a look, because that is not what was
/// asked or if only to say what is wrong.
fn fired(plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
    let (systems, kept) = loaded(plans, |ready| {
        let shots = fire(ready, set, (1.0, true)).into_iter();
        let [near, far] = LONGER.map(|longer| fire(ready, set, (longer, false)));
        let judges = near.into_iter().zip(far);
        shots
            .zip(judges)
            .map(|(shot, (near, far))| kept(shot?, [&near?, &far?]))
            .collect::<Vec<_>>()
    });
    in_place(&systems, kept.into_iter())
}

/// The systems of plans that the ensemble loop can fire, and a function of those.
fn loaded<T>(plans: &[&Plan], of: impl Fn(&[(&Plan, &System)]) -> T) -> (Vec<Option<System>>, T) {
    let load = |plan: &&Plan| {
        let suits = suits(plan) && plan.check().is_ok();
        suits.then(|| System::new(&plan.chain).ok()).flatten()
    };
    let systems: Vec<Option<System>> = plans.iter().map(load).collect();
    let ready = plans.iter().zip(&systems);
    let ready: Vec<(&Plan, &System)> = ready
        .filter_map(|(plan, system)| Some((*plan, system.as_ref()?)))
        .collect();
    let of_ready = of(&ready);
    (systems, of_ready)
}

/// Shots of the systems that there are, in the place of each.
fn in_place(
    systems: &[Option<System>],
    mut shots: impl Iterator<Item = Option<Shot>>,
) -> Vec<Option<Shot>> {
    systems
        .iter()
        .map(|system| system.as_ref().and_then(|_| shots.next().flatten()))
        .collect()
}

/// A shot with the accuracy it reached, if that is what was asked.
fn kept(mut shot: Shot, judges: [&Shot; 2]) -> Option<Shot> {
    let changes = judges.map(|judge| shot.change(judge));
    let reached = (OF_CHANGE[0] * changes[0]).max(OF_CHANGE[1] * changes[1]);
    shot.accuracy_reached = Some(reached);
    (reached <= shot.accuracy_asked).then_some(shot)
}

/// Fires plans that are alike in accuracy, sensor and length, with their step
/// times a factor; pulses have widths if asked, or if a pick needs their shape.
fn fire(
    ready: &[(&Plan, &System)],
    set: InstructionSet,
    (longer, shapes): (f64, bool),
) -> Vec<Option<Shot>> {
    let Some((first, system)) = ready.first() else {
        return Vec::new();
    };
    let Some((step, openings)) = accuracy::equal_steps(first) else {
        return vec![None; ready.len()];
    };
    let shots: Vec<ensemble::Shot<'_>> = ready
        .iter()
        .map(|(plan, system)| ensemble::Shot {
            system,
            step: step * longer,
            duration_s: duration::end(plan, system).longest_s,
            precision: accuracy::precision(plan, system),
        })
        .collect();
    let wall = system.contacts() - 1;
    let shaped = |plan: &Plan| plan.picks().any(|pick| pick != Pick::Peak);
    let settings = ensemble::Settings {
        sensors: vec![Sensor::Bead(first.sensor_bead), Sensor::Contact(wall)],
        end: if first.duration_s.is_none() {
            End::Reflected
        } else {
            End::Duration
        },
        set,
        shapes: shapes || ready.iter().any(|(plan, _)| shaped(plan)),
        whole_chain: false,
        openings,
    };
    let flown = ensemble::fire(&shots, &settings).into_iter();
    ready
        .iter()
        .zip(flown)
        .map(|((plan, system), flown)| shot(plan, system, flown.ok()?))
        .collect()
}

/// A single step may correct a velocity by this fraction of the shot's speed:
/// more, and something happens that equal steps do not resolve.
const MOST_CORRECTION: f64 = 0.01;

/// What a plan asks for, from what its sensors showed.
fn shot(plan: &Plan, system: &System, flown: Flown) -> Option<Shot> {
    if flown.correction > MOST_CORRECTION {
        return None;
    }
    let Ok([sensor, wall]) = <[_; 2]>::try_from(flown.signals) else {
        return None;
    };
    let passages = Passages::from_signals(sensor, wall, flown.time_s, plan.duration_s.is_none());
    let passage = passages.passage().ok()?;
    // Where what came last changes what came first, looks between steps are too coarse.
    let searched_s = RETURN_WITHIN * passage.tof_incident_s();
    if plan.duration_s.is_none() && flown.time_s < passage.wall.time_s + searched_s {
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
        notes: (closed_gaps(plan, system).into_iter())
            .chain(tie(&passage, plan.accuracy))
            .collect(),
        passage: Ok(passage),
    })
}
