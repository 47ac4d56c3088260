//! What was understood of an experiment, in SI, and what follows from it
//! without running anything.

mod chain;
mod contact;
mod dimer;
mod rest;
mod rig;
mod small_waves;
mod theory;

use crate::error::StudyError;
use hertzchain_chain::{Chain, System};
use hertzchain_experiment::{Experiment, Units};
use serde::{Serialize, Serializer};
use theory::Waves;

/// A value of one row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number in the row's unit.
    Number(f64),
    /// A number of things.
    Count(usize),
    /// From a least to a largest number.
    Range(f64, f64),
    /// Words.
    Text(String),
    /// What describes one thing: its numbers, and words that need no name.
    #[serde(serialize_with = "by_key")]
    Parts(Vec<Row>),
}

/// Parts by their names, each with its unit.
fn by_key<S: Serializer>(parts: &[Row], serializer: S) -> Result<S::Ok, S::Error> {
    let key = |part: &Row| {
        let words = [part.name.as_str(), part.unit.as_str()];
        let words = words.into_iter().filter(|word| !word.is_empty());
        let words = words.map(|word| word.replace([' ', '/'], "_").to_lowercase());
        words.collect::<Vec<_>>().join("_")
    };
    serializer.collect_map(parts.iter().map(|part| (key(part), &part.value)))
}

fn trimmed<S: Serializer>(name: &str, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(name.trim())
}

/// One line: a name, its value and unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What it is.
    #[serde(serialize_with = "trimmed")]
    pub name: String,
    /// Its value.
    pub value: Value,
    /// Unit; empty for plain numbers and words; dimensionless chains only count.
    pub unit: String,
}

/// Lines that belong together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// What they are about.
    pub title: String,
    /// The lines.
    pub rows: Vec<Row>,
}

impl Group {
    fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), rows: Vec::new() }
    }

    fn put(&mut self, name: impl Into<String>, value: Value, unit: &str) {
        self.rows.push(Row { name: name.into(), value, unit: unit.to_owned() });
    }

    fn number(&mut self, name: impl Into<String>, value: f64, unit: &str) {
        self.put(name, Value::Number(value), unit);
    }

    fn count(&mut self, name: impl Into<String>, count: usize) {
        self.put(name, Value::Count(count), "");
    }

    fn parts(&mut self, name: impl Into<String>, parts: Group) {
        self.put(name, Value::Parts(parts.rows), "");
    }

    fn text(&mut self, name: impl Into<String>, text: impl Into<String>) {
        self.put(name, Value::Text(text.into()), "");
    }

    /// A number, or a range if the values differ.
    fn spread(&mut self, name: impl Into<String>, values: &[f64], unit: &str) {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        match values.len() {
            0 => {}
            _ if least == most => self.number(name, least, unit),
            _ => self.put(name, Value::Range(least, most), unit),
        }
    }
}

/// An experiment in SI with what follows from it: contact constants, static
/// overlaps, linear waves, time scales, the pulse that theory expects.
///
/// `speed_m_s` replaces the file's own. The chain must be that of the
/// experiment at this speed.
///
/// # Errors
/// A chain that can't be set up.
pub fn describe(experiment: &Experiment, chain: &Chain) -> Result<Vec<Group>, StudyError> {
    let system = System::new(chain)?;
    let mut groups =
        vec![chain::experiment(experiment, chain), chain::beads(chain), chain::ends(chain)];
    groups.extend(contact::sections(experiment, chain));
    groups.push(rest::at_rest(chain, &system));
    groups.extend(rest::linear_waves(chain, &system));
    groups.push(theory::scales(&system));
    groups.extend(theory::expected(experiment, chain, &system));
    groups.extend(rig::rig(experiment));
    groups.retain(|group| !group.rows.is_empty());
    if experiment.units() == Units::Dimensionless {
        groups.iter_mut().for_each(drop_units);
    }
    Ok(groups)
}

/// What theory says of a chain's waves: the exact lattice solitary wave, the
/// long-wave theory, linear waves under preload, the collision of two beads.
///
/// # Errors
/// A chain that can't be set up.
pub fn describe_theory(experiment: &Experiment, chain: &Chain) -> Result<Vec<Group>, StudyError> {
    let system = System::new(chain)?;
    let mut groups: Vec<Group> = theory::collision(chain).into_iter().collect();
    groups.extend(theory::restitution(chain)?);
    groups.extend(large_waves(experiment, chain, &system));
    groups.extend(rest::linear_waves(chain, &system));
    groups.extend(small_waves::dispersion(chain, &system));
    groups.extend(small_waves::modes(chain, &system));
    groups.extend(theory::expected(experiment, chain, &system));
    if experiment.units() == Units::Dimensionless {
        groups.iter_mut().for_each(drop_units);
    }
    Ok(groups)
}

/// Solitary waves, as far as theory knows them in this row.
fn large_waves(experiment: &Experiment, chain: &Chain, system: &System) -> Vec<Group> {
    let known = match theory::waves(chain, system) {
        Waves::Touching => {
            vec![theory::solitary(chain), theory::profile(chain), theory::long_wave(chain)]
        }
        Waves::Loaded => vec![theory::loaded(chain, system)],
        Waves::Dimer => vec![dimer::long_wave(chain, experiment.units())],
        Waves::None(reason) => vec![Some(theory::no_waves(reason))],
    };
    known.into_iter().flatten().collect()
}

/// A dimensionless chain has numbers without units, but for counts and angles.
fn drop_units(group: &mut Group) {
    group.rows.iter_mut().for_each(drop_unit);
}

fn drop_unit(row: &mut Row) {
    row.unit = dimensionless_unit(&row.unit).to_owned();
    if let Value::Parts(parts) = &mut row.value {
        parts.iter_mut().for_each(drop_unit);
    }
}

/// What is left of a unit where lengths, masses and times have none: things
/// that are counted, and angles.
pub fn dimensionless_unit(unit: &str) -> &str {
    match unit {
        "beads" | "bits" | "°" => unit,
        "beads/s" | BEADS_A_TIME => BEADS_A_TIME,
        "cells/s" | CELLS_A_TIME => CELLS_A_TIME,
        _ => "",
    }
}

const BEADS_A_TIME: &str = "beads per unit time";
const CELLS_A_TIME: &str = "cells per unit time";
