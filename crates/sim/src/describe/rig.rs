//! What stands around the chain, as the file describes it.

use super::{Group, Value};
use hertzchain_experiment::{Experiment, RigPart};

/// One line a part that the file names. No number of them is computed with.
pub(super) fn rig(experiment: &Experiment) -> Option<Group> {
    let rig = experiment.rig()?;
    let mut group = Group::new("Rig, described only: nothing is computed from it");
    if let Some(beads) = &rig.beads {
        group.text("beads", beads);
    }
    for part in &rig.parts {
        group.parts(part.kind.key().replace('_', " "), described(part));
    }
    Some(group)
}

fn described(part: &RigPart) -> Group {
    let mut parts = Group::new("");
    parts.text("name", part.name.clone());
    let mut number = |name: &str, value: Option<f64>, unit: &str| {
        value.into_iter().for_each(|value| parts.number(name, value, unit));
    };
    number("mass", part.mass_kg, "kg");
    number("length", part.length_m, "m");
    number("force", part.force_n, "N");
    number("rate", part.rate_hz, "Hz");
    if let Some(bits) = part.bits {
        parts.put("resolution", Value::Count(bits), "bits");
    }
    parts
}
