//! From shots to curves: groups of one speed, ratios, lines with errors in both
//! coordinates, and how far stated errors can be believed.

mod chi_square;
mod coverage;
mod groups;
mod ratios;
mod shared;
mod summary;
mod york;

pub use chi_square::{ChiSquare, chi_square};
pub use coverage::{Coverage, coverage};
pub use groups::groups;
pub use ratios::{Point, Ratio, ratios_at_common};
pub use shared::{alone, shared};
pub use summary::{Summary, summary};
pub(crate) use york::{Points, all_equal};
