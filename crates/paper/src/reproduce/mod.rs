//! Everything in the paper, computed anew.

mod cases;
mod films;
mod gather;
mod point;
mod provenance;
mod reproduction;
mod tables;

pub(crate) use cases::OILS;
pub use cases::{CASES, Cases, ReproduceError, SPEEDS_M_S};
pub(crate) use films::{Film, SignalShot};
pub use gather::{Effort, Gathering, gather};
pub(crate) use gather::{ShotCache, gather_cached};
pub use provenance::{PROVENANCE, Progress, Provenance, Silent, remove_stale_files};
pub use reproduction::{ReproduceOptions, Reproduction, reproduce};
pub use tables::{oils_csv, tof_csv};
