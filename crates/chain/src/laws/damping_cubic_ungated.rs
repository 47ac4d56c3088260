use super::{Closed, DampingCubic, LawError, LawInfo, Term};
use crate::material::BeadPair;

/// Cubic in the overlap rate [Labbe2017]: F = B δ̇³ whether or not in contact,
/// as one reading of the equation with its rate kept when a contact opens.
#[derive(Clone, Debug, PartialEq)]
pub struct DampingCubicUngated(pub DampingCubic);

impl Term<1> for DampingCubicUngated {
    const INFO: LawInfo = LawInfo {
        name: "damping_cubic_ungated",
        equation: "F = B δ̇³, also between bodies that do not touch",
        validity: "a reading of the printed equation, for comparison only: no known mechanism acts across a gap",
        gated: false,
        ..DampingCubic::INFO
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self(DampingCubic::new(values))
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 1], LawError> {
        self.0.coefficients(pair)
    }

    fn force(k: &[f64; 1], contact: Closed) -> f64 {
        DampingCubic::force(k, contact)
    }
}
