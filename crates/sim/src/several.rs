//! Shots of many plans by their places, all of them or some.

use crate::ensemble::{shoot_all, shoot_tuned};
use crate::error::StudyError;
use crate::plan::Plan;
use crate::shot::Shot;
use crate::stop::stopped;
use crate::sweep::{Judges, PointError, Settings};
use crate::tuned::Tuned;
use hertzchain_experiment::Warning;
use rayon::prelude::*;

/// Plans to have in memory at a time, in the current rayon pool: so many for each thread
/// that none waits long for the others at the end, and few enough for near memory.
#[must_use]
pub fn piece() -> usize {
    256 * rayon::current_num_threads()
}

/// Plans for one flight, parted from what is odd about each or why it has none:
/// the shots of those that have one come back in the same order.
pub fn parted<P, O, E>(planned: Vec<Result<(P, O), E>>) -> (Vec<P>, Vec<Result<O, E>>) {
    let mut plans = Vec::with_capacity(planned.len());
    let part = |planned: Result<(P, O), E>| {
        planned.map(|(plan, odd)| {
            plans.push(plan);
            odd
        })
    };
    let odd = planned.into_iter().map(part).collect();
    (plans, odd)
}

/// A shot's plan with what is odd about it, or why there is none.
pub(crate) type Planned = Result<(Plan, Vec<Warning>), PointError>;

/// A shot or why there is none, with what is odd about it in words.
pub(crate) type Told = (Result<Shot, PointError>, Vec<String>);

/// Many plans, each by its place from 0.
pub(crate) struct Several<'a> {
    /// How many there are.
    pub count: usize,
    /// The one at a place.
    pub plan: &'a (dyn Fn(usize) -> Planned + Sync),
    /// How they are shot.
    pub settings: &'a Settings<'a>,
}

impl Several<'_> {
    /// What pilots choose, where they are asked to: from all plans, however few
    /// of them are shot here, so that every part of the work has the same setting.
    /// A place without a plan has no pilot.
    pub(crate) fn tuned(&self) -> Option<Tuned> {
        match self.settings.judges {
            Judges::Each => None,
            Judges::Pilots => {
                let places: Vec<usize> = Tuned::pilot_places(self.count).collect();
                let plans = places.par_iter().map(|place| (self.plan)(*place));
                let sound: Vec<Plan> = plans.filter_map(|plan| Some(plan.ok()?.0)).collect();
                Tuned::new(&sound, self.settings.set)
            }
        }
    }

    /// Shots at some places, in their order, each handed over once those that are
    /// in memory beside it are shot. Bits do not depend on which others are asked
    /// for along. Whoever is asked to stop plans no more.
    pub(crate) fn shoot(
        &self,
        places: &[usize],
        tuned: Option<&Tuned>,
        mut take: impl FnMut(usize, Told),
    ) {
        for part in places.chunks(piece()) {
            if stopped() {
                return;
            }
            for (place, told) in part.iter().zip(self.together(part, tuned)) {
                take(*place, told);
            }
        }
    }

    fn together(&self, places: &[usize], tuned: Option<&Tuned>) -> Vec<Told> {
        let wanted = |place: &usize| match stopped() {
            true => Err(StudyError::Stopped.into()),
            false => (self.plan)(*place),
        };
        let planned: Vec<Planned> = places.par_iter().map(wanted).collect();
        let (plans, odd) = parted(planned);
        let Settings {
            set,
            checked,
            progress,
            ..
        } = *self.settings;
        let shots = match tuned {
            Some(tuned) => shoot_tuned(&plans, tuned, set, progress),
            None => shoot_all(&plans, set, checked, progress),
        };
        let mut shots = shots.into_iter();
        let told = |odd: Result<Vec<Warning>, PointError>| match odd {
            Err(error) => Some((Err(error), Vec::new())),
            Ok(warnings) => {
                let shot = shots.next()?.map_err(PointError::from);
                Some((shot, warnings.iter().map(Warning::one_line).collect()))
            }
        };
        odd.into_iter().filter_map(told).collect()
    }
}
