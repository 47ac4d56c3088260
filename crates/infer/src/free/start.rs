//! Where a free number starts and what it may be.

use super::name::{Found, LOW_PASS, Target};
use hertzchain_chain::laws;
use hertzchain_experiment::Experiment;
use std::f64::consts::FRAC_PI_2;

const GRAVITY: &str = "track.gravity";

/// A change of an exponent that matters.
pub(super) const EXPONENT_SCALE: f64 = 0.1;

/// No property of a contact depends on speed more strongly.
pub(super) const MOST_EXPONENT: f64 = 5.0;

/// Poisson ratios of the paper's oils go beyond 1/2; the laws end below 1.
const MOST_POISSON_RATIO: f64 = 0.999;

/// The value to start from: asked for, given in the file, or derived from its materials.
pub(super) fn of(experiment: &Experiment, found: &Found, asked: Option<f64>) -> Option<(f64, f64)> {
    let given = found.given.or_else(|| Some((derived(experiment, found)?, 0.0)));
    match asked {
        Some(value) => Some((value, given.map_or(0.0, |(_, exponent)| exponent))),
        None => given,
    }
}

/// Stiffness and relaxation time of a section's reference contact as they follow from
/// materials and radii, at the experiment's own speed; a bulk viscosity as the shear one.
fn derived(experiment: &Experiment, found: &Found) -> Option<f64> {
    let Target::Number(path) = &found.target else {
        return None;
    };
    if path == LOW_PASS {
        return Some(experiment.campaign().amplifier.low_pass_hz);
    }
    if path == GRAVITY {
        return Some(experiment.chain(None).ok()?.0.gravity_m_s2);
    }
    if let Some(material) = path.strip_suffix("bulk_viscosity") {
        return experiment.get(&format!("{material}shear_viscosity")).ok();
    }
    let wet = [".film_entrained.", ".film_drained.", ".capillary_bridge."];
    let parameter = wet.into_iter().find_map(|law| Some(path.split_once(law)?.1));
    if let Some(parameter) = parameter {
        return experiment.liquid()?.value(parameter);
    }
    let reference = experiment.reference(path)?;
    reference.own_value.filter(|value| *value > 0.0)
}

/// Steepest exponent of a force that the experiment file takes.
const STEEPEST: f64 = 100.0;

/// What a parameter of a contact law may be, as its law declares.
fn of_law(path: &str) -> Option<(f64, f64)> {
    let (section, name) = path.rsplit_once('.')?;
    let law = laws::find(section.rsplit_once(".laws.")?.1)?;
    let parameter = law.info.parameters.iter().find(|p| p.name == name)?;
    let most = match name {
        "exponent" => STEEPEST,
        _ => f64::INFINITY,
    };
    let least = match name {
        "stiffness" => f64::MIN_POSITIVE,
        _ => parameter.least,
    };
    Some((least, most))
}

/// Delays and errors of radii of so many s and m matter.
const MICRO: f64 = 1e-6;

/// A change of a number that matters, from its value at the start.
pub(super) fn scale(target: &Target, start: f64) -> f64 {
    match target {
        Target::Delay(_) | Target::Radii(_) => MICRO,
        _ if start == 0.0 => 1.0,
        _ => start.abs(),
    }
}

/// What a number may be, as far as its name says.
pub(super) fn bounds(found: &Found) -> (f64, f64) {
    if matches!(found.target, Target::Delay(_) | Target::Radii(_)) {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let Some(path) = found.target.path() else {
        return (f64::MIN_POSITIVE, f64::INFINITY);
    };
    if let Some(bounds) = of_law(path) {
        return bounds;
    }
    match path.rsplit('.').next().unwrap_or_default() {
        "poisson_ratio" => (0.0, MOST_POISSON_RATIO),
        "exponent" => (-MOST_EXPONENT, MOST_EXPONENT),
        // The experiment file takes no other: the wall is below.
        "incline" => (0.0, FRAC_PI_2),
        "prefactor" | "young_modulus" | "stiffness" | "mass" | "radius" | "density"
        | "low_pass" => (f64::MIN_POSITIVE, f64::INFINITY),
        _ => (0.0, f64::INFINITY),
    }
}
