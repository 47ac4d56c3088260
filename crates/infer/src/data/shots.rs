//! Standard errors that come from the scatter of a few shots.

/// Fewer shots tell no error that could be corrected for.
pub const FEWEST_SHOTS: u32 = 6;

/// What standard errors from the scatter of n shots must be multiplied by, so that
/// intervals of a fit hold the truth as often as they say: √((n − 1)/(n − 5)).
/// `None` below [`FEWEST_SHOTS`].
///
/// With ν = n − 1 the estimated variance is s² = σ² χ²_ν/ν. Weights w = 1/s² have
/// ⟨w⟩ = ν/((ν − 2) σ²) and ⟨w²⟩ = ν²/((ν − 2)(ν − 4) σ⁴). A fit of many rows says
/// 1/Σ w of its variance, which is σ² Σ w²/(Σ w)²: the latter is ⟨w²⟩ σ²/⟨w⟩ =
/// ν/(ν − 4) times as large. Half of that is weights that are too large on
/// average, half that they scatter. Chi-square is then (ν − 4)/(ν − 2) of its
/// freedom on average, 0.88 for 20 shots.
#[must_use]
pub fn widening(shots: u32) -> Option<f64> {
    let shots = (shots >= FEWEST_SHOTS).then_some(f64::from(shots))?;
    Some(((shots - 1.0) / (shots - 5.0)).sqrt())
}
