//! Many shots of an experiment: batches over speeds and named numbers, and their results.

use crate::failure::Failure;
use crate::options::{ErrorControl, SweepOptions, Threads, check_speeds};
use crate::shot::{Energy, ShotView};
use crate::{input, missing};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty};
use hertzchain_sim::{
    Batch, BatchOptions, BatchResult, BatchShot, Calibration, Column, Plan, Shard, parse_speeds,
};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// A batch of shots of an experiment, computed as the options ask.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let row = preset("dry")?;
/// // Two speeds, with another coefficient of the cubic damping each.
/// let batch = hertzchain::sweep::batch(&row, vec![0.2, 0.4], &SweepOptions::default())?
///     .with_number("damping_cubic.coefficient", vec![0.0, 77.0])?;
/// let result = batch.run(Shard::WHOLE, &|| {});
/// assert_eq!(result.rows.len(), 2);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// An experiment without a striker, and options that it does not take.
pub fn batch(
    experiment: &Experiment,
    speeds_m_s: Vec<f64>,
    options: &SweepOptions,
) -> Result<Batch, Failure> {
    let plan = plan(experiment, options)?;
    let options = BatchOptions {
        accuracy: plan.accuracy,
        method: plan.method,
        step_s: plan.step_s,
        duration_s: plan.duration_s,
        pick: plan.pick,
        rebound: options.rebound,
        checked: options.how.check,
        error_control: options.error_control.into(),
        set: input::instruction_set()?,
    };
    Ok(Batch::new(experiment, speeds_m_s, options)?)
}

/// A plan at the experiment's own speed, to reject options before any work.
fn plan(experiment: &Experiment, options: &SweepOptions) -> Result<Plan, Failure> {
    let how = &options.how;
    if how.check && options.error_control == ErrorControl::None {
        return Err(Failure::User(
            "--check has nothing to compare with --error-control none; leave one out".to_owned(),
        ));
    }
    experiment.needs_striker("a sweep over speeds needs a chain with a striker")?;
    input::check_times(how, experiment)?;
    let (mut plan, _warnings) = Plan::from_experiment(experiment, None)?;
    input::adjust(how, &mut plan);
    input::check_effort(how, &plan, experiment.units())?;
    Ok(plan)
}

/// All shots of a sweep over speeds; it serialises in SI.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let options = SweepOptions { speeds: "0.2,0.5,1".to_owned(), ..SweepOptions::default() };
/// let swept = sweep(&preset("hertz")?, &options)?;
/// let json = serde_json::to_value(&swept)?;
/// // Hertz contacts alone: the time of flight follows v^(-1/5).
/// assert!((json["power_law_incident"]["exponent"].as_f64().unwrap() + 0.2).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SweepResult {
    /// The shots, in the order of the speeds.
    pub points: Vec<BatchShot>,
    /// Their table, with warnings and failures.
    pub result: BatchResult,
    /// Power laws and error control.
    pub summary: SweepSummary,
    /// A plan of one of the shots.
    pub plan: Plan,
}

/// Computes times of flight against speed.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let options = SweepOptions { speeds: "log:0.1:1:5".to_owned(), ..SweepOptions::default() };
/// let swept = sweep(&preset("dry")?, &options)?;
/// assert!(swept.points.iter().all(|point| point.shot.is_ok()));
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// As [`batch`]; a list of speeds that is none. A speed that fails is that shot's error alone.
pub fn sweep(experiment: &Experiment, options: &SweepOptions) -> Result<SweepResult, Failure> {
    let batch = batch(experiment, speeds(experiment, options)?, options)?;
    computed(experiment, options, &batch, &|| {})
}

/// The speeds that the options ask for.
pub(crate) fn speeds(experiment: &Experiment, options: &SweepOptions) -> Result<Vec<f64>, Failure> {
    let speeds = parse_speeds(&options.speeds).map_err(|e| Failure::User(e.to_string()))?;
    check_speeds("--speeds", &options.speeds, experiment.units())?;
    Ok(speeds)
}

/// Runs a batch over speeds, and calls `progress` after every shot.
pub(crate) fn computed(
    experiment: &Experiment,
    options: &SweepOptions,
    batch: &Batch,
    progress: &(dyn Fn() + Sync),
) -> Result<SweepResult, Failure> {
    let mut points = Vec::new();
    // Of a hundred thousand shots of a thousand beads these alone would take 0.8 GB.
    let take = |mut point: BatchShot| {
        if let Ok(shot) = &mut point.shot {
            shot.velocity_m_s = Vec::new();
        }
        points.push(point);
    };
    let (result, calibration) =
        pool(options.threads)?.install(|| batch.run_each(Shard::WHOLE, progress, take));
    let summary = SweepSummary::new(experiment, &result, calibration.as_ref());
    Ok(SweepResult { points, result, summary, plan: plan(experiment, options)? })
}

/// As many threads as an option asks for.
pub(crate) fn pool(threads: Option<Threads>) -> Result<rayon::ThreadPool, Failure> {
    let pool = hertzchain_sim::pool(threads.map_or(0, |threads| threads.0));
    pool.map_err(|error| Failure::Ours(format!("threads: {error}")))
}

/// A sweep without its shots.
///
/// ```
/// use hertzchain::prelude::*;
/// use hertzchain::sweep::SweepSummary;
///
/// let row = preset("hertz")?;
/// let batch = hertzchain::sweep::batch(&row, vec![0.2, 0.4], &SweepOptions::default())?;
/// let (result, calibration) = batch.run_each(Shard::WHOLE, &|| {}, |_| {});
/// let summary = SweepSummary::new(&row, &result, calibration.as_ref());
/// assert!(summary.error_control.starts_with("per shot"), "{}", summary.error_control);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
#[derive(Debug, Serialize)]
pub struct SweepSummary {
    /// The default experiment that was assumed, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub assumed_model: Option<String>,
    calibration: Value,
    /// How errors were controlled, and why.
    pub error_control: String,
    /// Name of the experiment.
    pub experiment: String,
    power_law_incident: Value,
    power_law_reflected: Value,
}

impl SweepSummary {
    /// Summarises a batch over speeds.
    pub fn new(
        experiment: &Experiment,
        result: &BatchResult,
        calibration: Option<&Calibration>,
    ) -> Self {
        let law = |of| law(result.rows.law(of, result.accuracy));
        Self {
            assumed_model: None,
            calibration: json!(calibration.map(|of| json!({
                "count": of.shots, "accuracy_reached": of.reached, "way": of.to_string(),
            }))),
            error_control: result.error_control.clone(),
            experiment: experiment.name().to_owned(),
            power_law_incident: law(Column::Incident),
            power_law_reflected: law(Column::Reflected),
        }
    }
}

/// A fit of times against speed, with its standard errors and with what the accuracies of the
/// times alone leave open. Two speeds determine no errors and no R²: null.
fn law((law, least): (Result<PowerLaw, FitError>, Result<Uncertainty, FitError>)) -> Value {
    let law = match law {
        Err(error) => return json!({ "missing": missing::law(&error) }),
        Ok(law) => law,
    };
    let least = least.ok();
    json!({
        "covariance": law.covariance,
        "exponent": law.exponent,
        "exponent_accuracy": least.as_ref().map(|least| least.exponent),
        "exponent_error": law.exponent_error,
        "prefactor_accuracy_s": least.map(|it| law.prefactor * it.prefactor_relative),
        "prefactor_error_s": law.prefactor_error,
        "prefactor_s": law.prefactor,
        "r_squared": (law.residuals.len() > 2).then_some(law.r_squared),
        "speeds": law.residuals.len(),
        "residuals": law.residuals,
    })
}

impl Serialize for SweepResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct SweepView<'a> {
            #[serde(flatten)]
            summary: &'a SweepSummary,
            points: Points<'a>,
        }
        SweepView { summary: &self.summary, points: Points(self) }.serialize(serializer)
    }
}

/// The shots, one of which at a time is JSON.
struct Points<'a>(&'a SweepResult);

impl Serialize for Points<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let SweepResult { points, result, plan, .. } = self.0;
        serializer.collect_seq(points.iter().map(|it| Point::new(it, result.units, plan)))
    }
}

/// What stands in the place of the energy budget in a sweep.
const NO_BUDGET: &str =
    "a sweep asks for times of flight and keeps no energy budget; `hertzchain shot` does";

/// A shot of a sweep as JSON, or why there is none.
#[derive(Serialize)]
#[serde(untagged)]
enum Point<'a> {
    Shot(Box<ShotView<'a>>),
    Failed { error: String, speed_m_s: f64 },
}

impl<'a> Point<'a> {
    fn new(of: &'a BatchShot, units: Units, plan: &Plan) -> Self {
        let speed_m_s = of.speed_m_s;
        let shot = match &of.shot {
            Ok(shot) => shot,
            Err(error) => return Self::Failed { error: error.to_string(), speed_m_s },
        };
        let mut view = ShotView::new(shot, units, plan);
        view.energy = Some(Energy::Missing { missing: NO_BUDGET });
        (view.speed_m_s, view.warnings) = (Some(speed_m_s), Some(&of.warnings[..]));
        Self::Shot(Box::new(view))
    }
}
