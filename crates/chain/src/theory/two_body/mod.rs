//! Two bodies that meet: contact time, largest overlap and force, restitution.
//!
//! Reduced mass m = m1 m2 / (m1 + m2) (a wall is an infinite mass), force law
//! F = k δⁿ, relative speed v at first touch. The elastic collision is closed
//! form; the viscoelastic one is a series and an integration to rounding.

mod elastic;
mod restitution;
mod stepper;

pub use self::{
    elastic::{ElasticCollision, reduced_mass_kg},
    restitution::{
        ContactEnd, TwoBodyRebound, ViscoelasticCollision, rebound, restitution_by_series,
        restitution_coefficients,
    },
};
