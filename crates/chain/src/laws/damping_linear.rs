use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// Linear dashpot while in contact: F = c δ̇ [CundallStrack1979].
#[derive(Clone, Debug, PartialEq)]
pub struct DampingLinear {
    /// c in N s/m.
    pub coefficient_n_s_m: f64,
}

impl Term<1> for DampingLinear {
    const INFO: LawInfo = LawInfo {
        name: "damping_linear",
        equation: "F = c δ̇",
        parameters: &[Parameter {
            name: "coefficient",
            unit: "N s/m",
            meaning: "dashpot constant c",
            source: Source::Required,
            least: 0.0,
        }],
        validity: "a numerical convenience; acts at once when a contact closes",
        reference: "CundallStrack1979",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { coefficient_n_s_m: values[0].unwrap_or(f64::NAN) }
    }

    fn coefficients(&self, _pair: &BeadPair) -> Result<[f64; 1], LawError> {
        Ok([self.coefficient_n_s_m])
    }

    fn force(&[coefficient]: &[f64; 1], contact: Closed) -> f64 {
        coefficient * contact.rate
    }
}
