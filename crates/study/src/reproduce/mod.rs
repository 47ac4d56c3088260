//! Everything in the paper, computed anew.

mod cases;
mod closing;
mod error;
mod files;
mod films;
mod gather;
mod leftovers;
mod memory;
mod point;
mod progress;
mod provenance;
mod reproduction;
mod speeds;
mod tables;

pub use cases::{CASES, Cases, OILS};
pub use error::ReproduceError;
pub(crate) use error::failed;
pub use files::write_atomically;
pub use films::{FILM_SHOTS, Film, SIGNAL_SHOTS, SignalShot, films, signals};
pub use gather::{Change, Effort, Gathering, gather, gather_remembering};
pub use memory::Memory;
pub use progress::{Progress, Silent};
pub use provenance::{Provenance, commit};
pub use reproduction::{Options, Reproduction, reproduce};
pub use speeds::SPEEDS_M_S;
pub use tables::{oils_csv, power_law_residuals_csv, power_laws_csv, ratios_csv, tof_csv};
