//! What the rest of a shot cannot do, by energy alone.

use super::dense::Piece;
use crate::laws::Closed;

impl Piece<'_> {
    /// Energy in J that all bodies but body 0 have and that all contacts hold:
    /// Σ m v²/2 + Σ U(δ). `None` where more than that can move them (loads, a
    /// push, threads, a driven end) or where laws remember.
    pub fn energy_beyond_striker_j(&self, theta: f64) -> Option<f64> {
        let system = self.system;
        if !system.flies_free() || system.has_memory || system.has_states {
            return None;
        }
        let kinetic = |body: usize| {
            let mass = system.mass_kg[body];
            let speed = self.body(body, theta).1;
            if mass.is_finite() { 0.5 * mass * speed * speed } else { 0.0 }
        };
        let stored = |contact: usize| match self.overlap(contact, theta).0 {
            overlap if overlap > 0.0 => system.stored_energy(contact, overlap),
            _ => 0.0,
        };
        let moving: f64 = (1..system.bodies()).map(kinetic).sum();
        let held: f64 = (0..system.contacts()).map(stored).sum();
        Some(moving + held)
    }

    /// Kinetic energy of body 0 in J while it flies away from the chain and no bridge holds it, else 0.
    pub fn leaving_energy_j(&self, theta: f64) -> f64 {
        let speed = self.body(0, theta).1;
        let free = self.overlap(0, theta).0 < 0.0 && !self.state.is_bridged(0);
        match free && speed < 0.0 {
            true => 0.5 * self.system.mass_kg[0] * speed * speed,
            false => 0.0,
        }
    }

    /// A force in N that a contact cannot exceed when all bodies together have
    /// no more than an energy: all of it as overlap, and all of it as approach.
    pub fn most_force_n(&self, contact: usize, energy_j: f64) -> f64 {
        let system = self.system;
        let mut overlap = 1.0;
        while system.stored_energy(contact, overlap) > energy_j && overlap > 1e-30 {
            overlap *= 0.5;
        }
        while system.stored_energy(contact, overlap) < energy_j && overlap < 1e30 {
            overlap *= 1.25;
        }
        let lightest = [contact, contact + 1]
            .map(|body| system.mass_kg[body])
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        // Two bodies with all the energy approach at most twice as fast as one.
        let rate = 2.0 * (2.0 * energy_j / lightest).sqrt();
        system.unclipped_force(contact, Closed::new(overlap, rate))
    }
}
