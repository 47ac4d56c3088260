use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// Cubic in the overlap rate [Labbe2017]: F = B δ̇³ while in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingCubic {
    /// B in kg s/m².
    pub coefficient_kg_s_m2: f64,
}

impl Term<1> for DampingCubic {
    const INFO: LawInfo = LawInfo {
        name: "damping_cubic",
        equation: "F = B δ̇³",
        parameters: &[Parameter {
            name: "coefficient",
            unit: "kg s/m^2",
            meaning: "coefficient B",
            source: Source::Required,
            least: 0.0,
        }],
        validity: "phenomenological, fitted between 0.075 and 1.23 m/s; acts at once when a contact closes",
        reference: "Labbe2017",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { coefficient_kg_s_m2: values[0].unwrap_or(f64::NAN) }
    }

    fn coefficients(&self, _pair: &BeadPair) -> Result<[f64; 1], LawError> {
        Ok([self.coefficient_kg_s_m2])
    }

    fn force(k: &[f64; 1], contact: Closed) -> f64 {
        k[0] * contact.rate * contact.rate * contact.rate
    }
}
