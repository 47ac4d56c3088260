//! The power laws of a sweep in words.

use crate::missing;
use crate::program::format::{digits, r_squared, with_error};
use hertzchain_experiment::Units;
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty};
use hertzchain_sim::{BatchResult, Column};

/// A line for the incident and one for the reflected times of flight.
pub(super) fn lines(part: &BatchResult) -> String {
    let named = [("incident", Column::Incident), ("reflected", Column::Reflected)];
    let lines = named.map(|(name, column)| {
        let (fit, uncertainty) = part.rows.law(column, part.accuracy);
        line(name, &fit, uncertainty, part.units)
    });
    lines.concat()
}

fn line(
    name: &str,
    fit: &Result<PowerLaw, FitError>,
    uncertainty: Result<Uncertainty, FitError>,
    units: Units,
) -> String {
    let law = match fit {
        Err(error) => return format!("{name}: no power law: {}\n", missing::law(error)),
        Ok(law) => law,
    };
    let (size, unit, speed) = match units {
        Units::Si => (1e-6, " µs", "(v/(1 m/s))"),
        Units::Dimensionless => (1.0, "", "v"),
    };
    let errors = Errors::of(law, uncertainty.ok());
    let (prefactor, prefactor_error) = with_error(law.prefactor / size, errors.prefactor / size);
    let (exponent, exponent_error) = with_error(law.exponent, errors.exponent);
    if law.residuals.len() == 2 {
        return format!(
            "{name}: ToF = {prefactor}{unit} · {speed}^({exponent}), through two speeds, which determine no errors\n",
        );
    }
    format!(
        "{name}: ToF = ({prefactor} ± {prefactor_error}){unit} · {speed}^({exponent} ± {exponent_error}), \
         R² = {}, largest deviation {} %\n",
        r_squared(law.r_squared),
        digits(100.0 * law.largest_deviation(), 2),
    )
}

/// The errors to quote of a fit.
struct Errors {
    prefactor: f64,
    exponent: f64,
}

impl Errors {
    /// Standard errors, but not less than what the accuracies of the times of
    /// flight alone leave open; only these where two speeds determine no others.
    fn of(law: &PowerLaw, uncertainty: Option<Uncertainty>) -> Self {
        let (prefactor, exponent) = uncertainty
            .map_or((0.0, 0.0), |least| (law.prefactor * least.prefactor_relative, least.exponent));
        // The larger; a standard error that is not a number is none.
        Self {
            prefactor: prefactor.max(law.prefactor_error),
            exponent: exponent.max(law.exponent_error),
        }
    }
}

#[cfg(test)]
#[path = "tests/fits.rs"]
mod tests;
