//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

mod any_input;
mod campaign;
mod mistakes;
mod oils;
mod one_mistake;
mod paths;
mod presets;
mod readings;
mod rig;
mod schema;
mod starts;
mod stiffness;
mod units;
