//! The loop: feel, kick, show, drift; every few steps look around.

use super::columns::Columns;
use super::pace::{LOOK_EVERY, Pace};
use super::{Rest, SlowPhase, State, Withdrawn, not_finite};
use crate::system::System;
use crate::wave::SolveError;

/// Speeds in m/s up to this count as none. Friction stops a body exactly;
/// without it, this is when the last ringing is over.
const STILL_M_S: f64 = 1e-9;

/// The longest step, as a fraction of the time for which bodies must stick.
const LONGEST: f64 = 0.02;

/// More steps take ten seconds and more: no sensible chain needs them.
const MOST_STEPS: u64 = 50_000_000;

/// A step below this fraction of the longest time leads nowhere.
const SHORTEST: f64 = 1e-12;

pub(super) struct Relaxation<'a> {
    system: &'a System,
    slow: &'a SlowPhase,
    state: &'a mut State,
    columns: Columns,
    pace: Pace,
    time_s: f64,
    step_s: f64,
    still_since_s: Option<f64>,
    withdrawn: Option<Withdrawn>,
    steps: u64,
    next_look: u64,
}

impl<'a> Relaxation<'a> {
    pub(super) fn new(system: &'a System, slow: &'a SlowPhase, state: &'a mut State) -> Self {
        state.bridged.resize(system.bridged.len(), false);
        Self {
            columns: Columns::new(system, slow, state),
            pace: Pace::new(system, slow.step, LONGEST * slow.stuck_for_s),
            time_s: 0.0,
            step_s: 0.0,
            still_since_s: None,
            withdrawn: None,
            steps: 0,
            next_look: 0,
            system,
            slow,
            state,
        }
    }

    pub(super) fn run(
        mut self,
        seen: &mut dyn FnMut(f64, &State, &[f64]),
    ) -> Result<Rest, SolveError> {
        // Velocities lag half a step behind positions, but not at the start.
        let mut kick_s = 0.0;
        loop {
            self.columns.feel(self.system, self.state);
            if self.steps == self.next_look && self.look()? {
                return Ok(self.rest());
            }
            kick_s = 0.5 * (kick_s + self.step_s);
            self.columns.kick(kick_s, &mut self.state.velocity_m_s);
            let forces = &self.columns.force[1..=self.system.contacts()];
            seen(self.time_s, self.state, forces);
            self.columns.drift(self.step_s, &mut self.state.displacement_m);
            self.time_s += self.step_s;
            self.steps += 1;
            kick_s = self.step_s;
        }
    }

    fn look(&mut self) -> Result<bool, SolveError> {
        self.withdraw_striker();
        let fastest = self.fastest()?;
        let speed_m_s = self.columns.v[fastest].abs();
        let since = match speed_m_s <= STILL_M_S {
            true => self.still_since_s.or(Some(self.time_s)),
            false => None,
        };
        self.still_since_s = since;
        if since.is_some_and(|since| self.time_s - since >= self.slow.stuck_for_s) {
            return Ok(true);
        }
        if self.time_s >= self.slow.longest_s {
            self.park_striker();
            let time_s = self.time_s;
            let why = format!(
                "not at rest after {time_s:.3} s: body {fastest} (0 is the striker) still moves at {speed_m_s:.2e} m/s. \
                 Allow more time, or look at friction: a coefficient of 0 stops nothing, and on an incline \
                 a bead slides where the coefficient is below the tangent of the angle"
            );
            return Err(SolveError::StillMoving { time_s, why });
        }
        self.choose_step()?;
        Ok(false)
    }

    fn choose_step(&mut self) -> Result<(), SolveError> {
        let (x, before) = (&self.state.displacement_m, self.step_s);
        self.step_s = self.pace.step(self.system, &self.columns, x, before);
        // At the start nothing is known of what comes, and a step that has
        // shrunk by much may have to shrink again.
        let calm = self.steps >= LOOK_EVERY && self.step_s > 0.5 * before;
        self.next_look = self.steps + if calm { LOOK_EVERY } else { 1 };
        let leads_on = self.step_s > SHORTEST * self.slow.longest_s;
        match self.steps >= MOST_STEPS || !leads_on {
            true => Err(SolveError::TooManySteps {
                time_s: self.time_s,
                why: format!(
                    "gave up at t = {:e} s after {} steps: the last one was {:e} s, set by the stiffest contact; \
                     look at the contacts' laws and at the lightest bead",
                    self.time_s, self.steps, self.step_s
                ),
            }),
            false => Ok(()),
        }
    }

    fn fastest(&self) -> Result<usize, SolveError> {
        let (mut fastest, mut most) = (0, 0.0);
        for (i, (x, v)) in self.state.displacement_m.iter().zip(&self.columns.v).enumerate() {
            if !(x.is_finite() && v.is_finite()) {
                return Err(not_finite(self.time_s, i));
            }
            if v.abs() > most {
                (fastest, most) = (i, v.abs());
            }
        }
        Ok(fastest)
    }

    /// Takes the striker away where it is far enough and does not come back.
    fn withdraw_striker(&mut self) {
        if !self.columns.has_striker(self.system) {
            return;
        }
        let (x, v) = (&self.state.displacement_m, &self.columns.v);
        let gap = x[1] - x[0] - self.columns.offset[0];
        if gap >= self.slow.withdrawn_at_m && v[0] <= v[1] {
            self.withdrawn = Some(Withdrawn { time_s: self.time_s, velocity_m_s: v[0] });
            self.state.velocity_m_s[0] = 0.0;
            self.columns.withdraw();
        }
    }

    /// Bead 1 may have moved on beyond where the striker was taken away.
    fn park_striker(&mut self) {
        if self.withdrawn.is_some() {
            let touching = self.state.displacement_m[1] - self.system.rest_overlap_m(0);
            let away = touching - 2.0 * self.slow.withdrawn_at_m;
            self.state.displacement_m[0] = self.state.displacement_m[0].min(away);
        }
    }

    fn rest(mut self) -> Rest {
        self.park_striker();
        self.state.velocity_m_s.fill(0.0);
        let gap = |contact: usize| {
            let gap = -self.state.overlap_m(self.system, contact);
            let counts = self.system.has_contact(contact)
                && (contact > 0 || self.columns.has_striker(self.system));
            if counts { gap.max(0.0) } else { 0.0 }
        };
        let gaps_m: Vec<f64> = (0..self.system.contacts()).map(gap).collect();
        let closed = |&c: &usize| self.system.has_contact(c) && gaps_m[c] == 0.0;
        Rest {
            time_s: self.still_since_s.unwrap_or(self.time_s),
            closed_contacts: (1..self.system.contacts()).filter(closed).count(),
            gaps_m,
            withdrawn: self.withdrawn,
            steps: self.steps,
        }
    }
}
