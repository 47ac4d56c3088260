//! Where numbers stand, or could stand, in a file.

use crate::check::POWER_LAW;
use crate::document::{Node, Value};
use crate::keys::{Fields, Key, Kind, Limits, ROOT};
use crate::laws;
use crate::value::{Expected, Si, Units};

/// A place for a number.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    pub(super) path: String,
    pub(super) steps: Vec<Step>,
    pub(super) unit: String,
    /// `None` where the file gives nothing.
    pub(super) value: Option<Si>,
    pub(super) is_count: bool,
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
pub(super) fn all(tree: &Node, units: Units) -> Vec<Slot> {
    let mut walk = Walk {
        units,
        slots: Vec::new(),
    };
    walk.table(Some(tree), &ROOT, &Way::default());
    walk.slots
}

struct Walk {
    units: Units,
    slots: Vec<Slot>,
}

impl Walk {
    fn table(&mut self, node: Option<&Node>, fields: &'static Fields, way: &Way) {
        for key in fields.keys {
            let value = node.and_then(|node| node.get(key.name));
            self.value(key, value, &way.key(key.name));
        }
    }

    fn value(&mut self, key: &'static Key, node: Option<&Node>, way: &Way) {
        match (&key.kind, node) {
            (Kind::Quantity(unit, _), _) => self.number(unit, node, way),
            (Kind::Scaled(unit, _), Some(law)) if matches!(law.value, Value::Table(_)) => {
                for (part, unit) in POWER_LAW.into_iter().zip([unit, "1"]) {
                    self.number(unit, law.get(part), &way.key(part));
                }
            }
            (Kind::Scaled(unit, _), _) => self.number(unit, node, way),
            (Kind::Count { .. }, _) => self.count(node, way),
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
    fn law(&mut self, member: &Node, way: &Way, index: usize) {
        let Ok(row) = laws::row_of(member) else {
            return;
        };
        let mut at = way.named(row.info.name);
        at.steps.push(Step::Index(index));
        for parameter in row.info.parameters {
            let unit = laws::unit(parameter, row, member, self.units);
            let name = parameter.name;
            self.number(&unit, member.get(name), &at.key(name));
        }
    }

    fn number(&mut self, unit: &str, node: Option<&Node>, way: &Way) {
        let expected = Expected {
            name: &way.path,
            unit,
            limits: Limits::ANY,
            units: self.units,
        };
        let value = node.and_then(|node| expected.read(node).ok());
        self.push(unit, value, false, way);
    }

    fn count(&mut self, node: Option<&Node>, way: &Way) {
        let value = match node.map(|node| &node.value) {
            Some(Value::Number(number)) => Some(Si {
                value: number.value,
                half_digit: 0.0,
            }),
            _ => None,
        };
        self.push("1", value, true, way);
    }

    fn push(&mut self, unit: &str, value: Option<Si>, is_count: bool, way: &Way) {
        self.slots.push(Slot {
            path: way.path.clone(),
            steps: way.steps.clone(),
            unit: unit.to_owned(),
            value,
            is_count,
        });
    }
}
