//! The paper's statements, and its rig's.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod rebound;
mod reproduce;
mod rig_claims;
#[allow(dead_code, reason = "the rig's own tests use all of it")]
#[path = "../../sim/tests/rig/small.rs"]
mod small;
