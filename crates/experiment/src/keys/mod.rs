//! The keys of an experiment file, declared once: the check of a file, its
//! reading, the JSON Schema and the parameter paths all go by these tables.

pub(crate) mod advice;
pub(crate) mod ranges;
mod tables;

pub(crate) use tables::{MOST_BEADS, RIG, ROOT};

use crate::value::Units;

/// The keys of one table.
#[derive(Debug)]
pub(crate) struct Fields {
    /// The table as written in a file: "[striker]".
    pub(crate) title: &'static str,
    pub(crate) keys: &'static [Key],
}

/// One key.
#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) need: Need,
    /// What it means, in a few words.
    pub(crate) about: &'static str,
}

/// Whether a key must be there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    Always,
    /// In SI files; a dimensionless one has a default.
    InSi,
    Never,
}

/// What a key's value is.
#[derive(Debug)]
pub(crate) enum Kind {
    /// A quantity in this SI unit; "1" for a plain number.
    Quantity(&'static str, Limits),
    /// A quantity, or a power law of the striker's speed.
    Scaled(&'static str, Limits),
    /// Quantities in this SI unit.
    Quantities(&'static str),
    /// A whole number up to a largest one.
    Count {
        least: i64,
        most: i64,
    },
    /// Whole numbers from 0.
    Counts,
    Choice(&'static [&'static str]),
    Text,
    Flag,
    Table(&'static Fields),
    /// `[[name]]`
    Tables(&'static Fields),
    /// `[name.anything]`
    Named(&'static Fields),
    Variants(&'static Variants),
    /// Rows of the contact-law registry.
    Laws,
}

/// A table whose keys depend on the value of one of them.
#[derive(Debug)]
pub(crate) struct Variants {
    pub(crate) title: &'static str,
    pub(crate) tag: &'static str,
    pub(crate) options: &'static [(&'static str, Fields)],
}

/// Values that a quantity may have, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub(crate) least: f64,
    pub(crate) most: f64,
    /// Whether the ends themselves are accepted.
    pub(crate) closed: bool,
    /// The range in words: "positive".
    pub(crate) words: &'static str,
}

impl Limits {
    pub(crate) const ANY: Self = Self::new(f64::MIN, f64::MAX, true, "finite");
    pub(crate) const POSITIVE: Self = Self::new(0.0, f64::INFINITY, false, "positive");
    pub(crate) const NOT_NEGATIVE: Self = Self::new(0.0, f64::MAX, true, "0 or more");

    pub(crate) const fn new(least: f64, most: f64, closed: bool, words: &'static str) -> Self {
        Self {
            least,
            most,
            closed,
            words,
        }
    }

    /// The limits in a file of this unit system: physical ranges are of SI
    /// values, and dimensionless numbers need only be computable.
    pub(crate) fn within(self, units: Units, unit: &str) -> Self {
        match units {
            Units::Dimensionless if unit != "1" && self.least > 0.0 => ranges::PLAIN,
            Units::Dimensionless if unit != "1" && self.least == 0.0 && self.closed => {
                Self::NOT_NEGATIVE
            }
            Units::Dimensionless if unit != "1" => Self::ANY,
            _ => self,
        }
    }

    pub(crate) fn hold(&self, value: f64) -> bool {
        let inside = value > self.least && value < self.most;
        let end = value == self.least || value == self.most;
        inside || (self.closed && end)
    }
}

impl Fields {
    pub(crate) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }
}

impl Variants {
    /// The keys that go with a value of the tag.
    pub(crate) fn fields(&self, tag: &str) -> Option<&'static Fields> {
        let option = self.options.iter().find(|(name, _)| *name == tag);
        option.map(|(_, fields)| fields)
    }
}

/// Where a key belongs that stands in the wrong table, in words.
pub(crate) fn home(key: &str) -> Option<String> {
    if let Some(found) = ROOT.key(key) {
        let title = match &found.kind {
            Kind::Tables(fields) | Kind::Table(fields) | Kind::Named(fields) => fields.title,
            Kind::Variants(variants) => variants.title,
            _ => return Some("at the top of the file, before the first table".to_owned()),
        };
        return Some(format!("into a table of its own, {title}"));
    }
    let mut tables = ROOT.keys.iter().flat_map(|key| tables_of(&key.kind));
    let holding = tables.find(|fields| fields.key(key).is_some())?;
    Some(format!("into {}", holding.title))
}

/// The tables that a key of the file may hold.
fn tables_of(kind: &'static Kind) -> Vec<&'static Fields> {
    match kind {
        Kind::Table(fields) | Kind::Tables(fields) | Kind::Named(fields) => vec![fields],
        Kind::Variants(variants) => variants.options.iter().map(|(_, fields)| fields).collect(),
        _ => Vec::new(),
    }
}
