//! The loop itself: step, error control, event location, observers.

use super::dense::{Piece, StageWeights};
use super::forces::{Gates, Pass};
use super::gate::{ChangeDetector, Event};
use super::hardest::HardestContact;
use super::meter::Meter;
use super::order::Order;
use super::outcome::{Flow, Limits, Observer, Outcome, SolveError, Work};
use super::settings::{check, most_passes};
use super::state::WaveState;
use super::step::stage;
use super::table::Table;
use super::window::MovingBodies;
use super::zones::LongStep;
use super::{Control, Method};
use crate::system::System;
use std::cell::RefCell;
use std::ops::Range;

/// Runs one shot until an observer is finished or the duration is over.
///
/// # Errors
/// See [`SolveError`].
pub fn run(
    system: &System,
    method: &Method,
    limits: Limits,
    observers: &mut [&mut dyn Observer],
) -> Result<Outcome, SolveError> {
    check(method.control, &limits, system)?;
    let mut wave = Wave::new(system, method, limits);
    wave.first_accelerations();
    let mut finished = false;
    while !finished && wave.state.time_s < limits.duration_s {
        finished = wave.advance(observers)?;
    }
    Ok(wave.outcome(finished))
}

pub(super) struct Wave<'a> {
    pub(super) system: &'a System,
    order: Order<'a>,
    pub(super) table: &'a Table,
    pub(super) control: Control,
    pub(super) limits: Limits,
    pub(super) state: WaveState,
    pub(super) window: MovingBodies,
    pub(super) pass: Pass,
    pub(super) watch: ChangeDetector,
    pub(super) meter: Option<Meter>,
    hardest: Option<HardestContact>,
    /// The long step that slow bodies take beside short ones.
    pub(super) slow: LongStep,
    pub(super) gates: Gates,
    pub(super) a: Vec<Vec<f64>>,
    pub(super) x: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) proposed_s: f64,
    /// Change that the next step is shortened to end at.
    pub(super) aimed: Option<Event>,
    /// Body with the largest error in the last step tried.
    pub(super) worst: usize,
    pub(super) most_passes: u64,
    pub(super) work: Work,
}

/// First step in units of the contact time: small against everything, error
/// control lets it grow fivefold a step.
const FIRST_STEP: f64 = 1e-3;

impl<'a> Wave<'a> {
    fn new(system: &'a System, method: &'a Method, limits: Limits) -> Self {
        let remembers = system.has_states || system.has_memory;
        let order = Order::new(&method.table, method.smooth.as_ref().filter(|_| !remembers));
        let (control, most_stages) = (method.control, order.most_stages());
        let state = WaveState::start(system, most_stages);
        let bodies = || vec![0.0; system.bodies()];
        let tolerance = match control {
            Control::Adaptive { tolerance } => tolerance,
            Control::Fixed { .. } => 0.0,
        };
        let window =
            MovingBodies::new(system, &state, (most_stages, tolerance), limits.whole_chain);
        let adaptive = matches!(control, Control::Adaptive { .. });
        let two_clocks = adaptive && window.sleeps_again() && !system.has_memory;
        Self {
            window,
            slow: LongStep::new(system, most_stages, two_clocks),
            gates: if adaptive { Gates::Frozen } else { Gates::Instant },
            pass: Pass::new(system),
            watch: ChangeDetector::new(system, tolerance),
            meter: limits.budget.then(|| Meter::new(system, &state, most_stages)),
            hardest: limits.budget.then(|| HardestContact::new(system)),
            a: vec![bodies(); most_stages],
            x: state.x.clone(),
            v: state.v.clone(),
            proposed_s: FIRST_STEP * system.scales().time_s,
            aimed: None,
            worst: 0,
            most_passes: most_passes(system, &limits),
            work: Work::default(),
            system,
            table: order.table(),
            order,
            control,
            limits,
            state,
        }
    }

    pub(super) fn contacts(&self) -> Range<usize> {
        let bodies = self.moving();
        bodies.start..bodies.end - 1
    }

    /// Accelerations of one stage from the positions and velocities in `x`, `v`.
    pub(super) fn force_pass(&mut self, stage: usize) {
        let bodies = self.moving();
        let (gates, contacts) = (self.gates, self.contacts());
        let usual = gates == self.usual_gates();
        self.work.force_passes += 1;
        self.work.bodies_passed += bodies.len() as u64;
        let at = (&self.x[..], &self.v[..]);
        if self.system.has_states {
            let seen = (at.0, at.1, &self.state.touching[..]);
            let force = &mut self.pass.of_states;
            self.state.states.stage(stage, self.system, contacts.clone(), seen, force);
        }
        self.pass.accelerate(
            self.system,
            &self.state,
            gates,
            bodies.clone(),
            at,
            &mut self.a[stage],
        );
        if let Some(meter) = &mut self.meter {
            let parts = match usual {
                true => [contacts, 0..0],
                false => LongStep::contacts(&self.slow.quick, &bodies),
            };
            meter.stage(stage, self.system, &mut self.pass, parts, self.v[0]);
        }
    }

    /// The first stage of a step, at its start.
    pub(super) fn first_accelerations(&mut self) {
        let bodies = self.moving();
        self.x[bodies.clone()].copy_from_slice(&self.state.x[bodies.clone()]);
        self.v[bodies.clone()].copy_from_slice(&self.state.v[bodies]);
        self.hold_seams(self.state.time_s);
        self.combine_states(0.0, &[]);
        self.force_pass(0);
    }

    /// All stages of a step after the first; leaves the end in `x` and `v`.
    pub(super) fn stages(&mut self, h: f64) {
        let table = self.table;
        for s in 1..table.stages() {
            self.combine(h, table.nodes[s], &table.position[s], &table.velocity[s]);
            self.force_pass(s);
        }
        if !table.last_is_end {
            let (velocity, position) = table.end();
            self.combine(h, 1.0, position, velocity);
        }
    }

    fn combine(&mut self, h: f64, node: f64, position: &[f64], velocity: &[f64]) {
        let bodies = self.moving();
        let start = (&self.state.x[..], &self.state.v[..]);
        let out = (&mut self.x[..], &mut self.v[..]);
        stage(self.pass.set, bodies, (h, node), (position, velocity), start, &self.a, out);
        if let Some(motion) = &self.system.motion {
            (self.x[0], self.v[0]) = motion.at(self.state.time_s + node * h);
        }
        self.hold_seams(self.state.time_s + node * h);
        self.combine_states(h, velocity);
    }

    fn combine_states(&mut self, h: f64, weights: &[f64]) {
        if self.system.has_states {
            let contacts = self.contacts();
            self.state.states.combine(h, weights, &contacts);
        }
    }

    /// One accepted step; returns whether an observer is finished.
    fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, SolveError> {
        let h = match self.control {
            Control::Fixed { step_s } => self.fixed_step(step_s)?,
            Control::Adaptive { tolerance } => self.adaptive_step(tolerance)?,
        };
        let finished = self.show(h, observers);
        if let Some(mut hardest) = self.hardest.take() {
            let contacts = self.contacts();
            let overlaps_m = &self.pass.overlap[contacts.clone()];
            hardest.step(&self.piece(h), overlaps_m, contacts);
            self.hardest = Some(hardest);
        }
        self.accept(h);
        Ok(finished)
    }

    /// The longest step allowed from here: to the end, or to where a driven
    /// end's motion is not smooth.
    pub(super) fn longest(&self) -> f64 {
        let time = self.state.time_s;
        let next = self.system.motion.as_ref().map_or(f64::INFINITY, |m| m.next_break(time));
        let smooth = self.system.motion.as_ref().map_or(f64::INFINITY, |m| m.longest_step_s());
        let slow = match self.slow.active {
            true => self.slow.end_s() - time,
            false => f64::INFINITY,
        };
        let end = self.limits.duration_s - time;
        end.min(next - time).min(smooth).min(slow)
    }

    fn fixed_step(&mut self, step_s: f64) -> Result<f64, SolveError> {
        self.check_work()?;
        let h = step_s.min(self.longest());
        self.stages(h);
        match self.first_not_finite() {
            Some(body) => Err(self.not_finite(body)),
            None => Ok(h),
        }
    }

    fn adaptive_step(&mut self, tolerance: f64) -> Result<f64, SolveError> {
        let mut h = self.proposed_s.min(self.longest());
        let (mut repeated, tolerance) = (0, self.order.share() * tolerance);
        self.aimed = None;
        self.watch.rescale(self.speed_scale());
        loop {
            self.check_work()?;
            self.stages(h);
            let (error, body) = self.error(h);
            self.worst = body;
            let onset = if self.limits.careful_closings { self.watch.onset } else { 1.0 };
            let error = onset * error / tolerance;
            if error > 1.0 || error.is_nan() {
                let shrink = if error.is_finite() {
                    0.9 * error.powf(-self.table.order.recip())
                } else {
                    0.1
                };
                h = self.shrunk(h * shrink.max(0.1), body)?;
                self.proposed_s = h;
                self.aimed = None;
                self.work.rejected += 1;
                repeated += 1;
                continue;
            }
            match self.first_change(h) {
                None => {
                    let grown = h * (0.9 * error.powf(-self.table.order.recip())).clamp(0.2, 5.0);
                    // A step cut short by an event or the end says little
                    // about the step after it.
                    self.proposed_s =
                        if h < self.proposed_s { self.proposed_s.max(grown) } else { grown };
                    self.order.count(repeated);
                    return Ok(h);
                }
                Some(event) if event.at_start => {
                    self.watch.apply(&mut self.state, event);
                    self.first_accelerations();
                }
                Some(event) => {
                    h = self.shrunk(h * event.theta, event.contact)?;
                    self.aimed = Some(event);
                }
            }
            self.work.located += 1;
            repeated += 1;
        }
    }

    fn show(&self, h: f64, observers: &mut [&mut dyn Observer]) -> bool {
        let piece = self.piece(h);
        let mut finished = false;
        for observer in observers {
            finished |= observer.step(&piece) == Flow::Finished;
        }
        finished
    }

    fn piece(&self, h: f64) -> Piece<'_> {
        Piece {
            system: self.system,
            table: self.table,
            state: &self.state,
            step_s: h,
            end: (&self.x, &self.v),
            accelerations: &self.a[..self.table.stages()],
            window: self.window.bodies.clone(),
            asleep_since_s: &self.window.asleep_since_s,
            frozen: self.gates == Gates::Frozen,
            tolerance: match self.control {
                Control::Adaptive { tolerance } => tolerance,
                Control::Fixed { .. } => 0.0,
            },
            slow: self.slow.active.then_some(&self.slow),
            meter: self.meter.as_ref(),
            weights: RefCell::new((f64::NAN, StageWeights::default())),
            bends: self.table.bends.then(RefCell::default),
        }
    }

    /// The first change of a contact that must end the step.
    fn first_change(&self, h: f64) -> Option<Event> {
        self.watch.first(&self.piece(h), &self.pass, self.contacts())
    }

    /// Makes the end of the step the new state.
    fn accept(&mut self, h: f64) {
        let bodies = self.owned();
        let awake = self.window.bodies.clone();
        self.work.steps += 1;
        if let Some(meter) = &mut self.meter {
            let moving = bodies.clone().filter(|&i| self.system.mass_kg[i].is_finite());
            let kinetic =
                moving.map(|i| 0.5 * self.system.mass_kg[i] * self.v[i] * self.v[i]).sum();
            meter.finish_step(h, self.table.end().0, kinetic);
            meter.carry_over(self.table.stages() - 1);
        }
        self.state.time_s += h;
        self.state.x[bodies.clone()].copy_from_slice(&self.x[bodies.clone()]);
        self.state.v[bodies.clone()].copy_from_slice(&self.v[bodies.clone()]);
        let last = self.table.stages() - 1;
        self.a.swap(0, last);
        self.remember_largest();
        let states_changed = self.accept_states();
        let changed = match self.control {
            Control::Adaptive { .. } => self.settle_gates(),
            Control::Fixed { .. } => self.follow_gates(),
        };
        let finished = self.finish_slow();
        match self.slow.active {
            true => {
                let sides =
                    [self.slow.quick.start == 0, self.slow.quick.end == self.system.bodies()];
                self.window.keep_up(self.system, &mut self.state, sides);
            }
            false => self.window.follow(self.system, &mut self.state),
        }
        self.wake(awake);
        if !self.slow.active
            && let Some(longer) = self.order.change()
        {
            self.table = self.order.table();
            self.proposed_s *= longer;
        }
        let begun =
            !self.slow.active && self.slow.is_due(self.window.bodies.len()) && self.begin_slow();
        if changed || states_changed || finished || begun {
            self.first_accelerations();
        }
    }

    /// Bodies that have just woken rest or fly: nothing accelerates them yet.
    fn wake(&mut self, awake_before: Range<usize>) {
        let now = self.window.bodies.clone();
        for i in now.filter(|i| !awake_before.contains(i)) {
            self.a[0][i] = 0.0;
            (self.x[i], self.v[i]) = (self.state.x[i], self.state.v[i]);
        }
    }

    fn settle_gates(&mut self) -> bool {
        let (contacts, aimed) = (self.contacts(), self.aimed);
        self.watch.settle(self.system, &mut self.state, &self.pass, contacts, aimed)
    }

    /// With fixed steps modes only report to the energy budget what touches.
    fn follow_gates(&mut self) -> bool {
        for contact in self.contacts() {
            self.state.follow(self.system, contact);
        }
        false
    }

    fn remember_largest(&mut self) {
        if self.system.has_memory {
            for contact in self.contacts() {
                let overlap = self.state.overlap(self.system, contact);
                self.state.largest[contact] = self.state.largest[contact].max(overlap);
            }
        }
    }

    /// Whether the force or the rates of any contact's state jump here.
    fn accept_states(&mut self) -> bool {
        let mut changed = false;
        if self.system.has_states {
            let (contacts, mut states) = (self.contacts(), std::mem::take(&mut self.state.states));
            let v = &self.state.v;
            let at = |c| (self.state.overlap(self.system, c), v[c] - v[c + 1]);
            changed = states.accept(&contacts, at);
            self.state.states = states;
        }
        changed
    }

    fn outcome(mut self, finished: bool) -> Outcome {
        let time_s = self.state.time_s;
        self.slow.bring_to(self.system, self.table, &mut self.state, time_s);
        self.window.wake_all(&mut self.state);
        let slow = self.slow.active.then_some(&self.slow);
        let pending = slow.map(|slow| (slow.step_s, slow.weights(self.table, time_s)));
        Outcome {
            time_s,
            finished,
            budget: self
                .meter
                .map(|meter| meter.budget(self.system, &self.state, pending.as_ref())),
            hardest: self.hardest.and_then(|hardest| hardest.found()),
            velocity_m_s: self.state.v,
            displacement_m: self.state.x,
            bridged: self.state.bridged,
            work: self.work,
        }
    }
}
