//! Rows of beads and their solitary waves: predict, measure, infer.
//!
//! What the program `hertzchain` does, from memory: [`measure()`] turns recordings into times of flight,
//! [`fit()`] turns these into parameters of an experiment. Options of each verb are one struct in
//! [`options`]; mistakes are [`Failure`]s that print as reports.
//!
//! ```
//! use hertzchain::prelude::*;
//!
//! // The paper's dry row; `Experiment::open("row.toml")` reads your own.
//! let row = preset("dry")?;
//!
//! // Predict: one shot at 0.5 m/s.
//! let (plan, _warnings) = Plan::from_experiment(&row, Some(0.5))?;
//! let shot = shoot(&plan)?;
//! let incident_s = shot.flight.expect("the pulse reaches the wall").incident_s;
//! assert!((1e6 * incident_s - 756.0).abs() < 20.0);
//!
//! // Infer: which viscosity gives this time?
//! let table = format!(
//!     "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n0.5,1e-4,{incident_s},2e-7\n"
//! );
//! let options = FitOptions::free(["eta"]);
//! let data = inference::parsed("one shot", &table, &options.measured, None)?;
//! let found = fit(&data, &row, &options)?;
//! assert!((found.inferred.fit.point[0] / 3.2e4 - 1.0).abs() < 1e-2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bibliography;
mod contact;
pub mod csv;
pub mod design;
#[cfg(feature = "explore")]
pub mod explorer;
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
#[cfg(not(target_family = "wasm"))]
pub mod program;
pub mod quantity;
pub mod table;

pub use failure::Failure;
pub use fit::fit;
pub use measure::measure;

/// The page's examples, compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/how-to/use-from-rust.md")]
pub struct UseFromRust;

/// What most programs need, by one `use`.
pub mod prelude {
    pub use crate::fit::{FitResult, fit};
    pub use crate::measure::{MeasureResult, measure};
    pub use crate::options::{FitOptions, MeasureOptions, from_json};
    pub use crate::{Failure, inference};
    pub use hertzchain_experiment::{Experiment, preset};
    pub use hertzchain_infer::Data;
    pub use hertzchain_sim::{Plan, shoot};
}
