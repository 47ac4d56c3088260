//! Options of the verbs that simulate.

use super::given::{some_speed, some_time};
use super::values::{from_text, some_shard, speeds};
use super::{Accuracy, Given, Threads};
use clap::Args;
use hertzchain_sim::Shard;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Which experiment.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct Input {
    /// Experiment file (TOML)
    #[arg(value_name = "FILE", conflicts_with = "preset")]
    #[serde(skip_serializing)]
    pub file: Option<PathBuf>,
    /// An experiment that comes with the program; `hertzchain presets` lists them
    #[arg(long, short, value_name = "NAME")]
    #[serde(skip_serializing)]
    pub preset: Option<String>,
}

/// How to compute, in place of what the experiment says.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct SimulationOptions {
    /// Relative accuracy of times of flight, such as 1e-6
    #[arg(long, short, value_name = "NUMBER")]
    pub accuracy: Option<Accuracy>,
    /// How the motion is computed
    #[arg(long, value_enum, value_name = "NAME")]
    pub solver: Option<Solver>,
    /// Step of a fixed-step solver, such as "1 us"; found by halving when absent; a plain number
    /// where the experiment is dimensionless
    #[arg(long, value_name = "TIME", value_parser = Given::time, allow_hyphen_values = true)]
    #[serde(deserialize_with = "some_time")]
    pub step: Option<Given>,
    /// Duration of a shot, such as "2 ms"; until the reflected pulse has passed when absent; a
    /// plain number where the experiment is dimensionless
    #[arg(long, value_name = "TIME", value_parser = Given::time, allow_hyphen_values = true)]
    #[serde(deserialize_with = "some_time")]
    pub duration: Option<Given>,
    /// Where a pulse is timed
    #[arg(long, value_enum, value_name = "NAME")]
    pub pick: Option<Pick>,
    /// Compare with tighter runs; without, `shot` estimates its error by looser ones
    #[arg(long)]
    pub check: bool,
}

names! {
    /// Solvers by name.
    Solver for hertzchain_sim::Method {
        /// Embedded pair with adaptive steps that end at contact changes
        Adaptive,
        /// Classical Runge–Kutta with fixed steps
        Rk4,
        /// Velocity Verlet with fixed steps
        Verlet,
    }
}

names! {
    /// Picks by name.
    Pick for hertzchain_sim::Pick {
        /// At its maximum
        Peak,
        /// At 10 % of the maximum on the rising flank
        #[value(name = "flank-10")]
        #[serde(rename = "flank-10")]
        Flank10,
        /// At 50 % of the maximum on the rising flank
        #[value(name = "flank-50")]
        #[serde(rename = "flank-50")]
        Flank50,
        /// By cross-correlation of the pulses
        CrossCorrelation,
    }
}

/// Options of `shot`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct ShotOptions {
    /// Which experiment.
    #[command(flatten)]
    #[serde(flatten)]
    pub input: Input,
    /// Speed of the striker, such as "0.5 m/s" or 0.5; a plain number is in m/s, or dimensionless
    /// where the experiment is
    #[arg(long, short, value_name = "SPEED", value_parser = Given::speed, allow_hyphen_values = true)]
    #[serde(deserialize_with = "some_speed")]
    pub speed: Option<Given>,
    /// How to compute.
    #[command(flatten)]
    #[serde(flatten)]
    pub how: SimulationOptions,
    /// Print JSON
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
    /// Write traces (CSV) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    #[serde(skip_serializing)]
    pub out: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    #[serde(skip_serializing)]
    pub force: bool,
    /// Also write positions, velocities and forces of all bodies as NPY
    #[arg(long, requires = "out")]
    #[serde(skip_serializing)]
    pub npy: bool,
    /// Write a moving picture of the shot as one HTML file, into --out or here
    #[arg(long)]
    #[serde(skip_serializing)]
    pub animate: bool,
}

names! {
    /// Ways to control the error of many shots
    ErrorControl for hertzchain_sim::ErrorControl {
        /// Every shot is compared with two more, with longer steps
        PerShot,
        /// Calibration shots, computed much more tightly, choose the cheapest steps for all shots, and
        /// each estimates its own error: ten times as fast. As per shot below 160 shots, and of rows that are not
        /// uniform
        Calibrated,
        /// By the step for the accuracy asked alone: every shot once, without a bound on its error
        None,
    }
}

impl ShotOptions {
    /// Returns options of a shot at a speed in m/s, or dimensionless where the experiment is.
    ///
    /// ```
    /// use hertzchain::prelude::*;
    /// assert_eq!(shot(&preset("dry")?, &ShotOptions::at(0.5))?.speed_m_s, Some(0.5));
    /// # Ok::<(), hertzchain::Failure>(())
    /// ```
    pub fn at(speed_m_s: f64) -> Self {
        Self { speed: Some(Given::plain(speed_m_s)), ..Self::default() }
    }
}

impl CheckOptions {
    /// Returns options of a description at a speed in m/s, or dimensionless where the experiment is.
    ///
    /// ```
    /// use hertzchain::prelude::*;
    /// assert!(check(&preset("dry")?, &CheckOptions::at(0.5)).is_ok());
    /// # Ok::<(), hertzchain::Failure>(())
    /// ```
    pub fn at(speed_m_s: f64) -> Self {
        Self { speed: Some(Given::plain(speed_m_s)), ..Self::default() }
    }
}

/// Options of `sweep`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct SweepOptions {
    /// Which experiment.
    #[command(flatten)]
    #[serde(flatten)]
    pub input: Input,
    /// Speeds in m/s, or dimensionless where the experiment is: 0.1,0.2,0.5 or FROM:TO:COUNT or
    /// log:FROM:TO:COUNT
    #[arg(
        long,
        value_name = "SPEEDS",
        default_value = "log:0.075:1.23:25",
        allow_hyphen_values = true
    )]
    #[serde(deserialize_with = "speeds")]
    pub speeds: String,
    /// How to compute.
    #[command(flatten)]
    #[serde(flatten)]
    pub how: SimulationOptions,
    /// Print JSON; without an energy budget, which only `shot` keeps
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
    /// Write the table (CSV) and a figure (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    #[serde(skip_serializing)]
    pub out: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    #[serde(skip_serializing)]
    pub force: bool,
    /// Only the i-th of n parts, for several machines, as one file in --out, unless it is there;
    /// `hertzchain merge` puts them together
    #[arg(long, value_name = "i/n", requires = "out", conflicts_with = "json")]
    #[serde(skip_serializing, deserialize_with = "some_shard")]
    pub shard: Option<Shard>,
    /// Follow the striker until it is away for good and give its velocity; takes the slower loop
    #[arg(long)]
    pub rebound: bool,
    /// How the error of times of flight is controlled
    #[arg(long, value_enum, value_name = "NAME", default_value = "calibrated")]
    pub error_control: ErrorControl,
    /// Threads; all cores when absent
    #[arg(long, value_name = "COUNT", allow_hyphen_values = true)]
    #[serde(skip_serializing)]
    pub threads: Option<Threads>,
}

/// Options of `campaign`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct CampaignOptions {
    /// Which experiment.
    #[command(flatten)]
    #[serde(flatten)]
    pub input: Input,
    /// Folder to write recordings into; the same folder again goes on where a run was broken off
    #[arg(long, short, value_name = "DIR", default_value = "campaign")]
    #[serde(skip_serializing)]
    pub out: PathBuf,
    /// Only the i-th of n parts, for several machines: series are dealt out like cards
    #[arg(long, value_name = "i/n", default_value = "1/1")]
    #[serde(skip_serializing, deserialize_with = "from_text")]
    pub shard: Shard,
    /// Seed of all that is random, in place of the experiment's
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// Threads; all cores when absent; recordings do not depend on it
    #[arg(long, value_name = "COUNT", allow_hyphen_values = true)]
    #[serde(skip_serializing)]
    pub threads: Option<Threads>,
}

/// Options of `check` and `theory`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct CheckOptions {
    /// Which experiment.
    #[command(flatten)]
    #[serde(flatten)]
    pub input: Input,
    /// Speed of the striker, such as "0.5 m/s" or 0.5; a plain number is in m/s, or dimensionless
    /// where the experiment is
    #[arg(long, short, value_name = "SPEED", value_parser = Given::speed, allow_hyphen_values = true)]
    #[serde(deserialize_with = "some_speed")]
    pub speed: Option<Given>,
    /// Print JSON
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
}
