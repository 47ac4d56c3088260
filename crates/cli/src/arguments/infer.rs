//! Arguments of the verbs that go from times of flight to parameters.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// A measured curve.
#[derive(Debug, Args)]
pub struct Measured {
    /// Case of a table of several, and of an experiment that has cases
    #[arg(long, value_name = "CASE")]
    pub case: Option<String>,
    /// What to use of each row, separated by commas
    #[arg(
        long = "use",
        value_enum,
        value_name = "WHAT",
        value_delimiter = ',',
        default_value = "incident,reflected"
    )]
    pub observables: Vec<What>,
    /// Standard error of speeds in m/s where the table has none
    #[arg(long, value_name = "SPEED", value_parser = positive)]
    pub speed_error: Option<f64>,
    /// Standard error of times of flight in s where the table has none
    #[arg(long, value_name = "TIME", value_parser = positive)]
    pub tof_error: Option<f64>,
    /// Standard error of ratios of peaks where the table has none
    #[arg(long, value_name = "RATIO", value_parser = positive)]
    pub ratio_error: Option<f64>,
}

/// Observables by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum What {
    /// Incident times of flight
    Incident,
    /// Reflected times of flight
    Reflected,
    /// Peaks at the wall over passing ones; needs the gains of both sensors to be alike, or
    /// wall_gain to be free
    WallRatio,
    /// Returning peaks over passing ones, both of one sensor
    ReturningRatio,
}

/// A model with free numbers.
#[derive(Debug, Args)]
pub struct Modelled {
    /// Experiment file of the model
    #[arg(long, short, value_name = "FILE", conflicts_with = "preset")]
    pub model: Option<PathBuf>,
    /// A model that comes with the program; `hertzchain presets` lists them
    #[arg(long, short, value_name = "NAME")]
    pub preset: Option<String>,
    /// Set a number that stays fixed, such as incline=0.5deg
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Relative accuracy of the model's times of flight
    #[arg(long, short, value_name = "NUMBER", default_value = "1e-5", value_parser = super::accuracy)]
    pub accuracy: f64,
    /// Threads; all cores when absent; results do not depend on it
    #[arg(long, value_name = "COUNT", value_parser = super::threads)]
    pub threads: Option<usize>,
}

/// Which numbers are free, and what is known of them.
#[derive(Debug, Args)]
pub struct Freed {
    /// Free numbers, separated by commas: short names (Y, nu, eta, K, A, B, of a material or section
    /// as in pump-oil.eta or wet.K) or paths of the experiment file; followed by :power for a power
    /// law of speed, by :each for a value a speed
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true)]
    pub free: Vec<String>,
    /// Where a number starts, if not at the experiment's value
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub start: Vec<Assignment>,
    /// What a number may be
    #[arg(long, value_name = "NAME=FROM:TO", value_parser = assignment)]
    pub bounds: Vec<Assignment>,
    /// What is known of a number: normal, or normal in the logarithm by a factor
    #[arg(long, value_name = "NAME=MEAN+-SD or NAME=MEDIAN*/FACTOR", value_parser = assignment)]
    pub prior: Vec<Assignment>,
    /// Size of a change of a number that matters
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub scale: Vec<Assignment>,
}

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub struct Fit {
    /// Table (CSV) of times of flight against speed, such as speeds.csv of `measure`
    #[arg(value_name = "DATA")]
    pub data: PathBuf,
    /// The curve.
    #[command(flatten)]
    pub measured: Measured,
    /// The model.
    #[command(flatten)]
    pub modelled: Modelled,
    /// What is free.
    #[command(flatten)]
    pub freed: Freed,
    /// How uncertainty is told, beside the covariance
    #[arg(long, value_enum, value_name = "NAME", default_value = "covariance")]
    pub method: Method,
    /// Count outliers by their size, not its square
    #[arg(long)]
    pub robust: bool,
    /// Starts: the first as given, others spread over bounds and priors
    #[arg(long, value_name = "COUNT", default_value = "1", value_parser = count)]
    pub starts: usize,
    /// Seed of all that is random
    #[arg(long, value_name = "NUMBER", default_value = "0")]
    pub seed: u64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write fit.json, tables (CSV) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Ways to tell uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// By the curvature at the best fit
    Covariance,
    /// By how the fit worsens as each parameter is moved and the others follow
    Profile,
    /// By sampling the posterior
    Posterior,
}

/// A name and the text that stands for its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Name.
    pub name: String,
    /// Text after the sign.
    pub text: String,
}

fn assignment(text: &str) -> Result<Assignment, String> {
    let parts = text
        .split_once('=')
        .filter(|(name, _)| !name.trim().is_empty());
    let (name, text) = parts.ok_or("expected NAME=VALUE, such as eta=3.2e4")?;
    Ok(Assignment {
        name: name.trim().to_owned(),
        text: text.trim().to_owned(),
    })
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a positive number in SI, such as 3e-7".to_owned())
}

fn count(text: &str) -> Result<usize, String> {
    let number = text.trim().parse().ok();
    number
        .filter(|count| (1..=1000).contains(count))
        .ok_or_else(|| "expected a whole number from 1 to 1000".to_owned())
}
