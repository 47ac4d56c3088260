use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::{BeadPair, Material};

/// Viscoelastic spheres [Goldobin2015]: F = (3/2) A K √δ δ̇.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingViscoelastic {
    /// A in s; from the materials' viscosities when absent.
    pub relaxation_time_s: Option<f64>,
    /// K in N/m^{3/2}; from materials and radii when absent.
    pub stiffness: Option<f64>,
}

impl Term<1> for DampingViscoelastic {
    const INFO: LawInfo = LawInfo {
        name: "damping_viscoelastic",
        equation: "F = (3/2) A K √δ δ̇,  A = (1/Y) (1+ν)/(1−ν) [(4/3) η1 (1−ν+ν²) + η2 (1−2ν)²]",
        parameters: &[
            Parameter {
                name: "relaxation_time",
                unit: "s",
                meaning: "relaxation time A",
                source: Source::Materials,
                least: 0.0,
            },
            Parameter {
                name: "stiffness",
                unit: "N/m^(3/2)",
                meaning: "Hertz stiffness K of the contact",
                source: Source::Hertz,
                least: 0.0,
            },
        ],
        validity: "slow against the material's relaxation: A δ̇/δ small; ν below 1",
        reference: "Goldobin2015",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { relaxation_time_s: values[0], stiffness: values[1] }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 1], LawError> {
        let time = self
            .relaxation_time_s
            .unwrap_or_else(|| pair.mean_relaxation_time_s(Material::relaxation_time_s));
        Ok([1.5 * time * self.stiffness.unwrap_or_else(|| pair.hertz_stiffness())])
    }

    fn force(k: &[f64; 1], contact: Closed) -> f64 {
        k[0] * contact.root * contact.rate
    }
}
