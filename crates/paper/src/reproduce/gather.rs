//! From shots to the numbers that claims are evaluated on.

use super::ReproduceError;
use super::cases::{Cases, failed};
use super::point::{checked, excess_s, read_off_all};
use crate::claims::{Curve, Evaluator, Evidence, ShotPoint};
use hertzchain_chain::Sensor;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{
    Control, Fingerprint, InstructionSet, Pick, Plan, Shot, StudyError, run_plans, shoot,
};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::{PoisonError, RwLock};

#[derive(Clone, Debug)]
pub(crate) struct Gathering<'a> {
    pub cases: &'a Cases,
    pub speeds_m_s: &'a [f64],
    /// Relative accuracy asked of ToFs.
    pub accuracy: f64,
    pub effort: Effort<'a>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Effort<'a> {
    /// All numbers, each with the accuracy it reached: shots run again at a tenth of the tolerance.
    Checked,
    /// Times, peaks and widths by the ensemble loop; the striker, the gaps and the
    /// way back without them only of the shots in which one of these claims asks for them.
    Lean(&'a [Evaluator]),
}

/// Shoots all cases at all speeds that the cache, if there is one, has not, on all cores; `done` is
/// called after each shot, from any thread. The result does not depend on their number.
pub(crate) fn gather(
    how: &Gathering<'_>,
    cache: Option<&ShotCache>,
    done: &(dyn Fn() + Sync),
) -> Result<Evidence, ReproduceError> {
    let cases = how.cases;
    let all = cases.all().iter();
    let jobs = all.flat_map(|case| how.speeds_m_s.iter().map(move |speed| (case, *speed)));
    let jobs: Vec<_> = jobs.collect();
    let target = |&((case, experiment), speed): &(&(&'static str, Experiment), f64)| {
        let mut target = ShotTarget::new(case, experiment, speed, how)?;
        if cache.is_some() {
            // What is cached serves every pick.
            target.plan = target.plan.comparing_picks();
        }
        Ok::<_, ReproduceError>(target)
    };
    let targets: Vec<ShotTarget> = jobs.par_iter().map(target).collect::<Result<_, _>>()?;
    let points = shot_at(&targets, how.effort, cache, done)?;
    let points = points.chunks(how.speeds_m_s.len().max(1)).map(<[ShotPoint]>::to_vec);
    let curves = cases.all().iter().zip(points);
    Ok(Evidence {
        curves: curves.map(|((case, _), points)| Curve { case: (*case).into(), points }).collect(),
        oils: cases.oils(),
        viscosity_over_modulus_s: viscosity_over_modulus(cases)?,
        digitised: Vec::new(),
    })
}

/// η/Y of the dry balls in s.
fn viscosity_over_modulus(cases: &Cases) -> Result<f64, ReproduceError> {
    let (chain, _) = cases.get("dry")?.chain(Some(1.0))?;
    let material = chain.beads.first().map(|bead| bead.material);
    Ok(material.map_or(f64::NAN, |m| m.shear_viscosity_pa_s / m.young_modulus_pa))
}

struct ShotTarget {
    case: &'static str,
    speed_m_s: f64,
    plan: Plan,
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

fn shot_at(
    targets: &[ShotTarget],
    effort: Effort<'_>,
    cache: Option<&ShotCache>,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<ShotPoint>, ReproduceError> {
    let known = |target: &ShotTarget| {
        // A panic elsewhere leaves whole points behind.
        let stored = cache?.read().unwrap_or_else(PoisonError::into_inner);
        let points = stored.get(&key(&target.plan)).cloned()?;
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
            let mut stored = cache.write().unwrap_or_else(PoisonError::into_inner);
            stored.insert(key(&target.plan), fresh.clone());
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

/// Shots followed to their end run in the wave loop, others in the ensemble loop.
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

pub(crate) fn plan(
    experiment: &Experiment,
    speed_m_s: f64,
    accuracy: f64,
) -> Result<Plan, ReproduceError> {
    // The cases' ν above 1/2 is the paper's and said in the reading.
    let (plan, _warnings) = Plan::from_experiment(experiment, Some(speed_m_s))?;
    Ok(plan.with_accuracy(accuracy))
}

/// Points of shots by the fingerprint of their plan, one point a pick: many readings leave many of
/// the paper's chains as they are.
pub(crate) type ShotCache = RwLock<HashMap<Fingerprint, Vec<ShotPoint>>>;

fn key(plan: &Plan) -> Fingerprint {
    Fingerprint::of("shot of a scan", plan)
}
