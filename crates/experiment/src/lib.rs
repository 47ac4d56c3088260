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

mod assemble;
mod bodies;
mod check;
mod contacts;
mod document;
mod experiment;
mod keys;
mod paths;
mod report;
mod rig;
mod schema;
mod settings;
mod spec;
mod validity;
mod values;

pub mod reading;
pub mod units;

pub use self::{
    assemble::Reference,
    contacts::{LawSpec, SectionSpec},
    experiment::{
        Experiment, OpenError, Preset, campaigns, examples, film_presets, preset, presets,
    },
    paths::{NamedNumber, PathError},
    reading::{Pick, Reading, Switch},
    report::{Finding, Mistakes, UnknownName, Warning},
    rig::{
        Actuator, Amplifier, Campaign, Channels, Laying, LowPass, LowPassFactor, LowPassKind,
        Photogate, Recorder, Rig, RigPart, RigPartKind, Trigger,
    },
    schema::schema,
    settings::{Liquid, Method, Solver},
    validity::longest_duration_s,
    values::Units,
};

#[cfg(test)]
#[path = "../tests/all.rs"]
mod tests;
