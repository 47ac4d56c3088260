use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::Pair;

/// Cubic in the overlap rate [Labbe2017]: F = B δ̇³ whether or not in contact,
/// as one reading of the equation with its rate kept when a contact opens.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingCubicUngated {
    /// B in kg s/m².
    pub coefficient_kg_s_m2: f64,
}

impl Term<1> for DampingCubicUngated {
    const INFO: LawInfo = LawInfo {
        name: "damping_cubic_ungated",
        equation: "F = B δ̇³, also between bodies that do not touch",
        parameters: &[Parameter {
            name: "coefficient",
            unit: "kg s/m^2",
            meaning: "coefficient B",
            source: Source::Required,
            least: 0.0,
        }],
        validity: "a reading of the printed equation, for comparison only: no known mechanism acts across a gap",
        reference: "Labbe2017",
        nature: Nature::Dissipative,
        gated: false,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self {
            coefficient_kg_s_m2: values[0].unwrap_or(f64::NAN),
        }
    }

    fn coefficients(&self, _pair: &Pair) -> Result<[f64; 1], LawError> {
        Ok([self.coefficient_kg_s_m2])
    }

    fn force(&[coefficient]: &[f64; 1], contact: Closed) -> f64 {
        coefficient * contact.rate * contact.rate * contact.rate
    }
}
