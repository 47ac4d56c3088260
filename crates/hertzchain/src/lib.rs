//! What the verbs do, for every front: options in words, results as plain data,
//! mistakes as reports. A front prints, draws and keeps files; nothing here
//! knows a terminal.

pub mod bibliography;
pub mod csv;
pub mod design;
pub mod failure;
pub mod fit;
pub mod gauge;
pub mod inference;
pub mod input;
pub mod json;
pub mod laws;
pub mod measure;
pub mod missing;
pub mod options;
pub mod quantity;
pub mod table;

pub use failure::Failure;
pub use fit::fit;

/// What most programs need, by one `use`.
pub mod prelude {
    pub use crate::fit::{Fitted, fit};
    pub use crate::options::{FitOptions, MeasureOptions, from_json};
    pub use crate::{Failure, inference};
    pub use hertzchain_experiment::{Experiment, preset};
    pub use hertzchain_infer::Data;
}
