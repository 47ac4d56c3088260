//! A virtual rig: a striker on an actuator, taps, a photogate, two piezo discs
//! on one amplifier, a converter; and campaigns that a machine runs alone.
//!
//! Every sample comes from a motion that was integrated from the state which
//! the impact before has left. Nothing that a rig measures is drawn from a
//! distribution: random are the gaps and sizes of beads as a chain is laid, the
//! striker's speed and place, the photogate's error, the phase of the sampling
//! clock and the noise; each from a seed, in streams of their own for every
//! shot, so that results depend on neither threads nor order.
//!
//! ```no_run
//! use hertzchain_sim::rig::{Plan, Shard, campaign};
//! use std::path::Path;
//!
//! let paper = hertzchain_experiment::preset("paper")?;
//! let plan = Plan::new(&paper, None)?;
//! campaign(&plan, Path::new("records"), Shard::WHOLE, &|_| {})?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod amplifier;
mod bench;
mod campaign;
mod chance;
mod converter;
mod error;
mod hold;
mod keep;
mod laying;
mod merge;
mod outlook;
mod photogate;
mod plan;
mod record;
mod recording;
mod series;
mod shot;
mod striker;
mod tape;

pub use crate::Shard;
pub use amplifier::Amplifier;
pub use bench::Bench;
pub use campaign::{Done, Progress, campaign};
pub use chance::{Chance, Purpose};
pub use converter::Converter;
pub use error::RigError;
pub use keep::{TOLD_IN, told_plan};
pub use merge::{Merged, merge};
pub use outlook::outlook;
pub use photogate::Passing;
pub use plan::{Case, Plan, Series};
pub use record::{Record, Window};
pub use recording::{Truth, truth};
pub use series::{Fired, run};
pub use shot::{Shot, shoot};
pub use striker::{OutOfRange, fired_m_s, misplaced_m, programmed};
pub use tape::Tape;
