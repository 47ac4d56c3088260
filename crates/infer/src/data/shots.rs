//! Standard errors that come from the scatter of a few shots.

use super::Observable;

/// Fewer shots tell no error that could be corrected for.
pub const FEWEST_SHOTS: u32 = 6;

/// Least degrees of freedom of an error that can be corrected for.
const FEWEST: f64 = (FEWEST_SHOTS - 1) as f64;

/// How well a row's standard errors are known, each as the degrees of freedom of the
/// scatter from which it comes: 19 for that of 20 shots, infinite if it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Of the speed's.
    pub speed: f64,
    /// Of the measured values', in the order of [`Observable::ALL`].
    pub values: [f64; 4],
}

impl Freedom {
    /// All errors are known.
    pub const KNOWN: Self = Self::of_all(f64::INFINITY);

    /// All errors have these degrees of freedom.
    #[must_use]
    pub const fn of_all(freedom: f64) -> Self {
        Self {
            speed: freedom,
            values: [freedom; 4],
        }
    }

    pub(super) fn of(&self, of: Observable) -> f64 {
        self.values[of.index()]
    }

    /// Whether some error comes from too few shots to be corrected for.
    pub(super) fn is_too_small(&self) -> bool {
        let all = self.values.iter().chain([&self.speed]);
        all.into_iter().any(|freedom| *freedom < FEWEST)
    }
}

/// Whether an error of so many degrees of freedom is widened at all.
pub(super) fn is_widened(freedom: f64) -> bool {
    freedom >= FEWEST && freedom.is_finite()
}

/// What the standard error of part of a sum must be multiplied by, if it comes from a
/// scatter of ν degrees of freedom and has this share h of the sum's variance, so that
/// intervals of a fit hold the truth as often as they say: 1/√(1 − 4h/ν). 1 if ν is
/// too small for that ([`FEWEST_SHOTS`]).
///
/// Let C = Σ u uᵀ be a row's covariance, one u for each independent error, and the
/// estimate Ĉ have (1 + ε) u uᵀ in place of u uᵀ with ⟨ε²⟩ = 2/ν, P = C⁻¹. A fit says
/// (Σ Xᵀ Ĉ⁻¹ X)⁻¹ of its variance, which is that times Σ Xᵀ Ĉ⁻¹ C Ĉ⁻¹ X times it again. To second
/// order in ε the means are ⟨Ĉ⁻¹⟩ = P + Σ (2/ν) h P u uᵀ P and ⟨Ĉ⁻¹ C Ĉ⁻¹⟩ = P + Σ (6/ν) h P u uᵀ P
/// with h = uᵀ P u: weights are too large on average, and scatter. With Σ u uᵀ/(1 − 4h/ν) in
/// place of Ĉ both means are P − Σ (2/ν) h P u uᵀ P, row by row, so that a sum over many rows is right.
///
/// For one error (h = 1) it is exact: ⟨χ²_ν⁻¹⟩ = 1/(ν − 2) and ⟨χ²_ν⁻²⟩ = 1/((ν − 2)(ν − 4))
/// make it √(ν/(ν − 4)). For several in one sum it is the same with the degrees of freedom of
/// Welch and Satterthwaite, (Σ v)²/Σ (v²/ν) [Satterthwaite1946].
#[must_use]
pub fn widening(share: f64, freedom: f64) -> f64 {
    match freedom >= FEWEST {
        true => (1.0 - 4.0 * share / freedom).sqrt().recip(),
        false => 1.0,
    }
}
