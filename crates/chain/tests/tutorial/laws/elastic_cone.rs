use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;
use std::f64::consts::FRAC_2_PI;

/// Bodies that touch with blunt conical tips [Sneddon1965]:
/// F = (2/π) E* δ²/s with E* = 1/(D1 + D2).
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticCone {
    /// s, sum of the slopes of both tips against the contact plane, dimensionless.
    pub slope: f64,
}

impl Term<1> for ElasticCone {
    const INFO: LawInfo = LawInfo {
        name: "elastic_cone",
        equation: "F = (2/π) E* δ²/s,  E* = 1/(D1 + D2),  D = (1 − ν²)/Y",
        parameters: &[Parameter {
            name: "slope",
            unit: "1",
            meaning: "sum of the slopes s of both tips",
            source: Source::Required,
            least: 1e-6,
        }],
        validity: "blunt tips (s far below 1), no yielding; stress at the tip itself is unbounded",
        reference: "Sneddon1965",
        nature: Nature::Elastic,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { slope: values[0].unwrap_or(f64::NAN) }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 1], LawError> {
        let compliance = pair.left.compliance_per_pa() + pair.right.compliance_per_pa();
        Ok([FRAC_2_PI / (compliance * self.slope)])
    }

    fn force(&[stiffness]: &[f64; 1], contact: Closed) -> f64 {
        stiffness * contact.overlap * contact.overlap
    }

    fn energy(&[stiffness]: &[f64; 1], overlap: f64, _largest: f64) -> f64 {
        stiffness * overlap.powi(3) / 3.0
    }
}
