//! The loop itself: step, judge, locate, accept, show.

use super::dense::Piece;
use super::forces::{Gates, Pass};
use super::gate::{Event, Watch};
use super::meter::Meter;
use super::outcome::{Flow, Limits, Observer, Outcome, SolveError, Work};
use super::state::State;
use super::step::{error_norm, stage};
use super::table::Table;
use super::window::Window;
use super::{Control, Method};
use crate::system::System;
use std::ops::Range;

/// Runs one shot until an observer is finished or the duration is over.
///
/// # Errors
/// See [`SolveError`].
pub fn run(
    system: &System,
    method: &dyn Method,
    limits: Limits,
    observers: &mut [&mut dyn Observer],
) -> Result<Outcome, SolveError> {
    let table = method.table();
    check(method.control(), &limits, system)?;
    let mut wave = Wave::new(system, &table, method.control(), limits);
    wave.first_accelerations();
    let mut finished = false;
    while !finished && wave.state.time_s < limits.duration_s {
        finished = wave.advance(observers)?;
    }
    Ok(wave.outcome(finished))
}

/// Below this the rounding of a step is larger than its error.
const LEAST_TOLERANCE: f64 = 5e-15;

/// Refuses settings with which no shot can be computed.
fn check(control: Control, limits: &Limits, system: &System) -> Result<(), SolveError> {
    let setting = |what, value| Err(SolveError::Setting { what, value });
    if limits.duration_s.is_nan() || limits.duration_s < 0.0 {
        return setting("duration in s", limits.duration_s);
    }
    match control {
        Control::Adaptive { tolerance } if tolerance < LEAST_TOLERANCE => {
            Err(SolveError::TooTight {
                tolerance,
                least: LEAST_TOLERANCE,
            })
        }
        Control::Adaptive { tolerance } if tolerance.is_nan() || tolerance >= 1.0 => {
            setting("tolerance (below 1)", tolerance)
        }
        Control::Fixed { step_s } if !(step_s > 0.0 && step_s.is_finite()) => {
            setting("step in s", step_s)
        }
        Control::Fixed { step_s } if step_s > system.scales().time_s => {
            Err(SolveError::StepTooLong {
                step_s,
                contact_time_s: system.scales().time_s,
            })
        }
        _ => Ok(()),
    }
}

/// Ten thousand force passes a contact time, where a shot at 1e-12 needs a
/// thousand, and ten million for the shortest shot.
fn most_passes(system: &System, limits: &Limits) -> u64 {
    let contact_times = limits.duration_s / system.scales().time_s;
    limits
        .force_passes
        .unwrap_or(10_000_000_u64.saturating_add((1e4 * contact_times) as u64))
}

/// A shot under way.
struct Wave<'a> {
    system: &'a System,
    table: &'a Table,
    control: Control,
    limits: Limits,
    state: State,
    window: Window,
    pass: Pass,
    watch: Watch,
    meter: Option<Meter>,
    a: Vec<Vec<f64>>,
    x: Vec<f64>,
    v: Vec<f64>,
    /// Step the error control proposes.
    proposed_s: f64,
    /// Change that the next step is shortened to end at.
    aimed: Option<Event>,
    /// Body with the largest error in the last step tried.
    worst: usize,
    most_passes: u64,
    work: Work,
}

/// First step in units of the contact time: small against everything, error
/// control lets it grow fivefold a step.
const FIRST_STEP: f64 = 1e-3;

/// Steps below this fraction of the contact time mean that accuracy is out of
/// reach: at the first touch of a contact and the least tolerance 1e-9 is enough.
const SMALLEST_STEP: f64 = 1e-13;

/// Errors are measured against the speed at which closed contacts move now,
/// but never less than this fraction of the speed that set the chain in motion.
const LEAST_SCALE: f64 = 1e-2;

impl<'a> Wave<'a> {
    fn new(system: &'a System, table: &'a Table, control: Control, limits: Limits) -> Self {
        let state = State::start(system);
        let bodies = || vec![0.0; system.bodies()];
        let tolerance = match control {
            Control::Adaptive { tolerance } => tolerance,
            Control::Fixed { .. } => 0.0,
        };
        Self {
            window: Window::new(
                system,
                &state,
                (table.stages(), tolerance),
                limits.whole_chain,
            ),
            pass: Pass::new(system),
            watch: Watch::new(system, tolerance),
            meter: limits
                .budget
                .then(|| Meter::new(system, &state, table.stages())),
            a: vec![bodies(); table.stages()],
            x: state.x.clone(),
            v: state.v.clone(),
            proposed_s: FIRST_STEP * system.scales().time_s,
            aimed: None,
            worst: 0,
            most_passes: most_passes(system, &limits),
            work: Work::default(),
            system,
            table,
            control,
            limits,
            state,
        }
    }

    fn gates(&self) -> Gates {
        match self.control {
            Control::Adaptive { .. } => Gates::Frozen,
            Control::Fixed { .. } => Gates::Instant,
        }
    }

    fn contacts(&self) -> Range<usize> {
        self.window.bodies.start..self.window.bodies.end - 1
    }

    /// Accelerations of one stage from the positions and velocities in `x`, `v`.
    fn force_pass(&mut self, stage: usize) {
        let bodies = self.window.bodies.clone();
        let (gates, contacts) = (self.gates(), self.contacts());
        self.work.force_passes += 1;
        self.work.bodies_passed += bodies.len() as u64;
        let at = (&self.x[..], &self.v[..]);
        self.pass.accelerate(
            self.system,
            &self.state,
            gates,
            bodies,
            at,
            &mut self.a[stage],
        );
        if let Some(meter) = &mut self.meter {
            meter.stage(stage, self.system, &mut self.pass, contacts, self.v[0]);
        }
    }

    /// The first stage of a step, at its start.
    fn first_accelerations(&mut self) {
        let bodies = self.window.bodies.clone();
        self.x[bodies.clone()].copy_from_slice(&self.state.x[bodies.clone()]);
        self.v[bodies.clone()].copy_from_slice(&self.state.v[bodies]);
        self.force_pass(0);
    }

    /// All stages of a step after the first; leaves the end in `x` and `v`.
    fn stages(&mut self, h: f64) {
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
        let bodies = self.window.bodies.clone();
        let start = (&self.state.x[..], &self.state.v[..]);
        let out = (&mut self.x[..], &mut self.v[..]);
        stage(bodies, (h, node), (position, velocity), start, &self.a, out);
        if let Some(motion) = &self.system.motion {
            (self.x[0], self.v[0]) = motion.at(self.state.time_s + node * h);
        }
    }

    /// One accepted step; tells whether an observer is finished.
    fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, SolveError> {
        let h = match self.control {
            Control::Fixed { step_s } => self.fixed_step(step_s)?,
            Control::Adaptive { tolerance } => self.adaptive_step(tolerance)?,
        };
        let finished = self.show(h, observers);
        self.accept(h);
        Ok(finished)
    }

    /// The longest step allowed from here: to the end, or to where a driven
    /// end's motion is not smooth.
    fn longest(&self) -> f64 {
        let time = self.state.time_s;
        let next = self
            .system
            .motion
            .as_ref()
            .map_or(f64::INFINITY, |m| m.next_break(time));
        let smooth = self
            .system
            .motion
            .as_ref()
            .map_or(f64::INFINITY, |m| m.longest_step_s());
        (self.limits.duration_s - time).min(next - time).min(smooth)
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
        self.aimed = None;
        self.watch.rescale(self.speed_scale());
        loop {
            self.check_work()?;
            self.stages(h);
            let (error, body) = self.error(h);
            self.worst = body;
            let error = error / tolerance;
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
                continue;
            }
            match self.first_change(h) {
                None => {
                    let grown = h * (0.9 * error.powf(-self.table.order.recip())).clamp(0.2, 5.0);
                    // A step cut short by an event or the end says little
                    // about the step after it.
                    self.proposed_s = if h < self.proposed_s {
                        self.proposed_s.max(grown)
                    } else {
                        grown
                    };
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
        }
    }

    /// A smaller step, unless it is too small.
    fn shrunk(&self, h: f64, near: usize) -> Result<f64, SolveError> {
        let time_s = self.state.time_s;
        if h > SMALLEST_STEP * self.system.scales().time_s && time_s + h > time_s {
            return Ok(h);
        }
        match self.first_not_finite() {
            Some(body) => Err(self.not_finite(body)),
            None => {
                let contact = near.min(self.system.contacts() - 1);
                Err(SolveError::StepTooSmall {
                    time_s,
                    step_s: h,
                    contact,
                })
            }
        }
    }

    fn check_work(&self) -> Result<(), SolveError> {
        match self.work.force_passes < self.most_passes {
            true => Ok(()),
            false => Err(SolveError::TooMuchWork {
                time_s: self.state.time_s,
                force_passes: self.work.force_passes,
                step_s: match self.control {
                    Control::Fixed { step_s } => step_s,
                    Control::Adaptive { .. } => self.proposed_s,
                },
                contact: self.worst.min(self.system.contacts() - 1),
            }),
        }
    }

    fn first_not_finite(&self) -> Option<usize> {
        let bodies = self.window.bodies.clone();
        bodies
            .into_iter()
            .find(|&i| !(self.x[i].is_finite() && self.v[i].is_finite()))
    }

    fn not_finite(&self, body: usize) -> SolveError {
        let contact = body.min(self.system.contacts() - 1);
        SolveError::NotFinite {
            time_s: self.state.time_s,
            contact,
        }
    }

    /// Error of the step just tried, relative to the motion's scales.
    fn error(&self, h: f64) -> (f64, usize) {
        let Some(weights) = &self.table.error else {
            return (0.0, 0);
        };
        let speed = self.speed_scale();
        let length = speed * self.system.scales().time_s;
        let bodies = self.window.bodies.clone();
        let (error, body) = error_norm(bodies, h, weights, &self.a, (speed, length));
        let work = self
            .meter
            .as_ref()
            .map_or(0.0, |meter| meter.error(h, &weights[0]));
        (if work > error { work } else { error }, body)
    }

    /// Largest rate of a touching contact, within bounds.
    fn speed_scale(&self) -> f64 {
        let contacts = self.contacts();
        let v = &self.state.v[contacts.start..=contacts.end];
        let touching = &self.state.touching[contacts];
        let rates = v
            .windows(2)
            .zip(touching)
            .map(|(v, on)| on * (v[0] - v[1]).abs());
        rates.fold(LEAST_SCALE * self.system.scales().speed_m_s, f64::max)
    }

    /// Shows the step to the observers.
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
            accelerations: &self.a,
            window: self.window.bodies.clone(),
            asleep_since_s: &self.window.asleep_since_s,
            frozen: self.gates() == Gates::Frozen,
            meter: self.meter.as_ref(),
        }
    }

    /// The first change of a contact that must end the step.
    fn first_change(&self, h: f64) -> Option<Event> {
        self.watch
            .first(&self.piece(h), &self.pass, self.contacts())
    }

    /// Makes the end of the step the new state.
    fn accept(&mut self, h: f64) {
        let bodies = self.window.bodies.clone();
        self.work.steps += 1;
        if let Some(meter) = &mut self.meter {
            let moving = bodies
                .clone()
                .filter(|&i| self.system.mass_kg[i].is_finite());
            let kinetic = moving
                .map(|i| 0.5 * self.system.mass_kg[i] * self.v[i] * self.v[i])
                .sum();
            meter.finish_step(h, self.table.end().0, kinetic);
            meter.carry_over();
        }
        self.state.time_s += h;
        self.state.x[bodies.clone()].copy_from_slice(&self.x[bodies.clone()]);
        self.state.v[bodies.clone()].copy_from_slice(&self.v[bodies.clone()]);
        let last = self.table.stages() - 1;
        self.a.swap(0, last);
        self.remember_largest();
        let changed = match self.control {
            Control::Adaptive { .. } => self.settle_gates(),
            Control::Fixed { .. } => self.follow_gates(),
        };
        self.window.follow(self.system, &mut self.state);
        self.wake(bodies);
        if changed {
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
        self.watch
            .settle(self.system, &mut self.state, &self.pass, contacts, aimed)
    }

    /// With fixed steps modes only tell the energy budget what touches.
    fn follow_gates(&mut self) -> bool {
        for contact in self.contacts() {
            let touches = self.state.overlap(self.system, contact) >= 0.0;
            let mode = if touches {
                super::state::Mode::Closed
            } else {
                super::state::Mode::Open
            };
            self.state.set(contact, mode);
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

    fn outcome(mut self, finished: bool) -> Outcome {
        self.window.wake_all(&mut self.state);
        Outcome {
            time_s: self.state.time_s,
            finished,
            budget: self
                .meter
                .map(|meter| meter.budget(self.system, &self.state)),
            velocity_m_s: self.state.v,
            displacement_m: self.state.x,
            work: self.work,
        }
    }
}
