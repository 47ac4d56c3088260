//! The paper's statements, and its rig's.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_sim::rig;

mod claims;
#[path = "../../figures/tests/covered/mod.rs"]
mod covered;
mod figures;
mod rebound;
mod reproduce;
mod rig_claims;
mod rig_claims_figures;
mod rig_figure;
#[allow(dead_code, reason = "the rig's own tests use all of it")]
#[path = "../../sim/tests/rig/small.rs"]
mod small;
#[path = "../../figures/tests/type_size/mod.rs"]
mod type_size;

use crate::reproduce::ReproduceProgress;

/// Reports nothing.
pub(crate) struct Silent;

impl ReproduceProgress for Silent {
    fn begin(&self, _stage: &str, _steps: u64) {}
    fn advance(&self) {}
}
