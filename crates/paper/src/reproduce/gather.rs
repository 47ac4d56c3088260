//! From shots to the numbers that claims are evaluated on.

use super::ReproduceError;
use super::cases::{Cases, failed};
use super::point::{checked, excess_s, read_off_all};
use crate::claims::{Curve, Evaluator, Evidence, ShotPoint};
use hertzchain_chain::Sensor;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Control, InstructionSet, Pick, Plan, Shot, StudyError, run_plans, shoot};
use rayon::prelude::*;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How the paper's chains are shot.
#[derive(Clone, Debug)]
pub(crate) struct Gathering<'a> {
    /// The chains.
    pub cases: &'a Cases,
    /// Speeds of the striker in m/s.
    pub speeds_m_s: &'a [f64],
    /// Relative accuracy asked of ToFs.
    pub accuracy: f64,
    /// How much is known of every shot.
    pub effort: Effort<'a>,
}

/// How much is known of every shot.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Effort<'a> {
    /// All numbers, each with the accuracy it reached: every shot is computed again
    /// at a tenth of the tolerance.
    Checked,
    /// Times, peaks and widths by the ensemble loop; the striker, the gaps and the
    /// way back without them only of the shots in which one of these claims asks for them.
    Lean(&'a [Evaluator]),
}

/// Shoots all cases at all speeds, on all cores; `done` is called after each
/// shot, from any thread. The result does not depend on their number.
///
/// # Errors
/// The first shot that can't be computed, in the order of the tables.
pub(crate) fn gather(
    how: &Gathering<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<Evidence, ReproduceError> {
    gathered(how, None, done)
}

/// The same with a cache of shots.
///
/// # Errors
/// As [`gather`].
pub(crate) fn gather_cached(
    how: &Gathering<'_>,
    cache: &ShotCache,
) -> Result<Evidence, ReproduceError> {
    gathered(how, Some(cache), &|| {})
}

fn gathered(
    how: &Gathering<'_>,
    cache: Option<&ShotCache>,
    done: &(dyn Fn() + Sync),
) -> Result<Evidence, ReproduceError> {
    let cases = how.cases;
    let all = cases.all().iter();
    let jobs = all.flat_map(|case| how.speeds_m_s.iter().map(move |speed| (case, *speed)));
    let jobs: Vec<_> = jobs.collect();
    let target = |&((case, experiment), speed): &(&(&'static str, Experiment), f64)| {
        let target = ShotTarget::new(case, experiment, speed, how)?;
        // What is cached serves every pick.
        Ok::<_, ReproduceError>(match cache {
            Some(_) => target.comparing_picks(),
            None => target,
        })
    };
    let targets: Vec<ShotTarget> = jobs.par_iter().map(target).collect::<Result<_, _>>()?;
    let points = shot_at(&targets, how.effort, cache, done)?;
    let curves = points.chunks(how.speeds_m_s.len().max(1));
    let curves = cases
        .all()
        .iter()
        .zip(curves)
        .map(|((case, _), points)| Curve { case: (*case).to_owned(), points: points.to_vec() });
    Ok(Evidence {
        curves: curves.collect(),
        oils: cases.oils(),
        viscosity_over_modulus_s: viscosity_over_modulus(cases)?,
        digitised: Vec::new(),
    })
}

/// η/Y of the dry balls in s.
fn viscosity_over_modulus(cases: &Cases) -> Result<f64, ReproduceError> {
    let Some(dry) = cases.get("dry") else {
        return Ok(f64::NAN);
    };
    let (chain, _) = dry.chain(Some(1.0))?;
    let material = chain.beads.first().map(|bead| bead.material);
    Ok(material.map_or(f64::NAN, |m| m.shear_viscosity_pa_s / m.young_modulus_pa))
}

/// A shot to be computed.
struct ShotTarget {
    case: &'static str,
    speed_m_s: f64,
    plan: Plan,
    /// How the reading times pulses.
    pick: Pick,
    /// Whether its way back without gaps is asked for.
    closing: bool,
}

/// The end beads are sampled this often to see how far they are apart, in s.
const SAMPLED_S: f64 = 5e-6;

impl ShotTarget {
    fn new(
        case: &'static str,
        experiment: &Experiment,
        speed_m_s: f64,
        how: &Gathering<'_>,
    ) -> Result<Self, ReproduceError> {
        let plan = plan(experiment, speed_m_s, how.accuracy)?;
        let asks = |what: fn(&Evaluator, &str, f64) -> bool| match how.effort {
            Effort::Checked => true,
            Effort::Lean(evaluators) => {
                evaluators.iter().any(|evaluator| what(evaluator, case, speed_m_s))
            }
        };
        let closing = asks(Evaluator::needs_closing);
        let followed = closing || asks(Evaluator::needs_end);
        let ends = vec![Sensor::Position(1), Sensor::Position(plan.chain.beads.len())];
        let plan = match followed {
            true => plan.watching(ends, Some(SAMPLED_S)),
            false => plan.for_flights(),
        };
        Ok(Self { case, speed_m_s, pick: plan.pick, closing, plan })
    }

    fn comparing_picks(self) -> Self {
        Self { plan: self.plan.comparing_picks(), ..self }
    }

    /// The point of the target's own pick.
    fn own(&self, mut points: Vec<ShotPoint>) -> Option<ShotPoint> {
        let at = self.plan.picks().position(|pick| pick == self.pick)?;
        (at < points.len()).then(|| points.swap_remove(at))
    }

    fn failed(&self, error: StudyError) -> ReproduceError {
        failed(self.case, self.speed_m_s, error)
    }

    fn points(&self, shot: Result<Shot, StudyError>) -> Result<Vec<ShotPoint>, ReproduceError> {
        let shot = shot.map_err(|error| self.failed(error))?;
        let mut points = read_off_all(&self.plan, self.speed_m_s, &shot);
        if self.closing {
            let excess_s = excess_s(&self.plan, &shot).map_err(|error| self.failed(error))?;
            points.iter_mut().for_each(|point| point.excess_s = excess_s);
        }
        Ok(points)
    }
}

/// Points of all targets, in order.
fn shot_at(
    targets: &[ShotTarget],
    effort: Effort<'_>,
    cache: Option<&ShotCache>,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<ShotPoint>, ReproduceError> {
    let known = |target: &ShotTarget| {
        let points = cache.and_then(|cache| cache.restored(&target.plan))?;
        // Two cases may share a plan of which only one asks for the way back without gaps.
        let has_all = !target.closing || points.iter().all(|point| !point.excess_s[1].is_nan());
        has_all.then_some(points)
    };
    let mut points: Vec<Option<Vec<ShotPoint>>> = targets.par_iter().map(known).collect();
    let new = || targets.iter().zip(&points).enumerate();
    let new = new().filter_map(|(at, (target, point))| point.is_none().then_some((at, target)));
    let new: Vec<(usize, &ShotTarget)> = new.collect();
    let fresh = match effort {
        Effort::Checked => checked_points(&new, done)?,
        Effort::Lean(_) => lean_points(&new, done)?,
    };
    for ((at, target), fresh) in new.into_iter().zip(fresh) {
        if let Some(cache) = cache {
            cache.store(&target.plan, &fresh);
        }
        points[at] = Some(fresh);
    }
    let points = targets.iter().zip(points);
    Ok(points.filter_map(|(target, points)| target.own(points?)).collect())
}

fn checked_points(
    targets: &[(usize, &ShotTarget)],
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Vec<ShotPoint>>, ReproduceError> {
    let one = |(_, target): &(usize, &ShotTarget)| {
        let point = checked(&target.plan, target.speed_m_s);
        done();
        point.map(|point| vec![point]).map_err(|error| target.failed(error))
    };
    targets.par_iter().map(one).collect()
}

/// Shots that are followed to their end run in the wave loop, the others side by
/// side in the ensemble loop.
fn lean_points(
    targets: &[(usize, &ShotTarget)],
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Vec<ShotPoint>>, ReproduceError> {
    let passing = targets.iter().filter(|(_, t)| !t.plan.rebound);
    let plans: Vec<Plan> = passing.map(|(_, target)| target.plan.clone()).collect();
    let set = InstructionSet::default();
    let control = Control::PerShot { checked: false };
    let mut passing = run_plans(&plans, control, set, done).into_iter();
    let followed: Vec<_> = targets.iter().filter(|(_, t)| t.plan.rebound).collect();
    let one = |(_, target): &&(usize, &ShotTarget)| {
        let points = target.points(shoot(&target.plan));
        done();
        points
    };
    let mut followed = followed.par_iter().map(one).collect::<Vec<_>>().into_iter();
    let in_order = targets.iter().filter_map(|(_, target)| match target.plan.rebound {
        true => followed.next(),
        false => Some(target.points(passing.next()?)),
    });
    in_order.collect()
}

/// The plan of a shot of a case.
pub(super) fn plan(
    experiment: &Experiment,
    speed_m_s: f64,
    accuracy: f64,
) -> Result<Plan, ReproduceError> {
    // The cases' ν above 1/2 is the paper's and said in the reading.
    let (plan, _warnings) = Plan::from_experiment(experiment, Some(speed_m_s))?;
    Ok(plan.with_accuracy(accuracy))
}

/// Cache of shots by everything that decides them, each as every pick times it:
/// many readings leave many of the paper's chains as they are.
#[derive(Debug, Default)]
pub(crate) struct ShotCache(Mutex<HashMap<[u64; 2], Vec<ShotPoint>>>);

impl ShotCache {
    /// The stored points of a plan, one a pick.
    fn restored(&self, plan: &Plan) -> Option<Vec<ShotPoint>> {
        let key = key(plan);
        self.lock().get(&key).cloned()
    }

    /// Stores the points of a plan.
    fn store(&self, plan: &Plan, points: &[ShotPoint]) {
        let key = key(plan);
        self.lock().insert(key, points.to_vec());
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<[u64; 2], Vec<ShotPoint>>> {
        // A panic elsewhere leaves whole points behind.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Two independent hashes of a plan as written out, numbers to the last bit:
/// among the thousands of plans of a scan no two share both.
fn key(plan: &Plan) -> [u64; 2] {
    let text = format!("{plan:?}");
    [0_u8, 1].map(|salt| {
        let mut hasher = DefaultHasher::new();
        salt.hash(&mut hasher);
        text.hash(&mut hasher);
        hasher.finish()
    })
}
