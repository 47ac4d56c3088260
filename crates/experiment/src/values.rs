//! Values of checked tables in SI: a key's unit and limits come from its declaration.

use crate::document::{Node, TomlNumber, TomlValue};
use crate::keys::{Fields, KeyKind, LARGEST, SMALLEST, ValueLimits};
use crate::report::{FileProblem, short};
use crate::units::{self, Dimension};
use std::ops::Range;

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

/// The quantity that a key must have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExpectedQuantity<'a> {
    pub(crate) name: &'a str,
    pub(crate) unit: &'a str,
    pub(crate) limits: ValueLimits,
    pub(crate) units: Units,
}

impl ExpectedQuantity<'_> {
    fn dimension(&self) -> Dimension {
        let unit = units::parse_unit(self.unit);
        unit.map_or(Dimension::NONE, |unit| unit.dimension)
    }

    fn limits(&self) -> ValueLimits {
        self.limits.within(self.units, self.unit)
    }

    fn problem(&self, node: &Node, wrong: &str) -> FileProblem {
        let (dimension, unit) = (self.dimension(), self.unit);
        let label = if self.units == Units::Dimensionless || dimension == Dimension::NONE {
            format!("expected a plain number, {}", self.limits().words)
        } else if let Some(name) = dimension.common_name() {
            let example = dimension.example();
            format!("expected {name} in {unit}, such as \"{example}\"")
        } else {
            format!("expected a quantity in {unit}, such as \"1 {unit}\"")
        };
        FileProblem::new(&node.span, format!("`{}`{wrong}", self.name), label)
    }

    /// The node's value in SI, within the limits.
    pub(crate) fn read(&self, node: &Node) -> Result<Si, FileProblem> {
        let si = match &node.value {
            TomlValue::Number(number) => self.number(node, *number)?,
            TomlValue::Text(text) => self.quantity(node, text)?,
            _ => return Err(self.problem(node, &format!(" is {}, not a quantity", node.kind()))),
        };
        self.within(node, si)
    }

    fn number(&self, node: &Node, number: TomlNumber) -> Result<Si, FileProblem> {
        let plain = number.from_code || self.units == Units::Dimensionless;
        match plain || self.dimension() == Dimension::NONE {
            true => Ok(Si { value: number.value, half_digit: number.half_digit }),
            false => Err(self.problem(node, &format!(" {HAS_NONE}"))),
        }
    }

    fn quantity(&self, node: &Node, text: &str) -> Result<Si, FileProblem> {
        let found = units::parse_quantity(text)
            .map_err(|error| self.problem(node, &format!(": {error}")))?;
        let expected = match self.units {
            Units::Si => self.dimension(),
            Units::Dimensionless => Dimension::NONE,
        };
        let wrong = if found.dimension.agrees_with(&expected) {
            return Ok(Si { value: found.value, half_digit: found.half_digit });
        } else if found.dimension == Dimension::NONE {
            HAS_NONE.to_owned()
        } else if self.units == Units::Dimensionless {
            HAS_ONE.to_owned()
        } else {
            format!("is {}", found.dimension.name())
        };
        Err(self.problem(node, &format!(" {wrong}")))
    }

    fn within(&self, node: &Node, si: Si) -> Result<Si, FileProblem> {
        if !si.value.is_finite() {
            return Err(self.problem(node, " is not a finite number"));
        }
        let size = si.value.abs();
        let extreme = size != 0.0 && !(SMALLEST..=LARGEST).contains(&size);
        let words = match (self.limits().hold(si.value), extreme) {
            (true, false) => return Ok(si),
            (true, true) => "0, or from 1e-100 to 1e100 in size",
            (false, _) if si.value <= 0.0 && self.limits().least > 0.0 => "positive",
            (false, _) => self.limits().words,
        };
        // As the user wrote it; in SI when a program set it.
        let written = match (&node.value, self.unit) {
            (TomlValue::Text(text), _) => text.trim().to_owned(),
            (_, "1") => short(si.value),
            (_, unit) => self.units.with_unit(&short(si.value), unit),
        };
        Err(self.problem(node, &format!(" is {written}, but must be {words}")))
    }
}

/// A whole number within limits.
pub(crate) fn whole(name: &str, least: i64, most: i64, node: &Node) -> Result<i64, FileProblem> {
    let label = match most {
        i64::MAX => format!("expected a whole number from {least}"),
        _ => format!("expected a whole number from {least} to {most}"),
    };
    let problem = |wrong: &str| FileProblem::new(&node.span, format!("`{name}` {wrong}"), &label);
    let TomlValue::Number(TomlNumber { value, .. }) = node.value else {
        return Err(problem(&format!("is {}", node.kind())));
    };
    // Whole numbers beyond 2^53 are not distinguished by a double.
    if value.fract() != 0.0 || value.abs() > 9e15 || !value.is_finite() {
        let wrong = if value.fract() == 0.0 { "too large" } else { "not a whole number" };
        return Err(problem(&format!("= {} is {wrong}", short(value))));
    }
    let found = value as i64;
    let inside = (least..=most).contains(&found).then_some(found);
    inside.ok_or_else(|| problem(&format!("= {found} is out of range")))
}

/// The keys of a power law of the striker's speed.
pub(crate) const POWER_LAW: [&str; 2] = ["prefactor", "exponent"];

/// A number that may be a power law of the striker's speed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpeedLaw {
    pub(crate) prefactor: f64,
    /// 0 for a plain number.
    pub(crate) exponent: f64,
    /// Of its value at any speed.
    pub(crate) limits: ValueLimits,
    pub(crate) span: Range<usize>,
}

/// One table of a file with the declaration of its keys.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TableView<'a> {
    pub(crate) node: &'a Node,
    pub(crate) fields: &'static Fields,
    pub(crate) units: Units,
}

impl<'a> TableView<'a> {
    pub(crate) fn span(&self) -> Range<usize> {
        self.node.span.clone()
    }

    /// Where a key's value stands, or the whole table.
    pub(crate) fn span_of(&self, name: &str) -> Range<usize> {
        self.node.get(name).unwrap_or(self.node).span.clone()
    }

    /// A problem with the value of a key, or with the whole table.
    pub(crate) fn problem(
        &self,
        name: &str,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> FileProblem {
        FileProblem::new(&self.span_of(name), message, label)
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.node.get(name).is_some()
    }

    /// A declared key with its value; `None` where the table lacks either.
    fn value(&self, name: &str) -> Option<(&'static KeyKind, &'a Node)> {
        Some((&self.fields.key(name)?.kind, self.node.get(name)?))
    }

    fn si(
        &self,
        name: &str,
        unit: &str,
        limits: ValueLimits,
        node: &Node,
    ) -> Result<f64, FileProblem> {
        let units = self.units;
        let expected = ExpectedQuantity { name, unit, limits, units };
        expected.read(node).map(|si| si.value)
    }

    /// A quantity in SI.
    pub(crate) fn quantity(&self, name: &str) -> Result<Option<f64>, FileProblem> {
        match self.value(name) {
            Some((KeyKind::Quantity(unit, limits), node)) => {
                self.si(name, unit, *limits, node).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// A quantity in SI that the check has seen to be there.
    pub(crate) fn needed(&self, name: &str) -> Result<f64, FileProblem> {
        let message = || format!("{} has no `{name}`", self.fields.title);
        let missing = || FileProblem::new(&self.node.span, message(), "expected here");
        self.quantity(name)?.ok_or_else(missing)
    }

    pub(crate) fn quantities(&self, name: &str) -> Result<Vec<f64>, FileProblem> {
        match self.value(name) {
            Some((KeyKind::Quantities(unit), node)) => (node.members().iter())
                .map(|member| self.si(name, unit, ValueLimits::ANY, member))
                .collect(),
            _ => Ok(Vec::new()),
        }
    }

    pub(crate) fn speed_law(&self, name: &str) -> Result<Option<SpeedLaw>, FileProblem> {
        let Some((KeyKind::Scaled(unit, limits), node)) = self.value(name) else {
            return Ok(None);
        };
        let (prefactor, exponent) = match (node.get(POWER_LAW[0]), node.get(POWER_LAW[1])) {
            (Some(prefactor), Some(exponent)) => (
                self.si(POWER_LAW[0], unit, ValueLimits::ANY, prefactor)?,
                self.si(POWER_LAW[1], "1", ValueLimits::ANY, exponent)?,
            ),
            _ => (self.si(name, unit, *limits, node)?, 0.0),
        };
        Ok(Some(SpeedLaw {
            prefactor,
            exponent,
            limits: limits.within(self.units, unit),
            span: node.span.clone(),
        }))
    }

    pub(crate) fn count(&self, name: &str) -> Result<Option<usize>, FileProblem> {
        match self.value(name) {
            Some((KeyKind::Count { least, most }, node)) => {
                let found = whole(name, *least, *most, node)?;
                Ok(usize::try_from(found).ok())
            }
            _ => Ok(None),
        }
    }

    pub(crate) fn counts(&self, name: &str) -> Result<Vec<(usize, Range<usize>)>, FileProblem> {
        let count = |member: &Node| {
            let found = whole(name, 0, i64::MAX, member)?;
            let found = usize::try_from(found).unwrap_or(usize::MAX);
            Ok((found, member.span.clone()))
        };
        self.node.list(name).iter().map(count).collect()
    }

    pub(crate) fn text(&self, name: &str) -> Option<&'a str> {
        self.node.get(name).and_then(Node::text)
    }

    pub(crate) fn flag(&self, name: &str) -> bool {
        let value = self.node.get(name).map(|node| &node.value);
        value == Some(&TomlValue::Flag(true))
    }

    fn of(&self, node: &'a Node, fields: &'static Fields) -> Self {
        Self { node, fields, ..*self }
    }

    pub(crate) fn table(&self, name: &str) -> Option<Self> {
        match self.value(name) {
            Some((KeyKind::Table(fields), node)) => Some(self.of(node, fields)),
            _ => None,
        }
    }

    pub(crate) fn tables(&self, name: &str) -> Vec<Self> {
        match self.value(name) {
            Some((KeyKind::Tables(fields), node)) => {
                let members = node.members().iter();
                members.map(|member| self.of(member, fields)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Tables with names of the user's.
    pub(crate) fn named(&self, name: &str) -> Vec<(&'a str, Range<usize>, Self)> {
        match self.value(name) {
            Some((KeyKind::Named(fields), node)) => (node.entries().iter())
                .map(|e| (e.key.as_str(), e.key_span.clone(), self.of(&e.node, fields)))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// A table whose keys depend on its tag, with the tag.
    pub(crate) fn variant(&self, name: &str) -> Option<(&'a str, Self)> {
        let Some((KeyKind::Variants(variants), node)) = self.value(name) else {
            return None;
        };
        let tag = node.get(variants.tag)?.text()?;
        Some((tag, self.of(node, variants.fields(tag)?)))
    }
}

/// A type that the value of a key can have.
pub(crate) trait FromKey: Sized {
    /// The value; `None` where the file gives none.
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem>;
}

impl FromKey for f64 {
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
        table.quantity(key)
    }
}

impl FromKey for usize {
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
        table.count(key)
    }
}

impl FromKey for String {
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
        Ok(table.text(key).map(str::to_owned))
    }
}

impl<T: FromKey> FromKey for Option<T> {
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
        Ok(T::from_key(table, key)?.map(Some))
    }
}

/// A struct whose fields are keys of a table: `field: Type = key default, kind, "meaning";`.
/// Keys without a field follow after a `+`.
macro_rules! record {
    (
        $(#[$meta:meta])* $Type:ident $title:literal
        $($field:ident: $Own:ty = $key:ident $default:expr, $kind:expr, $about:literal;)*
        $(+ $other:ident $other_kind:expr, $other_about:literal;)*
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $Type {
            $(#[doc = $about] pub $field: $Own,)*
        }

        impl $Type {
            pub(crate) const FIELDS: $crate::keys::Fields = $crate::keys::table! { $title;
                $($key: $kind, $about;)*
                $($other: $other_kind, $other_about;)*
            };

            pub(crate) fn read(
                table: Option<&$crate::values::TableView<'_>>,
            ) -> Result<Self, $crate::report::FileProblem> {
                $(let $field = match table {
                    Some(table) => <$Own as $crate::values::FromKey>::from_key(table, stringify!($key))?,
                    None => None,
                };
                let $field: $Own = $field.unwrap_or($default);)*
                Ok(Self { $($field,)* })
            }
        }
    };
}
pub(crate) use record;
