//! Numbers that are kept while their unit changes with another's value, and loads that no number
//! of the model describes.

use crate::options::Assignment;
use crate::quantity::digits;
use hertzchain_experiment::{Experiment, NamedNumber};
use hertzchain_infer::{FreeNumber, Model};

/// What it means that a number on which a unit depends, such as the n of F = k δ^n,
/// is free or set, one sentence for each number in that unit.
pub(crate) fn unit_changes(model: &Model, sets: &[Assignment]) -> Vec<String> {
    let experiment = &model.experiment;
    let free = model.numbers.iter().map(|n| n.name());
    let free = paths(experiment, free);
    let set = paths(experiment, sets.iter().map(|set| set.name.as_str()));
    let mut reported: Vec<String> = without_effect(model, sets);
    let unlike = set.iter().filter_map(|path| super::reference::of_unlike(experiment, path));
    reported.extend(unlike);
    for steering in free.iter().chain(&set) {
        let followers = experiment.followers(steering).unwrap_or_default();
        let is_free = free.contains(steering);
        reported.extend(followers.iter().filter_map(|follower| {
            match (is_free, free.contains(&follower.path)) {
                (true, true) => Some(follows(steering, follower)),
                (false, true) => None,
                (_, false) if set.contains(&follower.path) => None,
                (_, false) => Some(stays(steering, follower, is_free)),
            }
        }));
    }
    reported
}

/// That friction holds other loads on a pushed row than the model's equilibrium has, and how much
/// they may differ; nothing where the push is free.
pub(crate) fn held_loads(model: &Model) -> Option<String> {
    let experiment = &model.experiment;
    let (chain, _) = experiment.chain(None).ok()?;
    let mass_kg: f64 = chain.beads.iter().map(|bead| bead.mass_kg).sum();
    let weight_n = chain.gravity_m_s2 * mass_kg;
    let push_n = chain.push.force_n();
    let load_n = push_n + weight_n * chain.incline_rad.sin();
    let held_n = experiment.friction_coefficient() * weight_n * chain.incline_rad.cos();
    let free = model.numbers.iter();
    let is_free = free.map(FreeNumber::path).any(|path| path == Some(PUSH));
    if is_free || load_n <= 0.0 || held_n <= 0.0 {
        return None;
    }
    let free = match push_n > 0.0 {
        true => "Free the load with them (--free preload), or measure",
        false => "Measure",
    };
    Some(format!(
        "the model's row is loaded with {} N at the wall and its track has friction: where the row was tapped or shot \
         before, friction holds up to {} N more or less than the model's equilibrium, which the wave does not know, and \
         fitted numbers may be off by more than their errors. {free} a row that was laid compact",
        digits(load_n, 2),
        digits(held_n, 2)
    ))
}

/// The push on bead 1 in the experiment file.
const PUSH: &str = "near_end.force";

/// What a Young modulus still does where a stiffness that would follow from it has a
/// number of its own.
fn without_effect(model: &Model, sets: &[Assignment]) -> Vec<String> {
    let free: Vec<&str> = model.numbers.iter().map(|n| n.name()).collect();
    let all = free.iter().copied().chain(sets.iter().map(|set| set.name.as_str()));
    let Some(stiffness) = all.into_iter().find(|name| STIFFNESS.contains(&last(name))) else {
        return Vec::new();
    };
    let young = free.iter().filter(|name| YOUNG.contains(&last(name)));
    let reported = |young: &&str| {
        format!(
            "{young} is free and {stiffness} has a number of its own: where contacts have that stiffness, the Young \
             modulus acts through the relaxation time A alone"
        )
    };
    young.map(reported).collect()
}

/// What the stiffness of Hertz contacts is called, and the Young modulus.
const STIFFNESS: [&str; 2] = ["K", "stiffness"];
const YOUNG: [&str; 2] = ["Y", "young_modulus"];

fn paths<'a>(experiment: &Experiment, names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let path = |name| experiment.place(name).ok().map(|place| place.path);
    names.filter_map(path).collect()
}

fn follows(steering: &str, follower: &NamedNumber) -> String {
    format!(
        "{} and {steering}, on which its unit depends, are both free: its number is in the SI unit that \
         follows from the fitted {}, not in {}",
        follower.path,
        last(steering),
        follower.unit
    )
}

fn stays(steering: &str, follower: &NamedNumber, is_free: bool) -> String {
    let (how, unit) = match is_free {
        true => ("free", format!("{} where the fit starts, another elsewhere", follower.unit)),
        false => ("set", format!("now {}", follower.unit)),
    };
    format!(
        "{steering} is {how} and {} is not: its number {} is kept, in the SI unit that follows from the {} \
         ({unit}). So the force at an overlap of 1 m stays, and that at the overlaps of a contact, micrometres, \
         changes by orders of magnitude; {how} {} too if that is not meant",
        follower.path,
        digits(follower.value.unwrap_or(f64::NAN), DIGITS),
        last(steering),
        last(&follower.path)
    )
}

/// Digits of a number that a caller gave: more are rounding.
const DIGITS: usize = 10;

/// The key at the end of a path.
fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}
