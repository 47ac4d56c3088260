//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod batches;
mod choices;
mod common;
mod curve;
mod data;
mod film;
mod free;
mod gauge;
mod goodness;
mod joint;
mod linear;
mod mistakes;
mod nonlinear;
mod peers;
mod posterior;
mod pulses;
mod reference;
mod robust;
mod round_trip;
mod shots;
mod surrogate;
mod systematic;
mod toys;
