//! `design`: what to measure next.

use crate::csv::{Table, columns, list, table, view};
use crate::failure::Failure;
use crate::inference::{self, is_meant, references_json, user, warnings_json};
use crate::options::{DesignOptions as Arguments, Positive};
use hertzchain_experiment::Experiment;
use hertzchain_infer::{
    Aim, Candidate, Choices, CurveProblem, Data, Design, Expected, ExpectedErrors, Fit, Fitting,
    Goodness, Identifiability, Kind, Observable, Problem, fit, titled, ways, wrong_speed,
};
use hertzchain_sim::parse_speeds;
use serde_json::{Value, json};

/// What could be measured, and what it would determine.
pub struct DesignResult {
    /// How well the model follows the data so far: the ranking is the model's.
    pub goodness: Goodness,
    /// What could be measured.
    pub candidates: Vec<Candidate>,
    /// Which errors they are expected to have.
    pub errors: ExpectedErrors,
    /// What each would determine.
    pub design: Design,
    /// What is tightened, by name.
    pub names: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// Combinations of the parameters that the data so far leave open, in words.
    pub undetermined: Vec<String>,
    /// What would settle them, if there are any.
    pub advice: Vec<String>,
}

/// Ranks what to measure next so that parameters tighten most; the result is of the problem beside it.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let table = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n\
///              0.2,1e-4,9.030e-4,2e-7\n0.5,1e-4,7.565e-4,2e-7\n1.0,1e-4,6.829e-4,2e-7\n";
/// let mut options = DesignOptions { speeds: Some("0.3,0.8".to_owned()), ..DesignOptions::default() };
/// options.freed.free = vec!["eta".to_owned()];
/// let data = inference::parsed("table", table, &options.measured, None)?;
/// let (_, found) = design(&data, &preset("dry")?, &options)?;
/// let best = &found.candidates[found.design.ranked[0].candidate];
/// assert!(best.name.contains("m/s"), "{}", best.name);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// Options, data and model that do not fit together; what is in the way of a fit.
pub fn design(
    data: &Data,
    experiment: &Experiment,
    options: &Arguments,
) -> Result<(CurveProblem, DesignResult), Failure> {
    let speeds = speeds(data, options)?;
    let experiment = inference::in_case(experiment.clone(), &data.case)?;
    let experiment = inference::changed(experiment, &options.modelled.set)?;
    let model = inference::model(&experiment, &options.modelled, &options.freed)?;
    let problem = inference::problem(model, data.clone(), &options.freed)?;
    let targets = targets(&problem, options)?;
    let found = run_design(&problem, &targets, &speeds, options)?;
    Ok((problem, found))
}

/// Speeds that could be measured.
///
/// # Errors
/// A list that is none, or a speed that no striker has.
pub fn speeds(data: &Data, arguments: &Arguments) -> Result<Vec<f64>, Failure> {
    let Some(text) = &arguments.speeds else {
        return Ok(usual_speeds(&data.speeds_m_s()));
    };
    let speeds = parse_speeds(text).map_err(user)?;
    match speeds.iter().find_map(|speed| wrong_speed(*speed)) {
        None => Ok(speeds),
        Some(wrong) => Err(Failure::User(format!("--speeds {text}: {wrong}"))),
    }
}

/// A few speeds over the range of the data and a little beyond.
fn usual_speeds(speeds: &[f64]) -> Vec<f64> {
    let first = speeds.first().copied().unwrap_or(0.1) * 0.8;
    let last = speeds.last().copied().unwrap_or(1.0) * 1.25;
    let steps = 7;
    let speed = |at: i32| first * (last / first).powf(f64::from(at) / f64::from(steps));
    // Three digits are as near as a striker is set.
    let rounded = |speed: f64| format!("{speed:.3}").parse().unwrap_or(speed);
    (0..=steps).map(|at| rounded(speed(at))).collect()
}

/// Places of the named parameters; all of them where none is named.
///
/// # Errors
/// A parameter that is not free.
pub fn targets(problem: &CurveProblem, arguments: &Arguments) -> Result<Vec<usize>, Failure> {
    let names: Vec<&str> = problem.parameters().iter().map(|p| p.name.as_str()).collect();
    if arguments.target.is_empty() {
        return Ok((0..names.len()).collect());
    }
    let place = |target: &String| {
        let at = names.iter().position(|name| name == target);
        at.ok_or_else(|| {
            Failure::User(format!("--target {target} is not free; free are {}", names.join(", ")))
        })
    };
    arguments.target.iter().map(place).collect()
}

/// What the options say could be done otherwise.
fn choices(arguments: &Arguments) -> Choices {
    let mut choices = Choices {
        preloads_n: arguments.preloads.iter().filter_map(|preload| preload.0).collect(),
        sensor_beads: arguments.sensors.clone(),
        ..Choices::default()
    };
    for cost in &arguments.costs {
        choices.costs[Kind::from(cost.of) as usize] = cost.value;
    }
    choices
}

/// Fits, and ranks candidates by what they would determine of the targets.
pub(crate) fn run_design(
    problem: &CurveProblem,
    targets: &[usize],
    speeds: &[f64],
    arguments: &Arguments,
) -> Result<DesignResult, Failure> {
    let fit = fit(problem, &Fitting::default()).map_err(user)?;
    let problem = &sized_by(problem.clone(), &fit, arguments)?;
    let ways = ways(&problem.model().experiment, &choices(arguments)).map_err(user)?;
    let mut errors = ExpectedErrors::like(problem.data());
    if let Some(Positive(error)) = arguments.measured.ratio_error {
        for (of, expected) in Observable::ALL.into_iter().zip(&mut errors.values) {
            if !of.is_time() && !problem.data().has(of) {
                *expected = error;
            }
        }
    }
    let candidates = problem.candidates(&fit, &ways, speeds, &errors).map_err(user)?;
    let picks = arguments.picks.0;
    let found = hertzchain_infer::design(problem.parameters(), &fit, &candidates, targets, picks)
        .map_err(user)?;
    let aims = found.aims.iter().enumerate();
    let (names, units) = aims.map(|(at, aim)| called(problem, at, aim)).unzip();
    let label = |at: usize| problem.residual_label(at);
    let identified = Identifiability::new(problem.parameters(), &fit, label);
    let advice = match identified.unidentifiable.is_empty() {
        true => Vec::new(),
        false => problem.suggested_measurements(&fit).words(),
    };
    let open = identified.unidentifiable.into_iter();
    Ok(DesignResult {
        goodness: Goodness::new(problem, &fit),
        advice,
        candidates,
        errors,
        design: found,
        names,
        units,
        undetermined: open.map(|confusion| confusion.words).collect(),
    })
}

/// The problem with parameters as large as the fit has them where a start was asked for, which may be
/// far from that.
fn sized_by(
    problem: CurveProblem,
    fit: &Fit,
    arguments: &Arguments,
) -> Result<CurveProblem, Failure> {
    let mut parameters = problem.parameters().to_vec();
    for (parameter, value) in parameters.iter_mut().zip(&fit.point) {
        let mut starts = arguments.freed.start.iter();
        if *value != 0.0 && starts.any(|start| is_meant(&start.name, &parameter.name)) {
            parameter.scale = value.abs();
        }
    }
    problem.with_parameters(parameters).map_err(user)
}

/// What an aim, the `at`th, is called, and its unit.
fn called(problem: &CurveProblem, at: usize, aim: &Aim) -> (String, String) {
    match aim {
        Aim::Parameter(k) => {
            let parameter = &problem.parameters()[*k];
            (parameter.name.clone(), parameter.unit.clone())
        }
        Aim::Combination(_) => (format!("combination {}", at + 1), String::new()),
    }
}

impl DesignResult {
    /// What can't be tightened, and what is in its place, one sentence a line.
    pub(crate) fn unidentifiable(&self, problem: &CurveProblem) -> Vec<String> {
        let open = self.design.open.iter().map(|words| {
            format!("Nothing that could be measured determines this combination: {words}")
        });
        let mut reported: Vec<String> = open.collect();
        let names = self.design.not_identifiable.iter();
        let names: Vec<&str> = names.map(|k| problem.parameters()[*k].name.as_str()).collect();
        if !names.is_empty() {
            let which = match names[..] {
                [one] => one.to_owned(),
                _ => format!("none of {}", names.join(", ")),
            };
            let can = if names.len() > 1 { "can" } else { "can't" };
            reported.push(format!("So {which} {can} be tightened by itself"));
        }
        for (name, aim) in self.names.iter().zip(&self.design.aims) {
            if let Aim::Combination(words) = aim {
                reported.push(format!(
                    "Ranked is what tightens {name}, {words}, in shares of the parameters' sizes"
                ));
            }
        }
        reported
    }
}

/// Everything, in SI.
pub fn json(problem: &CurveProblem, run_design: &DesignResult) -> Value {
    let (candidates, found) = (&run_design.candidates, &run_design.design);
    let finite = |x: f64| x.is_finite().then_some(x);
    let one = |expected: &Expected| {
        json!({
            "measure": candidates[expected.candidate].name,
            "standard_errors": expected.after.iter().map(|sd| finite(*sd)).collect::<Vec<_>>(),
            "information_nats": expected.gain,
            "cost": candidates[expected.candidate].cost,
            "information_over_cost": expected.gain_per_cost,
        })
    };
    json!({
        "references": references_json(problem.model()),
        "warnings": warnings_json([&problem.model().experiment]),
        "follows_data": !run_design.goodness.is_rejected(),
        "parameters": run_design.names,
        "units": run_design.units,
        "standard_errors_now": found.before.iter().map(|sd| finite(*sd)).collect::<Vec<_>>(),
        "expected_errors": errors_json(&run_design.errors),
        "ranked": found.ranked.iter().map(one).collect::<Value>(),
        "series": found.greedy.iter().map(one).collect::<Value>(),
        "undetermined": run_design.undetermined,
        "not_identifiable": run_design.unidentifiable(problem),
    })
}

/// By column, standard errors of what could be measured, and the degrees of freedom that these have.
fn errors_json(errors: &ExpectedErrors) -> Value {
    let one = |error: f64, freedom: f64| {
        let freedom = freedom.is_finite().then_some(freedom);
        json!({ "error": error, "degrees_of_freedom": freedom })
    };
    let pairs = errors.values.into_iter().zip(errors.freedom.values);
    let named = Observable::ALL.into_iter().zip(pairs);
    let mut all = json!({ "speed_m_s": one(errors.speed_m_s, errors.freedom.speed) });
    for (of, (error, freedom)) in named {
        all[of.column()] = one(error, freedom);
    }
    all["tof_correlation"] = errors.correlation.into();
    all
}

/// Every table, as views of what [`json`] returns: files' names and what stands in them.
pub fn tables(found: &Value) -> Vec<Table> {
    let named = list(&found["parameters"]).iter().zip(list(&found["units"]));
    let now = named.clone().zip(list(&found["standard_errors_now"]));
    let now = now.map(|((name, unit), sd)| [name.clone(), unit.clone(), sd.clone()]);
    let errors = named.enumerate().map(|(at, (name, unit))| {
        let [name, unit] = [name, unit].map(|text| text.as_str().unwrap_or_default());
        (titled(&format!("{name}_error"), unit), format!("/standard_errors/{at}"))
    });
    let reported = columns("information_nats,cost,information_over_cost");
    let shown: Vec<_> = columns("measure").into_iter().chain(errors).chain(reported).collect();
    vec![
        ("design.csv", view(list(&found["ranked"]), &shown)),
        ("series.csv", view(list(&found["series"]), &shown)),
        ("now.csv", table(["name", "unit", "standard_error"], now)),
    ]
}
