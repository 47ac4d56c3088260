//! Which contacts the K or A of a fit belongs to.

use crate::quantity::digits;
use hertzchain_experiment::{Experiment, Reference};
use hertzchain_infer::Model;
use serde_json::{Value, json};

/// The free numbers of a model that belong to contacts, and those contacts.
fn all(model: &Model) -> impl Iterator<Item = (&str, &Reference)> {
    let numbers = model.numbers.iter();
    numbers.filter_map(|number| Some((number.name(), number.reference.as_ref()?)))
}

/// Which contact each free K or A is the value of, and what the others of its section have,
/// a sentence each.
pub fn references(model: &Model) -> Vec<String> {
    let experiment = &model.experiment;
    all(model).map(|(name, reference)| sentence(name, reference, experiment.beads())).collect()
}

/// Which contact a number that was set belongs to, where its section's contacts differ.
pub(super) fn of_unlike(experiment: &Experiment, path: &str) -> Option<String> {
    let reference = experiment.reference(path)?;
    let unlike = reference.contact.is_some() && !is_one(reference.ratios);
    unlike.then(|| sentence(path, &reference, experiment.beads()))
}

/// For programs.
pub(crate) fn references_json(model: &Model) -> Value {
    let one = |(name, reference): (&str, &Reference)| {
        json!({
            "name": name,
            "contact": reference.contact,
            "contacts": [reference.contacts.start(), reference.contacts.end()],
            "ratios": reference.ratios,
        })
    };
    all(model).map(one).collect()
}

fn sentence(name: &str, reference: &Reference, beads: usize) -> String {
    let (first, last) = (reference.contacts.start(), reference.contacts.end());
    let section = match first == last {
        true => format!("contact {first}"),
        false => format!("contacts {first} to {last}"),
    };
    let Some(contact) = reference.contact else {
        return format!("{name} is one value for {section}, as the model's file has it");
    };
    let bodies = match contact {
        0 => "striker and bead 1".to_owned(),
        last if last == beads => format!("bead {beads} and the wall"),
        inner => format!("beads {inner} and {}", inner + 1),
    };
    let [least, most] = reference.ratios;
    let others = match is_one([least, most]) {
        true => format!("{section} have the same"),
        false => format!(
            "{section} keep their ratios to it, {} to {}, as materials and radii give them",
            digits(least, 4),
            digits(most, 4)
        ),
    };
    format!("{name} is that of contact {contact} ({bodies}); {others}")
}

fn is_one([least, most]: [f64; 2]) -> bool {
    most - least < SAME * most
}

/// Relative difference of values that are one: rounding.
const SAME: f64 = 1e-12;
