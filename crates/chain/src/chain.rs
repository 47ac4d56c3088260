//! A chain as a physicist describes it: beads, contacts, ends.

use crate::laws::{Law, LawError};
use crate::material::Material;
use crate::motion::Motion;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// One ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bead {
    /// Radius in m.
    pub radius_m: f64,
    /// Mass in kg.
    pub mass_kg: f64,
    /// What it is made of.
    pub material: Material,
}

/// What sets the chain in motion at its near end.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// Body 0 is a striker that touches bead 1 at t = 0 with this speed.
    Striker {
        /// The striker.
        bead: Bead,
        /// Its speed toward the wall in m/s.
        speed_m_s: f64,
    },
    /// Body 0 follows a prescribed motion and carries the preload.
    Driven {
        /// Shape and material of the driven body; its mass plays no part.
        bead: Bead,
        /// Its position against time.
        motion: Motion,
    },
    /// Nothing at the near end: initial velocities and displacements start the shot.
    Free,
}

/// Initial deviation of one bead from rest at static equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Initial {
    /// Bead, 1..=N.
    pub bead: usize,
    /// Displacement in m.
    pub displacement_m: f64,
    /// Velocity in m/s.
    pub velocity_m_s: f64,
}

/// What pushes bead 1 toward the wall throughout the shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Push {
    /// Nothing.
    None,
    /// A constant force.
    Constant {
        /// Force in N.
        force_n: f64,
    },
    /// A spring that never pulls: F = max(0, force − stiffness · x_1).
    Spring {
        /// Force at rest in N.
        force_n: f64,
        /// Stiffness in N/m.
        stiffness_n_m: f64,
    },
}

impl Push {
    /// Force at rest in N.
    pub fn force_n(&self) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Constant { force_n } | Self::Spring { force_n, .. } => force_n,
        }
    }
}

/// What bead N leans on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FarEnd {
    /// A half-bead fixed to a stop that does not move.
    HalfBead {
        /// Its radius in m.
        radius_m: f64,
        /// What it is made of.
        material: Material,
    },
    /// The plane face of an elastic half-space.
    Plane {
        /// What it is made of.
        material: Material,
    },
    /// A half-bead on a stop of finite mass, held at rest by a constant force
    /// equal and opposite to its static load.
    Stop {
        /// Radius of the half-bead in m.
        radius_m: f64,
        /// What it is made of.
        material: Material,
        /// Mass of the stop in kg.
        mass_kg: f64,
    },
    /// A plane face on a stop of finite mass.
    PlaneStop {
        /// What it is made of.
        material: Material,
        /// Mass of the stop in kg.
        mass_kg: f64,
    },
    /// Bead 1 again: a ring.
    Periodic {
        /// Static contact force all around the ring in N.
        force_n: f64,
    },
    /// Nothing.
    Free,
}

/// Whether a closed contact may pull.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Tension {
    /// The total force may be negative until the overlap is back at 0.
    #[default]
    Allowed,
    /// The total force is cut at 0.
    Clipped,
}

/// Consecutive contacts that share their laws.
#[derive(Clone, Debug)]
pub struct Section {
    /// Contacts, 0..=N.
    pub contacts: RangeInclusive<usize>,
    /// Terms whose sum is the force.
    pub laws: Vec<Arc<dyn Law>>,
    /// Effective material of both sides, in place of the beads' own.
    pub material: Option<Material>,
}

/// An initial gap in an unloaded contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Contact, 0..=N.
    pub contact: usize,
    /// Gap in m; a contact with load closes it before the shot.
    pub gap_m: f64,
}

/// A row of beads with all that acts on it.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Beads 1..=N.
    pub beads: Vec<Bead>,
    /// What sets it in motion.
    pub start: Start,
    /// Initial deviations of beads from rest.
    pub initial: Vec<Initial>,
    /// Push on bead 1.
    pub push: Push,
    /// What bead N leans on.
    pub far: FarEnd,
    /// Laws of contacts 0..=N.
    pub sections: Vec<Section>,
    /// Initial gaps; 0 elsewhere.
    pub gaps: Vec<Gap>,
    /// Incline in rad, the wall below: 0 horizontal, π/2 vertical.
    pub incline_rad: f64,
    /// Gravity in m/s².
    pub gravity_m_s2: f64,
    /// Length in m of the threads on which beads hang (a cradle); `None` on a track.
    pub suspension_m: Option<f64>,
    /// Whether contacts may pull.
    pub tension: Tension,
}

/// Standard gravity in m/s².
pub const STANDARD_GRAVITY_M_S2: f64 = 9.80665;

/// Why a chain can't be set up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainError {
    /// A number that must be positive, or finite, is not.
    #[error("{what} = {value} must be {expected}")]
    Value {
        /// Which quantity, where.
        what: String,
        /// What it is.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// The chain's parts do not fit together.
    #[error("{0}")]
    Layout(String),
    /// A law can't be used on a contact.
    #[error("contact {contact}: {error}")]
    Law {
        /// Contact.
        contact: usize,
        /// Why.
        error: LawError,
    },
    /// No static equilibrium exists.
    #[error("no static equilibrium: {0}")]
    Equilibrium(String),
    /// A theory's number was not found to its accuracy.
    #[error("{0}")]
    NotConverged(String),
}
