//! Running a plan: once, with steps halved, or again to check.

use crate::accuracy::{self, Halvings, MOST_HALVINGS, Outlook, TIGHTEST};
use crate::duration::{self, End};
use crate::error::StudyError;
use crate::flight::Flight;
use crate::following::Following;
use crate::plan::{Plan, Solver, Watch};
use crate::shot::{Rebound, Shot, ambiguous, reported};
use crate::stop::{count_steps, stopped};
use hertzchain_chain::observe::{Apart, PassageError, Separation, Trace, Tracer};
use hertzchain_chain::wave::{Flow, Limits, Method, Observer, Outcome, Piece, run};
use hertzchain_chain::{Start, System};

/// Ends a shot that is no longer wanted or takes too many steps, which it counts.
struct BreakingOff {
    steps: u64,
    most_steps: f64,
}

/// Steps that are counted at a time: threads that share a counter wait for each other.
const COUNTED: u64 = 64;

impl Observer for BreakingOff {
    fn step(&mut self, _: &Piece<'_>) -> Flow {
        self.steps += 1;
        if self.steps.is_multiple_of(COUNTED) {
            count_steps(COUNTED);
        }
        match stopped() || self.is_long() {
            true => Flow::Finished,
            false => Flow::Continue,
        }
    }
}

impl BreakingOff {
    fn is_long(&self) -> bool {
        self.steps as f64 >= self.most_steps
    }
}

/// Most times that a shot is computed so that its energy budget closes.
const MOST_TRIES: u32 = 4;

/// How far the energy budget is from closing, as a fraction of the input; 0
/// where there is none.
fn residual(shot: &Shot) -> f64 {
    let budget = shot.budget.as_ref();
    budget.map_or(0.0, |budget| budget.relative_residual().abs())
}

/// A plan whose chain is set up.
pub(crate) struct Gun<'a> {
    plan: &'a Plan,
    system: System,
    end: End,
}

impl<'a> Gun<'a> {
    /// Sets up the chain and decides when its shot ends.
    pub(crate) fn load(plan: &'a Plan) -> Result<Self, StudyError> {
        plan.check()?;
        if stopped() {
            return Err(StudyError::Stopped);
        }
        let system = System::new(&plan.chain)?;
        let end = duration::end(plan, &system);
        Ok(Self { plan, system, end })
    }

    /// The shot, computed twice if checked.
    pub(crate) fn shoot(&self, checked: bool) -> Result<Shot, StudyError> {
        let mut shot = self.computed(checked)?;
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

    fn computed(&self, checked: bool) -> Result<Shot, StudyError> {
        match (self.plan.solver, accuracy::given_step(self.plan.solver)) {
            (Solver::Adaptive, _) => self.adaptive(checked),
            (solver, Some(step_s)) => self.fixed(solver, step_s, checked),
            (solver, None) => self.halving(solver),
        }
    }

    fn adaptive(&self, checked: bool) -> Result<Shot, StudyError> {
        let (tolerance, beyond) = accuracy::tolerance(self.plan);
        let (mut shot, tolerance) = self.balanced(tolerance)?;
        if beyond {
            shot.notes.push(format!(
                "an accuracy of {:e} is beyond double precision: computed at the tightest tolerance, {TIGHTEST:e} a step",
                self.plan.accuracy
            ));
        }
        if checked {
            self.refine(&mut shot, tolerance)?;
        }
        Ok(shot)
    }

    /// The shot, computed more tightly as long as its energy budget does not
    /// close to the accuracy asked; and the tolerance that it took.
    fn balanced(&self, mut tolerance: f64) -> Result<(Shot, f64), StudyError> {
        let mut tries = 1;
        loop {
            let mut shot = self.once(&*accuracy::adaptive(tolerance), self.plan.watch.is_some())?;
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

    /// Computes a shot again at a tenth of the tolerance; where that shows that
    /// the accuracy was not reached, the finer shot takes its place.
    fn refine(&self, shot: &mut Shot, mut tolerance: f64) -> Result<(), StudyError> {
        let mut again = self.once(&*accuracy::adaptive(0.1 * tolerance), false)?;
        let bound = |shot: &Shot, again: &Shot, tolerance: f64| {
            accuracy::reached(shot.change(again), tolerance)
        };
        while bound(shot, &again, tolerance) > self.plan.accuracy && 0.1 * tolerance >= TIGHTEST {
            tolerance *= 0.1;
            let notes = std::mem::take(&mut shot.notes);
            *shot = match self.plan.watch {
                Some(_) => self.once(&*accuracy::adaptive(tolerance), true)?,
                None => again,
            };
            (shot.tolerance, shot.notes) = (Some(tolerance), notes);
            again = self.once(&*accuracy::adaptive(0.1 * tolerance), false)?;
        }
        self.judge(shot, bound(shot, &again, tolerance));
        Ok(())
    }

    /// A fixed step as given, whatever accuracy that is.
    fn fixed(&self, solver: Solver, step_s: f64, checked: bool) -> Result<Shot, StudyError> {
        let mut shot = self.at_step(solver, step_s, self.plan.watch.is_some())?;
        if checked {
            let again = self.at_step(solver, 0.5 * step_s, false)?;
            let reached = accuracy::reached(shot.change(&again), 0.0);
            self.judge(&mut shot, reached);
        }
        Ok(shot)
    }

    /// Halves the step until the result stands still; gives up as soon as the
    /// order of convergence tells that it would take too long.
    fn halving(&self, solver: Solver) -> Result<Shot, StudyError> {
        let first_s = accuracy::first_step_s(&self.system);
        let step_s = |halving: u32| first_s * 0.5_f64.powf(f64::from(halving));
        let mut last = self.at_step(solver, first_s, false);
        let mut halvings = Halvings::default();
        for halving in 1..=MOST_HALVINGS {
            let next = self.at_step(solver, step_s(halving), false);
            halvings.note(match (&last, &next) {
                (Ok(one), Ok(two)) => one.change(two),
                _ => f64::INFINITY,
            });
            if halvings.standing() <= self.plan.accuracy {
                return self.settled(solver, step_s(halving), halvings.standing(), next);
            }
            let outlook = halvings.outlook(self.plan.accuracy);
            if let (Some(outlook), Ok(shot)) = (outlook, &next)
                && f64::from(halving) + outlook.halvings > f64::from(MOST_HALVINGS)
            {
                return Err(self.too_many_steps(shot, outlook));
            }
            last = next;
        }
        let last = last?;
        let (time_s, contact) = self.last_pulse(&last);
        Err(StudyError::NotConverged {
            method: accuracy::fixed(solver, first_s).name(),
            accuracy: self.plan.accuracy,
            step_s: step_s(MOST_HALVINGS),
            change: halvings.last(),
            time_s,
            contact,
        })
    }

    /// The refusal of an accuracy, from a shot with a longer step.
    fn too_many_steps(&self, shot: &Shot, outlook: Outlook) -> StudyError {
        let finer = outlook.halvings.exp2();
        let (time_s, contact) = self.last_pulse(shot);
        StudyError::TooManySteps {
            method: shot.solver.clone(),
            accuracy: self.plan.accuracy,
            steps: shot.work.steps as f64 * finer,
            step_s: shot.step_s.unwrap_or(f64::NAN) / finer,
            order: outlook.order,
            time_s,
            contact,
        }
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
    fn settled(
        &self,
        solver: Solver,
        step_s: f64,
        change: f64,
        found: Result<Shot, StudyError>,
    ) -> Result<Shot, StudyError> {
        let mut shot = match self.plan.watch {
            Some(_) => self.at_step(solver, step_s, true)?,
            None => found?,
        };
        shot.accuracy_reached = Some(change);
        Ok(shot)
    }

    fn at_step(&self, solver: Solver, step_s: f64, sampled: bool) -> Result<Shot, StudyError> {
        let mut shot = self.once(&*accuracy::fixed(solver, step_s), sampled)?;
        shot.step_s = Some(step_s);
        Ok(shot)
    }

    fn judge(&self, shot: &mut Shot, reached: f64) {
        shot.accuracy_reached = Some(reached);
        if reached > self.plan.accuracy {
            shot.notes.push(format!(
                "the asked accuracy of {:e} was not reached: as a tighter computation tells, the result is right to {reached:.1e}",
                self.plan.accuracy
            ));
        }
    }

    /// One run with one method.
    fn once(&self, method: &dyn Method, sampled: bool) -> Result<Shot, StudyError> {
        let mut following = Following::new(self.plan, &self.end);
        let mut separation = Separation::default();
        let mut apart = Apart;
        let mut tracer = self.tracer().filter(|_| sampled);
        let mut breaking_off = BreakingOff {
            steps: 0,
            most_steps: self.end.most_steps,
        };
        let mut observers: Vec<&mut dyn Observer> =
            vec![&mut breaking_off, &mut following, &mut separation];
        if self.end.when_apart {
            observers.push(&mut apart);
        }
        observers.extend(tracer.as_mut().map(|tracer| tracer as &mut dyn Observer));
        let limits = Limits {
            budget: self.plan.budget,
            slow_tolerance: Some(accuracy::of_times(self.plan)),
            ..Limits::until(self.end.longest_s)
        };
        let outcome = run(&self.system, method, limits, &mut observers)?;
        if stopped() {
            return Err(StudyError::Stopped);
        }
        let trace = tracer.map(|tracer| self.trace(tracer)).transpose()?;
        let mut shot = self.shot(method, outcome, &following, separation, trace);
        shot.finished &= !breaking_off.is_long();
        shot.notes.extend(self.ended_early(&shot, &following));
        Ok(shot)
    }

    /// What was not waited for.
    fn ended_early(&self, shot: &Shot, following: &Following) -> Option<String> {
        let searched_s = shot.passage.as_ref().ok()?.search_ends_s;
        let decided = following.decided_s().is_some();
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
        let interval_s = self.interval_s(watch);
        Some(Tracer::new(watch.sensors.clone(), interval_s, interval_s))
    }

    fn interval_s(&self, watch: &Watch) -> f64 {
        let usual = 0.1 * self.system.scales().time_s;
        watch.interval_s.unwrap_or(usual)
    }

    fn trace(&self, tracer: Tracer) -> Result<Trace, StudyError> {
        match (tracer.full_s(), &self.plan.watch) {
            (Some(time_s), Some(watch)) => Err(StudyError::LongTrace {
                sensors: watch.sensors.len(),
                interval_s: self.interval_s(watch),
                time_s,
            }),
            _ => Ok(tracer.into_trace()),
        }
    }

    fn shot(
        &self,
        method: &dyn Method,
        outcome: Outcome,
        following: &Following,
        separation: Separation,
        trace: Option<Trace>,
    ) -> Shot {
        let passages = following.passages();
        let passage = match duration::has_wall(&self.plan.chain.far) {
            true => passages.passage(),
            false => Err(PassageError::NoWallPulse {
                duration_s: outcome.time_s,
            }),
        };
        let seen = passage.as_ref().ok();
        let picked = |pick| Flight::picked(pick, passages, seen?);
        let between = (self.system.beads() - self.plan.sensor_bead) as f64 + 0.5;
        let is_struck = matches!(self.plan.chain.start, Start::Striker { .. });
        // A shot that came to the end of the rule by another way than the striker's.
        let own_end = self.plan.rebound && self.plan.duration_s.is_none();
        let at_end_m_s = outcome.velocity_m_s.first().filter(|_| own_end).copied();
        let at_end = at_end_m_s.map(|velocity_m_s| (outcome.time_s, velocity_m_s));
        let end = following.last_word().or(at_end);
        Shot {
            flight: picked(self.plan.pick),
            compared: self.plan.compare.iter().map(|&pick| picked(pick)).collect(),
            sensor_maxima: reported(passages.sensor().maxima()),
            pulse_speed_beads_s: seen.map(|passage| between / passage.tof_incident_s()),
            rebound: is_struck.then(|| Rebound {
                first: separation.first(),
                end_m_s: end.map(|(_, velocity_m_s)| velocity_m_s),
                end_s: end.map(|(time_s, _)| time_s),
            }),
            passage,
            budget: outcome.budget,
            trace,
            duration_s: outcome.time_s,
            finished: outcome.finished,
            velocity_m_s: outcome.velocity_m_s,
            work: outcome.work,
            accuracy_asked: self.plan.accuracy,
            accuracy_reached: None,
            solver: method.name().to_owned(),
            tolerance: None,
            step_s: None,
            notes: Vec::from_iter(following.decided_s().map(|_| DECIDED.to_owned())),
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
        count => Some(format!(
            "{count} of the initial gaps carry a load and are closed before the shot"
        )),
    }
}
