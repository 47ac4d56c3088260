//! Arguments of the verbs that go from times of flight to parameters.

use clap::{Args, ValueEnum};
use hertzchain_experiment::units::{Dimension, parse_quantity, parse_unit};
use hertzchain_infer::FEWEST_SHOTS;
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
    /// Standard error of speeds where the table has none, such as 0.7mm/s; a plain number is in m/s,
    /// and 0 says that they are exact
    #[arg(long, value_name = "SPEED", value_parser = speed_error, allow_hyphen_values = true)]
    pub speed_error: Option<f64>,
    /// Standard error of times of flight where the table has none, such as 0.5us; a plain number is
    /// in s
    #[arg(long, value_name = "TIME", value_parser = time_error, allow_hyphen_values = true)]
    pub tof_error: Option<f64>,
    /// Standard error of ratios of peaks where the table has none
    #[arg(long, value_name = "RATIO", value_parser = positive, allow_hyphen_values = true)]
    pub ratio_error: Option<f64>,
    /// Shots a row from whose scatter the standard errors come, or `known`; what the table tells in
    /// columns `shots` and `tof_incident_s_count` when absent. Errors from few shots are widened, so
    /// that intervals hold the truth as often as they say
    #[arg(long, value_name = "COUNT", value_parser = shots, allow_hyphen_values = true)]
    pub error_shots: Option<ErrorShots>,
}

/// From the scatter of how many shots standard errors come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorShots {
    /// They are known.
    Known,
    /// From so many.
    Of(u32),
}

impl std::fmt::Display for ErrorShots {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Known => write!(f, "{KNOWN}"),
            Self::Of(shots) => write!(f, "{shots}"),
        }
    }
}

/// The word for errors that need no shots.
const KNOWN: &str = "known";

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
    /// A model that comes with the program; `hertzchain presets` lists them. The paper's
    /// dry chain, `dry`, where no model is named, which the first line says
    #[arg(long, short, value_name = "NAME")]
    pub preset: Option<String>,
    /// Set a number that stays fixed, such as incline=0.5deg
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<Assignment>,
    /// Relative accuracy of the model's times of flight
    #[arg(long, short, value_name = "NUMBER", default_value = "1e-5", value_parser = super::accuracy, allow_hyphen_values = true)]
    pub accuracy: f64,
    /// Threads; all cores when absent; results do not depend on it
    #[arg(long, value_name = "COUNT", value_parser = super::threads, allow_hyphen_values = true)]
    pub threads: Option<usize>,
}

/// Which numbers are free, and what is known of them.
#[derive(Debug, Args)]
pub struct Freed {
    /// Free numbers, separated by commas: short names (Y, nu, eta, K, A, B, of a material or section
    /// as in pump-oil.eta or wet.K) or paths of the experiment file; followed by :power for a power
    /// law of speed, by :each for a value a speed
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true, value_parser = name)]
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
    /// Table (CSV) of times of flight against speed, such as speeds.csv of `measure`; or recordings
    /// of any format that `measure` reads, to fit whole pulses sample by sample
    #[arg(value_name = "DATA", required = true)]
    pub data: Vec<PathBuf>,
    /// Of recordings.
    #[command(flatten)]
    pub recorded: Recorded,
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
    /// Compare with another model of the same data: a preset or file and what is free in it; may be
    /// given several times
    #[arg(long, value_name = "MODEL=NAMES", value_parser = against)]
    pub against: Vec<Against>,
    /// Most steps of a posterior's walkers
    #[arg(long, value_name = "COUNT", default_value = "20000", value_parser = whole, allow_hyphen_values = true)]
    pub steps: u64,
    /// Compute every curve of a posterior, instead of interpolating between some hundreds or
    /// thousands where that is as good
    #[arg(long)]
    pub direct: bool,
    /// Go on where the last run into the same --out was broken off, with its best fit, profiles and
    /// walkers
    #[arg(long, requires = "out")]
    pub resume: bool,
    /// Count outliers by their size, not its square
    #[arg(long)]
    pub robust: bool,
    /// Starts: the first as given, others spread over bounds and priors
    #[arg(long, value_name = "COUNT", default_value = "1", value_parser = count, allow_hyphen_values = true)]
    pub starts: usize,
    /// Seed of all that is random
    #[arg(long, value_name = "NUMBER", default_value = "0", value_parser = whole, allow_hyphen_values = true)]
    pub seed: u64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write fit.json, tables (CSV) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Recordings whose pulses are fitted whole.
#[derive(Debug, Args)]
pub struct Recorded {
    /// Table (CSV) with a line a recording, as `measure` takes it: file, case, speed, speed error
    #[arg(long, value_name = "CSV")]
    pub shots: Option<PathBuf>,
    /// Sampling rate where a recording does not say, such as 1MHz; a plain number is in Hz
    #[arg(long, value_name = "RATE", value_parser = super::measure::rate, allow_hyphen_values = true)]
    pub rate: Option<f64>,
    /// Channel, column or array by name or by number from 1; twice: the sensor bead's, the wall's
    #[arg(long, value_name = "NAME")]
    pub channel: Vec<String>,
    /// Corner of the amplifier's low-pass, such as 180kHz, in place of the model's; a plain number is in
    /// Hz. --free low_pass fits it
    #[arg(long, value_name = "FREQUENCY", value_parser = super::measure::rate, allow_hyphen_values = true)]
    pub low_pass: Option<f64>,
    /// Order and kind of the amplifier's low-pass, in place of the model's
    #[arg(long, value_enum, value_name = "NAME")]
    pub filter: Option<Filter>,
    /// Most shots that are fitted, spread evenly over those that are good
    #[arg(long, value_name = "COUNT", default_value = "40", value_parser = count, allow_hyphen_values = true)]
    pub most_shots: usize,
}

impl Recorded {
    /// Whether an option says something of how files are to be read as recordings.
    #[must_use]
    pub fn describes_files(&self) -> bool {
        self.shots.is_some() || self.rate.is_some() || !self.channel.is_empty()
    }
}

/// Low-passes by order and kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Filter {
    /// One pole
    First,
    /// Butterworth of second order
    Butterworth2,
    /// Butterworth of third order
    Butterworth3,
    /// Butterworth of fourth order
    Butterworth4,
    /// Bessel of second order
    Bessel2,
    /// Bessel of third order
    Bessel3,
    /// Bessel of fourth order
    Bessel4,
}

impl Filter {
    /// Order and kind as an experiment file names them.
    #[must_use]
    pub const fn names(self) -> (&'static str, Option<&'static str>) {
        let (butterworth, bessel) = (Some("butterworth"), Some("bessel"));
        match self {
            Self::First => ("first", None),
            Self::Butterworth2 => ("second", butterworth),
            Self::Butterworth3 => ("third", butterworth),
            Self::Butterworth4 => ("fourth", butterworth),
            Self::Bessel2 => ("second", bessel),
            Self::Bessel3 => ("third", bessel),
            Self::Bessel4 => ("fourth", bessel),
        }
    }
}

/// Arguments of `design`.
#[derive(Debug, Args)]
pub struct Design {
    /// Table (CSV) of times of flight measured so far
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
    /// Parameters to tighten, as the fit names them; all when absent
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub target: Vec<String>,
    /// Speeds that could be measured: 0.1,0.2,0.5 or FROM:TO:COUNT or log:FROM:TO:COUNT; eight over
    /// the range of the data when absent
    #[arg(long, value_name = "SPEEDS", allow_hyphen_values = true)]
    pub speeds: Option<String>,
    /// Pushes on bead 1 that could be tried, such as 0.1N,0.5N; a plain number is in N; `none` for none
    #[arg(long, value_name = "FORCES", value_delimiter = ',', default_value = "0.24N", value_parser = force, allow_hyphen_values = true)]
    pub preloads: Vec<Push>,
    /// Beads that could hold the sensor; an eighth, a half and three quarters down the chain when
    /// absent
    #[arg(long, value_name = "BEADS", value_delimiter = ',')]
    pub sensors: Option<Vec<usize>>,
    /// What a speed costs when it is measured in a way: incident, reflected, ratio, sensor or
    /// preload, each 1 when absent; ways are ranked by information over cost
    #[arg(long, value_name = "WAY=NUMBER", value_delimiter = ',', value_parser = cost)]
    pub costs: Vec<Cost>,
    /// Length of the proposed series
    #[arg(long, value_name = "COUNT", default_value = "5", value_parser = count, allow_hyphen_values = true)]
    pub picks: usize,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write design.json and design.csv into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// A push that could be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Push {
    /// None at all.
    Nothing,
    /// Of a force in N.
    Of(f64),
}

fn force(text: &str) -> Result<Push, String> {
    if text.trim() == "none" {
        return Ok(Push::Nothing);
    }
    let expected = "expected a force that is not negative, such as 0.24N, or none";
    let force_n = quantity(text, "N").filter(|force| *force >= 0.0);
    force_n.map(Push::Of).ok_or_else(|| expected.to_owned())
}

/// A finite number in an SI unit, from text in any unit of its kind or in none.
fn quantity(text: &str, unit: &str) -> Option<f64> {
    let quantity = parse_quantity(text.trim()).ok()?;
    let own = parse_unit(unit).map_or(Dimension::NONE, |unit| unit.dimension);
    let fits = quantity.dimension == Dimension::NONE || quantity.dimension == own;
    (fits && quantity.value.is_finite()).then_some(quantity.value)
}

fn speed_error(text: &str) -> Result<f64, String> {
    let found = quantity(text, "m/s").filter(|speed| *speed >= 0.0);
    found.ok_or_else(|| "expected a speed or 0, such as 0.7mm/s, or 7e-4 for m/s".to_owned())
}

fn time_error(text: &str) -> Result<f64, String> {
    let found = quantity(text, "s").filter(|time| *time > 0.0);
    found.ok_or_else(|| "expected a positive time, such as 0.5us, or 5e-7 for s".to_owned())
}

fn name(text: &str) -> Result<String, String> {
    match text.trim() {
        "" => Err("expected names between commas, such as eta,B".to_owned()),
        _ => Ok(text.to_owned()),
    }
}

/// What a way to measure costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The way.
    pub of: WayKind,
    /// Its cost, in whatever unit the others are.
    pub value: f64,
}

/// Ways to measure, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WayKind {
    /// Incident times alone
    Incident,
    /// Reflected times too
    Reflected,
    /// And the ratio of returning to passing peaks
    Ratio,
    /// A sensor in another bead
    Sensor,
    /// A push on bead 1
    Preload,
}

fn cost(text: &str) -> Result<Cost, String> {
    let expected = "expected WAY=NUMBER with a positive number, such as sensor=10; ways are incident, reflected, \
                    ratio, sensor, preload";
    let (of, value) = text.split_once('=').ok_or(expected)?;
    Ok(Cost {
        of: WayKind::from_str(of.trim(), false).map_err(|_| expected)?,
        value: positive(value).map_err(|_| expected)?,
    })
}

/// Arguments of `gauge`.
#[derive(Debug, Args)]
pub struct Gauge {
    /// Table (CSV) of times of flight against speed of the wet chain
    #[arg(value_name = "WET")]
    pub wet: PathBuf,
    /// The same of the dry chain
    #[arg(long, value_name = "DRY")]
    pub dry: PathBuf,
    /// Case of the wet table, if it has several
    #[arg(long, value_name = "CASE")]
    pub wet_case: Option<String>,
    /// Case of the dry table, if it has several
    #[arg(long, value_name = "CASE")]
    pub dry_case: Option<String>,
    /// The curves.
    #[command(flatten)]
    pub measured: Measured,
    /// Experiment file of the wet chain, a section of it with `wet = true`
    #[arg(long, short, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Wet chain that comes with the program; its oil's own numbers play no part. The paper's, `pump`,
    /// where no model is named, which the first line says
    #[arg(long, short, value_name = "NAME")]
    pub preset: Option<String>,
    /// Experiment file of the dry chain
    #[arg(long, value_name = "FILE")]
    pub dry_model: Option<PathBuf>,
    /// Dry chain that comes with the program; the paper's, `dry`, where no model is named, which the
    /// first line says
    #[arg(long, value_name = "NAME")]
    pub dry_preset: Option<String>,
    /// Free numbers of the dry contacts, by names that both models know
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "aisi316.eta,dry.B"
    )]
    pub dry_free: Vec<String>,
    /// Numbers that each chain has for itself, by names that both models know, such as the load that
    /// friction holds in a tapped row (near_end.force); fitted anew with every oil
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub own: Vec<String>,
    /// How K and A of the wet contacts depend on speed
    #[arg(long, value_enum, value_name = "FORM", default_value = "each")]
    pub form: WetForm,
    /// Table (CSV) of further oils, with the columns of the program's own
    #[arg(long, value_name = "FILE")]
    pub oils: Option<PathBuf>,
    /// Relative accuracy of the model's times of flight
    #[arg(long, short, value_name = "NUMBER", default_value = "1e-5", value_parser = super::accuracy, allow_hyphen_values = true)]
    pub accuracy: f64,
    /// Threads; all cores when absent; results do not depend on it
    #[arg(long, value_name = "COUNT", value_parser = super::threads, allow_hyphen_values = true)]
    pub threads: Option<usize>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write gauge.json, contacts.csv and a figure (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// How K and A depend on speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum WetForm {
    /// In any way: each speed for itself
    #[default]
    Each,
    /// As power laws of speed, fitted to the whole curve; incident times do if speeds are known well
    Power,
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

/// Another model and what is free in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Against {
    /// File or preset.
    pub model: String,
    /// What is free in it.
    pub free: Vec<String>,
}

impl Against {
    /// The model as options of a fit, computed as another, with all that is set there.
    pub fn modelled(&self, like: &Modelled) -> Modelled {
        let file = Some(PathBuf::from(&self.model)).filter(|file| file.exists());
        Modelled {
            preset: file.is_none().then(|| self.model.clone()),
            model: file,
            set: like.set.clone(),
            accuracy: like.accuracy,
            threads: like.threads,
        }
    }
}

fn against(text: &str) -> Result<Against, String> {
    let (model, free) = text
        .split_once('=')
        .ok_or("expected MODEL=NAMES, such as hertz-viscoelastic=eta")?;
    Ok(Against {
        model: model.trim().to_owned(),
        free: free.split(',').map(|name| name.trim().to_owned()).collect(),
    })
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a positive number, such as 0.01".to_owned())
}

/// A whole number.
fn whole(text: &str) -> Result<u64, String> {
    let number = text.trim().parse();
    number.map_err(|_| "expected a whole number, 0 or more".to_owned())
}

fn shots(text: &str) -> Result<ErrorShots, String> {
    if text.trim() == KNOWN {
        return Ok(ErrorShots::Known);
    }
    let number = text.trim().parse().ok();
    let number = number.filter(|count| *count >= FEWEST_SHOTS);
    number.map(ErrorShots::Of).ok_or_else(|| {
        format!(
            "expected a whole number from {FEWEST_SHOTS}, or {KNOWN}: the scatter of fewer shots tells no \
             error of a row; take one over many rows"
        )
    })
}

fn count(text: &str) -> Result<usize, String> {
    let number = text.trim().parse().ok();
    number
        .filter(|count| (1..=1000).contains(count))
        .ok_or_else(|| "expected a whole number from 1 to 1000".to_owned())
}
