//! Ensembles: shots over arrays of speeds and of named numbers.

use crate::columns::Columns;
use crate::experiment::Experiment;
use crate::failure::{Failed, of_path};
use crate::job::{Job, Meter};
use crate::sweep::{Asked, judges, representative};
use hertzchain_experiment as experiment;
use hertzchain_study::{
    InstructionSet, Judges, Plan, Shot, StudyError, Tuned, shoot_all, shoot_tuned, shoot_unjudged,
    stopped,
};
use hertzchain_verbs::arguments::{How, parsed};
use hertzchain_verbs::failure::{Failure, of_speed};
use hertzchain_verbs::input;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

/// Rows that are in memory as chains at a time.
const TOGETHER: usize = 4096;

/// Rows that one thread plans in a go: neighbours often share their numbers.
const NEIGHBOURS: usize = 64;

/// Rows among which pilots are looked for.
const PILOT_ROWS: usize = 1000;

/// Rows of speeds and numbers.
struct Rows<'a> {
    experiment: &'a experiment::Experiment,
    speeds_m_s: Vec<f64>,
    names: Vec<String>,
    /// All values of the first name, then those of the second.
    values: Vec<f64>,
    how: &'a How,
    rebound: bool,
}

impl Rows<'_> {
    fn values_at(&self, row: usize) -> Vec<f64> {
        let count = self.speeds_m_s.len();
        let of = |name: usize| self.values.get(name * count + row).copied();
        (0..self.names.len()).filter_map(of).collect()
    }

    fn with(&self, values: &[f64]) -> Result<experiment::Experiment, String> {
        let names = self.names.iter().map(String::as_str);
        let pairs: Vec<(&str, f64)> = names.zip(values.iter().copied()).collect();
        let changed = self.experiment.set(&pairs);
        changed.map_err(|error| match of_path(error) {
            Failure::Mistakes(mistakes) => mistakes.to_string(),
            Failure::User(text) | Failure::Ours(text) => text,
            Failure::BrokenPipe => String::new(),
        })
    }

    /// Plans of consecutive rows, or why a row has none.
    fn plans(&self, rows: &[usize]) -> Vec<Result<Plan, String>> {
        let mut latest: Option<(Vec<f64>, Result<experiment::Experiment, String>)> = None;
        let mut one = |row: usize| {
            if stopped() {
                return Err(StudyError::Stopped.to_string());
            }
            let values = self.values_at(row);
            if latest.as_ref().is_none_or(|(same, _)| *same != values) {
                let changed = match values.is_empty() {
                    true => Ok(self.experiment.clone()),
                    false => self.with(&values),
                };
                latest = Some((values, changed));
            }
            match &latest {
                Some((_, Ok(changed))) => self.plan(changed, row),
                Some((_, Err(why))) => Err(why.clone()),
                None => Err(String::new()),
            }
        };
        rows.iter().map(|row| one(*row)).collect()
    }

    fn plan(&self, changed: &experiment::Experiment, row: usize) -> Result<Plan, String> {
        let speed_m_s = self.speeds_m_s.get(row).copied();
        let (mut plan, _warnings) = Plan::from_experiment(changed, speed_m_s)
            .map_err(|wrong| of_speed(&wrong).unwrap_or_else(|| wrong.to_string()))?;
        input::adjust(self.how, &mut plan);
        plan.rebound = self.rebound;
        Ok(plan)
    }

    fn planned(&self, rows: &[usize]) -> Vec<Result<Plan, String>> {
        let parts: Vec<Vec<_>> = rows
            .par_chunks(NEIGHBOURS)
            .map(|part| self.plans(part))
            .collect();
        parts.into_iter().flatten().collect()
    }

    /// Evenly spread rows, of which pilots are.
    fn tuned(&self, set: InstructionSet) -> Option<Tuned> {
        let count = self.speeds_m_s.len();
        let step = count.div_ceil(PILOT_ROWS).max(1);
        let some: Vec<usize> = (0..count).step_by(step).collect();
        let plans: Vec<Plan> = self.planned(&some).into_iter().flatten().collect();
        Tuned::new(&Tuned::pilots(&plans), set)
    }
}

/// How shots of plans are computed.
enum Shooting {
    Judged,
    Tuned(Tuned),
    Unjudged,
}

impl Shooting {
    fn of(judges: Option<Judges>, rows: &Rows<'_>, set: InstructionSet) -> Self {
        match judges {
            None => Self::Unjudged,
            Some(Judges::Each) => Self::Judged,
            Some(Judges::Pilots) => rows.tuned(set).map_or(Self::Judged, Self::Tuned),
        }
    }

    fn shots(
        &self,
        plans: &[Plan],
        set: InstructionSet,
        checked: bool,
        meter: &Meter,
    ) -> Vec<Result<Shot, StudyError>> {
        let seen = || meter.count();
        match self {
            Self::Judged => shoot_all(plans, set, checked, &seen),
            Self::Tuned(tuned) => shoot_tuned(plans, tuned, set, &seen),
            Self::Unjudged => {
                let shots = shoot_unjudged(plans, set);
                plans.iter().for_each(|_| seen());
                shots
            }
        }
    }
}

/// Columns, and why rows have none.
type Fired = (Columns, Vec<(usize, String)>);

fn fired(
    rows: &Rows<'_>,
    judges: Option<Judges>,
    set: InstructionSet,
    meter: &Meter,
) -> Result<Fired, Failure> {
    let shooting = Shooting::of(judges, rows, set);
    let mut columns = Columns::default();
    let mut errors = Vec::new();
    let all: Vec<usize> = (0..rows.speeds_m_s.len()).collect();
    for part in all.chunks(TOGETHER) {
        let planned = rows.planned(part);
        let plans: Vec<Plan> = planned.iter().flatten().cloned().collect();
        let mut shots = shooting
            .shots(&plans, set, rows.how.check, meter)
            .into_iter();
        for (row, plan) in part.iter().zip(planned) {
            let shot = match plan {
                Ok(_) => shots.next().map(|shot| shot.map_err(|why| why.to_string())),
                Err(why) => {
                    meter.count();
                    Some(Err(why))
                }
            };
            let shot = shot.unwrap_or_else(|| Err(StudyError::Stopped.to_string()));
            columns.push(shot.as_ref().ok());
            errors.extend(shot.err().map(|why| (*row, why)));
        }
        if stopped() {
            return Err(Failure::User(StudyError::Stopped.to_string()));
        }
    }
    Ok((columns, errors))
}

/// Shots of rows of speeds and numbers.
#[pyfunction]
#[pyo3(signature = (experiment, speeds_m_s, names, values, asked, progress))]
pub fn ensemble<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speeds_m_s: PyReadonlyArray1<'py, f64>,
    names: Vec<String>,
    values: PyReadonlyArray2<'py, f64>,
    asked: Asked,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let how: How = parsed("ensemble", &asked.options).map_err(Failed::from)?;
    let judges = match asked.judges.as_str() {
        "none" => None,
        name => Some(judges(name).map_err(Failed::from)?),
    };
    representative(experiment, &how).map_err(Failed::from)?;
    let set = input::instruction_set().map_err(Failed::from)?;
    let rows = Rows {
        experiment: &experiment.inner,
        speeds_m_s: speeds_m_s.as_array().to_vec(),
        values: values.as_array().iter().copied().collect(),
        names,
        how: &how,
        rebound: asked.rebound,
    };
    if rows.values.len() != rows.names.len() * rows.speeds_m_s.len() {
        let text = "every name needs as many values as there are speeds";
        return Err(Failed::from(Failure::User(text.to_owned())).into());
    }
    let job = Job::pooled(progress, asked.threads);
    let (columns, errors) = job.run(py, |meter| fired(&rows, judges, set, meter))?;
    let told = PyDict::new(py);
    told.set_item("columns", columns.arrays(py)?)?;
    told.set_item("errors", errors)?;
    Ok(told)
}
