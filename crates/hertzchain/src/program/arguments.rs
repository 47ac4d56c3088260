//! The command line, declared once: help, man pages and completions follow.

#[cfg(feature = "explore")]
use crate::options::Input;
use crate::options::{
    CampaignOptions, CheckOptions, DesignOptions, FitOptions, GaugeOptions, LiveOptions,
    MeasureOptions, ShotOptions, SweepOptions,
};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use std::path::PathBuf;

/// Rows of beads and their solitary waves.
///
/// A row of touching balls is hit at one end; a solitary wave runs down it. This
/// program computes what sensors in the row see and when, for the chains of
/// the paper by Labbé, Vergara and Olivares and for your own.
#[derive(Debug, Parser)]
#[command(name = "hertzchain", disable_version_flag = true, arg_required_else_help = true)]
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

const ENVIRONMENT: &str = "Environment:\n  HERTZCHAIN_INSTRUCTION_SET  vector instructions of ensembles, by name: \
see `hertzchain --version --verbose`";

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Compute everything in the paper: tables, figures, verdicts on its claims
    Reproduce(Reproduce),
    /// Compute one shot: times of flight, peaks, rebound, energy
    Shot(ShotOptions),
    /// Compute times of flight against speed, with power-law fits
    Sweep(SweepOptions),
    /// Put the shards of a sweep or a campaign together that several machines have computed
    Merge(Merge),
    /// Run a campaign on a virtual rig: taps and shots, recorded as by a real one
    Campaign(CampaignOptions),
    /// Measure times of flight on recordings of any rig, with errors and curves
    Measure(MeasureOptions),
    /// Measure shots as they are recorded: in a folder (DIR), on standard input (-) or from tcp://HOST:PORT
    Live(LiveOptions),
    /// Fit contact parameters to times of flight, with errors one can trust
    Fit(FitOptions),
    /// Rank what to measure next so that parameters tighten most
    Design(DesignOptions),
    /// Find the oil on a row's contacts from times of flight, wet and dry
    Gauge(GaugeOptions),
    /// Open a page in the browser on which the wave is seen and every number can be turned
    #[cfg(feature = "explore")]
    Explore(Explore),
    /// Check an experiment file and print what was understood; run nothing
    Check(CheckOptions),
    /// Print what theory says of a chain's waves
    Theory(CheckOptions),
    /// List every contact law with its equation, parameters and source
    Laws(LawsArguments),
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

#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// Folders with shards, as `sweep --shard` or `campaign --shard` have written them
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
    /// Folder to write the whole into: the files of a run that was never cut
    #[arg(long, short, value_name = "DIR")]
    pub out: PathBuf,
    /// Replace files of an earlier run
    #[arg(long)]
    pub force: bool,
}

#[cfg(feature = "explore")]
#[derive(Debug, Args)]
pub(crate) struct Explore {
    /// What the page shows first.
    #[command(flatten)]
    pub input: Input,
    /// Port of the page's address on this machine; a free one when absent
    #[arg(long, value_name = "NUMBER")]
    pub port: Option<u16>,
    /// Print the address and open no browser
    #[arg(long)]
    pub no_browser: bool,
}

#[derive(Debug, Args)]
pub(crate) struct LawsArguments {
    /// Only this law
    pub name: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Presets {
    /// Print this one's file, to start your own from
    pub name: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct Reproduce {
    /// Folder to write into
    #[arg(long, short, value_name = "DIR", default_value = "reproduction")]
    pub out: PathBuf,
    /// Replace files that no earlier reproduction has written
    #[arg(long)]
    pub force: bool,
    /// Also scan what the paper leaves open: which claims hold in which reading;
    /// tries every combination of the switches that move a verdict, up to an hour on
    /// two cores, and reports that before it begins
    #[arg(long)]
    pub readings: bool,
    /// Also hold what the paper says of its rig, of taps, gaps and rebounds, against virtual
    /// rigs; a few minutes on two cores
    #[arg(long)]
    pub rig: bool,
    /// Also put films of the paper's oils on its wet contacts, by the oils' own properties, and hold
    /// their times against the paper's; some minutes on two cores
    #[arg(long)]
    pub film: bool,
}
