//! Values of options: from text with or without a unit, or from a JSON number in SI.

use super::given::has_unit;
use clap::ValueEnum;
use hertzchain_experiment::units::parse_in;
use hertzchain_infer::{FEWEST_SHOTS, Kind};
use hertzchain_sim::Shard;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;
use std::str::FromStr;

/// A JSON value that stands for an option's text.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number or a text")]
pub(super) enum Text {
    Whole(i64),
    Number(f64),
    Words(String),
}

impl Display for Text {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(number) => write!(f, "{number}"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Words(text) => write!(f, "{text}"),
        }
    }
}

pub(super) fn from_text<'de, D: Deserializer<'de>, T: FromStr<Err: Display>>(
    source: D,
) -> Result<T, D::Error> {
    let text = Text::deserialize(source)?;
    text.to_string().parse().map_err(D::Error::custom)
}

/// A list of texts, some of which may be numbers.
pub(super) fn texts<'de, D: Deserializer<'de>>(source: D) -> Result<Vec<String>, D::Error> {
    Ok(Vec::<Text>::deserialize(source)?.iter().map(Text::to_string).collect())
}

/// A part of a whole, such as 1/4, where it may be absent.
pub(super) fn some_shard<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Shard>, D::Error> {
    from_text(source).map(Some)
}

/// Speeds as text: a range, or a list of numbers.
pub(super) fn speeds<'de, D: Deserializer<'de>>(source: D) -> Result<String, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected speeds: a range as text, or a list of numbers")]
    enum Speeds {
        List(Vec<Text>),
        One(Text),
    }
    Ok(match Speeds::deserialize(source)? {
        Speeds::List(list) => list.iter().map(Text::to_string).collect::<Vec<_>>().join(","),
        Speeds::One(text) => text.to_string(),
    })
}

/// The same where they may be absent.
pub(super) fn some_speeds<'de, D: Deserializer<'de>>(
    source: D,
) -> Result<Option<String>, D::Error> {
    speeds(source).map(Some)
}

/// Declares a number that is read from text, for the command line and JSON alike; of one that needs
/// a unit, a JSON number is in that of SI.
macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident($inner:ty)$( in $unit:literal)?: $expected:expr, $read:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
        pub struct $name(pub $inner);

        impl FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                let read: fn(&str) -> Option<$inner> = $read;
                read(text.trim()).map(Self).ok_or_else(|| format!("expected {}", $expected))
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
                let text = match Text::deserialize(source)? {
                    Text::Words(text) => text,
                    number => format!("{number}{}", concat!("", $(" ", $unit)?)),
                };
                text.parse().map_err(D::Error::custom)
            }
        }
    )*};
}

/// As [`number`], of a text with a unit: between 5 s and 5 us, or 180 Hz and 180 kHz, lie factors of
/// 1000 and more. 0 needs none.
fn quantity(text: &str, unit: &str) -> Option<f64> {
    number(text, unit).filter(|value| *value == 0.0 || has_unit(text))
}

fn number(text: &str, unit: &str) -> Option<f64> {
    parse_in(text, unit).ok().filter(|value| value.is_finite())
}

fn hertz(text: &str) -> Option<f64> {
    number(&text.replace("S/s", "Hz"), "Hz").filter(|rate| *rate == 0.0 || rate.is_normal())
}

fn whole(text: &str, most: usize) -> Option<usize> {
    text.parse().ok().filter(|count| (1..=most).contains(count))
}

numbers! {
    /// A relative accuracy of times of flight.
    Accuracy(f64): "a number between 1e-13 and 1e-2, such as 1e-6",
        |text| text.parse().ok().filter(|number| (1e-13..=1e-2).contains(number));
    /// A number of threads.
    Threads(usize): "a whole number from 1 to 1024", |text| whole(text, 1024);
    /// A whole number from 1 on.
    Count(usize): "a whole number from 1 on", |text| whole(text, usize::MAX);
    /// A whole number from 1 to 1000.
    UpTo1000(usize): "a whole number from 1 to 1000", |text| whole(text, 1000);
    /// A speed in m/s that is not negative.
    Speed(f64): "a speed or 0, such as 0.7mm/s, or 7e-4 for m/s",
        |text| number(text, "m/s").filter(|speed| *speed >= 0.0);
    /// A positive time in s.
    Time(f64): "a positive time, such as 0.5us, or 5e-7 for s",
        |text| number(text, "s").filter(|time| *time > 0.0);
    /// A time in s that may be negative.
    Delay(f64) in "s": "a time with its unit, such as 0.5us or -0.5us", |text| quantity(text, "s");
    /// A sensitivity in V/N.
    Sensitivity(f64) in "V/N": "a positive sensitivity with its unit, such as 12mV/N",
        |text| quantity(text, "V/N").filter(|sensitivity| *sensitivity > 0.0);
    /// A positive frequency or sampling rate in Hz.
    Frequency(f64): "a rate such as 1MHz, 500kS/s or 1e6", |text| hertz(text).filter(|rate| *rate > 0.0);
    /// A frequency in Hz, or 0 for none.
    Corner(f64) in "Hz": "a frequency with its unit, such as 180kHz or 0.5Hz, or 0 for none",
        |text| hertz(text).filter(|rate| *rate == 0.0 || (*rate > 0.0 && has_unit(text)));
    /// A voltage in V.
    Voltage(f64): "volts such as 0.2 or -0.2", |text| number(text, "V");
    /// A share between 0 and 1.
    Share(f64): "a number between 0 and 1",
        |text| text.parse().ok().filter(|share| *share > 0.0 && *share < 1.0);
    /// A positive number.
    Positive(f64): "a positive number, such as 0.01",
        |text| text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    /// A unit of time in s.
    TimeUnit(f64): "s, ms, us or ns", |text| match text {
        "s" => Some(1.0),
        "ms" => Some(1e-3),
        "us" | "µs" => Some(1e-6),
        "ns" => Some(1e-9),
        _ => None,
    };
}

/// The number of shots from whose scatter standard errors come; `None` if errors are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorShots(pub Option<u32>);

impl FromStr for ErrorShots {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let count = || text.trim().parse().ok().filter(|count| *count >= FEWEST_SHOTS);
        named(text, "known", count).map(Self).ok_or_else(|| {
            format!(
                "expected a whole number from {FEWEST_SHOTS}, or known: the scatter of fewer shots gives no error of a \
                 row; take one over many rows"
            )
        })
    }
}

/// A preload force in N that could be tried; `None` for none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preload(pub Option<f64>);

impl FromStr for Preload {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let force = || number(text.trim(), "N").filter(|force| *force >= 0.0);
        named(text, "none", force).map(Self).ok_or_else(|| {
            "expected a force that is not negative, such as 0.24N, or none".to_owned()
        })
    }
}

/// `Some(None)` for a name, else a value if there is one.
fn named<T>(text: &str, name: &str, value: impl FnOnce() -> Option<T>) -> Option<Option<T>> {
    if text.trim() == name { Some(None) } else { value().map(Some) }
}

/// A number of the model and the text of its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Name.
    pub name: String,
    /// Text after the sign.
    pub text: String,
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').filter(|(name, _)| !name.trim().is_empty());
        let (name, text) = parts.ok_or("expected NAME=VALUE, such as eta=3.2e4")?;
        Ok(Self { name: name.trim().to_owned(), text: text.trim().to_owned() })
    }
}

impl Display for Assignment {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.text)
    }
}

/// Another model of the same data, and what is free in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Against {
    /// File or preset.
    pub model: String,
    /// What is free in it.
    pub free: Vec<String>,
}

impl FromStr for Against {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=');
        let (model, free) = parts.ok_or("expected MODEL=NAMES, such as hertz-viscoelastic=eta")?;
        let free = free.split(',').map(|name| name.trim().to_owned()).collect();
        Ok(Self { model: model.trim().to_owned(), free })
    }
}

/// A further table of a fit, with its model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Also {
    /// The table.
    pub data: PathBuf,
    /// File or preset.
    pub model: String,
    /// Case of a table of several.
    pub case: Option<String>,
}

impl FromStr for Also {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('=').filter(|(data, model)| !data.is_empty() && !model.is_empty());
        let (data, model) = parts
            .ok_or("expected DATA=MODEL or DATA=MODEL,CASE, such as pushed.csv=pushed.toml")?;
        let (model, case) =
            model.split_once(',').map_or((model, None), |(model, case)| (model, Some(case)));
        Ok(Self { data: data.into(), model: model.to_owned(), case: case.map(str::to_owned) })
    }
}

/// The cost of a way to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The way.
    pub of: WayKind,
    /// Its cost, in the unit of the others.
    pub value: f64,
}

names! {
    /// Ways to measure, by name.
    WayKind for Kind {
        /// Incident times alone
        Incident,
        /// Reflected times too
        Reflected,
        /// And the ratio of reflected to incident peaks
        Ratio,
        /// A sensor in another bead
        Sensor,
        /// A push on bead 1
        Preload,
    }
}

impl FromStr for Cost {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "expected WAY=NUMBER with a positive number, such as sensor=10; ways are incident, reflected, \
                        ratio, sensor, preload";
        let (of, value) = text.split_once('=').ok_or(expected)?;
        let of = WayKind::from_str(of.trim(), false).map_err(|_| expected)?;
        let value: Positive = value.parse().map_err(|_| expected)?;
        Ok(Self { of, value: value.0 })
    }
}

impl Display for ErrorShots {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.map_or("known".to_owned(), |shots| shots.to_string()).fmt(f)
    }
}

impl Display for Preload {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.map_or("none".to_owned(), |force_n| force_n.to_string()).fmt(f)
    }
}

impl Display for Against {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.model, self.free.join(","))
    }
}

impl Display for Also {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.data.display(), self.model)?;
        self.case.iter().try_for_each(|case| write!(f, ",{case}"))
    }
}

impl Display for Cost {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let way = self.of.to_possible_value();
        write!(f, "{}={}", way.as_ref().map_or("", |way| way.get_name()), self.value)
    }
}

/// Serde for values that are text in JSON, too.
macro_rules! texts {
    ($($name:ident)*) => {$(
        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, into: S) -> Result<S::Ok, S::Error> {
                into.collect_str(self)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
                from_text(source)
            }
        }
    )*};
}

texts!(ErrorShots Preload Against Also);

/// Serde of `NAME=VALUE` lists as an object `{"NAME": value}`; `[a, b]` joins two values by the sign
/// that the option has between them.
pub(super) mod pairs {
    use super::*;

    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number or a text, or a pair of them")]
    enum Entry {
        One(Text),
        Two([Option<Text>; 2]),
    }

    pub(in super::super) fn serialize<T: Display, S: Serializer>(
        pairs: &[T],
        into: S,
    ) -> Result<S::Ok, S::Error> {
        let texts = pairs.iter().map(ToString::to_string);
        let texts: Vec<String> = texts.collect();
        into.collect_map(texts.iter().filter_map(|text| text.split_once('=')))
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>, T: FromStr<Err = String>>(
        source: D,
    ) -> Result<Vec<T>, D::Error> {
        joined(source, ":")
    }

    fn joined<'de, D: Deserializer<'de>, T: FromStr<Err = String>>(
        source: D,
        sign: &str,
    ) -> Result<Vec<T>, D::Error> {
        let entries = BTreeMap::<String, Entry>::deserialize(source)?.into_iter();
        let pair = |(name, entry)| match entry {
            Entry::One(one) => format!("{name}={one}").parse(),
            Entry::Two(two) => {
                let [first, second] =
                    two.map(|one| one.map_or(String::new(), |one| one.to_string()));
                format!("{name}={first}{sign}{second}").parse()
            }
        };
        entries.map(pair).collect::<Result<_, String>>().map_err(D::Error::custom)
    }

    /// Of priors: mean and standard deviation.
    pub(in super::super) fn priors<'de, D: Deserializer<'de>>(
        source: D,
    ) -> Result<Vec<Assignment>, D::Error> {
        joined(source, "+-")
    }
}
