//! Three numbers of a material that are two of its contacts.

use super::model::Model;
use crate::free::{Form, FreeNumber};
use hertzchain_experiment::Experiment;

/// Young modulus, Poisson ratio and viscosity, as paths end.
const THREE: [&str; 3] = ["young_modulus", "poisson_ratio", "shear_viscosity"];

/// That Young modulus, Poisson ratio and viscosity of one material enter through two
/// numbers of its contacts alone, where all three are free, and what to free instead.
pub(super) fn three_for_two(model: &Model) -> Option<String> {
    let numbers = model.numbers.iter();
    let constant = numbers.filter(|number| number.form != Form::EachSpeed);
    let owners: Vec<(&str, &str)> = constant.filter_map(FreeNumber::material_number).collect();
    let all = |owner: &str| THREE.iter().all(|number| owners.contains(&(owner, number)));
    let (owner, _) = owners.iter().find(|(owner, _)| all(owner))?;
    let experiment = &model.experiment;
    let [stiffness, relaxation] = names(experiment, owner);
    Some(format!(
        "Young modulus, Poisson ratio and viscosity of `{owner}` enter only through K and A of its contacts, \
         three numbers for two: free K and A instead (--free {stiffness},{relaxation}), or keep one of the three fixed"
    ))
}

/// Names of K and A of the contacts whose material this is.
fn names(experiment: &Experiment, owner: &str) -> [String; 2] {
    let own = |wet: bool| {
        let mut sections = experiment.sections().iter();
        sections.any(|s| s.wet == wet && experiment.effective_material(s) == Some(owner))
    };
    let prefix = match FreeNumber::find(experiment, "K", None) {
        Ok(_) => "",
        Err(_) if own(true) => "wet.",
        Err(_) => "dry.",
    };
    ["K", "A"].map(|name| format!("{prefix}{name}"))
}
