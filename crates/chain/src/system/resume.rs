//! The same chain for the next shot, from where the last one left it.

use super::scales::scales;
use super::statics::elastic_force;
use super::{Spring, System};
use crate::chain::ChainError;
use crate::settle::State;
use std::sync::Arc;

impl System {
    /// The same chain in a state: for a shot of the wave loop or the ensemble
    /// loop that begins where taps or another shot have left all bodies;
    /// [`State::strike`] puts the striker there. [`State::after`] leads back.
    ///
    /// Where nothing but the striker moves, the state becomes the new rest:
    /// overlaps, gaps and locked-in forces of the contacts are what loads are
    /// otherwise, and whatever friction holds back acts on as a constant force.
    /// An energy budget does not know that force. Where beads still move, or the
    /// spring on bead 1 has let go, the chain's own balance of push and weight
    /// stays, without friction.
    ///
    /// # Errors
    /// A state of another chain or with numbers that are not finite; a chain
    /// that is already in a state, that is driven, or that is a ring.
    pub fn from_state(&self, state: &State) -> Result<Self, ChainError> {
        self.check_state(state)?;
        let mut shot = self.clone();
        for (contact, bridged) in shot.bridged.iter_mut().enumerate() {
            let touches = contact > 0 && state.overlap_m(self, contact) >= 0.0;
            *bridged = touches || state.bridged.get(contact).is_some_and(|&bridged| bridged);
        }
        let spring = self.spring_at(state.displacement_m[1]);
        if state.rests() && spring.is_some() == self.spring.is_some() {
            shot.rest_in(state, spring);
        } else {
            shot.displacement_m.copy_from_slice(&state.displacement_m);
        }
        shot.velocity_m_s.copy_from_slice(&state.velocity_m_s);
        shot.scales = scales(&shot, &shot.kinds);
        Ok(shot)
    }

    /// Overlap in m of a contact at the rest positions that states count from;
    /// −∞ where no contact is.
    pub(crate) fn rest_overlap_m(&self, contact: usize) -> f64 {
        let place = |body: usize| self.origin_m.get(body).copied().unwrap_or(0.0);
        let offset = self.offset_m.get(contact).copied();
        offset.unwrap_or(f64::NEG_INFINITY) + (place(contact + 1) - place(contact))
    }

    /// Whether it was made by [`System::from_state`] from a chain at rest.
    pub(crate) fn is_in_state(&self) -> bool {
        self.origin_m.iter().any(|&x| x != 0.0)
    }

    /// The spring on bead 1 seen from a new rest; none where it has let go.
    fn spring_at(&self, x_m: f64) -> Option<Spring> {
        let spring = self.spring?;
        let force_n = spring.force_n - spring.stiffness_n_m * x_m;
        (force_n > 0.0 || spring.force_n == 0.0)
            .then_some(Spring { force_n: force_n.max(0.0), ..spring })
    }

    fn rest_in(&mut self, state: &State, spring: Option<Spring>) {
        let overlaps = (0..self.contacts()).map(|c| state.overlap_m(self, c));
        self.offset_m = overlaps.collect();
        let forces = (0..self.contacts()).map(|c| elastic_force(self, c, self.offset_m[c]));
        self.static_force_n = forces.collect();
        self.push_n = spring.map_or(self.push_n, |spring| spring.force_n);
        self.spring = spring;
        self.origin_m = Arc::from(&state.displacement_m[..]);
        self.displacement_m.fill(0.0);
    }

    fn check_state(&self, state: &State) -> Result<(), ChainError> {
        let fail = |why: String| Err(ChainError::Layout(why));
        if self.motion.is_some() || self.periodic {
            return fail("a ring or a driven chain has no state between shots".to_owned());
        }
        if self.is_in_state() {
            return fail("the chain is already in a state: start from the chain itself".to_owned());
        }
        let (places, speeds) = (state.displacement_m.len(), state.velocity_m_s.len());
        if places != self.bodies() || speeds != self.bodies() {
            return fail(format!(
                "a state of {places} displacements and {speeds} velocities does not fit {} bodies",
                self.bodies()
            ));
        }
        match state.first_not_finite() {
            Some(body) => {
                fail(format!("the place or the speed of body {body} in the state is not finite"))
            }
            None => Ok(()),
        }
    }
}
