//! The paper's statements on its rig, compared with virtual ones.
//!
//! The paper does not say how its beads rub, how they are laid, how unlike they are, nor how its
//! spring presses; so a [`RigDesign`] of rigs is tried. Each runs campaigns with taps and without,
//! and claims, rows of a data file, are evaluated on all rigs together and on each alone.

mod design;
mod evidence;
mod predicates;
mod report;

pub use self::{
    design::RigDesign,
    evidence::observe,
    report::{MEANING, RigClaims, series_csv},
};
pub(crate) use self::{
    design::{FACTORS, TriedRig},
    evidence::{Observed, RigEvidence, SpeedSeries, mean, rebound_m_s, spread_s, typical},
};

use crate::claims::{ClaimError, Evaluator, read};

static PAPER: &str = include_str!("../../data/rig_claims.toml");

/// What the paper says of its rig, in the order of the data file.
pub(crate) fn claims() -> Result<Vec<Evaluator<RigEvidence>>, ClaimError> {
    read(PAPER, predicates::find)
}
