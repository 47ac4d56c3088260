//! Evidence under the rounding of the printed constants, which are drawn anew within half a unit
//! of their last digit.

use crate::claims::{Evaluator, Evidence, Oil};
use crate::reproduce::{Cases, Effort, Gathering, OILS, ReproduceError, SPEEDS_M_S, gather};
use hertzchain_chain::laws::{DampingCubic, law};
use hertzchain_chain::{Bead, Chain, FarEnd, Material, Start};
use hertzchain_experiment::Reading;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Half units of the last printed digits, in SI.
mod half {
    /// Young moduli, printed in GPa without decimals.
    pub(super) const YOUNG_MODULUS_PA: f64 = 0.5e9;
    /// Viscosity of the dry balls, 3.2e4 Pa s.
    pub(super) const DRY_VISCOSITY_PA_S: f64 = 0.05e4;
    /// Coefficient of the cubic term, 77 kg s/m².
    pub(super) const CUBIC_KG_S_M2: f64 = 0.5;
    /// Mass, 8.54 g.
    pub(super) const MASS_KG: f64 = 0.005e-3;
    /// Radius, 6.35 mm.
    pub(super) const RADIUS_M: f64 = 0.005e-3;
    /// Prefactors of the oils' Poisson ratios.
    pub(super) const POISSON_PREFACTOR: f64 = 0.0005;
    /// Prefactors of the oils' viscosities.
    pub(super) const VISCOSITY_PREFACTOR_PA_S: f64 = 0.05;
    /// Exponents of both.
    pub(super) const EXPONENT: f64 = 0.0005;
}

/// How far the Poisson ratio 0.3 of the dry balls may be off: the paper prints
/// one digit where handbooks have two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DryPoisson {
    /// The handbooks' 0.30, within 0.005.
    TwoDigits,
    /// 0.3 to the letter, within 0.05.
    #[default]
    OneDigit,
}

impl DryPoisson {
    fn half_unit(self) -> f64 {
        match self {
            Self::TwoDigits => 0.005,
            Self::OneDigit => 0.05,
        }
    }
}

/// Offsets of one oil's constants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct WetOffsets {
    young_modulus_pa: f64,
    poisson_prefactor: f64,
    poisson_exponent: f64,
    viscosity_prefactor_pa_s: f64,
    viscosity_exponent: f64,
    kinematic_viscosity: f64,
    density: f64,
}

/// One draw of all printed constants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draw {
    young_modulus_pa: f64,
    poisson_ratio: f64,
    viscosity_pa_s: f64,
    cubic_kg_s_m2: f64,
    mass_kg: f64,
    radius_m: f64,
    oils: Vec<(&'static str, WetOffsets)>,
}

/// Half units of kinematic viscosity (m²/s) and density (kg/m³) of the oils.
const LIQUIDS: [(&str, f64, f64); 3] =
    [("pump", 0.5e-6, 0.5), ("gear", 0.5e-6, 0.5), ("motor", 0.05e-6, 0.05)];

/// Prefactors of the oils' Poisson ratios and viscosities: their values at 1 m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prefactors {
    /// Of the Poisson ratio.
    pub poisson_ratio: f64,
    /// Of the viscosity in Pa s.
    pub viscosity_pa_s: f64,
}

impl Prefactors {
    /// Of the wet contacts of a chain that is hit at 1 m/s.
    #[must_use]
    pub fn of(chain: &Chain) -> Option<Self> {
        let material = chain.sections.iter().find_map(|section| section.material)?;
        Some(Self {
            poisson_ratio: material.poisson_ratio,
            viscosity_pa_s: material.shear_viscosity_pa_s,
        })
    }
}

impl Draw {
    /// Draw `index` of a seed; each has a stream of its own.
    #[must_use]
    pub fn new(seed: u64, index: u64, dry_poisson: DryPoisson) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(index);
        let mut within = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        Self {
            young_modulus_pa: within(half::YOUNG_MODULUS_PA),
            poisson_ratio: within(dry_poisson.half_unit()),
            viscosity_pa_s: within(half::DRY_VISCOSITY_PA_S),
            cubic_kg_s_m2: within(half::CUBIC_KG_S_M2),
            mass_kg: within(half::MASS_KG),
            radius_m: within(half::RADIUS_M),
            oils: LIQUIDS.map(|row| (row.0, WetOffsets::draw(&mut within, row))).to_vec(),
        }
    }

    /// Changes a chain of a case, hit at a speed.
    pub fn change(
        &self,
        case: &str,
        speed_m_s: f64,
        prefactors: Option<Prefactors>,
        chain: &mut Chain,
    ) {
        for bead in &mut chain.beads {
            self.change_bead(bead);
        }
        if let Start::Striker { bead, .. } | Start::Driven { bead, .. } = &mut chain.start {
            self.change_bead(bead);
        }
        self.change_far_end(&mut chain.far);
        let oil = self.oils.iter().find(|(name, _)| *name == case);
        for section in &mut chain.sections {
            if let (Some(material), Some((_, oil)), Some(at_1)) =
                (&mut section.material, oil, prefactors)
            {
                oil.change(material, speed_m_s, at_1);
            }
            for term in &mut section.laws {
                if let Some(cubic) = self.cubic(term.info().name) {
                    *term = cubic;
                }
            }
        }
    }

    /// The cubic law with its drawn coefficient, in place of the printed one.
    fn cubic(&self, name: &str) -> Option<std::sync::Arc<dyn hertzchain_chain::laws::Law>> {
        let coefficient_kg_s_m2 = PRINTED_CUBIC_KG_S_M2 + self.cubic_kg_s_m2;
        (name == "damping_cubic").then(|| law(DampingCubic { coefficient_kg_s_m2 }))
    }

    fn change_bead(&self, bead: &mut Bead) {
        bead.mass_kg += self.mass_kg;
        bead.radius_m += self.radius_m;
        self.change_steel(&mut bead.material);
    }

    fn change_far_end(&self, far: &mut FarEnd) {
        match far {
            FarEnd::HalfBead { radius_m, material } | FarEnd::Stop { radius_m, material, .. } => {
                *radius_m += self.radius_m;
                self.change_steel(material);
            }
            FarEnd::Plane { material } | FarEnd::PlaneStop { material, .. } => {
                self.change_steel(material);
            }
            FarEnd::Periodic { .. } | FarEnd::Free => {}
        }
    }

    fn change_steel(&self, material: &mut Material) {
        material.young_modulus_pa += self.young_modulus_pa;
        material.poisson_ratio += self.poisson_ratio;
        for viscosity in [&mut material.shear_viscosity_pa_s, &mut material.bulk_viscosity_pa_s] {
            // A chain without viscosity, or without bulk viscosity, stays so.
            if *viscosity > 0.0 {
                *viscosity += self.viscosity_pa_s;
            }
        }
    }

    /// The liquids' own constants, drawn.
    pub(crate) fn change_oils(&self, oils: &mut [Oil]) {
        for oil in oils {
            if let Some((_, offsets)) = self.oils.iter().find(|(name, _)| *name == oil.case) {
                oil.kinematic_viscosity_m2_s += offsets.kinematic_viscosity;
                oil.density_kg_m3 += offsets.density;
            }
        }
    }
}

/// B as printed, in kg s/m².
const PRINTED_CUBIC_KG_S_M2: f64 = 77.0;

impl WetOffsets {
    fn draw(within: &mut impl FnMut(f64) -> f64, liquid: (&str, f64, f64)) -> Self {
        Self {
            young_modulus_pa: within(half::YOUNG_MODULUS_PA),
            poisson_prefactor: within(half::POISSON_PREFACTOR),
            poisson_exponent: within(half::EXPONENT),
            viscosity_prefactor_pa_s: within(half::VISCOSITY_PREFACTOR_PA_S),
            viscosity_exponent: within(half::EXPONENT),
            kinematic_viscosity: within(liquid.1),
            density: within(liquid.2),
        }
    }

    /// (p + Δp) v^(e + Δe) = p v^e · (1 + Δp/p) v^Δe.
    fn change(&self, material: &mut Material, speed_m_s: f64, at_1: Prefactors) {
        material.young_modulus_pa += self.young_modulus_pa;
        material.poisson_ratio *= (1.0 + self.poisson_prefactor / at_1.poisson_ratio)
            * speed_m_s.powf(self.poisson_exponent);
        let viscosity = (1.0 + self.viscosity_prefactor_pa_s / at_1.viscosity_pa_s)
            * speed_m_s.powf(self.viscosity_exponent);
        material.shear_viscosity_pa_s *= viscosity;
        material.bulk_viscosity_pa_s *= viscosity;
    }
}

/// Accuracies of a draw's shots: the next one where the last leaves it open on
/// which side of a threshold a number lies.
const ACCURACIES: [f64; 2] = [1e-6, 1e-7];

/// Draws the printed constants anew and shoots, in a reading, all cases at all speeds of the tables
/// for each draw, as accurately as the claims take to be decided on it.
///
/// # Errors
/// The first shot that can't be computed.
pub(crate) fn rounded_evidence(
    evaluators: &[Evaluator],
    reading: &Reading,
    (seed, draws): (u64, usize),
    dry_poisson: DryPoisson,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Evidence>, ReproduceError> {
    let cases = Cases::new(reading)?;
    let mut prefactors = Vec::new();
    for case in OILS {
        if let Some(experiment) = cases.get(case) {
            prefactors.push((case, Prefactors::of(&experiment.chain(Some(1.0))?.0)));
        }
    }
    let one = |index: usize| {
        let draw = Draw::new(seed, index as u64, dry_poisson);
        let change = |case: &str, speed: f64, chain: &mut Chain| {
            let own = prefactors.iter().find(|(name, _)| *name == case);
            draw.change(case, speed, own.and_then(|(_, p)| *p), chain);
        };
        let evidence = sharpened(evaluators, &ACCURACIES, &|accuracy| {
            let how = Gathering {
                reading: *reading,
                speeds_m_s: &SPEEDS_M_S,
                accuracy,
                effort: Effort::Lean(evaluators),
            };
            let mut evidence = gather(&how, &change, &|| {})?;
            draw.change_oils(&mut evidence.oils);
            Ok(evidence)
        });
        done();
        evidence
    };
    (0..draws).map(one).collect()
}

/// Evidence at the first of some accuracies at which no claim is left open, or
/// at the last.
pub(super) fn sharpened(
    evaluators: &[Evaluator],
    accuracies: &[f64],
    gather: &dyn Fn(f64) -> Result<Evidence, ReproduceError>,
) -> Result<Evidence, ReproduceError> {
    let mut evidence = Evidence::default();
    for accuracy in accuracies {
        evidence = gather(*accuracy)?;
        let mut findings = evaluators.iter().map(|evaluator| evaluator.decide(&evidence));
        if !findings.any(|finding| finding.is_open()) {
            break;
        }
    }
    Ok(evidence)
}

#[cfg(test)]
#[path = "tests/sharpened.rs"]
mod tests;
