use super::{Closed, DampingViscoelastic, LawError, LawInfo, Nature, Term};
use crate::material::{BeadPair, Material};

/// Viscoelastic spheres as first derived [Brilliantov1996]: the same form as
/// the later law, another A.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingBrilliantov1996 {
    /// A in s; from the materials' viscosities when absent.
    pub relaxation_time_s: Option<f64>,
    /// K in N/m^{3/2}; from materials and radii when absent.
    pub stiffness: Option<f64>,
}

impl Term<1> for DampingBrilliantov1996 {
    const INFO: LawInfo = LawInfo {
        name: "damping_brilliantov_1996",
        equation: "F = (3/2) A K √δ δ̇,  A = (1/3) (3η2−η1)²/(3η2+2η1) (1−ν²)(1−2ν)/(Y ν²)",
        parameters: DampingViscoelastic::INFO.parameters,
        validity: "as damping_viscoelastic; its A vanishes at ν = 1/2 and diverges at ν = 0",
        reference: "Brilliantov1996",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { relaxation_time_s: values[0], stiffness: values[1] }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 1], LawError> {
        let time = self
            .relaxation_time_s
            .unwrap_or_else(|| pair.mean_relaxation_time_s(Material::relaxation_time_1996_s));
        if time < 0.0 {
            let what =
                format!("A = {time:e} s is negative; it needs a Poisson ratio of at most 1/2");
            return Err(LawError { law: Self::INFO.name, what });
        }
        Ok([1.5 * time * self.stiffness.unwrap_or_else(|| pair.hertz_stiffness())])
    }

    fn force(&[damping]: &[f64; 1], contact: Closed) -> f64 {
        damping * contact.root * contact.rate
    }
}
