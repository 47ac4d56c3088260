//! Everything in the paper, computed anew.

mod cases;
mod films;
mod gather;
mod point;
mod provenance;
mod reproduction;
pub(crate) mod tables;

pub use self::{
    cases::{CASES, Cases, ReproduceError},
    gather::{Effort, Gathering, gather},
    provenance::{PROVENANCE, ReproduceProgress, remove_stale_files},
    reproduction::{ReproduceOptions, Reproduction, reproduce},
};
pub(crate) use self::{
    cases::{OILS, SPEEDS_M_S},
    films::{Film, SignalShot},
    gather::{ShotCache, gather_cached},
    provenance::Provenance,
};
