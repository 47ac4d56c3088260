use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// Damping that gives a restitution independent of speed on a Hertz contact
/// [Tsuji1992]: F = α √(m* K) δ^{1/4} δ̇.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingTsuji {
    /// α, dimensionless.
    pub damping_ratio: f64,
    /// K in N/m^{3/2}; from materials and radii when absent.
    pub stiffness: Option<f64>,
}

impl Term<1> for DampingTsuji {
    const INFO: LawInfo = LawInfo {
        name: "damping_tsuji",
        equation: "F = α √(m* K) δ^{1/4} δ̇,  m* the reduced mass",
        parameters: &[
            Parameter {
                name: "damping_ratio",
                unit: "1",
                meaning: "α, set by the coefficient of restitution",
                source: Source::Required,
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
        validity: "a numerical convenience beside elastic_hertz: restitution does not depend on speed",
        reference: "Tsuji1992",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { damping_ratio: values[0].unwrap_or(f64::NAN), stiffness: values[1] }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 1], LawError> {
        let stiffness = self.stiffness.unwrap_or_else(|| pair.hertz_stiffness());
        Ok([self.damping_ratio * (pair.mass_kg * stiffness).sqrt()])
    }

    fn force(&[damping]: &[f64; 1], contact: Closed) -> f64 {
        damping * contact.root.sqrt() * contact.rate
    }
}
