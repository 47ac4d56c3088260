//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod accuracy;
mod arrivals;
mod calibrated;
mod describe;
mod ensemble;
mod examples;
mod long_chains;
mod runs;
mod shot;
mod sweep;

/// The paper's chains.
const CASES: [&str; 6] = ["hertz", "hertz-viscoelastic", "dry", "pump", "gear", "motor"];
