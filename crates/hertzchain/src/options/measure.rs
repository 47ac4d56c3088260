//! Options of `measure`.

use super::values::texts;
use super::{
    Corner, Count, Delay, Filter, Frequency, Sensitivity, Share, Speed, Time, TimeUnit, Voltage,
};
use clap::Args;
use hertzchain_measure::records::{Rows, SampleKind};
use hertzchain_measure::signal::Polarity;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Options of `measure`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct MeasureOptions {
    /// Recordings: HDF5, MATLAB, CSV and other text, NPY, NPZ, WAV, TDMS; or folders of them
    #[arg(required = true, value_name = "RECORD")]
    #[serde(skip_serializing)]
    pub records: Vec<PathBuf>,
    /// Experiment file or preset of the rig: number of beads, sensor bead, photogate, both corners of the amplifier
    #[arg(long, value_name = "FILE")]
    pub rig: Option<PathBuf>,
    /// Table (CSV) with a line a file: file, case, speed, speed error; and shot, if files hold several
    #[arg(long, value_name = "CSV")]
    pub shots: Option<PathBuf>,
    /// What files leave open.
    #[command(flatten)]
    #[serde(flatten)]
    pub reading: ReadingOptions,
    /// How pulses are found and timed.
    #[command(flatten)]
    #[serde(flatten)]
    pub picking: PickOptions,
    /// Standard error of speeds in m/s where neither file nor table gives one
    #[arg(long, value_name = "SPEED")]
    pub speed_error: Option<Speed>,
    /// Speeds at most so far apart, in m/s, are one
    #[arg(long, value_name = "SPEED", default_value = "0.01")]
    pub speed_gap: Speed,
    /// Case that others are divided by
    #[arg(long, value_name = "CASE", default_value = "dry")]
    pub reference: String,
    /// Let clipped shots, those of doubtful order and those of which a pulse may be lost count in means
    #[arg(long)]
    pub keep_dubious: bool,
    /// Write a page (HTML) with a plot of every flagged shot
    #[arg(long, value_name = "FILE")]
    #[serde(skip_serializing)]
    pub report: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    #[serde(skip_serializing)]
    pub json: bool,
    /// Write tables (CSV), everything (JSON) and figures (SVG, PNG) into this folder
    #[arg(long, short, value_name = "DIR")]
    #[serde(skip_serializing)]
    pub out: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    #[serde(skip_serializing)]
    pub force: bool,
}

/// Options of `live`.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct LiveOptions {
    /// How recordings are read and measured.
    #[command(flatten)]
    #[serde(flatten)]
    pub measured: MeasureOptions,
    /// Type of the samples of a stream, little-endian; those of its channels alternate
    #[arg(long, value_enum, value_name = "TYPE", default_value = "i16")]
    pub samples: SampleType,
    /// Channels of a stream: 1 that sums both sensors, or 2, the sensor bead's and the wall's
    #[arg(long, value_name = "COUNT", default_value = "1", value_parser = clap::value_parser!(u8).range(1..=2))]
    pub channels: u8,
    /// Experiment file or preset of the model that proposes the next measurement
    #[arg(long, value_name = "FILE", requires = "free")]
    pub model: Option<String>,
    /// Numbers of the model that the next measurement is to determine best, such as eta,B
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "model")]
    pub free: Vec<String>,
    /// End when nothing has come for so long
    #[arg(long, value_name = "TIME")]
    pub stop_after: Option<Time>,
}

names! {
    /// Types of samples by name.
    SampleType for SampleKind {
        /// Whole numbers of 16 bits
        I16,
        /// Whole numbers of 32 bits
        I32,
        /// Floating-point numbers of 32 bits
        F32,
        /// Floating-point numbers of 64 bits
        F64,
    }
}

/// What files leave open.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct ReadingOptions {
    /// Sampling rate where a file does not say, such as 1MHz or 500kS/s; a plain number is in Hz
    #[arg(long, value_name = "RATE")]
    pub rate: Option<Frequency>,
    /// Take --rate even where a file says another
    #[arg(long, requires = "rate")]
    pub trust_rate: bool,
    /// Channel, column or array by name or by number from 1; twice: the sensor bead's, the wall's
    #[arg(long, value_name = "NAME")]
    #[serde(deserialize_with = "texts")]
    pub channel: Vec<String>,
    /// Unit of a column of times that names none: s, ms, us or ns
    #[arg(long, value_name = "UNIT")]
    pub time_unit: Option<TimeUnit>,
    /// Cut longer recordings into shots of so many samples
    #[arg(long, value_name = "COUNT")]
    pub shot_samples: Option<Count>,
    /// Cut recordings into shots where they pass so many volts; --shot-samples is then their length, else 10 ms
    #[arg(long, value_name = "VOLTS", allow_hyphen_values = true)]
    pub level: Option<Voltage>,
    /// Take every record for one shot; such that hold several are flagged and count in no mean
    #[arg(long, conflicts_with_all = ["level", "shot_samples"])]
    pub whole: bool,
    /// What the first axis of a two-dimensional array is; by its shape when absent
    #[arg(long, value_enum, value_name = "WHAT")]
    pub rows: Option<RowsAre>,
}

/// How pulses are found and timed.
#[derive(Clone, Debug, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct PickOptions {
    /// How a pulse is timed; docs/explanation/picking.md says what each is worth
    #[arg(long, value_enum, value_name = "NAME", default_value = "local")]
    pub method: MethodName,
    /// Share of its height at which --method onset times a pulse; 0.5 when absent
    #[arg(long, value_name = "SHARE")]
    pub onset: Option<Share>,
    /// Number N of beads; with --sensor bounds when pulses can come
    #[arg(long, value_name = "COUNT", requires = "sensor")]
    pub beads: Option<Count>,
    /// Number n of the sensor bead, counted from the striker
    #[arg(long, value_name = "NUMBER", requires = "beads")]
    pub sensor: Option<Count>,
    /// Which way pulses point; by the larger swing when absent
    #[arg(long, value_enum, value_name = "WAY")]
    pub polarity: Option<Way>,
    /// The same for the wall's channel, if it has one
    #[arg(long, value_enum, value_name = "WAY")]
    pub wall_polarity: Option<Way>,
    /// Smooth records by a low-pass without delay, forward and backward, of this corner
    #[arg(long, value_name = "FREQUENCY")]
    pub smooth: Option<Corner>,
    /// Corner of the amplifier's low-pass, such as 180kHz, in place of the rig's: its delay and rounding are
    /// taken out of maxima; 0 leaves them
    #[arg(long, value_name = "FREQUENCY")]
    pub low_pass: Option<Corner>,
    /// Order and kind of the amplifier's low-pass; the rig's, the recording's, or one pole, when absent
    #[arg(long, value_enum, value_name = "NAME")]
    pub filter: Option<Filter>,
    /// Corner of the AC coupling (high-pass) that the signal went through, such as 0.5Hz: its droop is corrected; 0 leaves it, also where a recording states a corner
    #[arg(long, value_name = "RATE")]
    pub ac_coupling: Option<Corner>,
    /// Frequency of the mains, such as 50Hz: hum in the record before a shot is held at its multiples
    #[arg(long, value_name = "FREQUENCY")]
    pub mains: Option<Corner>,
    /// Sensitivity of the sensor bead's sensor, such as 12mV/N: heights are also stated in N
    #[arg(long, value_name = "V/N")]
    pub sensitivity: Option<Sensitivity>,
    /// The same of the wall's sensor, if it is another: ratios of peaks are those of forces
    #[arg(long, value_name = "V/N", requires = "sensitivity")]
    pub wall_sensitivity: Option<Sensitivity>,
    /// By how much the wall's channel is late, such as 1.5us; with two channels
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub skew: Option<Delay>,
}

names! {
    /// Picking methods by name.
    MethodName {
        /// At the maximum of a bell of free skewness fitted about the peak
        Local,
        /// Where the rising flank passes a share of the height
        Onset,
        /// Where the passing pulse, as a template, correlates best
        Correlation,
        /// Where a bell of free height and width fits best
        Shape,
    }
}

names! {
    /// Directions by name.
    Way for Polarity {
        /// Up
        Positive,
        /// Down
        Negative,
    }
}

names! {
    /// First axes by name.
    RowsAre for Rows {
        /// A row is a shot
        Shots,
        /// A row is a channel
        Channels,
        /// A row is a moment, a column a channel
        Times,
        /// A row is a moment, a column a shot
        Moments,
    }
}
