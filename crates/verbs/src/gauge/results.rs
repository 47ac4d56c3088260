//! What the gauge says as JSON and tables, in SI.

use super::Gauged;
use crate::table::cell;
use hertzchain_infer::Problem;
use hertzchain_infer::gauge::{SharedLaw, WetRow};
use serde_json::{Value, json};

/// Everything that is to be said.
#[must_use]
pub fn json(gauged: &Gauged) -> Value {
    let gauge = &gauged.gauge;
    let names = gauge.dry().parameters().iter().enumerate();
    let verdict = &gauged.verdict;
    json!({
        "dry": names.map(|(at, parameter)| json!({
            "name": parameter.name, "unit": parameter.unit,
            "value": gauge.dry_fit.point[at], "standard_error": gauge.dry_covariance.sd[at],
        })).collect::<Value>(),
        "dry_chi_square": gauge.dry_fit.chi_square(),
        "contacts": gauged.rows.iter().map(row).collect::<Value>(),
        "stiffness_law": gauged.laws.as_ref().map(|laws| law_json(&laws.stiffness)),
        "relaxation_law": gauged.laws.as_ref().map(|laws| law_json(&laws.relaxation)),
        "to_add": gauge.to_add(),
        "oils": verdict.matches.iter().map(|found| json!({
            "name": found.oil, "distance": found.distance,
            "chi_square": found.chi_square.value, "freedom": found.chi_square.freedom,
            "probability": found.chi_square.probability, "possible": found.fits(),
            "own": found.own.iter().map(|own| json!({
                "name": own.parameter.name, "unit": own.parameter.unit,
                "value": own.value, "standard_error": own.standard_error,
            })).collect::<Value>(),
            "farthest": { "what": found.farthest.0, "standard_errors": found.farthest.1 },
        })).collect::<Value>(),
        "failed": verdict.failed.iter().map(|(oil, why)| json!({ "name": oil, "why": why })).collect::<Value>(),
        "verdict": verdict.sentence(),
        "doubts": gauge.doubts(verdict),
    })
}

fn row(row: &WetRow) -> Value {
    let mut all = json!({ "line": row.line, "speed_m_s": row.speed_m_s });
    match &row.told {
        Err(why) => all["missing"] = json!(why),
        Ok(contact) => {
            let [(k, k_sd), (a, a_sd)] = contact.estimates();
            all["stiffness"] = json!({ "value": k, "standard_error": k_sd });
            match &contact.combination {
                None => {
                    all["relaxation_time_s"] = json!({ "value": a, "standard_error": a_sd });
                    all["ln_covariance"] = json!(contact.covariance());
                    all["others"] = contact
                        .others
                        .iter()
                        .map(|ln| {
                            json!({
                                "stiffness": ln[0].exp(), "relaxation_time_s": ln[1].exp(),
                            })
                        })
                        .collect();
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

fn law_json(law: &SharedLaw) -> Value {
    json!({
        "prefactor": law.law.prefactor,
        "prefactor_relative_error": law.ln_prefactor_sd,
        "exponent": law.law.exponent,
        "exponent_error": law.exponent_sd,
        "reduced_chi_square": law.reduced_chi_square,
    })
}

/// One line a speed.
#[must_use]
pub fn contacts_csv(gauged: &Gauged) -> String {
    let mut text = "speed_m_s,stiffness,stiffness_error,relaxation_time_s,relaxation_time_s_error,\
                    combination_exponent,combination_reference_s\n"
        .to_owned();
    for row in &gauged.rows {
        let Ok(contact) = &row.told else { continue };
        let [(k, k_sd), (a, a_sd)] = contact.estimates();
        let mut cells = vec![cell(row.speed_m_s), cell(k), cell(k_sd)];
        cells.extend(match &contact.combination {
            None => [cell(a), cell(a_sd), String::new(), String::new()],
            Some(c) => [
                String::new(),
                String::new(),
                cell(c.exponent),
                cell(c.reference_s),
            ],
        });
        text += &format!("{}\n", cells.join(","));
    }
    text
}
