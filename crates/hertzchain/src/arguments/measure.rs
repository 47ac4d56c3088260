//! Arguments of `measure`.

use super::infer::Filter;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `measure`.
#[derive(Debug, Args)]
pub struct Measure {
    /// Recordings: HDF5 of a campaign, CSV and other text, NPY, NPZ, WAV, TDMS; or folders of them
    #[arg(required = true, value_name = "RECORD")]
    pub records: Vec<PathBuf>,
    /// Experiment file or preset of the rig: number of beads, sensor bead, photogate, both corners of the amplifier
    #[arg(long, value_name = "FILE")]
    pub rig: Option<PathBuf>,
    /// Table (CSV) with a line a file: file, case, speed, speed error; and shot, if files hold several
    #[arg(long, value_name = "CSV")]
    pub shots: Option<PathBuf>,
    /// What files leave open.
    #[command(flatten)]
    pub reading: Reading,
    /// How pulses are found and timed.
    #[command(flatten)]
    pub picking: Picking,
    /// Standard error of speeds in m/s where neither file nor table tells one
    #[arg(long, value_name = "SPEED", value_parser = not_negative)]
    pub speed_error: Option<f64>,
    /// Speeds at most so far apart, in m/s, are one
    #[arg(long, value_name = "SPEED", default_value = "0.01", value_parser = not_negative)]
    pub speed_gap: f64,
    /// Case that others are divided by
    #[arg(long, value_name = "CASE", default_value = "dry")]
    pub reference: String,
    /// Let clipped shots, those of doubtful order and those of which a pulse may be lost count in means
    #[arg(long)]
    pub keep_dubious: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write tables (CSV), everything (JSON) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What files leave open.
#[derive(Debug, Args)]
pub struct Reading {
    /// Sampling rate where a file does not say, such as 1MHz or 500kS/s; a plain number is in Hz
    #[arg(long, value_name = "RATE", value_parser = rate)]
    pub rate: Option<f64>,
    /// Take --rate even where a file says another
    #[arg(long, requires = "rate")]
    pub trust_rate: bool,
    /// Channel, column or array by name or by number from 1; twice: the sensor bead's, the wall's
    #[arg(long, value_name = "NAME")]
    pub channel: Vec<String>,
    /// Unit of a column of times that names none: s, ms, us or ns
    #[arg(long, value_name = "UNIT", value_parser = time_unit)]
    pub time_unit: Option<f64>,
    /// Cut longer recordings into shots of so many samples
    #[arg(long, value_name = "COUNT", value_parser = count)]
    pub shot_samples: Option<usize>,
    /// Cut recordings into shots where they pass so many volts; --shot-samples is then their length, else 10 ms
    #[arg(long, value_name = "VOLTS", value_parser = volts, allow_hyphen_values = true)]
    pub level: Option<f64>,
    /// Take every record for one shot, also where several with quiet between them are plain
    #[arg(long, conflicts_with_all = ["level", "shot_samples"])]
    pub whole: bool,
    /// What the first axis of a two-dimensional array is; by its shape when absent
    #[arg(long, value_enum, value_name = "WHAT")]
    pub rows: Option<RowsAre>,
}

/// How pulses are found and timed.
#[derive(Debug, Args)]
pub struct Picking {
    /// How a pulse's time is told; docs/measuring.md says what each is worth
    #[arg(long, value_enum, value_name = "NAME", default_value = "local")]
    pub method: MethodName,
    /// Share of its height at which `onset` times a pulse
    #[arg(long, value_name = "SHARE", default_value = "0.5", value_parser = share)]
    pub onset: f64,
    /// Number N of beads; with --sensor bounds when pulses can come
    #[arg(long, value_name = "COUNT", requires = "sensor", value_parser = count)]
    pub beads: Option<usize>,
    /// Number n of the sensor bead, counted from the striker
    #[arg(long, value_name = "NUMBER", requires = "beads", value_parser = count)]
    pub sensor: Option<usize>,
    /// Which way pulses point; by the larger swing when absent
    #[arg(long, value_enum, value_name = "WAY")]
    pub polarity: Option<Way>,
    /// The same for the wall's channel, if it has one
    #[arg(long, value_enum, value_name = "WAY")]
    pub wall_polarity: Option<Way>,
    /// Smooth records by a low-pass without delay, forward and backward, of this corner
    #[arg(long, value_name = "FREQUENCY", value_parser = rate)]
    pub smooth: Option<f64>,
    /// Corner of the amplifier's low-pass, such as 180kHz, in place of the rig's: its delay and rounding are
    /// taken out of maxima; 0 leaves them
    #[arg(long, value_name = "FREQUENCY", value_parser = rate_or_none)]
    pub low_pass: Option<f64>,
    /// Order and kind of the amplifier's low-pass; the rig's, or one pole, when absent
    #[arg(long, value_enum, value_name = "NAME")]
    pub filter: Option<Filter>,
    /// Corner of the AC coupling (high-pass) that the signal went through, such as 0.5Hz: its droop is corrected; 0 leaves it, also where a recording states a corner
    #[arg(long, value_name = "RATE", value_parser = rate_or_none)]
    pub ac_coupling: Option<f64>,
    /// The former name of --ac-coupling, rejected since it reads as a filter to be applied
    #[arg(long, hide = true, value_parser = renamed)]
    pub high_pass: Option<f64>,
    /// The former name of --low-pass, rejected since `fit` has the other one
    #[arg(long, hide = true, value_parser = renamed_low_pass)]
    pub bandwidth: Option<f64>,
    /// The former name of --filter
    #[arg(long, hide = true, value_parser = renamed_low_pass)]
    pub bandwidth_order: Option<f64>,
}

/// Picking methods by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// At the maximum of a bell of free skewness fitted about the peak
    Local,
    /// Where the rising flank passes a share of the height
    Onset,
    /// Where the passing pulse, as a template, correlates best
    Correlation,
    /// Where a bell of free height and width fits best
    Shape,
}

/// Directions by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Way {
    /// Up
    Positive,
    /// Down
    Negative,
}

/// First axes by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RowsAre {
    /// A row is a shot
    Shots,
    /// A row is a channel
    Channels,
    /// A row is a moment, a column a channel
    Times,
    /// A row is a moment, a column a shot
    Moments,
}

/// Units of a rate in Hz.
const RATES: [(&str, f64); 8] = [
    ("GHz", 1e9),
    ("MHz", 1e6),
    ("kHz", 1e3),
    ("Hz", 1.0),
    ("GS/s", 1e9),
    ("MS/s", 1e6),
    ("kS/s", 1e3),
    ("S/s", 1.0),
];

fn time_unit(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 5] = [
        ("s", 1.0),
        ("ms", 1e-3),
        ("us", 1e-6),
        ("µs", 1e-6),
        ("ns", 1e-9),
    ];
    let unit = UNITS.iter().find(|unit| unit.0 == text.trim());
    let size = unit.map(|unit| unit.1);
    size.ok_or_else(|| "expected s, ms, us or ns".to_owned())
}

fn volts(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('V').trim().parse().ok();
    let number = number.filter(|volts: &f64| volts.is_finite());
    number.ok_or_else(|| "expected volts such as 0.2 or -0.2".to_owned())
}

/// A sampling rate in Hz, with or without a unit.
pub fn rate(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let with_unit = RATES.iter().find_map(|(unit, size)| {
        let number = text.strip_suffix(unit)?;
        Some((number.trim(), *size))
    });
    let (number, size) = with_unit.unwrap_or((text, 1.0));
    let rate = number.parse().ok().map(|number: f64| number * size);
    let rate = rate.filter(|rate| rate.is_normal() && *rate > 0.0);
    rate.ok_or_else(|| "expected a rate such as 1MHz, 500kS/s or 1e6".to_owned())
}

/// Rejects the former name of --ac-coupling.
fn renamed(_: &str) -> Result<f64, String> {
    Err("no filter is applied: --ac-coupling (ac_coupling in Python) is the corner of the AC coupling \
         whose droop is corrected"
        .to_owned())
}

/// Rejects the former names of --low-pass and --filter.
fn renamed_low_pass(_: &str) -> Result<f64, String> {
    Err("the amplifier's low-pass is stated by --low-pass (its corner) and --filter (order and kind); in Python \
         low_pass and filter"
        .to_owned())
}

/// A rate, or 0.
fn rate_or_none(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(0.0) => Ok(0.0),
        _ => rate(text),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches("m/s").trim().parse().ok();
    let number = number.filter(|number: &f64| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "expected a speed in m/s such as 0.003".to_owned())
}

fn share(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|share: &f64| *share > 0.0 && *share < 1.0);
    number.ok_or_else(|| "expected a number between 0 and 1".to_owned())
}

fn count(text: &str) -> Result<usize, String> {
    let number = text.trim().parse().ok().filter(|count| *count > 0);
    number.ok_or_else(|| "expected a whole number from 1 on".to_owned())
}
