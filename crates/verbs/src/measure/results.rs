//! Everything measured, as JSON in SI.

use hertzchain_measure::{Case, Curves, Measurement, Shot, SpeedRow};
use hertzchain_signal::{Estimate, FitError, Picked, PowerLaw, Ratio, Summary};
use serde_json::{Value, json};

/// Shots, curves, ratios and what was refused.
#[must_use]
pub fn json(measured: &Measurement, curves: &Curves) -> Value {
    let refused = measured.refused.iter().map(ToString::to_string);
    json!({
        "shots": measured.shots.iter().map(shot).collect::<Value>(),
        "cases": curves.cases.iter().map(case).collect::<Value>(),
        "ratios": curves.ratios.iter().map(|wet| json!({
            "case": wet.case,
            "incident": wet.incident.iter().map(ratio).collect::<Value>(),
            "reflected": wet.reflected.iter().map(ratio).collect::<Value>(),
        })).collect::<Value>(),
        "notes": measured.notes.iter().map(|note| json!({
            "note": note.text,
            "files": note.files.iter().map(|file| file.display().to_string()).collect::<Value>(),
        })).collect::<Value>(),
        "unmatched": measured.unmatched,
        "refused": refused.collect::<Vec<_>>(),
    })
}

fn estimate(of: Estimate) -> Value {
    json!({ "value": of.value, "sigma": of.sigma })
}

fn shot(shot: &Shot) -> Value {
    let mut all = json!({
        "file": shot.file.display().to_string(),
        "shot": shot.shot,
        "case": shot.case,
        "speed_m_s": shot.speed_m_s.map(estimate),
        "flags": shot.remarks(),
    });
    match &shot.flight {
        Err(error) => all["missing"] = json!(error.to_string()),
        Ok(flight) => {
            all["tof_incident_s"] = estimate(flight.incident_s);
            all["tof_reflected_s"] = flight.reflected_s.map_or(Value::Null, estimate);
            all["wall_over_passing"] = estimate(flight.wall_over_passing);
            all["returning_over_passing"] =
                flight.returning_over_passing.map_or(Value::Null, estimate);
            all["passing"] = picked(&flight.picks.passing);
            all["wall"] = picked(&flight.picks.wall);
            all["returning"] = flight.picks.returning.as_ref().map_or(Value::Null, picked);
        }
    }
    all
}

fn picked(of: &Picked) -> Value {
    json!({
        "time_s": of.time_s,
        "time_sigma_s": of.sigma_s,
        "height_v": of.height,
        "width_s": of.width_s,
    })
}

fn case(case: &Case) -> Value {
    json!({
        "case": case.name,
        "speeds": case.rows.iter().map(row).collect::<Value>(),
        "power_law_incident": law(&case.laws.incident),
        "power_law_reflected": law(&case.laws.reflected),
    })
}

fn row(row: &SpeedRow) -> Value {
    json!({
        "speed_m_s": estimate(row.speed_m_s),
        "speed_error_shots": row.speed_error_shots,
        "shots": row.shots.0,
        "left_out": row.shots.1,
        "tof_incident_s": summary(&row.incident_s),
        "tof_reflected_s": row.reflected_s.as_ref().map(summary),
        "wall_over_passing": summary(&row.wall_over_passing),
        "returning_over_passing": row.returning_over_passing.as_ref().map(summary),
        "tof_incident_shared_s": row.shared_s[0],
        "tof_reflected_shared_s": row.shared_s[1],
        "tof_incident_at_mean_speed_s": row.at_mean_speed_s[0].map(estimate),
        "tof_reflected_at_mean_speed_s": row.at_mean_speed_s[1].map(estimate),
        "widths_s": row.widths_s.map(|width| width.map(|width| width.mean)),
    })
}

fn summary(of: &Summary) -> Value {
    json!({
        "mean": of.mean,
        "deviation": of.deviation,
        "error": of.error,
        "count": of.count,
        "weighted_mean": of.weighted.value,
        "weighted_error": of.weighted.sigma,
        "chi_square": of.chi_square,
    })
}

fn law(of: &Result<PowerLaw, FitError>) -> Value {
    match of {
        Err(error) => json!({ "missing": error.to_string() }),
        Ok(law) => json!({
            "prefactor_s": law.prefactor,
            "prefactor_error_s": law.prefactor_error,
            "exponent": law.exponent,
            "exponent_error": law.exponent_error,
            "covariance": law.covariance,
            "r_squared": law.r_squared,
            "chi_square": law.chi_square.map(|judged| judged.value),
            "degrees_of_freedom": law.chi_square.map(|judged| judged.freedom),
            "probability": law.chi_square.map(|judged| judged.probability),
            "supported": law.is_supported(),
        }),
    }
}

fn ratio(of: &Ratio) -> Value {
    json!({ "speed_m_s": of.speed, "ratio": of.ratio.value, "error": of.ratio.sigma })
}
