//! Cells and names in result files.

use hertzchain_experiment::Units;
use serde_json::{Map, Value};

/// A number with the fewest digits that give it back exactly: tiny and huge
/// ones with an exponent, nothing for what is not a number.
pub(crate) fn cell(value: f64) -> String {
    let size = value.abs();
    match value.is_nan() {
        true => String::new(),
        false if value == 0.0 || (1e-3..1e6).contains(&size) => value.to_string(),
        false => format!("{value:e}"),
    }
}

/// The end of a column's name: its unit, none in a dimensionless chain.
pub(crate) fn suffix(unit: &str, units: Units) -> String {
    match units {
        Units::Si => format!("_{}", unit.replace('/', "_").to_lowercase()),
        Units::Dimensionless => String::new(),
    }
}

/// Ends of names that are units, longer ones first.
const UNITS: [&str; 6] = ["_per_s", "_m_s", "_s", "_m", "_n", "_j"];

/// A name without its unit.
pub(crate) fn without_unit(name: &str) -> &str {
    let stripped = UNITS.iter().find_map(|unit| name.strip_suffix(unit));
    stripped.unwrap_or(name)
}

/// Results with names as they suit the units: a dimensionless chain's have
/// none. Names of laws stay as they are.
pub(crate) fn named(results: Value, units: Units) -> Value {
    match (results, units) {
        (results, Units::Si) => results,
        (Value::Array(items), units) => items.into_iter().map(|i| named(i, units)).collect(),
        (Value::Object(fields), units) => {
            let rename = |(name, value): (String, Value)| match name.as_str() {
                "dissipated_j" => ("dissipated".to_owned(), value),
                _ => (without_unit(&name).to_owned(), named(value, units)),
            };
            Value::Object(fields.into_iter().map(rename).collect::<Map<_, _>>())
        }
        (other, _) => other,
    }
}

#[cfg(test)]
#[path = "tests/table.rs"]
mod tests;
