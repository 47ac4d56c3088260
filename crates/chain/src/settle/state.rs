//! Where all bodies are between two shots.

use crate::system::System;
use crate::wave::Outcome;

/// Positions and velocities of all bodies: the striker, the beads, the far end.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Displacements in m from the rest positions of the chain's [`System::new`].
    pub displacement_m: Vec<f64>,
    /// Velocities in m/s, toward the wall.
    pub velocity_m_s: Vec<f64>,
    /// Contacts that have touched and not parted as far as a liquid bridge bears; empty in
    /// a chain without bridges.
    pub bridged: Vec<bool>,
}

impl State {
    /// A chain as its file says: at static equilibrium, the striker about to hit.
    pub fn start(system: &System) -> Self {
        let displaced = system.origin_m.iter().zip(&system.displacement_m);
        Self {
            displacement_m: displaced.map(|(origin, x)| origin + x).collect(),
            velocity_m_s: system.velocity_m_s.clone(),
            bridged: system.bridged.clone(),
        }
    }

    /// Beads laid at rest, from the far end on, with these gaps in m at contacts
    /// 0..=N; a negative one is an overlap. A contact beyond the list has its
    /// static overlap.
    pub fn laid(system: &System, gaps_m: &[f64]) -> Self {
        let mut displacement_m = vec![0.0; system.bodies()];
        for contact in (0..system.contacts()).rev() {
            let gap = gaps_m.get(contact).filter(|_| system.has_contact(contact));
            let apart = gap.map_or(0.0, |gap| system.rest_overlap_m(contact) + gap);
            displacement_m[contact] = displacement_m[contact + 1] - apart;
        }
        Self {
            velocity_m_s: vec![0.0; displacement_m.len()],
            displacement_m,
            bridged: vec![false; system.bridged.len()],
        }
    }

    /// At the end of a shot of the wave loop.
    pub fn after(shot: &System, outcome: &Outcome) -> Self {
        let displaced = shot.origin_m.iter().zip(&outcome.displacement_m);
        Self {
            displacement_m: displaced.map(|(origin, x)| origin + x).collect(),
            velocity_m_s: outcome.velocity_m_s.clone(),
            bridged: outcome.bridged.clone(),
        }
    }

    /// Puts the striker against bead 1 with a speed in m/s, as at the start of
    /// a tap or a shot; a chain without a striker stays as it is.
    pub fn strike(&mut self, system: &System, speed_m_s: f64) {
        if !system.has_striker {
            return;
        }
        if let [striker, bead, ..] = &mut self.displacement_m[..] {
            *striker = *bead - system.rest_overlap_m(0);
        }
        if let Some(velocity) = self.velocity_m_s.first_mut() {
            *velocity = speed_m_s;
        }
        if let Some(bridged) = self.bridged.first_mut() {
            *bridged = false;
        }
    }

    /// Overlap of a contact in m, negative across a gap, −∞ where no contact is.
    pub fn overlap_m(&self, system: &System, contact: usize) -> f64 {
        let place = |body: usize| self.displacement_m.get(body).copied().unwrap_or(0.0);
        system.rest_overlap_m(contact) - (place(contact + 1) - place(contact))
    }

    /// Whether nothing but the striker moves.
    pub fn rests(&self) -> bool {
        self.velocity_m_s.iter().skip(1).all(|&v| v == 0.0)
    }

    /// The first body whose place or speed is no number.
    pub(crate) fn first_not_finite(&self) -> Option<usize> {
        let bodies = self.displacement_m.iter().zip(&self.velocity_m_s);
        let mut bodies = bodies.map(|(x, v)| x.is_finite() && v.is_finite());
        bodies.position(|finite| !finite)
    }
}
