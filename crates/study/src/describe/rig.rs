//! What stands around the chain, as the file describes it.

use super::Group;
use super::chain::short;
use hertzchain_experiment::{Experiment, RigPart, Units};

/// One line a part that the file names. No number of them is computed with.
pub(super) fn rig(experiment: &Experiment) -> Option<Group> {
    let rig = experiment.rig()?;
    let mut group = Group::new("Rig, described only: nothing is computed from it");
    if let Some(beads) = &rig.beads {
        group.text("beads", beads);
    }
    for part in &rig.parts {
        group.text(
            part.kind.key().replace('_', " "),
            described(part, experiment.units()),
        );
    }
    Some(group)
}

fn described(part: &RigPart, units: Units) -> String {
    let number = |value: Option<f64>, unit: &str| match units {
        Units::Si => value.map(|value| format!("{} {unit}", short(value))),
        Units::Dimensionless => value.map(short),
    };
    let numbers = [
        number(part.mass_kg, "kg"),
        number(part.length_m, "m"),
        number(part.force_n, "N"),
        part.bits.map(|bits| format!("{bits} bits")),
        number(part.rate_hz, "Hz"),
    ];
    let words = std::iter::once(part.name.clone()).chain(numbers.into_iter().flatten());
    words.collect::<Vec<_>>().join(", ")
}
