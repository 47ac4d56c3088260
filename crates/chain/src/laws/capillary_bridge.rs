use super::{Closed, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;
use std::f64::consts::{FRAC_PI_2, PI};

/// A liquid bridge [Willett2000]: a pull that is constant in contact, falls across a gap S, and ends
/// where the bridge ruptures [Lian1993], until the bodies touch again.
///
/// F = −4π R* γ cos θ/(1 + 1.05 Ŝ + 2.5 Ŝ²), Ŝ = S √(2 R*/V), up to S = (1 + θ/2) V^{1/3}. The closed form was
/// made for equal spheres of radius R = 2 R*: harmonic mean of unlike ones, twice the ball's against a plane.
#[derive(Clone, Debug)]
pub(super) struct CapillaryBridge {
    surface_tension_n_m: f64,
    volume_m3: f64,
    contact_angle_rad: f64,
}

/// Coefficients of Ŝ and Ŝ² in the closed form.
const FALL: [f64; 2] = [1.05, 2.5];

/// ∫ dŜ/(1 + 1.05 Ŝ + 2.5 Ŝ²).
fn spent(reduced: f64) -> f64 {
    let root = (4.0 * FALL[1] - FALL[0] * FALL[0]).sqrt();
    2.0 / root * ((2.0 * FALL[1] * reduced + FALL[0]) / root).atan()
}

impl Term<3> for CapillaryBridge {
    const INFO: LawInfo = LawInfo {
        name: "capillary_bridge",
        equation: "F = −4π R* γ cos θ/(1 + 1.05 Ŝ + 2.5 Ŝ²),  Ŝ = S √(2 R*/V), gap S = max(−δ, 0);  \
                   from touch until S = (1 + θ/2) V^{1/3}",
        parameters: &[
            Parameter {
                name: "surface_tension",
                unit: "N/m",
                meaning: "surface tension γ of the liquid",
                source: Source::Liquid,
                least: 0.0,
            },
            Parameter {
                name: "volume",
                unit: "m^3",
                meaning: "volume V of the liquid in the contact",
                source: Source::Liquid,
                least: 0.0,
            },
            Parameter {
                name: "contact_angle",
                unit: "rad",
                meaning: "contact angle θ on both bodies, 90 degrees at most",
                source: Source::Default(0.0),
                least: 0.0,
            },
        ],
        validity: "V up to R³/1000, θ up to 40 degrees: force within 9 % of the pull at touch, rupture within 4 %; \
                   smooth bodies, a bridge without weight and viscosity",
        reference: "Willett2000",
        nature: Nature::Adhesive,
        gated: false,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self {
            surface_tension_n_m: values[0].unwrap_or(f64::NAN),
            volume_m3: values[1].unwrap_or(f64::NAN),
            contact_angle_rad: values[2].unwrap_or(0.0),
        }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 3], LawError> {
        let angle = self.contact_angle_rad;
        if angle > FRAC_PI_2 {
            let what =
                format!("its contact angle of {} degrees may be 90 at most", angle.to_degrees());
            return Err(LawError { law: Self::INFO.name, what });
        }
        if self.volume_m3 == 0.0 {
            return Ok([0.0; 3]);
        }
        let pull = 4.0 * PI * pair.radius_m * self.surface_tension_n_m * angle.cos();
        let per_gap = (2.0 * pair.radius_m / self.volume_m3).sqrt();
        Ok([pull, per_gap, (1.0 + 0.5 * angle) * self.volume_m3.cbrt()])
    }

    fn force(&[pull, per_gap, rupture]: &[f64; 3], contact: Closed) -> f64 {
        let gap = (-contact.overlap).max(0.0);
        let reduced = per_gap * gap;
        match gap <= rupture {
            true => -pull / (1.0 + reduced * (FALL[0] + FALL[1] * reduced)),
            false => 0.0,
        }
    }

    fn energy(&[pull, per_gap, rupture]: &[f64; 3], overlap: f64, _largest: f64) -> f64 {
        let gap = (-overlap).max(0.0);
        if gap >= rupture {
            return 0.0;
        }
        let work = pull / per_gap * (spent(per_gap * rupture) - spent(per_gap * gap));
        -work - pull * overlap.max(0.0)
    }

    fn rupture(&[_, _, rupture]: &[f64; 3]) -> f64 {
        rupture
    }
}
