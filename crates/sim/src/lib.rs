//! What is done with chains: shots, sweeps over speed, shards, descriptions, and a virtual
//! rig with its campaigns.
//!
//! A [`Plan`] says which chain, watched where, how accurately; [`shoot`] runs
//! it and returns a [`Shot`]: times of flight, peaks, rebound, energy budget.
//!
//! ```
//! use hertzchain_sim::{Plan, shoot};
//!
//! let dry = hertzchain_experiment::preset("dry")?;
//! let (plan, _warnings) = Plan::from_experiment(&dry, Some(0.5))?;
//! let shot = shoot(&plan)?;
//! let flight = shot.flight.expect("the pulse reaches the wall");
//! assert!(flight.reflected_s.unwrap() > flight.incident_s);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod rig;
pub mod shards;

pub mod accuracy;
mod commit;
mod describe;
mod duration;
mod ensemble;
mod error;
mod fingerprint;
mod flight;
mod following;
mod gun;
mod long_work;
mod other_picks;
mod plan;
mod rows;
mod run;
mod several;
mod shard;
mod shot;
mod speeds;
mod stop;
mod sweep;
mod tuned;

pub use commit::commit;
pub use describe::{Group, Row, Value, describe, describe_theory, dimensionless_unit};
pub use ensemble::{JUDGES, shoot_all, shoot_tuned, shoot_unjudged};
pub use error::StudyError;
pub use fingerprint::{Fingerprint, Inputs, NoFingerprint};
pub use flight::Flight;
pub use hertzchain_chain::InstructionSet;
pub use long_work::Expected;
pub use plan::{Pick, Plan, Solver, Watch};
pub use rows::{COLUMNS, Column, Failed, Law, Odd, Rows};
pub use run::{How, Part, Run, RunError};
pub use several::{parted, piece};
pub use shard::{Shard, ShardError};
pub use shot::{OF_PEAKS, Rebound, Shot, shoot, shoot_checked, shoot_estimated};
pub use speeds::{MOST_SPEEDS, SpeedError, parse_speed, parse_speeds, parse_time};
pub use stop::{Stop, count_done, note_progress, stopped};
pub use sweep::{Judges, Point, PointError, Settings, Sweep, sweep, sweep_each};
pub use tuned::{PILOTS, Tuned};

/// The README's example, compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
pub struct Readme;
