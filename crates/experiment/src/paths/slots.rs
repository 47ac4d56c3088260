//! Where numbers stand, or could stand, in a file.

use super::Place;
use crate::check::POWER_LAW;
use crate::document::{Node, Value};
use crate::keys::{Fields, Key, Kind, Limits, RIG, ROOT};
use crate::laws;
use crate::value::{Expected, Si, Units};
use std::borrow::Cow;

/// A place for a number.
#[derive(Clone, Debug)]
pub(super) struct Slot<'a> {
    pub(super) path: String,
    pub(super) steps: Vec<Step>,
    pub(super) unit: Cow<'static, str>,
    /// `None` where the file gives nothing.
    pub(super) node: Option<&'a Node>,
    pub(super) is_count: bool,
    /// The unit with the names of parameters in the places of their values; empty
    /// where it depends on none.
    form: &'static str,
    /// Whether it is left to materials and radii, which give each contact its own.
    pub(super) is_derived: bool,
}

impl Slot<'_> {
    /// Whether the unit of this parameter depends on that other one of its law.
    pub(super) fn follows(&self, other: &Self) -> bool {
        let [own, others] = [&self.path, &other.path].map(|path| path.rsplit_once('.'));
        let (Some((law, _)), Some((same, name))) = (own, others) else {
            return false;
        };
        law == same && self.form.contains(&format!("{{{name}}}"))
    }

    /// This place, for those who know nothing of trees.
    pub(super) fn place(self, units: Units) -> Place {
        Place {
            value: self.value(units).map(|si| si.value),
            unit: self.unit.into_owned(),
            path: self.path,
            is_count: self.is_count,
        }
    }

    /// The value in SI, where the file gives one.
    pub(super) fn value(&self, units: Units) -> Option<Si> {
        let node = self.node?;
        if self.is_count {
            return match &node.value {
                Value::Number(number) => Some(Si {
                    value: number.value,
                    half_digit: 0.0,
                }),
                _ => None,
            };
        }
        let expected = Expected {
            name: &self.path,
            unit: &self.unit,
            limits: Limits::ANY,
            units,
        };
        expected.read(node).ok()
    }
}

/// One step down the tree.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Key(String),
    Index(usize),
}

/// A way down the tree.
#[derive(Clone, Debug, Default)]
struct Way {
    path: String,
    steps: Vec<Step>,
}

impl Way {
    fn key(&self, key: &str) -> Self {
        let mut way = self.named(key);
        way.steps.push(Step::Key(key.to_owned()));
        way
    }

    /// A name in the path that is no step.
    fn named(&self, name: &str) -> Self {
        let mut way = self.clone();
        if !way.path.is_empty() {
            way.path.push('.');
        }
        way.path.push_str(name);
        way
    }

    fn index(&self, index: usize) -> Self {
        let mut way = self.clone();
        way.path.push_str(&format!("[{index}]"));
        way.steps.push(Step::Index(index));
        way
    }
}

/// All places of a checked file.
pub(super) fn all(tree: &Node, units: Units) -> Vec<Slot<'_>> {
    let mut walk = Walk {
        units,
        slots: Vec::new(),
    };
    walk.table(Some(tree), &ROOT, &Way::default());
    walk.slots
}

struct Walk<'a> {
    units: Units,
    slots: Vec<Slot<'a>>,
}

impl<'a> Walk<'a> {
    fn table(&mut self, node: Option<&'a Node>, fields: &'static Fields, way: &Way) {
        for key in fields.keys {
            let value = node.and_then(|node| node.get(key.name));
            self.value(key, value, &way.key(key.name));
        }
    }

    fn value(&mut self, key: &'static Key, node: Option<&'a Node>, way: &Way) {
        match (&key.kind, node) {
            (Kind::Quantity(unit, _), _) => self.push((*unit).into(), node, false, way),
            (Kind::Scaled(unit, _), Some(law)) if matches!(law.value, Value::Table(_)) => {
                for (part, unit) in POWER_LAW.into_iter().zip([*unit, "1"]) {
                    self.push(unit.into(), law.get(part), false, &way.key(part));
                }
            }
            (Kind::Scaled(unit, _), _) => self.push((*unit).into(), node, false, way),
            (Kind::Count { .. }, _) => self.push("1".into(), node, true, way),
            // Numbers of the rig are described only: nothing depends on them.
            (Kind::Table(fields), _) if std::ptr::eq(*fields, &RIG) => {}
            (Kind::Table(fields), _) => self.table(node, fields, way),
            (Kind::Tables(fields), Some(list)) => {
                for (index, member) in list.members().iter().enumerate() {
                    self.table(Some(member), fields, &way.index(index));
                }
            }
            (Kind::Named(fields), Some(table)) => {
                for entry in table.entries() {
                    self.table(Some(&entry.node), fields, &way.key(&entry.key));
                }
            }
            (Kind::Variants(variants), Some(table)) => {
                let tag = table.get(variants.tag).and_then(Node::text);
                if let Some(fields) = tag.and_then(|tag| variants.fields(tag)) {
                    self.table(Some(table), fields, way);
                }
            }
            (Kind::Laws, Some(list)) => {
                for (index, member) in list.members().iter().enumerate() {
                    self.law(member, way, index);
                }
            }
            _ => {}
        }
    }

    /// A law's parameters; the path has the law's name in place of its index.
    fn law(&mut self, member: &'a Node, way: &Way, index: usize) {
        let Ok(row) = laws::row_of(member) else {
            return;
        };
        let mut at = way.named(row.info.name);
        at.steps.push(Step::Index(index));
        for parameter in row.info.parameters {
            let unit = laws::unit(parameter, row, member, self.units);
            let name = parameter.name;
            self.push(unit.into(), member.get(name), false, &at.key(name));
            if let Some(slot) = self.slots.last_mut() {
                slot.is_derived = laws::is_own(parameter) && slot.node.is_none();
                if parameter.unit.contains('{') {
                    slot.form = parameter.unit;
                }
            }
        }
    }

    fn push(&mut self, unit: Cow<'static, str>, node: Option<&'a Node>, count: bool, way: &Way) {
        self.slots.push(Slot {
            form: "",
            is_derived: false,
            path: way.path.clone(),
            steps: way.steps.clone(),
            unit,
            node,
            is_count: count,
        });
    }
}
