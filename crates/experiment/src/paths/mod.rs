//! Parameter paths: the named numbers of an experiment file.
//!
//! `materials.aisi316.young_modulus`, `beads[0].radius`,
//! `contacts[1].laws.damping_cubic.coefficient`: the keys of the file joined
//! by points, lists by index from 0, laws by name. An end of a path that fits
//! only one number is enough: `young_modulus`, `damping_cubic.coefficient`.

mod slots;

use crate::document::{Entry, Node, Number, Value};
use crate::experiment::Experiment;
use crate::finding::Mistakes;
use crate::laws::CONTACT;
use crate::nearest;
use crate::reading::{PreloadReading, Reading};
use slots::{Slot, Step};

/// One number of an experiment, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Full path.
    pub path: String,
    /// Value in SI.
    pub value: f64,
    /// SI unit; "1" for a plain number.
    pub unit: String,
    /// Half a unit of the last digit written, in SI: what rounding for print
    /// may hide. 0 for values set by a program.
    pub half_digit: f64,
    /// Whether it counts something and must stay whole.
    pub is_count: bool,
}

/// A place for a number, whether or not the file gives one there.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Full path.
    pub path: String,
    /// Value in SI, where the file gives one.
    pub value: Option<f64>,
    /// SI unit; "1" for a plain number.
    pub unit: String,
    /// Whether it counts something and must stay whole.
    pub is_count: bool,
}

/// Why a path can't be followed.
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
    pub fn numbers(&self) -> Vec<Named> {
        let given = |slot: Slot<'_>| {
            let si = slot.value(self.units())?;
            Some(Named {
                path: slot.path,
                value: si.value,
                unit: slot.unit.into_owned(),
                half_digit: si.half_digit,
                is_count: slot.is_count,
            })
        };
        self.slots().into_iter().filter_map(given).collect()
    }

    /// Every place where a number stands or could stand, in the file's order.
    pub fn places(&self) -> Vec<Place> {
        let place = |slot: Slot<'_>| slot.place(self.units());
        self.slots().into_iter().map(place).collect()
    }

    /// The place that a path or an end of one names.
    ///
    /// # Errors
    /// An unknown or ambiguous path.
    pub fn place(&self, path: &str) -> Result<Place, PathError> {
        let slots = self.slots();
        Ok(find(&slots, path)?.clone().place(self.units()))
    }

    /// Numbers of the file whose unit depends on that at a path, with their units:
    /// the stiffness k of F = k δ^n in N/m^n, where the path is that of n.
    ///
    /// # Errors
    /// An unknown or ambiguous path.
    pub fn followers(&self, path: &str) -> Result<Vec<Place>, PathError> {
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
        value.ok_or_else(|| PathError::NotGiven {
            path: slot.path.clone(),
        })
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
        self.replaced(values.map(|(path, value)| (*path, Value::from_code(*value))))
    }

    /// This experiment with named numbers set from text as it would stand in
    /// the file: "200 GPa", "0.3".
    ///
    /// # Errors
    /// An unknown or ambiguous path, or a value that does not fit.
    pub fn set_text(&self, values: &[(&str, &str)]) -> Result<Self, PathError> {
        let texts = values.iter().map(|(path, text)| {
            let plain = text.trim().parse::<f64>();
            let number = plain.map(|value| {
                Value::Number(Number {
                    value,
                    half_digit: 0.0,
                    from_code: false,
                })
            });
            (
                *path,
                number.unwrap_or_else(|_| Value::Text((*text).to_owned())),
            )
        });
        self.replaced(texts)
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
        let step = |key: &str| Step::Key(key.to_owned());
        let force = Value::from_code(force_n);
        let mut tree = self.tree().clone();
        assign(&mut tree, &[step("near_end")], Value::Table(Vec::new()));
        for (key, value) in [
            ("push", Value::Text("constant".to_owned())),
            ("force", force),
        ] {
            assign(&mut tree, &[step("near_end"), step(key)], value);
        }
        let own = Reading {
            preload: PreloadReading::None,
            ..self.reading()
        };
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
        let text = |name: Option<&str>| name.map(|name| Value::Text(name.to_owned()));
        let corner = corner_hz.map(Value::from_code);
        let steps = ["campaign", "amplifier"].map(|key| Step::Key(key.to_owned()));
        let mut tree = self.tree().clone();
        for (key, value) in [
            ("low_pass", corner),
            ("order", text(order)),
            ("kind", text(kind)),
        ] {
            if let Some(value) = value {
                let key = Step::Key(key.to_owned());
                assign(&mut tree, &[&steps[..], &[key]].concat(), value);
            }
        }
        Ok(self.with_tree(tree)?)
    }

    fn slots(&self) -> Vec<Slot<'_>> {
        slots::all(self.tree(), self.units())
    }

    fn replaced<'a>(
        &self,
        values: impl Iterator<Item = (&'a str, Value)>,
    ) -> Result<Self, PathError> {
        let slots = self.slots();
        let mut tree = self.tree().clone();
        let mut found = Vec::new();
        for (path, value) in values {
            found.push((find(&slots, path)?, value));
        }
        for (slot, _) in &found {
            self.keep_numbers(&slots, slot, &mut tree);
        }
        for (slot, value) in found {
            assign(&mut tree, &slot.steps, value);
            let reference = slot
                .is_derived
                .then(|| self.reference(&slot.path))
                .flatten();
            if let Some(contact) = reference.and_then(|found| found.contact) {
                assign(
                    &mut tree,
                    &next_to(&slot.steps, CONTACT),
                    Value::from_code(contact as f64),
                );
            }
        }
        Ok(self.with_tree(tree)?)
    }

    /// Before a number is changed on which units of its law depend, as N/m^n does on
    /// n: what the file gives in them was checked against the file's own number, and
    /// is kept as a plain number in SI, in the unit that is to be.
    fn keep_numbers(&self, slots: &[Slot<'_>], changed: &Slot<'_>, tree: &mut Node) {
        for follower in slots.iter().filter(|slot| slot.follows(changed)) {
            if let Some(si) = follower.value(self.units()) {
                let number = Number {
                    value: si.value,
                    half_digit: si.half_digit,
                    from_code: true,
                };
                assign(tree, &follower.steps, Value::Number(number));
            }
        }
    }
}

/// Steps to another key of the same table.
fn next_to(steps: &[Step], key: &str) -> Vec<Step> {
    let (_, table) = steps.split_last().unwrap_or((&Step::Index(0), &[]));
    let key = Step::Key(key.to_owned());
    table.iter().cloned().chain([key]).collect()
}

/// The slot of a path or of an end of one: given numbers come first.
fn find<'a, 'b>(slots: &'b [Slot<'a>], path: &str) -> Result<&'b Slot<'a>, PathError> {
    if let Some(exact) = slots.iter().find(|slot| slot.path == path) {
        return Ok(exact);
    }
    let ending = format!(".{path}");
    let fitting: Vec<&Slot<'_>> = slots.iter().filter(|s| s.path.ends_with(&ending)).collect();
    let given: Vec<&Slot<'_>> = fitting
        .iter()
        .copied()
        .filter(|s| s.node.is_some())
        .collect();
    match (&given[..], &fitting[..]) {
        ([only], _) | ([], [only]) => Ok(only),
        ([], []) => Err(PathError::Unknown {
            path: path.to_owned(),
            nearest: nearest_path(path, slots),
        }),
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
    let near = nearest::of(path, ends.iter().map(String::as_str))?;
    let at = ends.iter().position(|end| end == near)?;
    slots.get(at).map(|slot| slot.path.clone())
}

/// Puts a value at the end of some steps, making tables on the way.
fn assign(node: &mut Node, steps: &[Step], value: Value) {
    match steps.split_first() {
        None => node.value = value,
        Some((Step::Key(key), rest)) => assign(entry(node, key), rest, value),
        Some((Step::Index(index), rest)) => {
            if let Value::List(members) = &mut node.value
                && let Some(member) = members.get_mut(*index)
            {
                assign(member, rest, value);
            }
        }
    }
}

/// The value of a key; a law given by its name alone becomes a table.
fn entry<'a>(node: &'a mut Node, key: &str) -> &'a mut Node {
    let span = node.span.clone();
    let fresh = |key: &str, value: Value| Entry {
        key: key.to_owned(),
        key_span: span.clone(),
        node: Node {
            value,
            span: span.clone(),
        },
    };
    let mut entries = match std::mem::replace(&mut node.value, Value::Flag(false)) {
        Value::Table(entries) => entries,
        Value::Text(law) => vec![fresh("law", Value::Text(law))],
        _ => Vec::new(),
    };
    let at = entries.iter().position(|entry| entry.key == key);
    let at = at.unwrap_or_else(|| {
        entries.push(fresh(key, Value::Table(Vec::new())));
        entries.len() - 1
    });
    node.value = Value::Table(entries);
    match &mut node.value {
        Value::Table(entries) => &mut entries[at].node,
        _ => unreachable!("the value has just been made a table"),
    }
}
