//! The power laws of a sweep in words.

use crate::missing;
use crate::program::format::r_squared;
use crate::program::{digits, with_error};
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
    // Standard errors, but not less than what the accuracies of the times of flight alone leave open;
    // only these where two speeds determine no others, and a standard error is not a number.
    let least = uncertainty.ok();
    let least = least.map_or([0.0; 2], |it| [law.prefactor * it.prefactor_relative, it.exponent]);
    let (prefactor, prefactor_error) =
        with_error(law.prefactor / size, least[0].max(law.prefactor_error) / size);
    let (exponent, exponent_error) = with_error(law.exponent, least[1].max(law.exponent_error));
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

#[cfg(test)]
#[path = "tests/fits.rs"]
mod tests;
