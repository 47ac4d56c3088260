//! Everything in the paper, computed anew.

mod cases;
mod films;
mod gather;
mod point;
mod provenance;
mod reproduction;
pub(crate) mod tables;

pub use self::{
    cases::{CASES, ReproduceError},
    provenance::{PROVENANCE, ReproduceProgress, remove_stale_files},
    reproduction::{ReproduceOptions, Reproduction, reproduce},
};
pub(crate) use self::{
    cases::{Cases, OILS, SPEEDS_M_S, failed},
    films::{Film, SignalShot},
    gather::{Effort, Gathering, ShotCache, gather, plan},
    point::read_off,
    provenance::Provenance,
};
