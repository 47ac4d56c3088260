//! Three numbers of a material that are two of its contacts.

use super::model::Model;
use crate::free::{Form, FreeNumber};
use hertzchain_experiment::Experiment;
use std::fmt::Write;

/// Young modulus, Poisson ratio and viscosity, as paths end.
const THREE: [&str; 3] = ["young_modulus", "poisson_ratio", "shear_viscosity"];

/// Change of the Poisson ratio in an example of another three.
const ASIDE: f64 = 0.02;

/// That Young modulus, Poisson ratio and viscosity of one material enter through two
/// numbers of its contacts alone, where all three are free: with these two, another three
/// that have the same two, and what to free instead.
pub(super) fn three_for_two(model: &Model) -> Option<String> {
    let numbers = model.numbers().as_slice().iter();
    let constant = numbers.filter(|number| number.form() != Form::EachSpeed);
    let owners: Vec<(&str, &str)> = constant.filter_map(FreeNumber::material_number).collect();
    let all = |owner: &str| THREE.iter().all(|number| owners.contains(&(owner, number)));
    let (owner, _) = owners.iter().find(|(owner, _)| all(owner))?;
    let experiment = model.experiment();
    let [stiffness, relaxation] = names(experiment, owner);
    let mut text = format!(
        "Young modulus, Poisson ratio and viscosity of `{owner}` enter only through K and A of its contacts, \
         three numbers for two: free K and A instead (--free {stiffness},{relaxation}), or keep one of the three fixed"
    );
    if let Some(shown) = shown(experiment, owner) {
        // A text takes whatever is written into it.
        let _ = write!(text, ". {shown}");
    }
    Some(text)
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

/// Two threes with one pair of K and A: the file's own, and one whose Poisson ratio is a
/// little larger. K goes as Y/(1 − ν²), and A is linear in η.
fn shown(experiment: &Experiment, owner: &str) -> Option<String> {
    let paths = THREE.map(|number| format!("materials.{owner}.{number}"));
    let [young, poisson, eta] = paths.each_ref().map(|path| experiment.get(path).ok());
    let (young, poisson, eta) = (young?, poisson?, eta?);
    let [stiffness, relaxation] = names(experiment, owner);
    let of = |name: &str, values: [f64; 3]| {
        let pairs = paths.iter().map(String::as_str).zip(values);
        let changed = experiment.set(&pairs.collect::<Vec<_>>()).ok()?;
        let number = FreeNumber::find(&changed, name, None).ok()?;
        Some(number.parameters(&[1.0]).first()?.start)
    };
    let own = [young, poisson, eta];
    let (k, a) = (of(&stiffness, own)?, of(&relaxation, own)?);
    let other = poisson + ASIDE;
    let softer = young * (1.0 - other * other) / (1.0 - poisson * poisson);
    let once = of(&relaxation, [softer, other, eta])?;
    let twice = of(&relaxation, [softer, other, 2.0 * eta])?;
    let thinner = eta * (1.0 + (a - once) / (twice - once));
    Some(format!(
        "Y = {young:.4e} Pa, nu = {poisson:.3}, eta = {eta:.4e} Pa s and Y = {softer:.4e} Pa, nu = {other:.3}, \
         eta = {thinner:.4e} Pa s are the same chain: K = {k:.4e} N/m^1.5, A = {a:.4e} s"
    ))
}
