//! Many plans at once.
//!
//! Plans that ask for times of flight alone run in the ensemble loop, eight side
//! by side on every thread; what that loop does not have, or does not finish
//! well, runs one by one in the wave loop.

use crate::accuracy;
use crate::duration::{self, has_wall};
use crate::error::StudyError;
use crate::flight::Flight;
use crate::plan::{Plan, Solver};
use crate::shot::{Shot, reported, shoot, shoot_checked};
use hertzchain_chain::ensemble::{self, End, Flown, LANES};
use hertzchain_chain::observe::Passages;
use hertzchain_chain::{InstructionSet, Sensor, Start, System};
use rayon::prelude::*;

/// Runs plans on all threads of the current rayon pool; results are in order
/// and have the same bits whatever the number of threads and whatever else is
/// fired along.
///
/// `progress` is called once a plan, from any thread. With `checked` every shot
/// is computed a second time to learn the accuracy reached.
pub fn shoot_all(
    plans: &[Plan],
    set: InstructionSet,
    checked: bool,
    progress: &(dyn Fn() + Sync),
) -> Vec<Result<Shot, StudyError>> {
    let mut results: Vec<Option<Result<Shot, StudyError>>> = vec![None; plans.len()];
    let blocks = blocks(plans);
    let fired: Vec<_> = blocks
        .par_iter()
        .flat_map_iter(|block| {
            let fired: Vec<&Plan> = block.iter().map(|&at| &plans[at]).collect();
            let shots = shoot_block(&fired, set, checked);
            fired.iter().for_each(|_| progress());
            block.iter().copied().zip(shots).collect::<Vec<_>>()
        })
        .collect();
    for (at, shot) in fired {
        results[at] = Some(shot);
    }
    results.into_iter().flatten().collect()
}

/// Plans to be fired together: alike in accuracy, sensor and length.
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
        let full = open.iter().position(|block| block.len() == LANES);
        blocks.extend(full.map(|at| open.swap_remove(at)));
    }
    blocks.extend(open);
    blocks
}

fn fire_together(one: &Plan, other: &Plan) -> bool {
    one.accuracy == other.accuracy
        && one.sensor_bead == other.sensor_bead
        && one.chain.beads.len() == other.chain.beads.len()
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
        && accuracy::equal_steps(plan, 1.0).is_some()
}

/// A check is computed as for an accuracy this much tighter.
const CHECK: f64 = 0.1;

/// Shots of plans that go together, or of one that goes alone.
fn shoot_block(
    plans: &[&Plan],
    set: InstructionSet,
    checked: bool,
) -> Vec<Result<Shot, StudyError>> {
    let mut shots = fired(plans, set, 1.0);
    if checked {
        for (shot, finer) in shots.iter_mut().zip(fired(plans, set, CHECK)) {
            *shot = shot.take().and_then(|shot| kept(shot, finer?));
        }
    }
    let alone = |plan: &Plan| match checked {
        true => shoot_checked(plan),
        false => shoot(plan),
    };
    let shots = plans.iter().zip(shots);
    shots
        .map(|(plan, shot)| shot.map_or_else(|| alone(plan), Ok))
        .collect()
}

/// A shot with the accuracy it reached, if that is what was asked.
fn kept(mut shot: Shot, finer: Shot) -> Option<Shot> {
    let change = shot.change(&finer);
    shot.accuracy_reached = Some(change);
    (change <= shot.accuracy_asked).then_some(shot)
}

/// Shots of plans by the ensemble loop, as for their accuracy times a factor;
/// `None` where the wave loop must have a look, if only to say what is wrong.
fn fired(plans: &[&Plan], set: InstructionSet, factor: f64) -> Vec<Option<Shot>> {
    let load = |plan: &&Plan| {
        let suits = suits(plan) && plan.check().is_ok();
        suits.then(|| System::new(&plan.chain).ok()).flatten()
    };
    let systems: Vec<Option<System>> = plans.iter().map(load).collect();
    let ready = plans.iter().zip(&systems);
    let ready: Vec<(&Plan, &System)> = ready
        .filter_map(|(plan, system)| Some((*plan, system.as_ref()?)))
        .collect();
    let mut shots = fire(&ready, set, factor).into_iter();
    systems
        .iter()
        .map(|system| system.as_ref().and_then(|_| shots.next().flatten()))
        .collect()
}

/// Fires plans that are alike in accuracy, sensor and length.
fn fire(ready: &[(&Plan, &System)], set: InstructionSet, factor: f64) -> Vec<Option<Shot>> {
    let Some((first, system)) = ready.first() else {
        return Vec::new();
    };
    let Some((step, openings)) = accuracy::equal_steps(first, factor) else {
        return vec![None; ready.len()];
    };
    let shots: Vec<ensemble::Shot<'_>> = ready
        .iter()
        .map(|(plan, system)| ensemble::Shot {
            system,
            step,
            duration_s: duration::end(plan, system).longest_s,
        })
        .collect();
    let wall = system.contacts() - 1;
    let settings = ensemble::Settings {
        sensors: vec![Sensor::Bead(first.sensor_bead), Sensor::Contact(wall)],
        end: if first.duration_s.is_none() {
            End::Reflected
        } else {
            End::Duration
        },
        set,
        whole_chain: false,
        openings,
    };
    let flown = ensemble::fire(&shots, &settings).into_iter();
    let plans = ready.iter().map(|(plan, _)| *plan);
    plans
        .zip(flown)
        .map(|(plan, flown)| shot(plan, flown.ok()?))
        .collect()
}

/// A single step may correct a velocity by this fraction of the shot's speed:
/// more, and something happens that equal steps do not resolve.
const MOST_CORRECTION: f64 = 0.03;

/// What a plan asks for, from what its sensors showed.
fn shot(plan: &Plan, flown: Flown) -> Option<Shot> {
    if flown.correction > MOST_CORRECTION {
        return None;
    }
    let Ok([sensor, wall]) = <[_; 2]>::try_from(flown.signals) else {
        return None;
    };
    let passages = Passages::from_signals(sensor, wall, flown.time_s);
    let passage = passages.passage().ok()?;
    let between = (plan.chain.beads.len() - plan.sensor_bead) as f64 + 0.5;
    Some(Shot {
        flight: Flight::picked(plan.pick, &passages, &passage),
        sensor_maxima: reported(passages.sensor().maxima()),
        pulse_speed_beads_s: Some(between / passage.tof_incident_s()),
        rebound: None,
        passage: Ok(passage),
        budget: None,
        trace: None,
        duration_s: flown.time_s,
        finished: flown.finished,
        velocity_m_s: flown.velocity_m_s,
        work: flown.work,
        accuracy_asked: plan.accuracy,
        accuracy_reached: None,
        solver: "predictor–corrector of order 6, equal steps".to_owned(),
        tolerance: None,
        step_s: Some(flown.step_s),
        notes: Vec::new(),
    })
}
