use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// General elastic exponent: F = k δ^n; n = 1 is the linear chain.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticPower {
    /// k in N/m^n.
    pub stiffness: f64,
    /// n, dimensionless.
    pub exponent: f64,
}

impl Term<2> for ElasticPower {
    const INFO: LawInfo = LawInfo {
        name: "elastic_power",
        equation: "F = k δ^n",
        parameters: &[
            Parameter {
                name: "stiffness",
                unit: "N/m^{exponent}",
                meaning: "stiffness k",
                source: Source::Required,
                least: 0.0,
            },
            Parameter {
                name: "exponent",
                unit: "1",
                meaning: "exponent n",
                source: Source::Required,
                least: 1.0,
            },
        ],
        validity: "contacts other than smooth spheres: cones n = 2, cylinders, o-rings, linear n = 1",
        reference: "Nesterenko2001",
        nature: Nature::Elastic,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { stiffness: values[0].unwrap_or(f64::NAN), exponent: values[1].unwrap_or(f64::NAN) }
    }

    fn coefficients(&self, _pair: &BeadPair) -> Result<[f64; 2], LawError> {
        Ok([self.stiffness, self.exponent])
    }

    fn force(&[stiffness, exponent]: &[f64; 2], contact: Closed) -> f64 {
        stiffness * contact.overlap.powf(exponent)
    }

    fn energy(&[stiffness, exponent]: &[f64; 2], overlap: f64, _largest: f64) -> f64 {
        stiffness * overlap.powf(exponent + 1.0) / (exponent + 1.0)
    }
}
