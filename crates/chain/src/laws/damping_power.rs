use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;

/// Power-law damping [CarreteroGonzalez2009], with a power of the overlap as
/// well: F = c δ^p |δ̇|^q sgn δ̇.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingPower {
    /// c in N/(m^p (m/s)^q).
    pub coefficient: f64,
    /// q, dimensionless.
    pub rate_exponent: f64,
    /// p, dimensionless.
    pub overlap_exponent: f64,
}

const fn exponent(
    name: &'static str,
    meaning: &'static str,
    source: Source,
    least: f64,
) -> Parameter {
    Parameter { name, unit: "1", meaning, source, least }
}

impl Term<3> for DampingPower {
    const INFO: LawInfo = LawInfo {
        name: "damping_power",
        equation: "F = c δ^p |δ̇|^q sgn δ̇",
        parameters: &[
            Parameter {
                name: "coefficient",
                unit: "N/m^{overlap_exponent}/(m/s)^{rate_exponent}",
                meaning: "coefficient c",
                source: Source::Required,
                least: 0.0,
            },
            exponent(
                "rate_exponent",
                "exponent q of the rate; below 1/2 it would be friction that sticks",
                Source::Required,
                0.5,
            ),
            exponent("overlap_exponent", "exponent p of the overlap", Source::Default(0.0), 0.0),
        ],
        validity: "phenomenological; c, p, q from measured decay",
        reference: "CarreteroGonzalez2009",
        nature: Nature::Dissipative,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        let value = |i: usize| values[i].unwrap_or(f64::NAN);
        Self { coefficient: value(0), rate_exponent: value(1), overlap_exponent: value(2) }
    }

    fn coefficients(&self, _pair: &BeadPair) -> Result<[f64; 3], LawError> {
        Ok([self.coefficient, self.rate_exponent, self.overlap_exponent])
    }

    fn force(&[coefficient, q, p]: &[f64; 3], contact: Closed) -> f64 {
        let size = coefficient * contact.overlap.powf(p) * contact.rate.abs().powf(q);
        size.copysign(contact.rate)
    }
}
