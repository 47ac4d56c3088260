//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod clipping;
mod common;
mod cutting;
mod droop;
mod finding;
mod nonsense;
mod picking;
mod power_law;
mod reduction;
mod shared;
mod zero_phase;
