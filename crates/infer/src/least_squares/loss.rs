//! What a residual costs.

use serde::{Deserialize, Serialize};

/// How fast the cost of a residual r grows; `scale` is where it stops being a
/// square, in standard deviations.
///
/// With z = (r/scale)² the cost is ½ scale² ρ(z).
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub enum Loss {
    /// ρ = z: least squares, the likelihood of normal errors.
    #[default]
    Squares,
    /// ρ = 2(√(1 + z) − 1): smooth, |r| for large residuals.
    SoftL1 {
        /// Where it turns.
        scale: f64,
    },
    /// ρ = z up to 1, 2√z − 1 beyond [Huber1964].
    Huber {
        /// Where it turns.
        scale: f64,
    },
    /// ρ = ln(1 + z): outliers count less the farther they are.
    Cauchy {
        /// Where it turns.
        scale: f64,
    },
}

/// ½ scale² ρ and what a step needs of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cost {
    /// ½ scale² ρ(z).
    pub value: f64,
    /// Factor on a row of the Jacobian, √(ρ′ + 2 z ρ″), kept positive.
    pub slope_factor: f64,
    /// Factor on a residual, ρ′ over that factor: the product of both rows is the gradient.
    pub residual_factor: f64,
}

/// Least curvature of a residual far out, as a share of the weight ρ′: without
/// any, a step from where all residuals are far out would have no length.
const LEAST_CURVATURE: f64 = 0.1;

impl Loss {
    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Squares => "squares",
            Self::SoftL1 { .. } => "soft L1",
            Self::Huber { .. } => "Huber",
            Self::Cauchy { .. } => "Cauchy",
        }
    }

    /// Where it turns, in standard deviations; 1 for squares, which turn nowhere.
    #[must_use]
    pub const fn scale(self) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::SoftL1 { scale } | Self::Huber { scale } | Self::Cauchy { scale } => scale,
        }
    }

    /// ρ, ρ′ and ρ″ at z.
    fn rho(self, z: f64) -> [f64; 3] {
        match self {
            Self::Squares => [z, 1.0, 0.0],
            Self::SoftL1 { .. } => {
                let root = (1.0 + z).sqrt();
                [2.0 * (root - 1.0), root.recip(), -0.5 * root.powi(-3)]
            }
            Self::Huber { .. } if z <= 1.0 => [z, 1.0, 0.0],
            Self::Huber { .. } => {
                let root = z.sqrt();
                [2.0 * root - 1.0, root.recip(), -0.5 * root.powi(-3)]
            }
            Self::Cauchy { .. } => {
                let slope = (1.0 + z).recip();
                [z.ln_1p(), slope, -slope * slope]
            }
        }
    }

    pub(crate) fn cost(self, residual: f64) -> Cost {
        let scale = self.scale();
        let z = (residual / scale).powi(2);
        let [rho, slope, curvature] = self.rho(z);
        let kept = (slope + 2.0 * z * curvature)
            .max(LEAST_CURVATURE * slope)
            .sqrt();
        Cost {
            value: 0.5 * scale * scale * rho,
            slope_factor: kept,
            residual_factor: slope / kept,
        }
    }

    /// ψ = d cost/dr and its slope: influence of a residual, for the
    /// uncertainty of a robust fit.
    pub(crate) fn influence(self, residual: f64) -> (f64, f64) {
        let z = (residual / self.scale()).powi(2);
        let [_, slope, curvature] = self.rho(z);
        (slope * residual, slope + 2.0 * z * curvature)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Loss; 4] = [
        Loss::Squares,
        Loss::SoftL1 { scale: 1.5 },
        Loss::Huber { scale: 1.5 },
        Loss::Cauchy { scale: 1.5 },
    ];

    #[test]
    fn influence_is_the_slope_of_the_cost_and_small_residuals_cost_squares() {
        for loss in ALL {
            for residual in [-4.0, -0.7, 0.3, 1.4, 9.0] {
                let h = 1e-5;
                let differences =
                    (loss.cost(residual + h).value - loss.cost(residual - h).value) / (2.0 * h);
                let (influence, _) = loss.influence(residual);
                // Rounding over the step: 1e-15/1e-5, times values near 10.
                assert!((influence - differences).abs() < 1e-8, "{loss:?}");
            }
            // Next order is r⁴.
            let small = loss.cost(1e-3).value;
            assert!((small / 0.5e-6 - 1.0).abs() < 1e-6, "{loss:?}");
        }
    }

    #[test]
    fn both_factors_multiply_to_the_gradient() {
        for loss in ALL {
            for residual in [0.5, 1.2] {
                let cost = loss.cost(residual);
                let product = cost.slope_factor * cost.residual_factor * residual;
                assert!((product - loss.influence(residual).0).abs() < 1e-15); // rounding
            }
        }
    }
}
