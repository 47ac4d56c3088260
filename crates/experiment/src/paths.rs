//! Parameter paths: the named numbers of an experiment file.
//!
//! `materials.aisi316.young_modulus`, `beads[0].radius`,
//! `contacts[1].laws.damping_cubic.coefficient`: the keys of the file joined
//! by points, lists by index from 0, laws by name. An end of a path that fits
//! only one number is enough: `young_modulus`, `damping_cubic.coefficient`.

use crate::contacts::{self, CONTACT};
use crate::document::{Node, TomlValue};
use crate::experiment::Experiment;
use crate::keys::{Fields, Key, KeyKind, ROOT, ValueLimits};
use crate::reading::{PreloadReading, Reading};
use crate::report::{Mistakes, nearest_word};
use crate::rig::RIG;
use crate::values::{ExpectedQuantity, POWER_LAW, Si, Units};

/// A place for a number, whether or not the file gives one there.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedNumber {
    /// Full path.
    pub path: String,
    /// Value in SI, where the file gives one.
    pub value: Option<f64>,
    /// SI unit; "1" for a plain number.
    pub unit: String,
    /// Half a unit of the last digit written, in SI: what rounding for print
    /// may hide. 0 for values set by a program.
    pub half_digit: f64,
    /// Whether it counts something and must stay whole.
    pub is_count: bool,
}

/// An error of a path or of a value set at it.
#[derive(Clone, Debug, thiserror::Error)]
pub enum PathError {
    /// No number has this name.
    #[error("there is no number `{path}`{}", hint(.nearest.as_deref()))]
    Unknown {
        /// The path given.
        path: String,
        /// The path probably meant.
        nearest: Option<String>,
    },
    /// Several numbers have this end.
    #[error("`{path}` can be any of: {}", .candidates.join(", "))]
    Ambiguous {
        /// The path given.
        path: String,
        /// Full paths that end so.
        candidates: Vec<String>,
    },
    /// The file does not give this number, and a default holds.
    #[error("`{path}` is not given in the file")]
    NotGiven {
        /// Full path.
        path: String,
    },
    /// The value does not fit the experiment.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |path| format!("; did you mean `{path}`?"))
}

impl Experiment {
    /// Every number that the file gives, in its order.
    pub fn numbers(&self) -> Vec<NamedNumber> {
        self.places().into_iter().filter(|number| number.value.is_some()).collect()
    }

    /// Every place where a number stands or could stand, in the file's order.
    pub fn places(&self) -> Vec<NamedNumber> {
        let place = |slot: Slot<'_>| slot.place(self.units());
        self.slots().into_iter().map(place).collect()
    }

    /// The place that a path or an end of one names.
    ///
    /// # Errors
    /// An unknown or ambiguous path.
    pub fn place(&self, path: &str) -> Result<NamedNumber, PathError> {
        let slots = self.slots();
        Ok(find(&slots, path)?.clone().place(self.units()))
    }

    /// Numbers of the file whose unit depends on that at a path, with their units:
    /// the stiffness k of F = k δ^n in N/m^n, where the path is that of n.
    ///
    /// # Errors
    /// An unknown or ambiguous path.
    pub fn followers(&self, path: &str) -> Result<Vec<NamedNumber>, PathError> {
        let slots = self.slots();
        let steering = find(&slots, path)?;
        let followers = slots.iter().filter(|slot| slot.follows(steering));
        let places = followers.map(|slot| slot.clone().place(self.units()));
        Ok(places.filter(|place| place.value.is_some()).collect())
    }

    /// The value of a named number in SI.
    ///
    /// # Errors
    /// An unknown or ambiguous path, or a number that the file does not give.
    pub fn get(&self, path: &str) -> Result<f64, PathError> {
        let slots = self.slots();
        let slot = find(&slots, path)?;
        let value = slot.value(self.units()).map(|si| si.value);
        value.ok_or_else(|| PathError::NotGiven { path: slot.path.clone() })
    }

    /// This experiment with named numbers set, in SI.
    ///
    /// Where the unit of one number depends on another, as that of the stiffness of
    /// F = k δ^n does on n, setting n alone keeps the number of k, in N/m^n of the
    /// new n: the force at an overlap of 1 m stays.
    ///
    /// A K or A that the file leaves to materials and radii is set at its [`Reference`](crate::Reference)
    /// contact, and the section's other contacts keep their ratios to it.
    ///
    /// ```
    /// let dry = hertzchain_experiment::preset("dry")?;
    /// let soft = dry.set(&[("young_modulus", 200e9), ("damping_cubic.coefficient", 50.0)])?;
    /// assert_eq!(soft.get("materials.aisi316.young_modulus")?, 200e9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// An unknown or ambiguous path, or a value that does not fit.
    pub fn set(&self, values: &[(&str, f64)]) -> Result<Self, PathError> {
        let values = values.iter();
        self.replaced(values.map(|(path, value)| (*path, TomlValue::from_code(*value, 0.0))))
    }

    /// This experiment with named numbers set from text as it would stand in
    /// the file: "200 GPa", "0.3".
    ///
    /// # Errors
    /// An unknown or ambiguous path, or a value that does not fit.
    pub fn set_text(&self, values: &[(&str, &str)]) -> Result<Self, PathError> {
        let value = |text: &str| match text.trim().parse() {
            Ok(value) => TomlValue::number(value, 0.0),
            Err(_) => TomlValue::Text(text.to_owned()),
        };
        self.replaced(values.iter().map(|(path, text)| (*path, value(text))))
    }

    /// This experiment with another speed of the striker in m/s.
    ///
    /// # Errors
    /// No striker, or a speed that is not positive and finite.
    pub fn with_speed(&self, speed_m_s: f64) -> Result<Self, PathError> {
        self.set(&[("striker.speed", speed_m_s)])
    }

    /// This experiment with a constant push on bead 1, a force in N, in place of any
    /// that the file or the reading has.
    ///
    /// ```
    /// let pushed = hertzchain_experiment::preset("dry")?.with_push(0.5)?;
    /// assert_eq!(pushed.get("near_end.force")?, 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A negative force, or one that the chain does not bear.
    pub fn with_push(&self, force_n: f64) -> Result<Self, PathError> {
        let mut tree = self.tree().clone();
        let near_end = tree.entry_mut("near_end");
        near_end.value = TomlValue::Table(Vec::new());
        near_end.entry_mut("push").value = TomlValue::Text("constant".to_owned());
        near_end.entry_mut("force").value = TomlValue::from_code(force_n, 0.0);
        let preload = PreloadReading::None;
        let own = Reading { preload, ..self.reading() };
        Ok(self.with_tree(tree)?.with_reading(&own)?)
    }

    /// This experiment with a low-pass of another corner in Hz, order or kind in its amplifier,
    /// by the names of the file.
    ///
    /// # Errors
    /// A corner that is not positive, or a name that is none.
    pub fn with_low_pass(
        &self,
        corner_hz: Option<f64>,
        order: Option<&str>,
        kind: Option<&str>,
    ) -> Result<Self, PathError> {
        let text = |name: Option<&str>| name.map(|name| TomlValue::Text(name.to_owned()));
        let corner = corner_hz.map(|corner_hz| TomlValue::from_code(corner_hz, 0.0));
        let mut tree = self.tree().clone();
        let amplifier = tree.entry_mut("campaign").entry_mut("amplifier");
        let values = [("low_pass", corner), ("order", text(order)), ("kind", text(kind))];
        for (key, value) in values {
            if let Some(value) = value {
                amplifier.entry_mut(key).value = value;
            }
        }
        Ok(self.with_tree(tree)?)
    }

    fn slots(&self) -> Vec<Slot<'_>> {
        let units = self.units();
        let mut walk = SlotWalk { units, slots: Vec::new() };
        walk.table(Some(self.tree()), &ROOT, &SlotPath::default());
        walk.slots
    }

    fn replaced<'a>(
        &self,
        values: impl Iterator<Item = (&'a str, TomlValue)>,
    ) -> Result<Self, PathError> {
        let slots = self.slots();
        let mut tree = self.tree().clone();
        let found = values.map(|(path, value)| Ok((find(&slots, path)?, value)));
        let found: Vec<(&Slot<'_>, TomlValue)> = found.collect::<Result<_, PathError>>()?;
        // Before a number is changed on which units of its law depend, as N/m^n does on
        // n: what the file gives in them was checked against the file's own number, and
        // is kept as a plain number in SI, in the unit that is to be.
        for (changed, _) in &found {
            for follower in slots.iter().filter(|slot| slot.follows(changed)) {
                if let Some(si) = follower.value(self.units()) {
                    let value = TomlValue::from_code(si.value, si.half_digit);
                    node_at(&mut tree, &follower.steps).value = value;
                }
            }
        }
        for (slot, value) in found {
            node_at(&mut tree, &slot.steps).value = value;
            let contact = slot.is_derived.then(|| self.reference(&slot.path)?.contact);
            if let (Some(contact), [table @ .., _]) = (contact.flatten(), &slot.steps[..]) {
                let law = node_at(&mut tree, table);
                law.entry_mut(CONTACT).value = TomlValue::from_code(contact as f64, 0.0);
            }
        }
        Ok(self.with_tree(tree)?)
    }
}

/// The node at the end of some steps; tables are made on the way.
fn node_at<'a>(node: &'a mut Node, steps: &[PathStep]) -> &'a mut Node {
    steps.iter().fold(node, |node, step| match step {
        PathStep::Key(key) => node.entry_mut(key),
        PathStep::Index(at) => match &mut node.value {
            TomlValue::List(members) => &mut members[*at],
            // A step to a member was found in a list.
            _ => unreachable!("only lists have members"),
        },
    })
}

/// The slot of a path or of an end of one: given numbers come first.
fn find<'a, 'b>(slots: &'b [Slot<'a>], path: &str) -> Result<&'b Slot<'a>, PathError> {
    if let Some(exact) = slots.iter().find(|slot| slot.path == path) {
        return Ok(exact);
    }
    let ending = format!(".{path}");
    let fitting: Vec<_> = slots.iter().filter(|s| s.path.ends_with(&ending)).collect();
    let given: Vec<_> = fitting.iter().filter(|s| s.node.is_some()).copied().collect();
    match (&given[..], &fitting[..]) {
        ([only], _) | ([], [only]) => Ok(only),
        ([], []) => {
            Err(PathError::Unknown { path: path.to_owned(), nearest: nearest_path(path, slots) })
        }
        ([], several) | (several, _) => Err(PathError::Ambiguous {
            path: path.to_owned(),
            candidates: several.iter().map(|slot| slot.path.clone()).collect(),
        }),
    }
}

/// The path nearest to a mistyped one, by the whole or by its end.
fn nearest_path(path: &str, slots: &[Slot<'_>]) -> Option<String> {
    let depth = path.split('.').count();
    let end = |slot: &Slot<'_>| {
        let parts: Vec<&str> = slot.path.split('.').collect();
        parts[parts.len().saturating_sub(depth)..].join(".")
    };
    let ends: Vec<String> = slots.iter().map(end).collect();
    let near = nearest_word(path, ends.iter().map(String::as_str))?;
    let at = ends.iter().position(|end| end == near)?;
    slots.get(at).map(|slot| slot.path.clone())
}

/// A place for a number in the tree.
#[derive(Clone, Debug)]
struct Slot<'a> {
    path: String,
    steps: Vec<PathStep>,
    unit: String,
    /// `None` where the file gives nothing.
    node: Option<&'a Node>,
    is_count: bool,
    /// The unit with the names of parameters in the places of their values; empty
    /// where it depends on none.
    form: &'static str,
    /// Whether it is left to materials and radii, which give each contact its own.
    is_derived: bool,
}

impl Slot<'_> {
    /// Whether the unit of this parameter depends on that other one of its law.
    fn follows(&self, other: &Self) -> bool {
        let [own, others] = [&self.path, &other.path].map(|path| path.rsplit_once('.'));
        let (Some((law, _)), Some((same, name))) = (own, others) else {
            return false;
        };
        law == same && self.form.contains(&format!("{{{name}}}"))
    }

    fn place(&self, units: Units) -> NamedNumber {
        let si = self.value(units);
        NamedNumber {
            path: self.path.clone(),
            value: si.map(|si| si.value),
            unit: self.unit.clone(),
            half_digit: si.map_or(0.0, |si| si.half_digit),
            is_count: self.is_count,
        }
    }

    /// The value in SI, where the file gives one.
    fn value(&self, units: Units) -> Option<Si> {
        let expected = ExpectedQuantity {
            name: &self.path,
            unit: &self.unit,
            limits: ValueLimits::ANY,
            units,
        };
        let si = expected.read(self.node?).ok()?;
        let half_digit = if self.is_count { 0.0 } else { si.half_digit };
        Some(Si { half_digit, ..si })
    }
}

/// One step down the tree.
#[derive(Clone, Debug)]
enum PathStep {
    Key(String),
    Index(usize),
}

/// A way down the tree.
#[derive(Clone, Debug, Default)]
struct SlotPath {
    path: String,
    steps: Vec<PathStep>,
}

impl SlotPath {
    fn key(&self, key: &str) -> Self {
        let mut way = self.named(key);
        way.steps.push(PathStep::Key(key.to_owned()));
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
        way.steps.push(PathStep::Index(index));
        way
    }
}

/// Collects all places of a checked file.
struct SlotWalk<'a> {
    units: Units,
    slots: Vec<Slot<'a>>,
}

impl<'a> SlotWalk<'a> {
    fn table(&mut self, node: Option<&'a Node>, fields: &'static Fields, way: &SlotPath) {
        for key in fields.keys {
            let value = node.and_then(|node| node.get(key.name));
            self.value(key, value, &way.key(key.name));
        }
    }

    fn value(&mut self, key: &'static Key, node: Option<&'a Node>, way: &SlotPath) {
        match (&key.kind, node) {
            (KeyKind::Scaled(unit, _), Some(law)) if law.is_table() => {
                for (part, unit) in POWER_LAW.into_iter().zip([*unit, "1"]) {
                    self.push(unit, law.get(part), way.key(part));
                }
            }
            (KeyKind::Quantity(unit, _) | KeyKind::Scaled(unit, _), _) => {
                self.push(unit, node, way.clone());
            }
            (KeyKind::Count { .. }, _) => self.push("1", node, way.clone()).is_count = true,
            // Numbers of the rig are described only: nothing depends on them.
            (KeyKind::Table(fields), _) if std::ptr::eq(*fields, &RIG) => {}
            (KeyKind::Table(fields), _) => self.table(node, fields, way),
            (KeyKind::Tables(fields), Some(list)) => {
                for (index, member) in list.members().iter().enumerate() {
                    self.table(Some(member), fields, &way.index(index));
                }
            }
            (KeyKind::Named(fields), Some(table)) => {
                for entry in table.entries() {
                    self.table(Some(&entry.node), fields, &way.key(&entry.key));
                }
            }
            (KeyKind::Variants(variants), Some(table)) => {
                let tag = table.get(variants.tag).and_then(Node::text);
                if let Some(fields) = tag.and_then(|tag| variants.fields(tag)) {
                    self.table(Some(table), fields, way);
                }
            }
            (KeyKind::Laws, Some(list)) => {
                for (index, member) in list.members().iter().enumerate() {
                    self.law(member, way, index);
                }
            }
            _ => {}
        }
    }

    /// A law's parameters; the path has the law's name in place of its index.
    fn law(&mut self, member: &'a Node, way: &SlotPath, index: usize) {
        let Ok(row) = contacts::row_of(member) else {
            return;
        };
        let mut at = way.named(row.info.name);
        at.steps.push(PathStep::Index(index));
        for parameter in row.info.parameters {
            let unit = contacts::unit_of(parameter, row, member, self.units);
            let node = member.get(parameter.name);
            let slot = self.push(&unit, node, at.key(parameter.name));
            slot.is_derived = contacts::is_derived(parameter) && node.is_none();
            if parameter.unit.contains('{') {
                slot.form = parameter.unit;
            }
        }
    }

    fn push(&mut self, unit: &str, node: Option<&'a Node>, way: SlotPath) -> &mut Slot<'a> {
        let at = self.slots.len();
        self.slots.push(Slot {
            path: way.path,
            steps: way.steps,
            unit: unit.to_owned(),
            node,
            is_count: false,
            form: "",
            is_derived: false,
        });
        &mut self.slots[at]
    }
}
