//! One value of a file in SI, or what is wrong with it.

use crate::document::{Node, Number, Value};
use crate::finding::Problem;
use crate::keys::{Limits, ranges};
use crate::units::{self, Dimension};

/// The unit system of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Units {
    /// Quantities with units.
    #[default]
    Si,
    /// Plain numbers, K = m = 1 unless written.
    Dimensionless,
}

impl Units {
    /// A number with its SI unit, which dimensionless files do not have.
    pub(crate) fn with_unit(self, number: &str, unit: &str) -> String {
        match self {
            Self::Si => format!("{number} {unit}"),
            Self::Dimensionless => number.to_owned(),
        }
    }
}

/// Ends of messages about a unit that is missing, or one too many.
pub(crate) const HAS_NONE: &str = "has no unit";
pub(crate) const HAS_ONE: &str = "has a unit in a dimensionless file";

/// A value in SI and half a unit of its last written digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Si {
    pub(crate) value: f64,
    pub(crate) half_digit: f64,
}

/// What a quantity must be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expected<'a> {
    pub(crate) name: &'a str,
    pub(crate) unit: &'a str,
    pub(crate) limits: Limits,
    pub(crate) units: Units,
}

impl Expected<'_> {
    fn dimension(&self) -> Dimension {
        if self.unit == "1" {
            return Dimension::NONE;
        }
        units::parse_unit(self.unit).map_or(Dimension::NONE, |unit| unit.dimension)
    }

    fn limits(&self) -> Limits {
        self.limits.within(self.units, self.unit)
    }

    /// "a length in m, such as "6.35 mm"".
    fn words(&self) -> String {
        let dimension = self.dimension();
        if self.units == Units::Dimensionless || dimension == Dimension::NONE {
            return format!("expected a plain number, {}", self.limits().words);
        }
        match dimension.known_name() {
            Some(name) => {
                let example = dimension.example();
                format!("expected {name} in {}, such as \"{example}\"", self.unit)
            }
            None => format!("expected a quantity in {0}, such as \"1 {0}\"", self.unit),
        }
    }

    fn problem(&self, node: &Node, message: String) -> Problem {
        Problem::new(&node.span, message, self.words())
    }

    /// The node's value in SI, within the limits.
    pub(crate) fn read(&self, node: &Node) -> Result<Si, Problem> {
        let si = match &node.value {
            Value::Number(number) => self.number(node, *number)?,
            Value::Text(text) => self.quantity(node, text)?,
            _ => {
                let message = format!("`{}` is {}, not a quantity", self.name, node.kind());
                return Err(self.problem(node, message));
            }
        };
        self.within(node, si)
    }

    fn number(&self, node: &Node, number: Number) -> Result<Si, Problem> {
        let plain = number.from_code || self.units == Units::Dimensionless;
        if plain || self.dimension() == Dimension::NONE {
            return Ok(Si {
                value: number.value,
                half_digit: number.half_digit,
            });
        }
        Err(self.problem(node, format!("`{}` {HAS_NONE}", self.name)))
    }

    fn quantity(&self, node: &Node, text: &str) -> Result<Si, Problem> {
        let found = units::parse_quantity(text)
            .map_err(|error| self.problem(node, format!("`{}`: {error}", self.name)))?;
        let expected = match self.units {
            Units::Si => self.dimension(),
            Units::Dimensionless => Dimension::NONE,
        };
        if found.dimension.agrees_with(&expected) {
            return Ok(Si {
                value: found.value,
                half_digit: found.half_digit,
            });
        }
        let message = if found.dimension == Dimension::NONE {
            format!("`{}` {HAS_NONE}", self.name)
        } else if self.units == Units::Dimensionless {
            format!("`{}` {HAS_ONE}", self.name)
        } else {
            format!("`{}` is {}", self.name, found.dimension.name())
        };
        Err(self.problem(node, message))
    }

    fn within(&self, node: &Node, si: Si) -> Result<Si, Problem> {
        if !si.value.is_finite() {
            let message = format!("`{}` is not a finite number", self.name);
            return Err(self.problem(node, message));
        }
        let size = si.value.abs();
        let extreme = size != 0.0 && !(ranges::SMALLEST..=ranges::LARGEST).contains(&size);
        let words = match (self.limits().hold(si.value), extreme) {
            (true, false) => return Ok(si),
            (true, true) => "0, or from 1e-100 to 1e100 in size",
            (false, _) if si.value <= 0.0 && self.limits().least > 0.0 => "positive",
            (false, _) => self.limits().words,
        };
        let message = format!(
            "`{}` is {}, but must be {words}",
            self.name,
            self.written(node, si)
        );
        Err(self.problem(node, message))
    }

    /// The value as the user wrote it; in SI when a program set it.
    fn written(&self, node: &Node, si: Si) -> String {
        match (&node.value, self.unit, self.units) {
            (Value::Text(text), _, _) => text.trim().to_owned(),
            (_, "1", _) | (_, _, Units::Dimensionless) => short(si.value),
            (_, unit, Units::Si) => format!("{} {unit}", short(si.value)),
        }
    }
}

/// A computed number for messages, to six digits.
pub(crate) fn rounded(value: f64) -> String {
    short(format!("{value:.5e}").parse().unwrap_or(value))
}

/// An estimate for messages, to two digits.
pub(crate) fn brief(value: f64) -> String {
    short(format!("{value:.1e}").parse().unwrap_or(value))
}

/// A number for messages: as short as it can be read back.
pub(crate) fn short(value: f64) -> String {
    match value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        true => format!("{value}"),
        false => format!("{value:e}"),
    }
}
