//! Options of the verbs that go from times of flight to parameters.

use super::values::{pairs, some_speeds, texts};
use super::{
    Accuracy, Against, Also, Assignment, Cost, ErrorShots, Frequency, Positive, Preload, Speed,
    Threads, Time, UpTo1000,
};
use clap::Args;
use hertzchain_infer::Observable;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A measured curve.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct CurveOptions {
    /// Case of a table of several, and of an experiment that has cases
    #[arg(long, value_name = "CASE")]
    pub case: Option<String>,
    /// What to use of each row, separated by commas
    #[arg(
        id = "use",
        long = "use",
        value_enum,
        value_name = "WHAT",
        value_delimiter = ',',
        default_value = "incident,reflected"
    )]
    #[serde(rename = "use")]
    pub observables: Vec<What>,
    /// Standard error of speeds where the table has none, such as 0.7mm/s; a plain number is in m/s,
    /// and 0 says that they are exact
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    pub speed_error: Option<Speed>,
    /// Standard error of times of flight where the table has none, such as 0.5us; a plain number is
    /// in s
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub tof_error: Option<Time>,
    /// Standard error of ratios of peaks where the table has none
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true)]
    pub ratio_error: Option<Positive>,
    /// Shots a row from whose scatter the standard errors come, or `known`; what the table gives in
    /// columns `shots` and `tof_incident_s_count` when absent. Errors from few shots are widened, so
    /// that intervals hold the truth as often as they say
    #[arg(long, value_name = "COUNT", allow_hyphen_values = true)]
    pub error_shots: Option<ErrorShots>,
}

names! {
    /// Observables by name.
    What for Observable {
        /// Incident times of flight
        Incident,
        /// Reflected times of flight
        Reflected,
        /// Peaks at the wall over passing ones; needs the gains of both sensors to be alike, or
        /// wall_gain to be free
        #[value(name = "wall-ratio")]
        #[serde(rename = "wall-ratio")]
        WallOverPassing,
        /// Returning peaks over passing ones, both of one sensor
        #[value(name = "returning-ratio")]
        #[serde(rename = "returning-ratio")]
        ReturningOverPassing,
    }
}

/// A model with free numbers.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct ModelOptions {
    /// Experiment file of the model
    #[arg(long, short, value_name = "FILE", conflicts_with = "preset")]
    #[serde(skip_serializing)]
    pub model: Option<PathBuf>,
    /// A model that comes with the program; `hertzchain presets` lists them. The paper's
    /// dry chain, `dry`, where no model is named, which the first line says
    #[arg(long, short, value_name = "NAME")]
    #[serde(skip_serializing)]
    pub preset: Option<String>,
    /// Set a number, such as incline=0.5deg; one that is free starts there
    #[arg(long, value_name = "NAME=VALUE")]
    #[serde(with = "pairs")]
    pub set: Vec<Assignment>,
    /// Relative accuracy of the model's times of flight
    #[arg(long, short, value_name = "NUMBER", default_value = "1e-5", allow_hyphen_values = true)]
    pub accuracy: Accuracy,
    /// Threads; all cores when absent; results do not depend on it
    #[arg(long, value_name = "COUNT", allow_hyphen_values = true)]
    #[serde(skip_serializing)]
    pub threads: Option<Threads>,
}

/// Which numbers are free, and what is known of them.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct ParameterOptions {
    /// Free numbers, separated by commas: short names (Y, nu, eta, K, A, B, of a material or section
    /// as in pump-oil.eta or wet.K) or paths of the experiment file; followed by :power for a power
    /// law of speed, by :each for a value a row
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true, value_parser = name)]
    pub free: Vec<String>,
    /// Where a number starts, if not at the experiment's value
    #[arg(long, value_name = "NAME=VALUE")]
    #[serde(with = "pairs")]
    pub start: Vec<Assignment>,
    /// What a number may be
    #[arg(long, value_name = "NAME=FROM:TO")]
    #[serde(with = "pairs")]
    pub bounds: Vec<Assignment>,
    /// What is known of a number: normal, or normal in the logarithm by a factor
    #[arg(long, value_name = "NAME=MEAN+-SD or NAME=MEDIAN*/FACTOR")]
    #[serde(serialize_with = "pairs::serialize", deserialize_with = "pairs::priors")]
    pub prior: Vec<Assignment>,
    /// Size of a change of a number that matters
    #[arg(long, value_name = "NAME=VALUE")]
    #[serde(with = "pairs")]
    pub scale: Vec<Assignment>,
    /// Systematic errors as nuisance parameters, each a number that is known to a standard deviation
    /// from elsewhere: delay=0.2us, reflected_delay, skew (of the wall's channel), speed_scale=1%,
    /// radius_error=1um, or any number that can be free
    #[arg(long, value_name = "NAME=SD", value_delimiter = ',')]
    #[serde(with = "pairs")]
    pub systematic: Vec<Assignment>,
}

/// Options of `fit`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct FitOptions {
    /// Table (CSV) of times of flight against speed, such as speeds.csv of `measure`; or recordings
    /// of any format that `measure` reads, to fit whole pulses sample by sample
    #[arg(value_name = "DATA", required = true)]
    #[serde(skip_serializing)]
    pub data: Vec<PathBuf>,
    /// Of recordings.
    #[command(flatten)]
    #[serde(flatten)]
    pub recorded: RecordOptions,
    /// The curve.
    #[command(flatten)]
    #[serde(flatten)]
    pub measured: CurveOptions,
    /// The model.
    #[command(flatten)]
    #[serde(flatten)]
    pub modelled: ModelOptions,
    /// What is free.
    #[command(flatten)]
    #[serde(flatten)]
    pub freed: ParameterOptions,
    /// A further table and its model, preset or file, fitted together with DATA: numbers that are free
    /// have one value in all models that know them; may be given several times
    #[arg(long, value_name = "DATA=MODEL[,CASE]")]
    #[serde(skip_serializing)]
    pub also: Vec<Also>,
    /// Free numbers that each table has for itself, such as preload: preload#1 is DATA's
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub own: Vec<String>,
    /// How uncertainty is reported, beside the covariance
    #[arg(long, value_enum, value_name = "NAME", default_value = "covariance")]
    pub method: Method,
    /// Compare with another model of the same data: a preset or file and what is free in it; may be
    /// given several times
    #[arg(long, value_name = "MODEL=NAMES")]
    pub against: Vec<Against>,
    /// Most steps of a posterior's walkers
    #[arg(long, value_name = "COUNT", default_value = "20000", allow_hyphen_values = true)]
    pub steps: u64,
    /// Compute every curve of a posterior, instead of interpolating between some hundreds or
    /// thousands where that is as good
    #[arg(long)]
    pub direct: bool,
    /// Go on where the last run into the same --out was broken off, with its best fit, profiles and
    /// walkers
    #[arg(long, requires = "out")]
    #[serde(skip_serializing)]
    pub resume: bool,
    /// Count outliers by their size, not its square
    #[arg(long)]
    pub robust: bool,
    /// Starts: the first as given, others spread over bounds and priors
    #[arg(long, value_name = "COUNT", default_value = "1", allow_hyphen_values = true)]
    pub starts: UpTo1000,
    /// Seed of all that is random
    #[arg(long, value_name = "NUMBER", default_value = "0", allow_hyphen_values = true)]
    pub seed: u64,
    /// Print JSON
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
    /// Write fit.json, tables (CSV) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    #[serde(skip_serializing)]
    pub out: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    #[serde(skip_serializing)]
    pub force: bool,
}

/// Recordings whose pulses are fitted whole.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct RecordOptions {
    /// Table (CSV) with a line a recording, as `measure` takes it: file, case, speed, speed error
    #[arg(long, value_name = "CSV")]
    pub shots: Option<PathBuf>,
    /// Sampling rate where a recording does not say, such as 1MHz; a plain number is in Hz
    #[arg(long, value_name = "RATE", allow_hyphen_values = true)]
    pub rate: Option<Frequency>,
    /// Channel, column or array by name or by number from 1; twice: the sensor bead's, the wall's
    #[arg(long, value_name = "NAME")]
    #[serde(deserialize_with = "texts")]
    pub channel: Vec<String>,
    /// Corner of the amplifier's low-pass, such as 180kHz, in place of the model's; a plain number is in
    /// Hz. --free low_pass fits it
    #[arg(long, value_name = "FREQUENCY", allow_hyphen_values = true)]
    pub low_pass: Option<Frequency>,
    /// Order and kind of the amplifier's low-pass, in place of the model's
    #[arg(long, value_enum, value_name = "NAME")]
    pub filter: Option<Filter>,
    /// Most shots that are fitted, spread evenly over those that are good
    #[arg(long, value_name = "COUNT", default_value = "40", allow_hyphen_values = true)]
    pub most_shots: UpTo1000,
}

impl FitOptions {
    /// Returns options that free these numbers, all else as by default.
    ///
    /// ```
    /// use hertzchain::options::FitOptions;
    /// assert_eq!(FitOptions::free(["eta", "B"]).freed.free, ["eta", "B"]);
    /// ```
    pub fn free<T: Into<String>>(names: impl IntoIterator<Item = T>) -> Self {
        let mut options = Self::default();
        options.freed.free = names.into_iter().map(Into::into).collect();
        options
    }
}

impl ParameterOptions {
    /// The same with what `of` makes of each thing known of a parameter, or without it.
    pub(crate) fn each(mut self, of: impl Fn(&Assignment) -> Option<Assignment>) -> Self {
        for known in [&mut self.start, &mut self.bounds, &mut self.prior, &mut self.scale] {
            *known = known.iter().filter_map(&of).collect();
        }
        self
    }
}

impl RecordOptions {
    /// Whether an option says something of how files are to be read as recordings.
    pub(crate) fn describes_files(&self) -> bool {
        self.shots.is_some() || self.rate.is_some() || !self.channel.is_empty()
    }
}

names! {
    /// Low-passes by order and kind.
    Filter {
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
}

impl Filter {
    /// Order and kind as an experiment file names them.
    pub(crate) const fn names(self) -> (&'static str, Option<&'static str>) {
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

/// Options of `design`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct DesignOptions {
    /// Table (CSV) of times of flight measured so far
    #[arg(value_name = "DATA", required = true)]
    #[serde(skip_serializing)]
    pub data: Option<PathBuf>,
    /// The curve.
    #[command(flatten)]
    #[serde(flatten)]
    pub measured: CurveOptions,
    /// The model.
    #[command(flatten)]
    #[serde(flatten)]
    pub modelled: ModelOptions,
    /// What is free.
    #[command(flatten)]
    #[serde(flatten)]
    pub freed: ParameterOptions,
    /// Parameters to tighten, as the fit names them; all when absent
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub target: Vec<String>,
    /// Speeds that could be measured: 0.1,0.2,0.5 or FROM:TO:COUNT or log:FROM:TO:COUNT; eight over
    /// the range of the data when absent
    #[arg(long, value_name = "SPEEDS", allow_hyphen_values = true)]
    #[serde(deserialize_with = "some_speeds")]
    pub speeds: Option<String>,
    /// Pushes on bead 1 that could be tried, such as 0.1N,0.5N; a plain number is in N; `none` for none
    #[arg(
        long,
        value_name = "FORCES",
        value_delimiter = ',',
        default_value = "0.24N",
        allow_hyphen_values = true
    )]
    pub preloads: Vec<Preload>,
    /// Beads that could hold the sensor; an eighth, a half and three quarters down the chain when
    /// absent
    #[arg(long, value_name = "BEADS", value_delimiter = ',')]
    pub sensors: Option<Vec<usize>>,
    /// What a speed costs when it is measured in a way: incident, reflected, ratio, sensor or
    /// preload, each 1 when absent; ways are ranked by information over cost
    #[arg(long, value_name = "WAY=NUMBER", value_delimiter = ',')]
    #[serde(with = "pairs")]
    pub costs: Vec<Cost>,
    /// Length of the proposed series
    #[arg(long, value_name = "COUNT", default_value = "5", allow_hyphen_values = true)]
    pub picks: UpTo1000,
    /// Print JSON
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
    /// Write design.json and design.csv into this folder
    #[arg(long, short, value_name = "DIR")]
    #[serde(skip_serializing)]
    pub out: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    #[serde(skip_serializing)]
    pub force: bool,
}

/// Options of `gauge`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct GaugeOptions {
    /// Table (CSV) of times of flight against speed of the wet chain
    #[arg(value_name = "WET", required = true)]
    #[serde(skip_serializing)]
    pub wet: Option<PathBuf>,
    /// The same of the dry chain
    #[arg(long, value_name = "DRY", required = true)]
    #[serde(skip_serializing)]
    pub dry: Option<PathBuf>,
    /// Case of the wet table, if it has several
    #[arg(long, value_name = "CASE")]
    pub wet_case: Option<String>,
    /// Case of the dry table, if it has several
    #[arg(long, value_name = "CASE")]
    pub dry_case: Option<String>,
    /// The curves.
    #[command(flatten)]
    #[serde(flatten)]
    pub measured: CurveOptions,
    /// Experiment file of the wet chain, a section of it with `wet = true`
    #[arg(long, short, value_name = "FILE")]
    #[serde(skip_serializing)]
    pub model: Option<PathBuf>,
    /// Wet chain that comes with the program; its oil's own numbers play no part. The paper's, `pump`,
    /// where no model is named, which the first line says
    #[arg(long, short, value_name = "NAME")]
    #[serde(skip_serializing)]
    pub preset: Option<String>,
    /// Experiment file of the dry chain
    #[arg(long, value_name = "FILE")]
    #[serde(skip_serializing)]
    pub dry_model: Option<PathBuf>,
    /// Dry chain that comes with the program; the paper's, `dry`, where no model is named, which the
    /// first line says
    #[arg(long, value_name = "NAME")]
    #[serde(skip_serializing)]
    pub dry_preset: Option<String>,
    /// Free numbers of the dry contacts, by names that both models know
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_value = "aisi316.eta,dry.B")]
    pub dry_free: Vec<String>,
    /// Numbers that each chain has for itself, by names that both models know, such as the load that
    /// friction holds in a tapped row (near_end.force); fitted anew with every oil
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub own: Vec<String>,
    /// Numbers of a film on the wet contacts (viscosity, pressure_viscosity, volume) that are free in
    /// place of K and A: the first at each speed, all over both curves together; no oils are compared
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with = "oils")]
    pub film: Vec<String>,
    /// Systematic errors that both curves share, as nuisance parameters: delay=0.2us, reflected_delay,
    /// skew (of the wall's channel), speed_scale=1%, radius_error=1um, or any number that can be free
    #[arg(long, value_name = "NAME=SD", value_delimiter = ',')]
    #[serde(with = "pairs")]
    pub systematic: Vec<Assignment>,
    /// Table (CSV) of further oils, with the columns of the program's own
    #[arg(long, value_name = "FILE")]
    #[serde(skip_serializing)]
    pub oils: Option<PathBuf>,
    /// Relative accuracy of the model's times of flight
    #[arg(long, short, value_name = "NUMBER", default_value = "1e-5", allow_hyphen_values = true)]
    pub accuracy: Accuracy,
    /// Threads; all cores when absent; results do not depend on it
    #[arg(long, value_name = "COUNT", allow_hyphen_values = true)]
    #[serde(skip_serializing)]
    pub threads: Option<Threads>,
    /// Print JSON
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
    /// Write gauge.json, contacts.csv and a figure (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    #[serde(skip_serializing)]
    pub out: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    #[serde(skip_serializing)]
    pub force: bool,
}

names! {
    /// Ways to determine uncertainty.
    Method {
        /// By the curvature at the best fit
        Covariance,
        /// By how the fit worsens as each parameter is moved and the others follow
        Profile,
        /// By sampling the posterior
        Posterior,
    }
}

impl ModelOptions {
    /// The same of another model, a file or a preset.
    pub(crate) fn of_other(&self, model: &str) -> Self {
        let file = Some(PathBuf::from(model)).filter(|file| crate::input::is_file(file));
        let preset = file.is_none().then(|| model.to_owned());
        Self { preset, model: file, ..self.clone() }
    }
}

fn name(text: &str) -> Result<String, String> {
    match text.trim() {
        "" => Err("expected names between commas, such as eta,B".to_owned()),
        _ => Ok(text.to_owned()),
    }
}
