//! From records of a rig, real or virtual, to times of flight with errors.
//!
//! [`measure`] reads recordings record by record and picks their pulses;
//! [`Curves::of`] reduces the shots to means a speed, ratios of wet to dry chains
//! and power laws. [`ShotList`] gives shots the speeds that their files lack.
//! Nothing here knows of chains: how many beads there are and where the sensor
//! sits are plain numbers in [`signal::FindOptions`].
#![doc = include_str!("../README.md")]

pub mod records;
pub mod signal;

mod ambiguous;
mod correlation;
mod curves;
mod error;
mod level;
mod list;
mod run;
mod separation;
mod shot;
mod table;

pub use self::{
    ambiguous::resolve_ambiguous,
    curves::{Case, Curves, Grouping, Laws, SpeedRow, UnmeasuredSpeed, WetOverDry},
    error::MeasureError,
    level::{Level, shots_at_level},
    list::ShotList,
    run::{Cut, Measurement, Note, Options, Watch, measure, measure_records},
    shot::{Example, Shot},
    table::{laws_csv, ratios_csv, shots_csv, speeds_csv, write_shots},
};

#[cfg(test)]
#[path = "../tests/signal/main.rs"]
mod tests;
