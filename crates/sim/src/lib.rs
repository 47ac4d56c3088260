//! Shots, batches of shots and their shards, descriptions of chains, and a virtual rig with
//! its campaigns.
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

pub mod accuracy;
pub mod rig;

mod batch;
mod calibration;
mod describe;
mod duration;
mod engine;
mod error;
mod fingerprint;
mod long_work;
mod other_picks;
mod plan;
mod prepared;
mod result;
mod shard;
mod shot;
mod similar;
mod speeds;
mod stop;
mod tracker;

pub use self::{
    batch::{Batch, BatchOptions, BatchResult, BatchShot, ErrorControl},
    calibration::Calibration,
    describe::{Group, Row, Value, describe, describe_theory, dimensionless_unit},
    engine::{Control, LONGER_STEPS, run_plans},
    error::StudyError,
    fingerprint::{Fingerprint, commit},
    long_work::Expected,
    plan::{Plan, PreparedChain, Watch},
    result::{COLUMNS, Column, Failed, Rows, WarningSummary},
    shard::{Shard, StoredShard},
    shot::{Flight, OF_PEAKS, Rebound, Shot, shoot, shoot_checked, shoot_estimated},
    speeds::{parse_speed, parse_speeds, parse_time},
    stop::{Stop, count_done, note_progress, pool, stopped},
};
pub use hertzchain_chain::InstructionSet;
pub use hertzchain_experiment::{Method, Pick};
