//! Best fits by nonlinear least squares.

mod descent;
mod drive;
mod ending;
mod error;
mod fit;
mod jacobian;
mod loss;
mod merit;
mod slopes;
mod starts;

pub use descent::Ending;
pub use error::FitError;
pub use fit::{Binding, Fit, Fitting, Started, fit};
pub use jacobian::Jacobian;
pub use loss::Loss;

pub(crate) use descent::Descent;
pub(crate) use drive::drive;
pub(crate) use fit::check;
pub(crate) use jacobian::{EXTRAPOLATED, JUMPING, ROUNDING, jacobian_at};
pub(crate) use merit::Merit;
pub(crate) use slopes::Slopes;
