//! Every value of a chain, looked at before it is used.

use crate::chain::{Bead, Chain, ChainError, FarEnd, Push, Start};
use crate::material::Material;

fn must(
    holds: bool,
    what: impl Fn() -> String,
    value: f64,
    expected: &'static str,
) -> Result<(), ChainError> {
    match holds {
        true => Ok(()),
        false => Err(ChainError::Value { what: what(), value, expected }),
    }
}

pub(crate) fn positive(what: impl Fn() -> String, value: f64) -> Result<(), ChainError> {
    must(value.is_finite() && value > 0.0, what, value, "positive and finite")
}

fn finite(what: impl Fn() -> String, value: f64) -> Result<(), ChainError> {
    must(value.is_finite(), what, value, "finite")
}

fn at_least_zero(what: impl Fn() -> String, value: f64) -> Result<(), ChainError> {
    must(value.is_finite() && value >= 0.0, what, value, "0 or more, and finite")
}

fn check_bead(bead: &Bead, name: impl Fn() -> String) -> Result<(), ChainError> {
    positive(|| format!("radius of {}", name()), bead.radius_m)?;
    positive(|| format!("mass of {}", name()), bead.mass_kg)?;
    check_material(&bead.material, name)
}

/// A rigid material has an infinite Young modulus.
fn check_material(material: &Material, name: impl Fn() -> String) -> Result<(), ChainError> {
    let (modulus, ratio) = (material.young_modulus_pa, material.poisson_ratio);
    must(modulus > 0.0, || format!("Young modulus in Pa of {}", name()), modulus, "positive")?;
    let sound = ratio > -1.0 && ratio < 1.0;
    must(sound, || format!("Poisson ratio of {}", name()), ratio, "between -1 and 1")?;
    at_least_zero(|| format!("shear viscosity of {}", name()), material.shear_viscosity_pa_s)?;
    at_least_zero(|| format!("bulk viscosity of {}", name()), material.bulk_viscosity_pa_s)
}

pub(super) fn check_values(chain: &Chain) -> Result<(), ChainError> {
    if chain.beads.is_empty() {
        return Err(ChainError::Layout("a chain needs at least one bead".into()));
    }
    for (i, bead) in chain.beads.iter().enumerate() {
        check_bead(bead, || format!("bead {}", i + 1))?;
    }
    check_start(chain)?;
    check_far(&chain.far)?;
    at_least_zero(|| "push on bead 1 in N".into(), chain.push.force_n())?;
    if let Push::Spring { stiffness_n_m, .. } = chain.push {
        at_least_zero(|| "stiffness of the push in N/m".into(), stiffness_n_m)?;
    }
    for section in &chain.sections {
        let name =
            || format!("contacts {} to {}", section.contacts.start(), section.contacts.end());
        section.material.map_or(Ok(()), |material| check_material(&material, name))?;
    }
    finite(|| "incline in rad".into(), chain.incline_rad)?;
    at_least_zero(|| "gravity in m/s²".into(), chain.gravity_m_s2)?;
    chain.suspension_m.map_or(Ok(()), |length| positive(|| "suspension in m".into(), length))?;
    for gap in &chain.gaps {
        contact_exists(chain, gap.contact, "a gap")?;
        at_least_zero(|| format!("gap of contact {} in m", gap.contact), gap.gap_m)?;
    }
    for initial in &chain.initial {
        if !(1..=chain.beads.len()).contains(&initial.bead) {
            let what =
                format!("bead {} has an initial state but is not in the chain", initial.bead);
            return Err(ChainError::Layout(what));
        }
        finite(|| format!("displacement of bead {}", initial.bead), initial.displacement_m)?;
        finite(|| format!("velocity of bead {}", initial.bead), initial.velocity_m_s)?;
    }
    Ok(())
}

pub(super) fn contact_exists(chain: &Chain, contact: usize, who: &str) -> Result<(), ChainError> {
    match contact <= chain.beads.len() {
        true => Ok(()),
        false => Err(ChainError::Layout(format!(
            "{who} names contact {contact}, but contacts are 0..={}",
            chain.beads.len()
        ))),
    }
}

fn check_start(chain: &Chain) -> Result<(), ChainError> {
    let periodic = matches!(chain.far, FarEnd::Periodic { .. });
    if periodic && !matches!(chain.start, Start::Free) {
        return Err(ChainError::Layout("a ring has no end to strike or drive".into()));
    }
    match &chain.start {
        Start::Striker { bead, speed_m_s } => {
            check_bead(bead, || "the striker".into())?;
            positive(|| "speed of the striker in m/s".into(), *speed_m_s)
        }
        Start::Driven { bead, motion } => {
            positive(|| "radius of the driven end".into(), bead.radius_m)?;
            motion.check().map_err(|what| ChainError::Layout(format!("driven end: {what}")))
        }
        Start::Free => Ok(()),
    }
}

fn check_far(far: &FarEnd) -> Result<(), ChainError> {
    match *far {
        FarEnd::HalfBead { radius_m, .. } => {
            positive(|| "radius of the half-bead".into(), radius_m)
        }
        FarEnd::Stop { radius_m, mass_kg, .. } => {
            positive(|| "radius of the half-bead".into(), radius_m)?;
            positive(|| "mass of the stop".into(), mass_kg)
        }
        FarEnd::PlaneStop { mass_kg, .. } => positive(|| "mass of the stop".into(), mass_kg),
        FarEnd::Periodic { force_n } => {
            at_least_zero(|| "static force of the ring".into(), force_n)
        }
        FarEnd::Plane { .. } | FarEnd::Free => Ok(()),
    }
}
