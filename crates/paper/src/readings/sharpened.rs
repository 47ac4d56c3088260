//! As accurate as it takes.

use crate::claims::{Evaluator, Evidence};
use crate::reproduce::ReproduceError;

/// Evidence at the first of some accuracies at which no claim is left open, or
/// at the last.
pub(super) fn sharpened(
    evaluators: &[Evaluator],
    accuracies: &[f64],
    gather: &dyn Fn(f64) -> Result<Evidence, ReproduceError>,
) -> Result<Evidence, ReproduceError> {
    let mut evidence = Evidence::default();
    for accuracy in accuracies {
        evidence = gather(*accuracy)?;
        let mut findings = evaluators
            .iter()
            .map(|evaluator| evaluator.decide(&evidence));
        if !findings.any(|finding| finding.is_open()) {
            break;
        }
    }
    Ok(evidence)
}

#[cfg(test)]
#[path = "tests/sharpened.rs"]
mod tests;
