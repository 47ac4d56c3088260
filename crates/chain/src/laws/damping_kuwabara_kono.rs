use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// Viscoelastic spheres with a measured coefficient [KuwabaraKono1987]:
/// F = γ √δ δ̇.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingKuwabaraKono {
    /// γ in N s/m^{3/2}.
    pub coefficient: f64,
}

impl Term<1> for DampingKuwabaraKono {
    const INFO: LawInfo = LawInfo {
        name: "damping_kuwabara_kono",
        equation: "F = γ √δ δ̇",
        parameters: &[Parameter {
            name: "coefficient",
            unit: "N s/m^(3/2)",
            meaning: "coefficient γ",
            source: Source::Required,
            least: 0.0,
        }],
        validity: "viscoelastic spheres, γ from a measured restitution",
        reference: "KuwabaraKono1987",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { coefficient: values[0].unwrap_or(f64::NAN) }
    }

    fn coefficients(&self, _pair: &BeadPair) -> Result<[f64; 1], LawError> {
        Ok([self.coefficient])
    }

    fn force(&[coefficient]: &[f64; 1], contact: Closed) -> f64 {
        coefficient * contact.root * contact.rate
    }
}
