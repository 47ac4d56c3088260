//! Everything in the paper, computed anew.

mod cases;
mod closing;
mod error;
mod films;
mod gather;
mod memory;
mod point;
mod progress;
mod provenance;
mod reproduction;
mod speeds;
mod stale_files;
mod tables;

pub use cases::{CASES, Cases, OILS};
pub use error::ReproduceError;
pub(crate) use error::failed;
pub use films::{FILM_SHOTS, Film, SIGNAL_SHOTS, SignalShot, films, signals};
pub use gather::{Change, Effort, Gathering, gather, gather_remembering};
pub use memory::Memory;
pub use progress::{Progress, Silent};
pub use provenance::{PROVENANCE, Provenance};
pub use reproduction::{Options, Reproduction, reproduce};
pub use speeds::SPEEDS_M_S;
pub use stale_files::remove_stale_files;
pub use tables::{oils_csv, power_law_residuals_csv, power_laws_csv, ratios_csv, tof_csv};
