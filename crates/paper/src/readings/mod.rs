//! What becomes of the claims when the paper is read otherwise, or its
//! constants are rounded otherwise.

mod draws;
mod report;
mod rounding;
mod scan;
mod sharpened;

pub use draws::rounded_evidence;
pub use report::{FLIPPED, scan_csv, scan_markdown, two_digits_markdown};
pub use rounding::{Draw, DryPoisson, Prefactors};
pub use scan::{Factor, Price, Row, Scan, scan};
