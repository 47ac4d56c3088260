use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;
use std::f64::consts::PI;

/// Elastic, then perfectly plastic loading, elastic unloading with a flatter
/// sphere [Thornton1997].
///
/// With E* = 1/(D1 + D2) and contact yield pressure p: Hertz up to
/// δ_y = R* (π p / 2E*)²; beyond, F = F_y + π p R* (δ − δ_y); from the
/// largest overlap δ* (force F*) down, F = (4/3) E* √R_p (δ − δ_p)^{3/2} with
/// R_p = (4E*/3F*) ((2F* + F_y)/(2π p))^{3/2} and δ_p that makes F(δ*) = F*.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticPlasticThornton {
    /// Contact yield pressure p in Pa.
    pub yield_pressure_pa: f64,
}

impl Term<5> for ElasticPlasticThornton {
    const INFO: LawInfo = LawInfo {
        name: "elastic_plastic_thornton",
        equation: "F = K δ^{3/2} below δ_y; F_y + π p R* (δ − δ_y) above; \
                   unloads as (4/3) E* √R_p (δ − δ_p)^{3/2}",
        parameters: &[Parameter {
            name: "yield_pressure",
            unit: "Pa",
            meaning: "contact yield pressure p, about 1.6 times the uniaxial yield stress",
            source: Source::Required,
            least: 1.0,
        }],
        validity: "elastic, perfectly plastic spheres, small strains; reloading follows the unloading curve",
        reference: "Thornton1997",
        nature: Nature::ElasticPlastic,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self { yield_pressure_pa: values[0].unwrap_or(f64::NAN) }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 5], LawError> {
        let compliance = pair.left.compliance_per_pa() + pair.right.compliance_per_pa();
        let modulus = compliance.recip();
        let yield_overlap = pair.radius_m * (PI * self.yield_pressure_pa / (2.0 * modulus)).powi(2);
        let slope = PI * self.yield_pressure_pa * pair.radius_m;
        Ok([pair.hertz_stiffness(), yield_overlap, slope, modulus, self.yield_pressure_pa])
    }

    fn force(k: &[f64; 5], contact: Closed) -> f64 {
        let (stiffness, rest) = unloading(k, contact.largest);
        let above = (contact.overlap - rest).max(0.0);
        stiffness * above * above.sqrt()
    }

    fn energy(k: &[f64; 5], overlap: f64, largest: f64) -> f64 {
        let (stiffness, rest) = unloading(k, largest);
        0.4 * stiffness * (overlap - rest).max(0.0).powf(2.5)
    }
}

/// Stiffness and rest overlap of the unloading curve from the largest overlap.
fn unloading(k: &[f64; 5], largest: f64) -> (f64, f64) {
    let &[hertz, yield_overlap, slope, modulus, pressure] = k;
    if largest <= yield_overlap {
        return (hertz, 0.0);
    }
    let yield_force = hertz * yield_overlap * yield_overlap.sqrt();
    let force = yield_force + slope * (largest - yield_overlap);
    let radius = 4.0 * modulus / (3.0 * force)
        * ((2.0 * force + yield_force) / (2.0 * PI * pressure)).powf(1.5);
    let stiffness = 4.0 / 3.0 * modulus * radius.sqrt();
    (stiffness, largest - (force / stiffness).powf(2.0 / 3.0))
}
