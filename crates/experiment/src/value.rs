//! One value of a file in SI, or what is wrong with it.

use crate::document::{Node, Number, Value};
use crate::finding::Problem;
use crate::keys::Limits;
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

    /// "a length in m, such as "6.35 mm"".
    fn words(&self) -> String {
        let dimension = self.dimension();
        if self.units == Units::Dimensionless || dimension == Dimension::NONE {
            return format!("expected a plain number, {}", self.limits.words);
        }
        let (name, example) = (dimension.name(), dimension.example());
        format!("expected {name} in {}, such as \"{example}\"", self.unit)
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
        Err(self.problem(node, format!("`{}` has no unit", self.name)))
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
            format!("`{}` has no unit", self.name)
        } else if self.units == Units::Dimensionless {
            format!("`{}` has a unit in a dimensionless file", self.name)
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
        if self.limits.hold(si.value) {
            return Ok(si);
        }
        let unit = match (self.unit, self.units) {
            ("1", _) | (_, Units::Dimensionless) => String::new(),
            (unit, Units::Si) => format!(" {unit}"),
        };
        let message = format!(
            "`{}` is {}{unit}, but must be {}",
            self.name, si.value, self.limits.words
        );
        Err(self.problem(node, message))
    }
}
