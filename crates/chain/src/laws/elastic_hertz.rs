use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// Elastic spheres [Hertz1881]: F = K δ^{3/2}, K in N/m^{3/2}.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticHertz {
    /// K in N/m^{3/2}; from materials and radii when absent.
    pub stiffness: Option<f64>,
}

impl Term<1> for ElasticHertz {
    const INFO: LawInfo = LawInfo {
        name: "elastic_hertz",
        equation: "F = K δ^{3/2},  K = (4/3) √R* / (D1 + D2),  D = (1 − ν²)/Y",
        parameters: &[Parameter {
            name: "stiffness",
            unit: "N/m^(3/2)",
            meaning: "Hertz stiffness K",
            source: Source::Materials,
            least: 0.0,
        }],
        validity: "smooth spheres, contact radius small against R, no yielding; ν below 1",
        reference: "Hertz1881",
        nature: Nature::Elastic,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { stiffness: values[0] }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 1], LawError> {
        let stiffness = self.stiffness.unwrap_or_else(|| pair.hertz_stiffness());
        Ok([stiffness])
    }

    fn force(k: &[f64; 1], contact: Closed) -> f64 {
        k[0] * contact.overlap * contact.root
    }

    fn energy(&[stiffness]: &[f64; 1], overlap: f64, _largest: f64) -> f64 {
        0.4 * stiffness * overlap * overlap * overlap.sqrt()
    }
}
