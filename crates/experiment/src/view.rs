//! Reading checked tables: a key's unit and limits come from its declaration.

use crate::check::{POWER_LAW, whole};
use crate::document::{Node, Value};
use crate::finding::Problem;
use crate::keys::{Fields, Kind, Limits, Variants};
use crate::value::{Expected, Units};
use std::ops::Range;

/// One table of a file with the declaration of its keys.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    pub(crate) node: &'a Node,
    pub(crate) fields: &'static Fields,
    pub(crate) units: Units,
}

/// A number that may be a power law of the striker's speed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scaled {
    pub(crate) prefactor: f64,
    /// 0 for a plain number.
    pub(crate) exponent: f64,
    /// What its value must be at any speed.
    pub(crate) limits: Limits,
    pub(crate) span: Range<usize>,
}

impl<'a> View<'a> {
    pub(crate) fn span(&self) -> Range<usize> {
        self.node.span.clone()
    }

    /// Where a key's value stands, or the whole table.
    pub(crate) fn span_of(&self, name: &str) -> Range<usize> {
        self.node.get(name).unwrap_or(self.node).span.clone()
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.node.get(name).is_some()
    }

    fn kind(&self, name: &str) -> Option<&'static Kind> {
        let key = self.fields.key(name);
        debug_assert!(
            key.is_some(),
            "{} declares no key {name}",
            self.fields.title
        );
        key.map(|key| &key.kind)
    }

    fn si(&self, name: &str, unit: &str, limits: Limits, node: &Node) -> Result<f64, Problem> {
        let expected = Expected {
            name,
            unit,
            limits,
            units: self.units,
        };
        expected.read(node).map(|si| si.value)
    }

    /// A quantity in SI.
    pub(crate) fn quantity(&self, name: &str) -> Result<Option<f64>, Problem> {
        match (self.kind(name), self.node.get(name)) {
            (Some(Kind::Quantity(unit, limits)), Some(node)) => {
                self.si(name, unit, *limits, node).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// A quantity in SI that the check has seen to be there.
    pub(crate) fn needed(&self, name: &str) -> Result<f64, Problem> {
        self.quantity(name)?.ok_or_else(|| {
            let message = format!("{} has no `{name}`", self.fields.title);
            Problem::new(&self.node.span, message, "expected here")
        })
    }

    pub(crate) fn quantities(&self, name: &str) -> Result<Vec<f64>, Problem> {
        let (Some(Kind::Quantities(unit)), Some(node)) = (self.kind(name), self.node.get(name))
        else {
            return Ok(Vec::new());
        };
        let members = node.members().iter();
        members
            .map(|member| self.si(name, unit, Limits::ANY, member))
            .collect()
    }

    pub(crate) fn scaled(&self, name: &str) -> Result<Option<Scaled>, Problem> {
        let (Some(Kind::Scaled(unit, limits)), Some(node)) = (self.kind(name), self.node.get(name))
        else {
            return Ok(None);
        };
        let (prefactor, exponent) = match (node.get(POWER_LAW[0]), node.get(POWER_LAW[1])) {
            (Some(prefactor), Some(exponent)) => (
                self.si(POWER_LAW[0], unit, Limits::ANY, prefactor)?,
                self.si(POWER_LAW[1], "1", Limits::ANY, exponent)?,
            ),
            _ => (self.si(name, unit, *limits, node)?, 0.0),
        };
        Ok(Some(Scaled {
            prefactor,
            exponent,
            limits: limits.within(self.units, unit),
            span: node.span.clone(),
        }))
    }

    pub(crate) fn count(&self, name: &str) -> Result<Option<usize>, Problem> {
        match (self.kind(name), self.node.get(name)) {
            (Some(Kind::Count { least, most }), Some(node)) => {
                let found = whole(name, *least, *most, node)?;
                Ok(usize::try_from(found).ok())
            }
            _ => Ok(None),
        }
    }

    pub(crate) fn counts(&self, name: &str) -> Result<Vec<(usize, Range<usize>)>, Problem> {
        let members = self.node.get(name).map_or(&[][..], Node::members).iter();
        members
            .map(|member| {
                let found = whole(name, 0, i64::MAX, member)?;
                Ok((
                    usize::try_from(found).unwrap_or(usize::MAX),
                    member.span.clone(),
                ))
            })
            .collect()
    }

    pub(crate) fn text(&self, name: &str) -> Option<&'a str> {
        self.node.get(name).and_then(Node::text)
    }

    pub(crate) fn flag(&self, name: &str) -> bool {
        matches!(
            self.node.get(name),
            Some(Node {
                value: Value::Flag(true),
                ..
            })
        )
    }

    fn of(&self, node: &'a Node, fields: &'static Fields) -> Self {
        View {
            node,
            fields,
            units: self.units,
        }
    }

    pub(crate) fn table(&self, name: &str) -> Option<Self> {
        match (self.kind(name), self.node.get(name)) {
            (Some(Kind::Table(fields)), Some(node)) => Some(self.of(node, fields)),
            _ => None,
        }
    }

    pub(crate) fn tables(&self, name: &str) -> Vec<Self> {
        match (self.kind(name), self.node.get(name)) {
            (Some(Kind::Tables(fields)), Some(node)) => {
                let members = node.members().iter();
                members.map(|member| self.of(member, fields)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Tables with names of the user's.
    pub(crate) fn named(&self, name: &str) -> Vec<(&'a str, Range<usize>, Self)> {
        match (self.kind(name), self.node.get(name)) {
            (Some(Kind::Named(fields)), Some(node)) => (node.entries().iter())
                .map(|e| (e.key.as_str(), e.key_span.clone(), self.of(&e.node, fields)))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// A table whose keys depend on its tag, with the tag.
    pub(crate) fn variant(&self, name: &str) -> Option<(&'a str, Self)> {
        let Some(Kind::Variants(variants)) = self.kind(name) else {
            return None;
        };
        let variants: &'static Variants = variants;
        let node = self.node.get(name)?;
        let tag = node.get(variants.tag)?.text()?;
        Some((tag, self.of(node, variants.fields(tag)?)))
    }
}
