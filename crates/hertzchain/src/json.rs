//! Results as JSON, full precision, SI units in the names.

use crate::contact::HertzContact;
use crate::missing;
use hertzchain_chain::observe::{Competing, Maximum};
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::{Experiment, Units};
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty};
use hertzchain_sim::{
    BatchResult, BatchShot, Calibration, Column, Group, Plan, Rebound, Row, Shot, Value,
};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Value as Json, json};

/// A maximum of a signal.
#[derive(Serialize)]
struct PeakView {
    time_s: f64,
    value: f64,
}

impl From<&Maximum> for PeakView {
    fn from(maximum: &Maximum) -> Self {
        Self { time_s: maximum.time_s, value: maximum.value }
    }
}

fn peaks<S: Serializer>(maxima: &&[Maximum], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(maxima.iter().map(PeakView::from))
}

/// One shot of an experiment at a speed of its own or another.
pub fn shot_of(experiment: &Experiment, speed_m_s: Option<f64>, plan: &Plan, shot: &Shot) -> Json {
    let view = ShotView {
        experiment: Some(experiment.name()),
        speed_m_s: speed_m_s.or(experiment.speed_m_s()),
        ..ShotView::of(shot, experiment.units(), plan)
    };
    // Numbers and texts always have a form in JSON.
    serde_json::to_value(view).unwrap_or_default()
}

/// One shot as JSON.
#[derive(Serialize)]
struct ShotView<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    experiment: Option<&'a str>,
    speed_m_s: Option<f64>,
    tof_incident_s: Option<f64>,
    tof_reflected_s: Option<f64>,
    accuracy_asked: f64,
    accuracy_reached: Option<f64>,
    passage: PassageView<'a>,
    wall_contact: Option<HertzContact>,
    #[serde(serialize_with = "peaks")]
    sensor_maxima: &'a [Maximum],
    pulse_speed_beads_per_s: Option<f64>,
    striker_rebound: Option<ReboundView>,
    energy: Option<Json>,
    duration_s: f64,
    solver: &'a str,
    tolerance: Option<f64>,
    step_s: Option<f64>,
    force_passes: u64,
    steps: u64,
    notes: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    warnings: Option<&'a [String]>,
}

impl<'a> ShotView<'a> {
    /// One shot of a plan that differs from this one in speed at most.
    fn of(shot: &'a Shot, units: Units, plan: &Plan) -> Self {
        Self {
            experiment: None,
            speed_m_s: None,
            tof_incident_s: shot.flight.map(|flight| flight.incident_s),
            tof_reflected_s: shot.flight.and_then(|flight| flight.reflected_s),
            accuracy_asked: shot.accuracy_asked,
            accuracy_reached: shot.accuracy_reached,
            passage: PassageView::of(shot, units, plan),
            wall_contact: HertzContact::of_wall(units, plan, shot),
            sensor_maxima: &shot.sensor_maxima,
            pulse_speed_beads_per_s: shot.pulse_speed_beads_s,
            striker_rebound: shot.rebound.map(ReboundView::of),
            energy: shot.budget.as_ref().map(budget),
            duration_s: shot.duration_s,
            solver: &shot.solver,
            tolerance: shot.tolerance,
            step_s: shot.step_s,
            force_passes: shot.work.force_passes,
            steps: shot.work.steps,
            notes: &shot.notes,
            warnings: None,
        }
    }
}

/// The striker afterwards.
#[derive(Serialize)]
struct ReboundView {
    first_separation_time_s: Option<f64>,
    first_separation_m_s: Option<f64>,
    end_time_s: Option<f64>,
    end_m_s: Option<f64>,
}

impl ReboundView {
    fn of(rebound: Rebound) -> Self {
        Self {
            first_separation_time_s: rebound.first.map(|first| first.0),
            first_separation_m_s: rebound.first.map(|first| first.1),
            end_time_s: rebound.end_s,
            end_m_s: rebound.end_m_s,
        }
    }
}

/// The three pulses, or why they are not seen.
#[derive(Serialize)]
#[serde(untagged)]
enum PassageView<'a> {
    Missing {
        missing: String,
        wall: Option<PeakView>,
    },
    Seen {
        incident: PeakView,
        wall: PeakView,
        reflected: Option<PeakView>,
        search_ends_s: f64,
        #[serde(serialize_with = "others")]
        competing: &'a [Competing],
        #[serde(serialize_with = "peaks")]
        wall_maxima: &'a [Maximum],
        incident_width_s: Option<f64>,
        wall_width_s: Option<f64>,
        reflected_width_s: Option<f64>,
    },
}

impl<'a> PassageView<'a> {
    fn of(shot: &'a Shot, units: Units, plan: &Plan) -> Self {
        match &shot.passage {
            Err(error) => Self::Missing {
                missing: missing::reason(&plan.chain.far, units, error),
                wall: shot.wall().as_ref().map(PeakView::from),
            },
            Ok(seen) => Self::Seen {
                incident: PeakView::from(&seen.incident),
                wall: PeakView::from(&seen.wall),
                reflected: seen.reflected.as_ref().map(PeakView::from),
                search_ends_s: seen.search_ends_s,
                competing: &seen.competing,
                wall_maxima: &seen.wall_maxima,
                incident_width_s: seen.incident_width_s,
                wall_width_s: seen.wall_width_s,
                reflected_width_s: seen.reflected_width_s,
            },
        }
    }
}

fn others<S: Serializer>(others: &&[Competing], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct View {
        pulse: &'static str,
        time_s: f64,
        value: f64,
        share: f64,
    }
    serializer.collect_seq(others.iter().map(|other| View {
        pulse: other.pulse.name(),
        time_s: other.maximum.time_s,
        value: other.maximum.value,
        share: other.share,
    }))
}

fn budget(budget: &Budget) -> Json {
    let lines = budget.dissipated.iter();
    let dissipated: serde_json::Map<String, Json> =
        lines.map(|line| (line.law.to_owned(), json!(line.energy_j))).collect();
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

/// All speeds of a sweep and their power laws, written as they are read; `plan` is that of one
/// of them.
pub struct SweepView<'a> {
    /// What stands beside the points.
    pub outline: Json,
    /// The shots.
    pub points: &'a [BatchShot],
    /// Units of the experiment.
    pub units: Units,
    /// A plan of one of them.
    pub plan: &'a Plan,
}

impl<'a> SweepView<'a> {
    /// Of the shots and the results of one batch.
    pub fn new(
        experiment: &Experiment,
        plan: &'a Plan,
        points: &'a [BatchShot],
        (result, calibration): (&BatchResult, Option<&Calibration>),
    ) -> Self {
        let laws = [Column::Incident, Column::Reflected];
        let laws = laws.map(|of| result.rows.law(of, result.accuracy));
        let through = laws.each_ref().map(|(law, least)| (law, least.clone()));
        let mut outline = outline(experiment, calibration, through);
        outline["error_control"] = json!(result.error_control);
        Self { outline, points, units: experiment.units(), plan }
    }
}

impl Serialize for SweepView<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (key, value) in self.outline.as_object().into_iter().flatten() {
            map.serialize_entry(key, value)?;
        }
        map.serialize_entry("points", &Points(self))?;
        map.end()
    }
}

struct Points<'a>(&'a SweepView<'a>);

impl Serialize for Points<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let SweepView { points, units, plan, .. } = self.0;
        serializer.collect_seq(points.iter().map(|it| point(it, *units, plan)))
    }
}

/// A sweep without its points; laws are the incident and the reflected times'.
pub fn outline(
    experiment: &Experiment,
    calibration: Option<&Calibration>,
    [incident, reflected]: [Through<'_>; 2],
) -> Json {
    let calibrated = |it: &Calibration| json!({"count": it.shots, "accuracy_reached": it.reached, "way": it.to_string()});
    json!({
        "experiment": experiment.name(),
        "calibration": calibration.map(calibrated),
        "power_law_incident": fit(incident.0, incident.1.ok()),
        "power_law_reflected": fit(reflected.0, reflected.1.ok()),
    })
}

/// A power law, and what accuracies alone leave open of it.
pub type Through<'a> = (&'a Result<PowerLaw, FitError>, Result<Uncertainty, FitError>);

/// What stands in the place of the energy budget in a sweep.
const NO_BUDGET: &str =
    "a sweep asks for times of flight and keeps no energy budget; `hertzchain shot` does";

#[derive(Serialize)]
#[serde(untagged)]
enum PointView<'a> {
    Failed { speed_m_s: f64, error: String },
    Shot(Box<ShotView<'a>>),
}

/// One speed of a sweep.
fn point<'a>(point: &'a BatchShot, units: Units, plan: &Plan) -> PointView<'a> {
    let speed_m_s = point.speed_m_s;
    match &point.shot {
        Err(error) => PointView::Failed { speed_m_s, error: error.to_string() },
        Ok(shot) => {
            let view = ShotView::of(shot, units, plan);
            let energy = view.energy.or_else(|| Some(json!({ "missing": NO_BUDGET })));
            PointView::Shot(Box::new(ShotView {
                speed_m_s: Some(speed_m_s),
                warnings: Some(&point.warnings),
                energy,
                ..view
            }))
        }
    }
}

/// A fit of times against speed, with its standard errors and with what the
/// accuracies of the times alone leave open. Two speeds determine no errors and no
/// R²: null.
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
