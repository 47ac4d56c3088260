//! What the gauge says as JSON, in SI.

use super::GaugeResult;
use crate::inference::references_json;
use hertzchain_infer::Problem;
use hertzchain_infer::gauge::{
    Gauge, LAWS, Pair, PowerForm, Scan, SharedLaw, WetRow, is_determined,
};
use serde_json::{Value, json};

/// Everything that is to be said.
pub fn json(run_gauge: &GaugeResult) -> Value {
    let gauge = &run_gauge.gauge;
    let names = gauge.dry().parameters().iter().enumerate();
    let verdict = &run_gauge.verdict;
    json!({
        "dry": names.map(|(at, parameter)| json!({
            "name": parameter.name, "unit": parameter.unit,
            "value": gauge.dry_fit.point[at], "standard_error": gauge.dry_covariance.sd[at],
        })).collect::<Value>(),
        "dry_chi_square": gauge.dry_fit.chi_square(),
        "references": references_json(gauge.wet_model()),
        "contacts": run_gauge.rows.iter().map(row).collect::<Value>(),
        "stiffness_law": run_gauge.laws.as_ref().map(|laws| law_json(&laws.stiffness)),
        "relaxation_law": run_gauge.laws.as_ref().map(|laws| law_json(&laws.relaxation)),
        "form": run_gauge.form.as_ref().map(|form| form_json(form, gauge)),
        "to_add": run_gauge.to_add(),
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
        "verdict": verdict.sentence(),
        "doubts": run_gauge.doubts(),
    })
}

fn row(row: &WetRow) -> Value {
    let mut all = json!({ "line": row.line, "speed_m_s": row.speed_m_s });
    match &row.contact {
        Err(why) => all["missing"] = json!(why),
        Ok(contact) => {
            let [(k, k_sd), (a, a_sd)] = contact.first.estimates();
            all["stiffness"] = number(k, k_sd);
            match &contact.combination {
                None => {
                    all["relaxation_time_s"] = number(a, a_sd);
                    all["ln_covariance"] = json!(contact.first.covariance());
                    all["branch"] = json!(contact.branch.name());
                    all["scan"] = contact.scan.as_ref().map(scan).into();
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

fn number(value: f64, standard_error: f64) -> Value {
    json!({
        "value": value, "standard_error": finite(standard_error), "determined": is_determined(value, standard_error),
    })
}

/// Another pair that fits as well.
fn other(pair: &Pair) -> Value {
    let [(k, k_sd), (a, a_sd)] = pair.estimates();
    json!({
        "stiffness": k, "stiffness_error": finite(k_sd),
        "relaxation_time_s": a, "relaxation_time_s_error": finite(a_sd),
        "ln_covariance": pair.covariance().map(|row| row.map(finite)),
    })
}

/// How far pairs were looked for.
fn scan(scan: &Scan) -> Value {
    json!({
        "between_s": scan.between_s, "complete": scan.is_complete(), "missing_s": scan.missing_s,
    })
}

/// Power laws of the whole curve.
fn form_json(form: &PowerForm, gauge: &Gauge) -> Value {
    let sd = form.sd();
    let law = |at: usize| {
        json!({
            "prefactor": form.values[at].exp(), "prefactor_relative_error": finite(sd[at]),
            "exponent": form.values[at + 1], "exponent_error": finite(sd[at + 1]),
        })
    };
    let contact = |speed: &f64| {
        let [(k, k_sd), (a, a_sd)] = form.at(*speed).estimates();
        json!({
            "speed_m_s": speed, "stiffness": number(k, k_sd), "relaxation_time_s": number(a, a_sd),
        })
    };
    let other = |values: &[f64; LAWS]| {
        json!({
            "stiffness": { "prefactor": values[0].exp(), "exponent": values[1] },
            "relaxation_time_s": { "prefactor": values[2].exp(), "exponent": values[3] },
        })
    };
    json!({
        "stiffness": law(0),
        "relaxation_time_s": law(2),
        "covariance_of_ln_prefactors_and_exponents": form.covariance.map(|row| row.map(finite)),
        "chi_square": form.chi_square.map(|c| json!({
            "value": c.value, "freedom": c.freedom, "probability": c.probability,
        })),
        "contacts": gauge.wet().speeds_m_s().iter().map(contact).collect::<Value>(),
        "oils_held_against_it": form.is_sufficient(),
        "others": form.others.iter().map(other).collect::<Value>(),
        "not_determined": form.undetermined,
    })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn law_json(law: &SharedLaw) -> Value {
    json!({
        "prefactor": law.law.prefactor,
        "prefactor_relative_error": law.ln_prefactor_sd,
        "exponent": law.law.exponent,
        "exponent_error": law.exponent_sd,
        "reduced_chi_square": law.reduced_chi_square,
    })
}
