//! Options, declared once: help, man pages, completions and Python's keywords follow.

pub mod infer;
pub mod measure;
mod words;

use crate::failure::Failure;
use crate::given::Given;
use clap::{Args, Command, ValueEnum};
use std::path::PathBuf;

/// Options of a verb from words, as a command line has them.
///
/// # Errors
/// Words that are no options, or say nothing sensible.
pub fn parsed<A: Args>(verb: &'static str, words: &[String]) -> Result<A, Failure> {
    let command = Command::new(verb).no_binary_name(true);
    let command = A::augment_args(command.disable_help_flag(true));
    let told = |error: clap::Error| {
        let text = error.to_string();
        let text = text.split("\n\nUsage:").next().unwrap_or_default();
        let text = text.split("\n\nFor more information").next();
        let text = text.unwrap_or_default().trim();
        Failure::User(text.strip_prefix("error: ").unwrap_or(text).to_owned())
    };
    let matches = command.try_get_matches_from(words).map_err(told)?;
    A::from_arg_matches(&matches).map_err(told)
}

/// Which experiment.
#[derive(Debug, Args)]
pub struct Input {
    /// Experiment file (TOML)
    #[arg(value_name = "FILE", conflicts_with = "preset")]
    pub file: Option<PathBuf>,
    /// An experiment that comes with the program; `hertzchain presets` lists them
    #[arg(long, short, value_name = "NAME")]
    pub preset: Option<String>,
}

/// How to compute, in place of what the experiment says.
#[derive(Debug, Args)]
pub struct How {
    /// Relative accuracy of times of flight, such as 1e-6
    #[arg(long, short, value_name = "NUMBER", value_parser = accuracy)]
    pub accuracy: Option<f64>,
    /// How the motion is computed
    #[arg(long, value_enum, value_name = "NAME")]
    pub solver: Option<Solver>,
    /// Step of a fixed-step solver, such as "1 us"; found by halving when absent; a plain number
    /// where the experiment is dimensionless
    #[arg(long, value_name = "TIME", value_parser = Given::time, allow_hyphen_values = true)]
    pub step: Option<Given>,
    /// Duration of a shot, such as "2 ms"; until the reflected pulse has passed when absent; a
    /// plain number where the experiment is dimensionless
    #[arg(long, value_name = "TIME", value_parser = Given::time, allow_hyphen_values = true)]
    pub duration: Option<Given>,
    /// Where a pulse is timed
    #[arg(long, value_enum, value_name = "NAME")]
    pub pick: Option<Pick>,
    /// Compare with tighter runs; without, `shot` estimates its error by looser ones
    #[arg(long)]
    pub check: bool,
}

/// A relative accuracy that results can have.
///
/// # Errors
/// What else it is.
pub fn accuracy(text: &str) -> Result<f64, String> {
    let number: f64 = text
        .parse()
        .map_err(|_| "expected a number such as 1e-6".to_owned())?;
    match (1e-13..=1e-2).contains(&number) {
        true => Ok(number),
        false => Err("expected a number between 1e-13 and 1e-2".to_owned()),
    }
}

/// More threads than any machine has cores.
const MOST_THREADS: usize = 1024;

/// A number of threads.
///
/// # Errors
/// What else it is.
pub fn threads(text: &str) -> Result<usize, String> {
    match text.trim().parse() {
        Ok(count) if (1..=MOST_THREADS).contains(&count) => Ok(count),
        _ => Err(format!("expected a whole number from 1 to {MOST_THREADS}")),
    }
}

/// Solvers by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// Embedded pair with adaptive steps that end at contact changes
    Adaptive,
    /// Classical Runge–Kutta with fixed steps
    Rk4,
    /// Velocity Verlet with fixed steps
    Verlet,
}

/// Picks by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Pick {
    /// At its maximum
    Peak,
    /// At 10 % of the maximum on the rising flank
    #[value(name = "flank-10")]
    Flank10,
    /// At 50 % of the maximum on the rising flank
    #[value(name = "flank-50")]
    Flank50,
    /// By cross-correlation of the pulses
    CrossCorrelation,
}
