//! The two bodies of every contact.

use crate::chain::{Bead, Chain, FarEnd, Start};
use crate::material::BeadPair;

/// Radius of a plane and mass of a body that does not move.
const ENDLESS: f64 = f64::INFINITY;

impl Chain {
    /// What a contact's laws know of its two bodies; `None` where one is missing.
    pub fn pair(&self, contact: usize) -> Option<BeadPair> {
        let (left, right) = (self.body(contact)?, self.body(contact + 1)?);
        let section = self.sections.iter().find(|section| section.contacts.contains(&contact));
        let material = section.and_then(|section| section.material);
        Some(BeadPair {
            left: material.unwrap_or(left.material),
            right: material.unwrap_or(right.material),
            radius_m: reduced(left.radius_m, right.radius_m),
            mass_kg: reduced(left.mass_kg, right.mass_kg),
        })
    }

    /// The shape, mass and material that body 0..=N+1 shows to its contacts.
    pub(super) fn body(&self, body: usize) -> Option<Bead> {
        match body {
            0 => self.near_body(),
            body if body == self.beads.len() + 1 => self.far_body(),
            body => self.beads.get(body - 1).copied(),
        }
    }

    fn near_body(&self) -> Option<Bead> {
        match self.start {
            Start::Striker { bead, .. } => Some(bead),
            Start::Driven { bead, .. } => Some(Bead { mass_kg: ENDLESS, ..bead }),
            Start::Free => None,
        }
    }

    fn far_body(&self) -> Option<Bead> {
        let (radius_m, mass_kg, material) = match self.far {
            FarEnd::HalfBead { radius_m, material } => (radius_m, ENDLESS, material),
            FarEnd::Plane { material } => (ENDLESS, ENDLESS, material),
            FarEnd::Stop { radius_m, material, mass_kg } => (radius_m, mass_kg, material),
            FarEnd::PlaneStop { material, mass_kg } => (ENDLESS, mass_kg, material),
            FarEnd::Periodic { .. } => return self.beads.first().copied(),
            FarEnd::Free => return None,
        };
        Some(Bead { radius_m, mass_kg, material })
    }
}

/// Product over sum, with the limit for an infinite partner.
fn reduced(left: f64, right: f64) -> f64 {
    match (left.is_infinite(), right.is_infinite()) {
        (true, _) => right,
        (_, true) => left,
        _ => left * right / (left + right),
    }
}
