//! Running a plan: once, with steps halved, or again to check.

use crate::accuracy::{self, Forecast, Halvings, MOST_HALVINGS, TIGHTEST};
use crate::duration::{self, End, LONG_CHAIN};
use crate::engine::unchecked;
use crate::error::StudyError;
use crate::long_work::CountedShots;
use crate::other_picks::other_picks;
use crate::plan::{Plan, Watch};
use crate::shot::{Rebound, Shot, ambiguous};
use crate::stop::stopped;
use crate::tracker::Tracker;
use hertzchain_chain::observe::{Apart, PassageError, Separation, Trace, Tracer};
use hertzchain_chain::wave::{Limits, Method, Observer, Outcome, run};
use hertzchain_chain::{InstructionSet, Start, System};
use hertzchain_experiment::Method as SolverMethod;
use std::sync::Arc;

/// Loosest tolerance of a run: steps of any chain are then still error-controlled.
const LOOSEST: f64 = 1e-2;

/// Tightest tolerance of a run that others are compared with.
const LEAST_CHECK: f64 = 1e-14;

/// Below this tolerance errors of short rows with laws whose force begins with an
/// infinite slope hardly fall: up to 2.6 times an estimate of 5 in 57 random rows.
const FINE: f64 = 1e-10;
const OF_FINE: f64 = 3.0;

/// Errors of heights, over the largest, in tolerances of a step: 9 of 10 random rows have less.
const OF_HEIGHTS: f64 = 30.0;

/// A bound on the error of a shot; where heights that are this wrong allow to pick another
/// maximum, what that changes.
fn error_bound(shot: &Shot, reached: f64, heights: f64) -> f64 {
    let heights = heights.max(OF_HEIGHTS * shot.tolerance.unwrap_or(0.0));
    let possible = shot.other_picks.iter().filter(|pick| pick.height_error <= heights);
    possible.fold(reached, |reached, pick| reached.max(pick.time_error))
}

/// A bound on what two runs that should be the same differ by.
fn difference(shot: &Shot, other: &Shot) -> f64 {
    error_bound(shot, shot.change(other), shot.height_change(other))
}

/// Largest difference from equal steps, in accuracies asked, that confirms a shot: at 1, errors of
/// small returns of 2 in 14,000 random rows were 1.1 and 1.3 times what was stated.
const CONFIRMING: f64 = 0.3;

/// Whether heights as wrong as a shot's tolerance allow to pick another maximum.
pub(crate) fn is_ambiguous(shot: &Shot) -> bool {
    error_bound(shot, 0.0, 0.0) > shot.accuracy_asked
}

/// A run's tolerance and the run, if it has not failed.
type Looser = (f64, Option<Shot>);

/// Tolerance of a run that looks for a missing time of flight, over that of the shot.
const OF_MISSING: f64 = 1e-3;

/// Most runs from which an error is estimated.
const MOST_LOOSER: usize = 3;

/// Most times that a shot is computed so that its energy budget closes.
const MOST_TRIES: u32 = 4;

/// How far the energy budget is from closing, as a fraction of the input; 0
/// where there is none.
fn residual(shot: &Shot) -> f64 {
    let budget = shot.budget.as_ref();
    budget.map_or(0.0, |budget| budget.relative_residual().abs())
}

/// How the error of a shot is controlled.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Check<'a> {
    /// Computed once, by its tolerance alone.
    Unchecked,
    /// Compared with looser runs, computed more tightly where they differ.
    Estimated,
    /// Compared with a run at a tenth of the tolerance.
    Again,
    /// At a tenth of the tolerance, compared with a computation by another method; as
    /// [`Check::Again`] where that differs.
    By(&'a Shot),
}

/// A plan with its system and the end of its shot.
pub(crate) struct PreparedShot<'a> {
    plan: &'a Plan,
    system: Arc<System>,
    end: End,
}

impl<'a> PreparedShot<'a> {
    pub(crate) fn new(plan: &'a Plan) -> Result<Self, StudyError> {
        plan.check()?;
        if stopped() {
            return Err(StudyError::Stopped);
        }
        let system = plan.chain.system()?;
        let end = duration::end(plan, &system);
        Ok(Self { plan, system, end })
    }

    /// The shot, with the accuracy reached unless it is unchecked.
    pub(crate) fn run(&self, check: Check<'_>) -> Result<Shot, StudyError> {
        let mut shot = self.computed(check)?;
        shot.notes.extend(closed_gaps(self.plan, &self.system));
        let passage = shot.passage.as_ref().ok();
        let ambiguous = passage.map(|passage| ambiguous(passage, self.plan.accuracy));
        shot.notes.extend(ambiguous.unwrap_or_default());
        let residual = residual(&shot);
        if residual > self.plan.accuracy {
            shot.notes.push(format!(
                "the energy budget closes to {residual:.1e} of the input only: less than the accuracy asked"
            ));
        }
        Ok(shot)
    }

    fn computed(&self, check: Check<'_>) -> Result<Shot, StudyError> {
        match (self.plan.method, self.plan.step_s) {
            (SolverMethod::Adaptive, _) => self.adaptive(check),
            (method, Some(step_s)) => self.fixed(method, step_s, check),
            (method, None) => self.halving(method),
        }
    }

    fn adaptive(&self, check: Check<'_>) -> Result<Shot, StudyError> {
        let (tolerance, beyond) = accuracy::tolerance(self.plan);
        if let Check::By(other) = check
            && let Some(shot) = self.confirmed(tolerance, other)?
        {
            return Ok(shot);
        }
        let (mut shot, tolerance) = self.balanced(tolerance)?;
        if beyond {
            shot.notes.push(format!(
                "an accuracy of {:e} is beyond double precision: computed at the tightest tolerance, {TIGHTEST:e} a step",
                self.plan.accuracy
            ));
        }
        match check {
            Check::Unchecked => {}
            Check::Estimated if self.is_confirmed(&shot) => {
                self.note_reached(&mut shot, self.plan.accuracy);
            }
            // Without a budget the tolerance is looser, and looser runs say less.
            Check::Estimated if self.plan.budget => self.estimate(&mut shot, tolerance)?,
            _ => self.refine(&mut shot, tolerance)?,
        }
        Ok(shot)
    }

    /// A shot at a tenth of the tolerance, or at a hundredth where maxima are too alike for that, that
    /// another computation confirms: by another method, or else the adaptive loop at ten times its tolerance.
    fn confirmed(&self, tolerance: f64, other: &Shot) -> Result<Option<Shot>, StudyError> {
        if 0.01 * tolerance < TIGHTEST {
            return Ok(None);
        }
        let mut shot = self.tightened(0.1 * tolerance, false)?;
        let mut confirmed = difference(&shot, other) <= self.plan.accuracy;
        if !confirmed {
            let looser = match is_ambiguous(&shot) {
                true => std::mem::replace(&mut shot, self.tightened(0.01 * tolerance, false)?),
                false => self.tightened(tolerance, false)?,
            };
            // Ten times the tolerance at least doubles the error, as in estimates by looser runs.
            confirmed = difference(&shot, &looser) <= self.plan.accuracy;
        }
        self.note_reached(&mut shot, self.plan.accuracy);
        Ok(confirmed.then_some(shot))
    }

    /// Estimates a shot's error from runs for times of flight alone at looser
    /// tolerances. Where the estimate is above the accuracy asked, a tighter shot
    /// takes its place, and those before it estimate the error of that one: in other than gentle
    /// rows several, because one agrees by chance where errors hardly fall with the tolerance.
    fn estimate(&self, shot: &mut Shot, mut tolerance: f64) -> Result<(), StudyError> {
        if let Some(found) = self.missing_time(shot, tolerance)? {
            tolerance = found.tolerance.unwrap_or(tolerance);
            *shot = found;
        }
        let mut looser = self.looser(tolerance);
        let mut reached = self.estimated(shot, tolerance, &looser);
        for _ in 0..MOST_TRIES {
            if reached <= self.plan.accuracy || 0.1 * tolerance < TIGHTEST {
                break;
            }
            let tighter = self.tightened(0.1 * tolerance, self.plan.watch.is_some())?;
            let notes = std::mem::take(&mut shot.notes);
            let before = std::mem::replace(shot, Shot { notes, ..tighter });
            looser.retain(|(_, run)| run.is_some());
            looser.push((tolerance, Some(before)));
            let kept = if accuracy::is_gentle(self.plan) { 1 } else { MOST_LOOSER };
            looser.drain(..looser.len().saturating_sub(kept));
            tolerance *= 0.1;
            reached = self.estimated(shot, tolerance, &looser);
        }
        let margin = if tolerance < FINE { OF_FINE } else { 1.0 };
        // Looser runs confirm the accuracy asked and no better one.
        self.note_reached(shot, (margin * reached).max(self.plan.accuracy));
        Ok(())
    }

    /// A tighter shot, where it has a time of flight that a shot lacks: errors of contacts whose damping
    /// is stiff may end the search for the wall's peak, and in looser runs they do so all the more.
    fn missing_time(&self, shot: &Shot, tolerance: f64) -> Result<Option<Shot>, StudyError> {
        let tighter = OF_MISSING * tolerance;
        if shot.passage.is_ok() || accuracy::is_gentle(self.plan) || tighter < TIGHTEST {
            return Ok(None);
        }
        let found = self.tightened(tighter, self.plan.watch.is_some())?;
        Ok(Some(found).filter(|found| found.passage.is_ok()))
    }

    /// Runs that are looser than one of a tolerance, with their own; `None` of one that fails.
    fn looser(&self, tolerance: f64) -> Vec<Looser> {
        let wall = duration::has_wall(&self.plan.chain.far);
        let plan = Plan {
            budget: false,
            watch: None,
            rebound: self.plan.rebound && !wall,
            ..self.plan.clone()
        };
        let looser = PreparedShot {
            plan: &plan,
            system: Arc::clone(&self.system),
            end: duration::end(&plan, &self.system),
        };
        let run = |looseness: f64| {
            let run = looser.tightened((looseness * tolerance).min(LOOSEST), false);
            (looseness * tolerance, run.ok())
        };
        accuracy::LOOSER.map(run).into()
    }

    /// The error of a shot, by looser runs.
    fn estimated(&self, shot: &Shot, tolerance: f64, looser: &[Looser]) -> f64 {
        let of_plan = accuracy::margin(self.plan);
        let change = |run: &Shot| self.change(shot, run);
        let changes = looser
            .iter()
            .map(|(loose, run)| (loose / tolerance, run.as_ref().map_or(f64::INFINITY, change)));
        let changes: Vec<(f64, f64)> = changes.collect();
        let runs = looser.iter().filter_map(|(_, run)| run.as_ref());
        let heights = runs.map(|run| shot.height_change(run)).fold(f64::INFINITY, f64::min);
        error_bound(shot, accuracy::estimated(&changes, of_plan, tolerance), heights)
    }

    /// Largest relative difference of two runs; but for gentle rows of equal beads that of each peak's time
    /// over the shortest time of flight too, as differences of times that are wrong may be right by chance.
    fn change(&self, shot: &Shot, run: &Shot) -> f64 {
        match accuracy::is_gentle_and_equal(self.plan) {
            true => shot.change(run),
            false => shot.change(run).max(shot.times_change(run)),
        }
    }

    /// A run at a tolerance other than the plan's own.
    fn tightened(&self, tolerance: f64, sampled: bool) -> Result<Shot, StudyError> {
        let slow = self.accuracy_at(tolerance) * accuracy::of_times(self.plan) / self.plan.accuracy;
        let mut shot = self.integrate(&accuracy::adaptive(self.plan, tolerance), sampled, slow)?;
        shot.tolerance = Some(tolerance);
        Ok(shot)
    }

    fn accuracy_at(&self, tolerance: f64) -> f64 {
        self.plan.accuracy * tolerance / accuracy::tolerance(self.plan).0
    }

    /// The shot, computed more tightly as long as its energy budget does not
    /// close to the accuracy asked; and the tolerance that it took.
    fn balanced(&self, mut tolerance: f64) -> Result<(Shot, f64), StudyError> {
        let mut tries = 1;
        loop {
            let mut shot =
                self.once(&accuracy::adaptive(self.plan, tolerance), self.plan.watch.is_some())?;
            shot.tolerance = Some(tolerance);
            let excess = residual(&shot) / self.plan.accuracy;
            if excess.is_nan() || excess <= 1.0 || tolerance <= TIGHTEST || tries == MOST_TRIES {
                return Ok((shot, tolerance));
            }
            // The residual goes with the tolerance, about; twice is a margin.
            tolerance = (tolerance / (2.0 * excess)).max(TIGHTEST);
            tries += 1;
        }
    }

    /// Computes a shot again at a tenth and a hundredth of the tolerance; where that
    /// shows that the accuracy was not reached, a finer shot takes its place. Two finer
    /// runs, because one agrees by chance with one shot in a hundred that is wrong.
    fn refine(&self, shot: &mut Shot, mut tolerance: f64) -> Result<(), StudyError> {
        let finer = |tolerance: f64| match tolerance < LEAST_CHECK {
            true => Ok(None),
            false => self.tightened(tolerance, false).map(Some),
        };
        let of_plan = accuracy::margin_of_finer(self.plan);
        let mut near = finer(0.1 * tolerance)?;
        let mut far = finer(0.01 * tolerance)?;
        loop {
            let change =
                |other: &Option<Shot>| other.as_ref().map_or(0.0, |it| self.change(shot, it));
            let reached = accuracy::reached([change(&near), change(&far)], of_plan, tolerance);
            let heights = near.as_ref().map_or(0.0, |near| 2.0 * shot.height_change(near));
            let reached = error_bound(shot, reached, heights);
            let Some(next) =
                near.filter(|_| reached > self.plan.accuracy && 0.1 * tolerance >= TIGHTEST)
            else {
                self.note_reached(shot, reached);
                return Ok(());
            };
            tolerance *= 0.1;
            let next = match self.plan.watch {
                Some(_) => self.tightened(tolerance, true)?,
                None => next,
            };
            let notes = std::mem::take(&mut shot.notes);
            *shot = Shot { notes, ..next };
            (near, far) = (far, finer(0.01 * tolerance)?);
        }
    }

    /// Whether a run with equal steps, which takes a tenth of the time, agrees with a shot that its budget
    /// made tighter than was asked. Both may be wrong in one direction where a return is a small
    /// part of the incident pulse.
    fn is_confirmed(&self, shot: &Shot) -> bool {
        let short = self.plan.chain.beads.len() < LONG_CHAIN;
        if !(self.plan.budget && short && accuracy::is_gentle(self.plan)) {
            return false;
        }
        let plan = Plan { budget: false, watch: None, ..self.plan.clone() }.for_flights();
        let other = unchecked(&[&plan], InstructionSet::default()).pop().flatten();
        other.is_some_and(|other| difference(shot, &other) <= CONFIRMING * self.plan.accuracy)
    }

    /// A fixed step as given, whatever accuracy that is: estimated by steps 2 and 1.4 times as long, or by
    /// shorter ones where these fail or a check is asked for: twice the larger change, as one may be that of
    /// two errors that are alike.
    fn fixed(
        &self,
        method: SolverMethod,
        step_s: f64,
        check: Check<'_>,
    ) -> Result<Shot, StudyError> {
        let mut shot = self.at_step(method, step_s, self.plan.watch.is_some())?;
        let at = |share: f64| self.at_step(method, share * step_s, false);
        let both = |[one, other]: [f64; 2]| Ok::<_, StudyError>([at(one)?, at(other)?]);
        let others = match check {
            Check::Unchecked => return Ok(shot),
            Check::Estimated => both([2.0, 1.4]).or_else(|_| both([0.5, 0.7]))?,
            Check::Again | Check::By(_) => both([0.5, 0.7])?,
        };
        let most = |change: fn(&Shot, &Shot) -> f64| {
            others.iter().map(|other| change(&shot, other)).fold(0.0, f64::max)
        };
        let (times, heights) = (most(Shot::change), most(Shot::height_change));
        let reached = accuracy::reached([2.0 * times, 0.0], accuracy::margin(self.plan), 0.0);
        let reached = error_bound(&shot, reached, 2.0 * heights);
        self.note_reached(&mut shot, reached);
        Ok(shot)
    }

    /// Halves the step until the result stands still; gives up as soon as the
    /// order of convergence shows that it would take too long.
    fn halving(&self, method: SolverMethod) -> Result<Shot, StudyError> {
        let first_s = accuracy::first_step_s(&self.system);
        let step_s = |halving: u32| first_s * 0.5_f64.powf(f64::from(halving));
        let mut last = self.at_step(method, first_s, false);
        let mut halvings = Halvings::default();
        for halving in 1..=MOST_HALVINGS {
            let next = self.at_step(method, step_s(halving), false);
            let change = match (&last, &next) {
                (Ok(one), Ok(two)) => one.change(two),
                _ => f64::INFINITY,
            };
            halvings.note(change);
            let standing = accuracy::margin(self.plan) * halvings.standing();
            if standing <= self.plan.accuracy {
                let heights = last.iter().zip(&next).map(|(one, two)| two.height_change(one));
                let heights = heights.fold(0.0, f64::max);
                return self.converged(method, step_s(halving), (standing, heights), next);
            }
            let forecast = halvings.forecast(self.plan.accuracy);
            if let (Some(forecast), Ok(shot)) = (forecast, &next)
                && f64::from(halving) + forecast.halvings > f64::from(MOST_HALVINGS)
            {
                return Err(self.too_many_steps(shot, forecast));
            }
            last = next;
        }
        let (time_s, contact) = self.last_pulse(&last?);
        Err(StudyError::NotConverged(format!(
            "{} does not reach an accuracy of {:e}: halving its step down to {:.3e} s still changes the result by \
             {:.1e}, last seen at t = {time_s:.4e} s in contact {contact}; ask for less accuracy or use the adaptive solver",
            accuracy::fixed(method, first_s).name,
            self.plan.accuracy,
            step_s(MOST_HALVINGS),
            halvings.last(),
        )))
    }

    /// The refusal of an accuracy, from a shot with a longer step.
    fn too_many_steps(&self, shot: &Shot, forecast: Forecast) -> StudyError {
        let finer = forecast.halvings.exp2();
        let (time_s, contact) = self.last_pulse(shot);
        StudyError::NotConverged(format!(
            "{} does not reach an accuracy of {:e} in reasonable time: it would take about {:.0e} steps of {:.0e} s, \
             since halving the step divides the error only by 2^{:.1}, seen at t = {time_s:.4e} s in contact {contact}; \
             ask for less accuracy, give a step, or use the adaptive solver",
            shot.solver,
            self.plan.accuracy,
            shot.work.steps as f64 * finer,
            shot.step_s.unwrap_or(f64::NAN) / finer,
            forecast.order,
        ))
    }

    /// When and in which contact a shot's last pulse was picked.
    fn last_pulse(&self, shot: &Shot) -> (f64, usize) {
        match &shot.passage {
            Ok(passage) => match passage.reflected {
                Some(peak) => (peak.time_s, self.plan.sensor_bead),
                None => (passage.wall.time_s, self.system.contacts() - 1),
            },
            Err(_) => (shot.duration_s, 0),
        }
    }

    /// The shot at the step that was found, sampled if asked.
    fn converged(
        &self,
        method: SolverMethod,
        step_s: f64,
        (change, heights): (f64, f64),
        found: Result<Shot, StudyError>,
    ) -> Result<Shot, StudyError> {
        let mut shot = match self.plan.watch {
            Some(_) => self.at_step(method, step_s, true)?,
            None => found?,
        };
        let reached = error_bound(&shot, change, heights);
        self.note_reached(&mut shot, reached);
        Ok(shot)
    }

    fn at_step(
        &self,
        method: SolverMethod,
        step_s: f64,
        sampled: bool,
    ) -> Result<Shot, StudyError> {
        let mut shot = self.once(&accuracy::fixed(method, step_s), sampled)?;
        shot.step_s = Some(step_s);
        Ok(shot)
    }

    fn note_reached(&self, shot: &mut Shot, reached: f64) {
        // Two runs without times do not differ.
        shot.accuracy_reached = Some(reached).filter(|reached| *reached > 0.0);
        if reached > self.plan.accuracy {
            let known = match reached.is_finite() {
                true => format!("the estimated relative error is {reached:.1e}"),
                false => "its error is not known".to_owned(),
            };
            let asked = self.plan.accuracy;
            shot.notes.push(format!("the asked accuracy of {asked:e} was not reached: {known}"));
        }
    }

    fn once(&self, method: &Method, sampled: bool) -> Result<Shot, StudyError> {
        self.integrate(method, sampled, accuracy::of_times(self.plan))
    }

    /// The same with a tolerance for bodies of long chains that move slowly.
    fn integrate(
        &self,
        method: &Method,
        sampled: bool,
        slow_tolerance: f64,
    ) -> Result<Shot, StudyError> {
        let mut tracker = Tracker::new(self.plan, &self.end);
        let mut separation = Separation::default();
        let mut apart = Apart;
        let mut tracer = self.tracer().filter(|_| sampled);
        let mut counted = CountedShots::new(self.plan, &self.system, &self.end);
        let mut observers: Vec<&mut dyn Observer> =
            vec![&mut counted, &mut tracker, &mut separation];
        if self.end.when_apart {
            observers.push(&mut apart);
        }
        observers.extend(tracer.as_mut().map(|tracer| tracer as &mut dyn Observer));
        let limits = Limits {
            budget: self.plan.budget,
            slow_tolerance: Some(slow_tolerance),
            careful_closings: !accuracy::is_gentle(self.plan),
            ..Limits::until(self.end.longest_s)
        };
        let outcome = run(&self.system, method, limits, &mut observers)?;
        if stopped() {
            return Err(StudyError::Stopped);
        }
        if tracker.passages().is_full() {
            return Err(StudyError::Refused(format!(
                "the sensors have shown more than is kept of a shot after {:.1e} steps, {:.3e} s after its start; \
                 give a shorter duration (--duration), a longer step or less accuracy",
                outcome.work.steps as f64, outcome.time_s
            )));
        }
        let trace = tracer.map(|tracer| self.trace(tracer)).transpose()?;
        let mut shot = self.shot(method, outcome, &tracker, separation, trace);
        shot.finished &= !counted.is_long();
        shot.notes.extend(self.ended_early(&shot, &tracker));
        Ok(shot)
    }

    fn ended_early(&self, shot: &Shot, tracker: &Tracker) -> Option<String> {
        let searched_s = shot.passage.as_ref().ok()?.search_ends_s;
        let decided = tracker.decided_s().is_some();
        (shot.duration_s < searched_s && !decided).then(|| {
            format!(
                "the shot ends at t = {:.4e}, before the search for the wall's peak and the reflected pulse is over \
                 at t = {searched_s:.4e}: a longer `duration` goes on",
                shot.duration_s
            )
        })
    }

    fn tracer(&self) -> Option<Tracer> {
        let watch = self.plan.watch.as_ref()?;
        Some(Tracer::new(watch.sensors.clone(), self.interval_s(watch)))
    }

    fn interval_s(&self, watch: &Watch) -> f64 {
        let usual = 0.1 * self.system.scales().time_s;
        watch.interval_s.unwrap_or(usual)
    }

    fn trace(&self, tracer: Tracer) -> Result<Trace, StudyError> {
        match (tracer.full_s(), &self.plan.watch) {
            (Some(time_s), Some(watch)) => Err(StudyError::Refused(format!(
                "a trace with {} sensors, a sample every {:e} s, has more than {} numbers {time_s:.3e} s after the \
                 start of the shot; sample less often, fewer sensors or a shorter shot",
                watch.sensors.len(),
                self.interval_s(watch),
                Tracer::MOST_NUMBERS
            ))),
            _ => Ok(tracer.into_trace()),
        }
    }

    fn shot(
        &self,
        method: &Method,
        outcome: Outcome,
        tracker: &Tracker,
        separation: Separation,
        trace: Option<Trace>,
    ) -> Shot {
        let passages = tracker.passages();
        let passage = match duration::has_wall(&self.plan.chain.far) {
            true => passages.passage(),
            false => Err(PassageError::NoWallPulse { duration_s: outcome.time_s }),
        };
        let seen = passage.as_ref().ok();
        let given_steps = self.plan.method != SolverMethod::Adaptive;
        let of = (&*self.system, given_steps);
        let other_picks = seen.map(|seen| other_picks(passages, seen, of));
        let is_struck = matches!(self.plan.chain.start, Start::Striker { .. });
        // A shot that came to the end of the rule by another way than the striker's.
        let own_end = self.plan.rebound && self.plan.duration_s.is_none();
        let at_end_m_s = outcome.velocity_m_s.first().filter(|_| own_end).copied();
        let at_end = at_end_m_s.map(|velocity_m_s| (outcome.time_s, velocity_m_s));
        let end = tracker.last_word().or(at_end);
        let last_m_s = outcome.velocity_m_s.first().copied().unwrap_or_default();
        // In free flight the velocity stays as it is, and is right to the last bit at the end.
        let parted = |(own_s, own_m_s): (f64, f64)| match separation.last() {
            Some((time_s, _)) if self.system.flies_free() && time_s <= own_s => (time_s, own_m_s),
            Some(last) => last,
            // In contact at the end: of the time that was asked for, if that is later.
            None if self.plan.duration_s.is_some() => (outcome.time_s, last_m_s),
            None => (own_s, own_m_s),
        };
        let end = end.map(parted);
        Shot {
            rebound: is_struck.then(|| Rebound {
                first: separation.first(),
                end_m_s: end.map(|(_, velocity_m_s)| velocity_m_s),
                end_s: end.map(|(time_s, _)| time_s),
            }),
            hardest: outcome.hardest,
            budget: outcome.budget,
            trace,
            finished: outcome.finished,
            velocity_m_s: outcome.velocity_m_s,
            work: outcome.work,
            other_picks: other_picks.unwrap_or_default(),
            notes: Vec::from_iter(tracker.decided_s().map(|_| DECIDED.to_owned())),
            ..Shot::picked(self.plan, passages, passage, outcome.time_s, method.name)
        }
    }
}

/// Which rule ended a long chain's shot.
const DECIDED: &str = "this long chain's shot ended with the pulse's return: what is left in the chain has neither \
     the energy to reach the striker nor to press the sensor bead harder than the reflected pulse did";

/// A gap under load is no gap: the chain has closed it before the shot.
pub(crate) fn closed_gaps(plan: &Plan, system: &System) -> Option<String> {
    let gaps = plan.chain.gaps.iter().filter(|gap| gap.gap_m > 0.0);
    let loaded = |contact| system.static_contact(contact).overlap_m >= 0.0;
    match gaps.filter(|gap| loaded(gap.contact)).count() {
        0 => None,
        count => {
            Some(format!("{count} of the initial gaps carry a load and are closed before the shot"))
        }
    }
}
