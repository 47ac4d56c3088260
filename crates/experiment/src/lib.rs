//! The experiment file: TOML with units, presets and readings; it becomes
//! chains and shots.
//!
//! ```
//! use hertzchain_experiment::preset;
//!
//! let dry = preset("dry")?;
//! let (chain, warnings) = dry.chain(Some(0.5))?;
//! assert_eq!(chain.beads.len(), 40);
//! assert!(warnings.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod apply;
mod assemble;
mod check;
mod document;
mod experiment;
mod finding;
mod keys;
mod laws;
mod locate;
mod motion_file;
mod nearest;
mod paths;
mod presets;
mod schema;
mod spec;
mod value;
mod view;

pub mod reading;
pub mod units;

pub use experiment::{Experiment, OpenError};
pub use finding::{Finding, Mistakes, Source, Warning};
pub use laws::LawSpec;
pub use paths::{Named, PathError};
pub use presets::{Preset, UnknownPreset, examples, preset, presets};
pub use reading::{Pick, Reading, Switch, SwitchError};
pub use schema::schema;
pub use spec::{Liquid, Method, SectionSpec, Solver};
pub use value::Units;
