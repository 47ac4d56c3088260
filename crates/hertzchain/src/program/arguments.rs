//! The command line, declared once: help, man pages and completions follow.

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use hertzchain::arguments::{How, Input, infer, measure, threads};
use hertzchain::given::Given;
use hertzchain_sim::Shard;
use std::path::PathBuf;

/// Rows of beads and their solitary waves.
///
/// A row of touching balls is hit at one end; a solitary wave runs down it. This
/// program computes what sensors in the row see and when, for the chains of
/// the paper by Labbé, Vergara and Olivares and for your own.
#[derive(Debug, Parser)]
#[command(
    name = "hertzchain",
    disable_version_flag = true,
    arg_required_else_help = true
)]
#[command(after_help = ENVIRONMENT, subcommand_negates_reqs = true)]
pub(crate) struct Program {
    /// Print the version; with --verbose also the instruction sets
    #[arg(long, short = 'V')]
    pub version: bool,
    /// Say more, with --version
    #[arg(long, requires = "version")]
    pub verbose: bool,
    /// What to do.
    #[command(subcommand)]
    pub verb: Option<Verb>,
}

/// What the environment can change.
const ENVIRONMENT: &str = "Environment:\n  HERTZCHAIN_INSTRUCTION_SET  vector instructions of ensembles, by name: \
see `hertzchain --version --verbose`";

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Compute everything in the paper: tables, figures, verdicts on its claims
    Reproduce(Reproduce),
    /// Compute one shot: times of flight, peaks, rebound, energy
    Shot(Shot),
    /// Compute times of flight against speed, with power-law fits
    Sweep(Sweep),
    /// Put the shards of a sweep or a campaign together that several machines have computed
    Merge(Merge),
    /// Run a campaign on a virtual rig: taps and shots, recorded as by a real one
    Campaign(Campaign),
    /// Measure times of flight on recordings of any rig, with errors and curves
    Measure(measure::Measure),
    /// Fit contact parameters to times of flight, with errors one can trust
    Fit(infer::Fit),
    /// Rank what to measure next so that parameters tighten most
    Design(infer::Design),
    /// Tell the oil on a row's contacts from times of flight, wet and dry
    Gauge(infer::Gauge),
    /// Check an experiment file and print what was understood; run nothing
    Check(Check),
    /// Print what theory says of a chain's waves
    Theory(Check),
    /// List every contact law with its equation, parameters and source
    Laws(Laws),
    /// List the experiments that come with the program, or print one
    Presets(Presets),
    /// Print the JSON Schema of experiment files, for editors
    Schema,
    /// Print a completion script for a shell
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Print the manual page, or write one page a verb into a folder
    Man {
        /// Folder to write into
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Arguments of `shot`.
#[derive(Debug, Args)]
pub(crate) struct Shot {
    /// Which experiment.
    #[command(flatten)]
    pub input: Input,
    /// Speed of the striker, such as "0.5 m/s" or 0.5; a plain number is in m/s, or dimensionless
    /// where the experiment is
    #[arg(long, short, value_name = "SPEED", value_parser = Given::speed, allow_hyphen_values = true)]
    pub speed: Option<Given>,
    /// How to compute.
    #[command(flatten)]
    pub how: How,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write traces (CSV) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Also write positions, velocities and forces of all bodies as NPY
    #[arg(long, requires = "out")]
    pub npy: bool,
    /// Write a moving picture of the shot as one HTML file, into --out or here
    #[arg(long)]
    pub animate: bool,
}

/// Judges by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Judges {
    /// Two more shots each, with longer steps
    Each,
    /// Forty speeds, computed much more tightly, choose the cheapest steps for all: two to five
    /// times as fast on dry rows
    Pilots,
}

/// Arguments of `sweep`.
#[derive(Debug, Args)]
pub(crate) struct Sweep {
    /// Which experiment.
    #[command(flatten)]
    pub input: Input,
    /// Speeds in m/s, or dimensionless where the experiment is: 0.1,0.2,0.5 or FROM:TO:COUNT or
    /// log:FROM:TO:COUNT
    #[arg(
        long,
        value_name = "SPEEDS",
        default_value = "log:0.075:1.23:25",
        allow_hyphen_values = true
    )]
    pub speeds: String,
    /// How to compute.
    #[command(flatten)]
    pub how: How,
    /// Print JSON; without an energy budget, which only `shot` keeps
    #[arg(long)]
    pub json: bool,
    /// Write the table (CSV) and a figure (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Only the i-th of n parts, for several machines, as one file in --out, unless it is there;
    /// `hertzchain merge` puts them together
    #[arg(long, value_name = "i/n", requires = "out", conflicts_with = "json")]
    pub shard: Option<Shard>,
    /// Follow the striker until it is away for good and give its velocity; takes the slower loop
    #[arg(long)]
    pub rebound: bool,
    /// Who tells how right times of flight are
    #[arg(long, value_enum, value_name = "WHO", default_value = "each")]
    pub judges: Judges,
    /// Threads; all cores when absent
    #[arg(long, value_name = "COUNT", value_parser = threads, allow_hyphen_values = true)]
    pub threads: Option<usize>,
}

/// Arguments of `merge`.
#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// Folders with shards, as `sweep --shard` or `campaign --shard` have written them
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
    /// Folder to write the whole into: the files of a run that was never cut
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `campaign`.
#[derive(Debug, Args)]
pub(crate) struct Campaign {
    /// Which experiment.
    #[command(flatten)]
    pub input: Input,
    /// Folder to write recordings into; the same folder again goes on where a run was broken off
    #[arg(long, short, value_name = "DIR", default_value = "campaign")]
    pub out: PathBuf,
    /// Only the i-th of n parts, for several machines: series are dealt out like cards
    #[arg(long, value_name = "i/n", default_value = "1/1")]
    pub shard: Shard,
    /// Seed of all that is random, in place of the experiment's
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// Threads; all cores when absent; recordings do not depend on it
    #[arg(long, value_name = "COUNT", value_parser = threads, allow_hyphen_values = true)]
    pub threads: Option<usize>,
}

/// Arguments of `check` and `theory`.
#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Which experiment.
    #[command(flatten)]
    pub input: Input,
    /// Speed of the striker, such as "0.5 m/s" or 0.5; a plain number is in m/s, or dimensionless
    /// where the experiment is
    #[arg(long, short, value_name = "SPEED", value_parser = Given::speed, allow_hyphen_values = true)]
    pub speed: Option<Given>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `laws`.
#[derive(Debug, Args)]
pub(crate) struct Laws {
    /// Only this law
    pub name: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `presets`.
#[derive(Debug, Args)]
pub(crate) struct Presets {
    /// Print this one's file, to start your own from
    pub name: Option<String>,
}

/// Arguments of `reproduce`.
#[derive(Debug, Args)]
pub(crate) struct Reproduce {
    /// Folder to write into
    #[arg(long, short, value_name = "DIR", default_value = "reproduction")]
    pub out: PathBuf,
    /// Also scan what the paper leaves open: which claims hold in which reading;
    /// tries every combination of the switches that move a verdict, up to an hour on
    /// two cores, and tells before it begins
    #[arg(long)]
    pub readings: bool,
    /// Also hold what the paper says of its rig, of taps, gaps and rebounds, against virtual
    /// rigs; a few minutes on two cores
    #[arg(long)]
    pub rig: bool,
}
