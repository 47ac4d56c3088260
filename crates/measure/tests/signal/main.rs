//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod bandwidth;
mod calibration;
mod clipping;
mod common;
mod competing;
mod crosstalk;
mod drift;
mod droop;
#[path = "common/dry.rs"]
mod dry;
mod faint;
mod finding;
mod nonsense;
mod picking;
mod power_law;
mod quiet;
mod reduction;
mod returns;
mod shared;
#[path = "common/source.rs"]
mod source;
mod spikes;
mod tones;
mod zero_phase;
