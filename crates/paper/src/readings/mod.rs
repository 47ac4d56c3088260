//! The claims when the paper is read otherwise, or its constants are rounded otherwise.

mod report;
pub(crate) mod rounding;
mod scan;

pub(crate) use self::{
    rounding::DryPoisson,
    scan::{ReadingRow, scan},
};
pub(crate) use report::{FLIPPED, scan_csv, scan_markdown, two_digits_markdown};
pub(crate) use rounding::rounded_evidence;
pub use scan::ReadingScan;
