//! Many plans that are alike: pilots find the cheapest setting of the ensemble
//! loop that is right enough, and all the others fly with it, and once more to
//! find those that are unlike the pilots.

use crate::ensemble::{Setting, fire, fire_together, load, shoot_all, suits};
use crate::plan::Plan;
use crate::shot::Shot;
use hertzchain_chain::ensemble::Precision;
use hertzchain_chain::{InstructionSet, System};
use std::fmt::{Display, Formatter, Result as Formatted};

/// Pilots that are enough for plans between which little changes: the paper's
/// chains at a thousand speeds (`docs/numerics.md`).
pub const PILOTS: usize = 40;

/// What pilots are compared with is this many times as right as asked.
const TIGHTER: f64 = 20.0;

/// Steps of a guard, over those of the shot that it guards: what that changes
/// by more than the accuracy asked is judged by itself. A guard also waits for
/// what may come after the reflected pulse.
const GUARD: f64 = 1.3;

/// Judges take 2.36 times the force passes of a shot. A tuned shot ends when its
/// pulse has passed, after 0.56 of them, and its guard takes 0.77 times: with
/// steps below this share of a judged shot's, pilots save nothing.
const WORTHWHILE: f64 = 0.56;

/// Pilots may use this share of the accuracy asked: between them others may
/// be worse.
const SHARE: f64 = 0.5;

/// Precision, step in contact times and whether openings are found; the
/// cheapest first.
const WAYS: [(Precision, f64, bool); 23] = [
    (Precision::Single, 0.3, false),
    (Precision::Single, 0.28, false),
    (Precision::Single, 0.26, false),
    (Precision::Single, 0.24, false),
    (Precision::Single, 0.22, false),
    (Precision::Single, 0.2, false),
    (Precision::Single, 0.18, false),
    (Precision::Single, 0.16, false),
    (Precision::Single, 0.14, false),
    (Precision::Single, 0.12, false),
    (Precision::Single, 0.1, false),
    (Precision::Double, 0.2, false),
    (Precision::Double, 0.17, false),
    (Precision::Double, 0.15, false),
    (Precision::Double, 0.12, false),
    (Precision::Double, 0.1, true),
    (Precision::Double, 0.08, true),
    (Precision::Double, 0.065, true),
    (Precision::Double, 0.05, true),
    (Precision::Double, 0.04, true),
    (Precision::Double, 0.03, true),
    (Precision::Double, 0.02, true),
    (Precision::Double, 0.01, true),
];

/// A setting of the ensemble loop that pilots have shown to be right enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    setting: Setting,
    /// Largest relative error of a time of flight among the pilots.
    pub reached: f64,
    /// How many pilots there were.
    pub pilots: usize,
}

impl Tuned {
    /// The cheapest setting with which times of flight of all pilots are within
    /// half of the accuracy asked and change by no more than that with steps 1.3
    /// times as long; `None` where there is none, or where pilots
    /// are not alike or not for the ensemble loop, or where judges cost no more.
    ///
    /// Pilots should span what the plans span: speeds, coefficients of laws.
    #[must_use]
    pub fn new(pilots: &[Plan], set: InstructionSet) -> Option<Self> {
        let first = pilots.first()?;
        let alike = |plan: &Plan| suits(plan) && fire_together(first, plan);
        if !pilots.iter().all(alike) {
            return None;
        }
        let shortest = WORTHWHILE * Setting::of(first)?.step;
        let exact = exact(pilots, set)?;
        let plans: Vec<&Plan> = pilots.iter().collect();
        let loaded = load(&plans);
        let mut ways = WAYS.iter().filter(|(_, step, _)| *step >= shortest);
        ways.find_map(|&(precision, step, openings)| {
            let setting = Setting {
                step,
                precision: Some(precision),
                openings,
                shapes: false,
                passed: true,
            };
            let shots = guarded(&plans, &loaded, set, setting);
            let reached = worst(&shots, &exact)? + first.accuracy / TIGHTER;
            (reached <= SHARE * first.accuracy).then_some(Self {
                setting,
                reached,
                pilots: pilots.len(),
            })
        })
    }

    /// Plans, evenly spread over those given in the order of what changes.
    #[must_use]
    pub fn pilots(plans: &[Plan]) -> Vec<Plan> {
        let places = Self::pilot_places(plans.len());
        places.map(|place| plans[place].clone()).collect()
    }

    /// Places from 0 of the pilots among so many plans, evenly spread.
    pub(crate) fn pilot_places(plans: usize) -> impl Iterator<Item = usize> {
        let count = PILOTS.min(plans);
        (0..count).map(move |i| i * (plans - 1) / (count - 1).max(1))
    }

    /// Shots of plans by the ensemble loop, of those that are like the pilots.
    pub(crate) fn fired(&self, plans: &[&Plan], set: InstructionSet) -> Vec<Option<Shot>> {
        let shots = guarded(plans, &load(plans), set, self.setting);
        let told = |shot: Shot| Shot {
            accuracy_reached: Some(self.reached),
            ..shot
        };
        shots.into_iter().map(|shot| shot.map(told)).collect()
    }
}

impl Display for Tuned {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        let precision = match self.setting.precision {
            Some(Precision::Single) => "single",
            _ => "double",
        };
        write!(
            f,
            "{precision} precision, steps of {} contact times, chosen by {} pilots that are right to {:.0e}",
            self.setting.step, self.pilots, self.reached
        )
    }
}

/// Shots that change by no more than the accuracy asked with longer steps.
fn guarded(
    plans: &[&Plan],
    loaded: &[Option<System>],
    set: InstructionSet,
    setting: Setting,
) -> Vec<Option<Shot>> {
    let [shots, guards] = [setting, setting.longer(GUARD)].map(|it| fire(plans, loaded, set, &it));
    let alike = |(shot, guard): (Option<Shot>, Option<Shot>)| {
        let (mut shot, guard) = (shot?, guard?);
        if shot.change(&guard) > shot.accuracy_asked {
            return None;
        }
        // A shot that ends when the pulse has passed has not seen all maxima that compete.
        if let (Ok(seen), Ok(all)) = (&mut shot.passage, guard.passage) {
            seen.competing = all.competing;
            shot.notes = guard.notes;
        }
        Some(shot)
    };
    shots.into_iter().zip(guards).map(alike).collect()
}

/// Times of flight of pilots, however picked, right to a small share of what is asked.
fn exact(pilots: &[Plan], set: InstructionSet) -> Option<Vec<Shot>> {
    let tighter = |plan: &Plan| {
        let accuracy = plan.accuracy / TIGHTER;
        plan.clone().with_accuracy(accuracy)
    };
    let plans: Vec<Plan> = pilots.iter().map(tighter).collect();
    let shots = shoot_all(&plans, set, true, &|| {}).into_iter();
    let right =
        |shot: &Shot| (shot.accuracy_reached).is_some_and(|reached| reached <= shot.accuracy_asked);
    shots.map(|shot| shot.ok().filter(right)).collect()
}

/// Largest relative difference of times of flight; `None` if any is missing.
fn worst(shots: &[Option<Shot>], exact: &[Shot]) -> Option<f64> {
    let mut changes = shots
        .iter()
        .zip(exact)
        .map(|(shot, exact)| Some(shot.as_ref()?.change(exact)));
    changes.try_fold(0.0, |worst: f64, change| Some(worst.max(change?)))
}
