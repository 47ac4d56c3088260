//! Everything in the paper, computed anew.

mod error;
mod files;
mod films;
mod gather;
mod memory;
mod progress;
mod provenance;
mod reproduction;
mod speeds;
mod tables;

pub use error::ReproduceError;
pub use files::write_atomically;
pub use films::{FILM_SHOTS, Film, SIGNAL_SHOTS, SignalShot, films, signals};
pub use gather::{CASES, Cases, Change, Gathering, HELD, OILS, gather, gather_remembering};
pub use memory::Memory;
pub use progress::{Progress, Silent};
pub use provenance::Provenance;
pub(crate) use reproduction::SCAN_ACCURACY;
pub use reproduction::{Options, Reproduction, reproduce};
pub use speeds::{SCAN_SPEEDS_M_S, SPEEDS_M_S};
pub use tables::{oils_csv, power_law_residuals_csv, power_laws_csv, ratios_csv, tof_csv};
