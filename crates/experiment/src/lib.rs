//! The experiment file: TOML with units, presets and readings; it becomes
//! chains and shots.
//!
//! ```
//! use hertzchain_experiment::Experiment;
//!
//! let experiment = Experiment::from_text("my-chain.toml", r#"
//!     [materials.steel]
//!     young_modulus = "200 GPa"
//!     poisson_ratio = 0.3
//!     density = "7.8 g/cm^3"
//!
//!     [striker]
//!     speed = "0.5 m/s"
//!
//!     [[beads]]
//!     count = 20
//!     radius = "5 mm"
//!     material = "steel"
//!
//!     [[contacts]]
//!     laws = ["elastic_hertz"]
//! "#)?;
//! let (chain, warnings) = experiment.chain(Some(1.2))?; // at 1.2 m/s instead
//! assert_eq!(chain.beads.len(), 20);
//! assert_eq!(chain.beads[0].radius_m, 0.005);
//! assert!(warnings.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - [`Experiment`] is a file that has been read and checked. What is wrong is
//!   reported as [`Mistakes`], each with its line and what was expected.
//! - [`preset`] gives the files that come with the program.
//! - [`Reading`] is one choice of what the paper leaves open;
//!   [`Experiment::with_reading`] applies it.
//! - [`Experiment::set`] changes named numbers, for sweeps and fits;
//!   [`Experiment::numbers`] lists them.
//! - [`schema`] describes the file for editors.
//!
//! The keys of a file are declared once, in tables; reading, messages, paths
//! and schema follow from them, and contact laws from the registry of
//! `hertzchain_chain`.

mod apply;
mod assemble;
mod check;
mod document;
mod effort;
mod experiment;
mod file;
mod finding;
mod keys;
mod known;
mod laws;
mod locate;
mod meeting;
mod motion_file;
mod nearest;
mod paths;
mod presets;
mod reference;
mod schema;
mod spec;
mod syntax;
mod understood;
mod validity;
mod value;
mod view;

pub mod reading;
pub mod units;

pub use effort::longest_duration_s;
pub use experiment::{Experiment, OpenError};
pub use finding::{Finding, Mistakes, Source, Warning};
pub use laws::LawSpec;
pub use paths::{Named, PathError, Place};
pub use presets::{Preset, UnknownPreset, campaigns, examples, preset, presets};
pub use reading::{Pick, Reading, Switch, SwitchError};
pub use reference::Reference;
pub use schema::schema;
pub use spec::{
    Actuator, Amplifier, Campaign, Channels, Factor, KINDS, Laying, Liquid, LowPass, LowPassKind,
    Method, ORDERS, Photogate, Recorder, Rig, RigPart, RigPartKind, SectionSpec, Solver, Trigger,
};
pub use value::Units;
