//! Speeds and times whose units must suit the experiment's.

use super::values::Text;
use crate::failure::Failure;
use hertzchain_experiment::Units;
use hertzchain_experiment::units::{Dimension, parse_quantity};
use hertzchain_sim::{StudyError, parse_speed, parse_time};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A speed or time as given, before it is known whether the experiment has units.
#[derive(Clone, Debug)]
pub struct Given {
    text: String,
    value: f64,
    has_unit: bool,
    /// An example with a unit where an SI experiment asks for one.
    asks_unit: Option<&'static str>,
}

impl Given {
    /// Returns a speed; a plain number is in m/s, or dimensionless.
    pub(crate) fn speed(text: &str) -> Result<Self, StudyError> {
        Ok(Self {
            text: text.trim().to_owned(),
            has_unit: has_unit(text),
            ..Self::plain(parse_speed(text)?)
        })
    }

    /// Returns a speed in m/s, or dimensionless; one that no striker has is reported when it is used.
    pub(super) fn plain(value: f64) -> Self {
        Self { text: value.to_string(), value, has_unit: false, asks_unit: None }
    }

    /// Returns a time; a plain number only suits a dimensionless experiment.
    pub(crate) fn time(text: &str) -> Result<Self, StudyError> {
        let asks_unit = Some("2 ms");
        let (has_unit, value) = (has_unit(text), parse_time(text)?);
        Ok(Self { text: text.trim().to_owned(), value, has_unit, asks_unit })
    }

    pub(crate) const fn value(&self) -> f64 {
        self.value
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Rejects a unit in a dimensionless experiment, and a time without one in SI: between 2 s and
    /// 2 ms lies a factor of 1000.
    pub(crate) fn check(&self, option: &str, units: Units) -> Result<(), Failure> {
        match (units, self.has_unit, self.asks_unit) {
            (Units::Dimensionless, true, _) => Err(dimensionless(option, &self.text)),
            (Units::Si, false, Some(example)) => Err(Failure::User(format!(
                "{option} {} has no unit; expected one, such as \"{example}\"",
                self.text
            ))),
            _ => Ok(()),
        }
    }
}

impl Serialize for Given {
    fn serialize<S: Serializer>(&self, into: S) -> Result<S::Ok, S::Error> {
        into.serialize_str(&self.text)
    }
}

fn text<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Text>, D::Error> {
    Option::deserialize(source)
}

pub(super) fn some_speed<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Given>, D::Error> {
    let given = text(source)?.map(|text| Given::speed(&text.to_string()));
    given.transpose().map_err(D::Error::custom)
}

/// A JSON number is in SI, or dimensionless as the experiment.
pub(super) fn some_time<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Given>, D::Error> {
    let Some(text) = text(source)? else {
        return Ok(None);
    };
    let given = Given::time(&text.to_string()).map_err(D::Error::custom)?;
    let asks_unit = given.asks_unit.filter(|_| matches!(text, Text::Words(_)));
    Ok(Some(Given { asks_unit, ..given }))
}

/// Rejects units in a list of speeds for a dimensionless experiment.
///
/// # Errors
/// The option and the speed with a unit.
pub(crate) fn check_speeds(option: &str, speeds: &str, units: Units) -> Result<(), Failure> {
    let mut parts = speeds.split([',', ':']);
    match (units, parts.find(|part| has_unit(part))) {
        (Units::Dimensionless, Some(part)) => Err(dimensionless(option, part.trim())),
        _ => Ok(()),
    }
}

/// Whether a number has a unit.
pub(crate) fn has_unit(text: &str) -> bool {
    parse_quantity(text).is_ok_and(|quantity| quantity.dimension != Dimension::NONE)
}

fn dimensionless(option: &str, text: &str) -> Failure {
    Failure::User(format!(
        "{option} {text} has a unit, but the experiment is dimensionless; expected a plain \
         number in the file's own units, such as 0.5"
    ))
}
