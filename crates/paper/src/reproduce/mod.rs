//! Everything in the paper, computed anew.

mod cases;
mod films;
mod gather;
mod point;
mod provenance;
mod reproduction;
mod tables;

pub use self::{
    provenance::{PROVENANCE, Provenance, ReproduceProgress, Silent, remove_stale_files},
    reproduction::{ReproduceOptions, Reproduction, reproduce},
    tables::{oils_csv, tof_csv},
};
pub(crate) use cases::OILS;
pub use cases::{CASES, Cases, ReproduceError, SPEEDS_M_S};
pub(crate) use films::{Film, SignalShot};
pub use gather::{Effort, Gathering, gather};
pub(crate) use gather::{ShotCache, gather_cached};
