//! A virtual rig: a striker on an actuator, taps, a photogate, two piezo discs
//! on one amplifier, a converter; and campaigns that a machine runs alone.
//!
//! Every sample comes from a motion that was integrated from the state which
//! the impact before has left. Random are the gaps and sizes of beads as a chain
//! is assembled, the striker's speed and place, the photogate's error, the phase
//! of the sampling clock and the noise; each from a seed, in streams of their own
//! for every shot, so that results depend on neither threads nor order.
//!
//! ```no_run
//! use hertzchain_sim::Shard;
//! use hertzchain_sim::rig::{Plan, campaign};
//! use std::path::Path;
//!
//! let paper = hertzchain_experiment::preset("paper")?;
//! let plan = Plan::new(&paper, None)?;
//! campaign(&plan, Path::new("records"), Shard::WHOLE, &|_| {})?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod campaign;
mod error;
mod forecast;
mod instruments;
mod plan;
mod recorder;
mod shot;

pub use self::{
    campaign::{CAMPAIGN_FILE, Done, Merged, Progress, campaign, merge, plan_of_folder},
    error::RigError,
    forecast::forecast,
    instruments::{Amplifier, Purpose, RandomStream},
    plan::{Case, Plan, Series},
    recorder::Record,
    shot::{MeasuredShot, Shot, run_series},
};

#[cfg(test)]
#[path = "../../tests/rig/main.rs"]
mod tests;
