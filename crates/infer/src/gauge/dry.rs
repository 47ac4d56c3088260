//! What the dry chain is to a gauge.

use super::Chains;
use crate::curve::{CurveError, CurveProblem, Model};
use crate::data::Data;
use crate::free::{FreeError, FreeNumber};
use hertzchain_experiment::Experiment;

/// A dry curve against its model, all as the experiment has it.
pub(super) fn problem(model: Model, data: Data) -> Result<CurveProblem, CurveError> {
    let parameters = model.numbers().parameters(&data.speeds_m_s());
    CurveProblem::new(model, data, parameters)
}

/// K and A of the dry contacts as the dry model has them; where it has several
/// sections, or laws without K and A, those of the wet ones.
pub(super) fn contact(chains: &Chains<'_>) -> Result<[f64; 2], FreeError> {
    let value = |name: &str| {
        let dry = FreeNumber::find(chains.dry, &format!("dry.{name}"), None);
        let found = dry.or_else(|_| FreeNumber::find(chains.wet, &format!("wet.{name}"), None))?;
        Ok(found.parameters(&[]).first().map_or(f64::NAN, |p| p.start))
    };
    Ok([value("K")?, value("A")?])
}

/// Reduced radius in m of the wet contact whose K is fitted; `None` without any.
pub(super) fn wet_radius_m(experiment: &Experiment) -> Option<f64> {
    let section = experiment.sections().iter().find(|section| section.wet)?;
    let stiffness = FreeNumber::find(experiment, "wet.K", None).ok();
    let reference = stiffness
        .as_ref()
        .and_then(|number| number.reference()?.contact);
    let (chain, _) = experiment.chain(None).ok()?;
    Some(chain.pair(reference.unwrap_or(section.from))?.radius_m)
}

/// Square root of a covariance by columns (Cholesky): shifts of all parameters
/// that are independent of each other and one standard error long; parameters
/// without an error do not move.
pub(super) fn shifts(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let count = matrix.len();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for at in 0..count {
        let entry = |row: usize| {
            let known: f64 = columns.iter().map(|c| c[row] * c[at]).sum();
            matrix[row][at] - known
        };
        let pivot = entry(at);
        let column: Vec<f64> = match pivot > 0.0 {
            true => (0..count)
                .map(|row| {
                    if row < at {
                        0.0
                    } else {
                        entry(row) / pivot.sqrt()
                    }
                })
                .collect(),
            false => vec![0.0; count],
        };
        columns.push(column);
    }
    columns
}

#[cfg(test)]
#[path = "tests/dry.rs"]
mod tests;
