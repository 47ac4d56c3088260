//! Results as JSON, full precision, SI units in the names.

use crate::missing;
use hertzchain_chain::observe::{Competing, Maximum};
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::{Experiment, Units};
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty};
use hertzchain_sim::{BatchResult, BatchShot, Calibration, Column, Group, Plan, Row, Shot, Value};
use serde_json::{Value as Json, json};

fn peak(maximum: &Maximum) -> Json {
    json!({ "time_s": maximum.time_s, "value": maximum.value })
}

fn peaks(maxima: &[Maximum]) -> Json {
    maxima.iter().map(peak).collect()
}

/// One shot of an experiment at a speed of its own or another.
#[must_use]
pub fn shot_of(experiment: &Experiment, speed_m_s: Option<f64>, plan: &Plan, shot: &Shot) -> Json {
    let units = experiment.units();
    let mut result = self::shot(shot, units, plan);
    if let Some(object) = result.as_object_mut() {
        object.insert("experiment".to_owned(), json!(experiment.name()));
        object.insert(
            "speed_m_s".to_owned(),
            json!(speed_m_s.or(experiment.speed_m_s())),
        );
    }
    result
}

/// One shot of a plan that differs from this one in speed at most.
#[must_use]
pub fn shot(shot: &Shot, units: Units, plan: &Plan) -> Json {
    json!({
        "tof_incident_s": shot.flight.map(|flight| flight.incident_s),
        "tof_reflected_s": shot.flight.and_then(|flight| flight.reflected_s),
        "accuracy_asked": shot.accuracy_asked,
        "accuracy_reached": shot.accuracy_reached,
        "passage": passage(shot, units, plan),
        "sensor_maxima": peaks(&shot.sensor_maxima),
        "pulse_speed_beads_per_s": shot.pulse_speed_beads_s,
        "striker_rebound": shot.rebound.map(|rebound| json!({
            "first_separation_time_s": rebound.first.map(|first| first.0),
            "first_separation_m_s": rebound.first.map(|first| first.1),
            "end_time_s": rebound.end_s,
            "end_m_s": rebound.end_m_s,
        })),
        "energy": shot.budget.as_ref().map(budget),
        "duration_s": shot.duration_s,
        "solver": shot.solver,
        "tolerance": shot.tolerance,
        "step_s": shot.step_s,
        "force_passes": shot.work.force_passes,
        "steps": shot.work.steps,
        "notes": shot.notes,
    })
}

fn passage(shot: &Shot, units: Units, plan: &Plan) -> Json {
    match &shot.passage {
        Err(error) => json!({
            "missing": missing::reason(&plan.chain.far, units, error),
            "wall": shot.wall().as_ref().map(peak),
        }),
        Ok(seen) => json!({
            "incident": peak(&seen.incident),
            "wall": peak(&seen.wall),
            "reflected": seen.reflected.as_ref().map(peak),
            "search_ends_s": seen.search_ends_s,
            "competing": seen.competing.iter().map(competing).collect::<Json>(),
            "wall_maxima": peaks(&seen.wall_maxima),
            "incident_width_s": seen.incident_width_s,
            "wall_width_s": seen.wall_width_s,
            "reflected_width_s": seen.reflected_width_s,
        }),
    }
}

fn competing(other: &Competing) -> Json {
    json!({
        "pulse": other.pulse.name(),
        "time_s": other.maximum.time_s,
        "value": other.maximum.value,
        "share": other.share,
    })
}

fn budget(budget: &Budget) -> Json {
    let lines = budget.dissipated.iter();
    let dissipated: serde_json::Map<String, Json> = lines
        .map(|line| (line.law.to_owned(), json!(line.energy_j)))
        .collect();
    json!({
        "time_s": budget.time_s,
        "start_j": budget.start_j,
        "driven_j": budget.driven_j,
        "kinetic_j": budget.kinetic_j,
        "elastic_j": budget.elastic_j,
        "dissipated_j": dissipated,
        "clipped_j": budget.clipped_j,
        "gravity_j": budget.gravity_j,
        "preload_j": budget.preload_j,
        "stop_j": budget.stop_j,
        "residual_j": budget.residual_j(),
        "relative_residual": budget.relative_residual(),
    })
}

/// All speeds of a sweep and their power laws; `plan` is that of one of them.
#[must_use]
pub fn sweep(
    experiment: &Experiment,
    plan: &Plan,
    points: &[BatchShot],
    (result, calibration): (&BatchResult, Option<Calibration>),
) -> Json {
    let units = experiment.units();
    let laws = [Column::Incident, Column::Reflected].map(|of| result.rows.law(of, result.accuracy));
    let through = laws.each_ref().map(|(law, least)| (law, least.clone()));
    let mut results = outline(experiment, calibration, through);
    let points = points.iter();
    results["points"] = points
        .map(|point| self::point(point, units, plan))
        .collect();
    results
}

/// A sweep without its points; laws are the incident and the reflected times'.
#[must_use]
pub fn outline(
    experiment: &Experiment,
    calibration: Option<Calibration>,
    [incident, reflected]: [Through<'_>; 2],
) -> Json {
    let calibrated = |it: Calibration| json!({"count": it.shots, "accuracy_reached": it.reached, "way": it.to_string()});
    json!({
        "experiment": experiment.name(),
        "calibration": calibration.map(calibrated),
        "power_law_incident": fit(incident.0, incident.1.ok()),
        "power_law_reflected": fit(reflected.0, reflected.1.ok()),
    })
}

/// A power law, and what accuracies alone leave open of it.
pub type Through<'a> = (
    &'a Result<PowerLaw, FitError>,
    Result<Uncertainty, FitError>,
);

/// What stands in the place of the energy budget in a sweep.
const NO_BUDGET: &str =
    "a sweep asks for times of flight and keeps no energy budget; `hertzchain shot` does";

/// One speed of a sweep.
#[must_use]
pub fn point(point: &BatchShot, units: Units, plan: &Plan) -> Json {
    match &point.shot {
        Err(error) => json!({ "speed_m_s": point.speed_m_s, "error": error.to_string() }),
        Ok(result) => {
            let mut json = shot(result, units, plan);
            if let Some(object) = json.as_object_mut() {
                object.insert("speed_m_s".to_owned(), json!(point.speed_m_s));
                object.insert("warnings".to_owned(), json!(point.warnings));
                if result.budget.is_none() {
                    object.insert("energy".to_owned(), json!({ "missing": NO_BUDGET }));
                }
            }
            json
        }
    }
}

/// A fit of times against speed, with its standard errors and with what the
/// accuracies of the times alone leave open. Two speeds tell no errors and no
/// R²: null.
#[must_use]
pub fn fit(fit: &Result<PowerLaw, FitError>, uncertainty: Option<Uncertainty>) -> Json {
    match fit {
        Err(error) => json!({ "missing": missing::law(error) }),
        Ok(law) => json!({
            "prefactor_s": law.prefactor,
            "prefactor_error_s": law.prefactor_error,
            "prefactor_accuracy_s": uncertainty.map(|least| law.prefactor * least.prefactor_relative),
            "exponent": law.exponent,
            "exponent_error": law.exponent_error,
            "exponent_accuracy": uncertainty.map(|least| least.exponent),
            "covariance": law.covariance,
            "r_squared": (law.residuals.len() > 2).then_some(law.r_squared),
            "speeds": law.residuals.len(),
            "residuals": law.residuals,
        }),
    }
}

/// A description: numbers as numbers. What has several of them is an object
/// whose keys name the units.
#[must_use]
pub fn groups(groups: &[Group]) -> Json {
    let row = |row: &Row| json!({ "name": row.name.trim(), "value": value(&row.value), "unit": row.unit });
    let group = |group: &Group| json!({ "title": group.title, "rows": group.rows.iter().map(row).collect::<Json>() });
    groups.iter().map(group).collect()
}

fn value(of: &Value) -> Json {
    match of {
        Value::Number(number) => json!(number),
        Value::Count(count) => json!(count),
        Value::Range(least, most) => json!([least, most]),
        Value::Text(text) => json!(text),
        Value::Parts(parts) => {
            let named = parts.iter().map(|part| (key(part), value(&part.value)));
            Json::Object(named.collect())
        }
    }
}

/// A name as a key, with its unit.
fn key(part: &Row) -> String {
    let words = [part.name.as_str(), part.unit.as_str()];
    let words = words.into_iter().filter(|word| !word.is_empty());
    let words = words.map(|word| word.replace([' ', '/'], "_").to_lowercase());
    words.collect::<Vec<_>>().join("_")
}
