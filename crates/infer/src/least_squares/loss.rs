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
#[path = "tests/loss.rs"]
mod tests;
