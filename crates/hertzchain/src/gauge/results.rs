//! What the gauge says as JSON, in SI.

use super::GaugeResult;
use crate::inference::{references_json, warnings_json};
use hertzchain_infer::gauge::{LEAST_PROBABILITY, Pair, WetRow, is_determined};
use hertzchain_infer::{Covariance, CurveProblem, Fit, Identifiability, Problem};
use hertzchain_measure::signal::ChiSquare;
use serde_json::{Value, json};

/// Everything that is to be said.
pub fn json(run_gauge: &GaugeResult) -> Value {
    let gauge = &run_gauge.gauge;
    let names = gauge.dry.parameters().iter().enumerate();
    let verdict = &run_gauge.verdict;
    let models = [&gauge.wet.experiment, &gauge.dry.model().experiment];
    let mut all = json!({
        "models": models.map(|model| model.name()),
        "dry": names.map(|(at, parameter)| json!({
            "name": parameter.name, "unit": parameter.unit,
            "value": gauge.dry_fit.point[at], "standard_error": gauge.dry_covariance.sd[at],
        })).collect::<Value>(),
        "dry_chi_square": gauge.dry_fit.chi_square(),
        "references": references_json(&gauge.wet),
        "warnings": warnings_json(models),
        "contacts": run_gauge.rows.iter().map(|of| row(of, run_gauge)).collect::<Value>(),
        "film": run_gauge.film.as_ref().map(film),
        "to_add": gauge.to_add(),
        "oils": verdict.matches.iter().map(|found| json!({
            "name": found.oil, "distance": found.distance,
            "chi_square": found.chi_square.value, "freedom": found.chi_square.freedom,
            "probability": found.chi_square.probability, "possible": found.fits(),
            "own": found.own.iter().map(|own| json!({
                "name": own.parameter.name, "unit": own.parameter.unit,
                "value": own.value, "standard_error": own.standard_error,
            })).collect::<Value>(),
            "farthest": { "what": found.largest.0, "standard_errors": found.largest.1 },
        })).collect::<Value>(),
        "failed": verdict.failed.iter().map(|(oil, why)| json!({ "name": oil, "why": why })).collect::<Value>(),
        "verdict": run_gauge.sentence(),
        "doubts": run_gauge.doubts(),
    });
    // A film's numbers are fitted, not scanned.
    if run_gauge.film.is_none() {
        all["scanned_s"] = json!(gauge.scanned_s());
    }
    all
}

impl GaugeResult {
    /// Warnings on the verdict or on the film's numbers.
    pub(crate) fn doubts(&self) -> Option<String> {
        let film = self.film.as_ref().map(|(problem, fit, _)| (problem, fit));
        self.gauge.doubts(&self.verdict, film)
    }

    /// The verdict on the oils, or on a film, in a sentence.
    pub(crate) fn sentence(&self) -> String {
        let Some((_, _, chi_square)) = &self.film else {
            return self.verdict.sentence();
        };
        match chi_square {
            Some(found) if found.probability < LEAST_PROBABILITY => format!(
                "No one film gives the times at all speeds (p = {:.1e}).",
                found.probability
            ),
            Some(found) => {
                format!("One film gives the times at all speeds (p = {:.2}).", found.probability)
            }
            None => "No number is left to test the film by: measure at more speeds.".to_owned(),
        }
    }
}

/// All numbers of both curves, and what they leave open.
fn film((problem, fit, found): &(CurveProblem, Fit, Option<ChiSquare>)) -> Value {
    let sd = Covariance::new(problem.parameters(), fit).sd;
    let label = |at: usize| problem.residual_label(at);
    let identified = Identifiability::new(problem.parameters(), fit, label);
    let values = problem.parameters().iter().zip(&fit.point).zip(&sd);
    json!({
        "parameters": values.map(|((parameter, value), sd)| json!({
            "name": parameter.name, "unit": parameter.unit,
            "value": value, "standard_error": standard_error(*sd),
        })).collect::<Value>(),
        "chi_square": found.map(|of| of.value), "freedom": found.map(|of| of.freedom),
        "probability": found.map(|of| of.probability),
        "undetermined": identified.unidentifiable.iter().map(|one| &one.words).collect::<Vec<_>>(),
    })
}

fn row(row: &WetRow, run_gauge: &GaugeResult) -> Value {
    let mut all = json!({ "line": row.line, "speed_m_s": row.speed_m_s });
    match &row.contact {
        Err(why) => all["missing"] = json!(why),
        Ok(contact) => {
            let [(k, k_sd), (a, a_sd)] = contact.first.estimates();
            if let Some(of) = run_gauge.gauge.film_number() {
                all["film"] = number(k, k_sd);
                (all["film"]["name"], all["film"]["unit"]) = (json!(of.name), json!(of.unit));
                return all;
            }
            all["stiffness"] = number(k, k_sd);
            match &contact.combination {
                None => {
                    all["relaxation_time_s"] = number(a, a_sd);
                    all["ln_covariance"] = json!(contact.first.covariance);
                    all["branch"] = json!(contact.branch.name());
                    all["scan_complete"] = contact.is_complete.into();
                    all["others"] = contact.others.iter().map(other).collect();
                }
                Some(combination) => {
                    all["stiffness_times_relaxation_to"] = json!({
                        "exponent": combination.exponent, "reference_s": combination.reference_s,
                    });
                }
            }
        }
    }
    all
}

fn number(value: f64, sd: f64) -> Value {
    json!({
        "value": value, "standard_error": standard_error(sd), "determined": is_determined(value, sd),
    })
}

/// Another pair that fits as well.
fn other(pair: &Pair) -> Value {
    let [(k, k_sd), (a, a_sd)] = pair.estimates();
    json!({
        "stiffness": k, "stiffness_error": finite(k_sd),
        "relaxation_time_s": a, "relaxation_time_s_error": finite(a_sd),
        "ln_covariance": pair.covariance.map(|row| row.map(finite)),
    })
}

/// A standard error; none of a parameter that is not determined or held by a bound.
fn standard_error(sd: f64) -> Option<f64> {
    finite(sd).filter(|sd| *sd > 0.0)
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
