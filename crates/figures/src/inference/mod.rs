//! Pictures of what fits leave uncertain: posteriors, profiles, singular values.

mod contour;
mod corner;
mod profiles;
mod smooth;
mod values;

pub use corner::Corner;
pub use profiles::{ProfileCurve, profile_figure};
pub use values::SingularValues;
