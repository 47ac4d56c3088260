//! Everything in the paper, computed anew.

mod error;
mod gather;
mod speeds;

pub use error::ReproduceError;
pub use gather::{CASES, Cases, Change, Gathering, HELD, OILS, gather};
pub use speeds::{SCAN_SPEEDS_M_S, SPEEDS_M_S};
