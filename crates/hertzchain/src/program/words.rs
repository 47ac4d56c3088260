//! Numbers of inference in words.

use crate::program::{digits, with_error};
use hertzchain_infer::{Ending, Goodness, Jacobian, Parameter};
use hertzchain_measure::signal::ChiSquare;

/// A value and its standard error, with the unit of its parameter: both over a
/// power of ten where they are large or small.
pub(crate) fn estimate(parameter: &Parameter, value: f64, sd: f64) -> String {
    let unit = match parameter.unit.as_str() {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    if sd == 0.0 {
        return format!("{}{unit}, at its bound", digits(value, 7));
    }
    if !sd.is_finite() {
        return format!("{}{unit}, not determined", digits(value, 7));
    }
    // A value that its error dwarfs has the error's size.
    let most: f64 = format!("{:.1e}", value.abs().max(sd)).parse().unwrap_or(sd);
    let power = match most.log10().floor() {
        power if (-3.0..5.0).contains(&power) || !power.is_finite() => 0,
        power => power as i32,
    };
    let size = 10_f64.powi(power);
    let (value, sd) = with_error(value / size, sd / size);
    match power {
        0 => format!("{value} ± {sd}{unit}"),
        _ => format!("({value} ± {sd})·1e{power}{unit}"),
    }
}

/// χ² over degrees of freedom with its p-value, as `χ²/ν = 50.9/48, p = 0.36`.
pub(crate) fn chi_square_text(found: ChiSquare) -> String {
    let (value, freedom) = (digits(found.value, 4), found.freedom);
    format!("χ²/ν = {value}/{freedom}, {}", p_value(found.probability))
}

/// A p-value, as `p = 0.36`.
pub(crate) fn p_value(probability: f64) -> String {
    // No error is so exactly normal that smaller probabilities would mean anything.
    match probability < 1e-11 {
        true => "p < 1e-11".to_owned(),
        false => format!("p = {}", digits(probability, 2)),
    }
}

/// That a model is rejected by the data, as a warning.
pub(crate) fn misfit(goodness: &Goodness) -> Option<String> {
    let ratio = goodness.birge_ratio.filter(|_| goodness.is_rejected())?;
    Some(format!(
        "the model does not follow the data: √(χ²/ν) = {}; its values and standard errors are not valid",
        digits(ratio, 3)
    ))
}

/// Disagreement of derivatives by two step sizes from which they are doubtful. Between steps
/// that a smooth curve suits it is far below one percent; the extrapolated derivatives are
/// usually some ten times better than it, but not where curves jump.
const ROUGH: f64 = 0.05;

/// That derivatives are doubtful, if they are: by which parameter, and what to do.
pub(crate) fn rough(parameters: &[Parameter], jacobian: &Jacobian) -> Option<String> {
    let (at, share) = jacobian.least_agreeing()?;
    let name = parameters.get(at).filter(|_| share > ROUGH)?.name.as_str();
    Some(format!(
        "derivatives by {name} differ by {} between two step sizes: standard errors by the covariance may be wrong \
         (--method profile needs no derivatives; a smaller --accuracy gives smoother curves)",
        percent(share)
    ))
}

pub(crate) fn percent(share: f64) -> String {
    match share {
        0.0 => "0 %".to_owned(),
        // No error is so exactly normal that smaller shares would mean anything.
        share if share > 0.0 && 100.0 * share < 1e-9 => "less than 1e-9 %".to_owned(),
        share if share < 1e-4 => format!("{:.0e} %", 100.0 * share),
        share => format!("{} %", digits(100.0 * share, 2)),
    }
}

/// Why a fit ended where it did, if that is worth a warning.
pub(crate) fn doubt(ending: &Ending) -> Option<String> {
    match ending {
        Ending::Minimum | Ending::Floor { .. } | Ending::Open { .. } => None,
        Ending::Stuck { expected_fall } => Some(format!(
            "the fit stopped where χ²/2 should still fall by {expected_fall:.1e} (a smaller --accuracy, or --start, \
             --starts)"
        )),
        Ending::Iterations { expected_fall } => Some(format!(
            "the fit ran out of iterations where χ²/2 should still fall by {expected_fall:.1e} (--start)"
        )),
        other if other.converged() => None,
        Ending::ModelFails(error) => Some(format!("the fit ended where the model fails: {error}")),
        other => Some(format!("the fit did not converge: {other:?}")),
    }
}

pub(crate) fn lines(sentences: impl IntoIterator<Item = String>) -> String {
    sentences.into_iter().map(|one| format!("{one}\n")).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/words.rs"]
mod tests;
