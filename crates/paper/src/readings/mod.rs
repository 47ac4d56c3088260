//! The claims when the paper is read otherwise, or its constants are rounded otherwise.

mod report;
mod rounding;
mod scan;

pub use self::{
    rounding::{Draw, DryPoisson},
    scan::{ReadingRow, ReadingScan, scan},
};
pub(crate) use report::{FLIPPED, scan_csv, scan_markdown, two_digits_markdown};
pub(crate) use rounding::rounded_evidence;
