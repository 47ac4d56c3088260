//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod balances;
mod bridge;
mod common;
mod convergence;
mod ensemble_accuracy;
mod ensemble_allocations;
mod ensemble_lanes;
mod ensemble_limits;
mod ensemble_openings;
mod ensemble_reference;
mod ensemble_sensors;
mod ensemble_sets;
mod ensemble_work;
mod film;
mod film_drained;
mod laws;
mod paper;
mod random_chains;
#[path = "common/row.rs"]
mod row;
mod settle;
mod settle_allocations;
mod settle_random;
mod settle_taps;
mod theory_linear;
mod theory_long_wave;
mod theory_solitary;
mod theory_striker;
mod theory_two_body;
mod traps;
mod window;
