//! Ensembles: shots over arrays of speeds and of named numbers.

use crate::columns::{Columns, copied, list, told};
use crate::experiment::Experiment;
use crate::failure::{Failed, of_path};
use crate::job::Job;
use crate::sweep::{Asked, judges, representative};
use hertzchain::arguments::{How, parsed};
use hertzchain::failure::{Failure, of_speed};
use hertzchain::input;
use hertzchain_experiment as experiment;
use hertzchain_experiment::Warning;
use hertzchain_sim::{
    InstructionSet, Judges, Odd, Plan, Shot, Stop, StudyError, Tuned, parted, piece, shoot_all,
    shoot_tuned, shoot_unjudged, stopped,
};
use numpy::{IntoPyArray, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

/// Rows that one thread plans in a go: neighbours often share their numbers.
const NEIGHBOURS: usize = 64;

/// Rows among which pilots are looked for.
const PILOT_ROWS: usize = 1000;

/// A row's plan with what is odd about it in words, or why there is none.
type Planned = Result<(Plan, Vec<String>), String>;

/// Rows of speeds and numbers.
struct Rows<'a> {
    experiment: &'a experiment::Experiment,
    speeds_m_s: Vec<f64>,
    names: Vec<String>,
    /// Of each name, one a row.
    values: Vec<Vec<f64>>,
    how: &'a How,
    rebound: bool,
}

impl Rows<'_> {
    fn values_at(&self, row: usize) -> Vec<f64> {
        let of = |values: &Vec<f64>| values.get(row).copied();
        self.values.iter().filter_map(of).collect()
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
    fn plans(&self, rows: &[usize]) -> Vec<Planned> {
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

    fn plan(&self, changed: &experiment::Experiment, row: usize) -> Planned {
        let speed_m_s = self.speeds_m_s.get(row).copied();
        let (mut plan, warnings) = Plan::from_experiment(changed, speed_m_s)
            .map_err(|wrong| of_speed(&wrong).unwrap_or_else(|| wrong.to_string()))?;
        input::adjust(self.how, &mut plan);
        plan.rebound = self.rebound;
        Ok((plan, warnings.iter().map(Warning::one_line).collect()))
    }

    fn planned(&self, rows: &[usize]) -> Vec<Planned> {
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
        let sound = self.planned(&some).into_iter().flatten();
        let plans: Vec<Plan> = sound.map(|(plan, _)| plan).collect();
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
        stop: &Stop,
    ) -> Vec<Result<Shot, StudyError>> {
        let seen = || stop.count(1);
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

/// What came of rows.
#[derive(Default)]
struct Fired {
    columns: Columns,
    /// Why rows have no shot.
    errors: Vec<(usize, String)>,
    odd: Option<Odd>,
}

impl Fired {
    /// Of all rows, some hundreds at a time.
    fn of(
        rows: &Rows<'_>,
        judges: Option<Judges>,
        set: InstructionSet,
        stop: &Stop,
    ) -> Result<Self, Failure> {
        let shooting = Shooting::of(judges, rows, set);
        let mut fired = Self::default();
        let count = rows.speeds_m_s.len();
        let piece = piece();
        for first in (0..count).step_by(piece) {
            let part: Vec<usize> = (first..count.min(first + piece)).collect();
            let (plans, told) = parted(rows.planned(&part));
            let shots = shooting.shots(&plans, set, rows.how.check, stop);
            if stopped() {
                return Err(Failure::User(StudyError::Stopped.to_string()));
            }
            let mut shots = shots.into_iter();
            for (row, told) in part.into_iter().zip(told) {
                fired.take(row, told, &mut shots, stop);
            }
        }
        Ok(fired)
    }

    /// One row more, with what is odd about its plan or why it has none; its shot is
    /// the next if it has one.
    fn take(
        &mut self,
        row: usize,
        told: Result<Vec<String>, String>,
        shots: &mut impl Iterator<Item = Result<Shot, StudyError>>,
        stop: &Stop,
    ) {
        let shot = match told {
            Ok(warnings) => {
                Odd::add(&mut self.odd, row, &warnings);
                let shot = shots.next().unwrap_or(Err(StudyError::Stopped));
                shot.map_err(|why| why.to_string())
            }
            Err(why) => {
                stop.count(1);
                Err(why)
            }
        };
        self.columns.push(shot.as_ref().ok());
        self.errors.extend(shot.err().map(|why| (row, why)));
    }
}

/// Shots of rows of speeds and numbers.
#[pyfunction]
#[pyo3(signature = (experiment, speeds_m_s, names, values, asked, progress))]
pub(crate) fn ensemble<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speeds_m_s: PyReadonlyArrayDyn<'py, f64>,
    names: Vec<String>,
    values: Vec<PyReadonlyArrayDyn<'py, f64>>,
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
        speeds_m_s: copied(py, &speeds_m_s)?,
        values: all_copied(py, &values)?,
        names,
        how: &how,
        rebound: asked.rebound,
    };
    let count = rows.speeds_m_s.len();
    if rows.values.len() != rows.names.len() || rows.values.iter().any(|own| own.len() != count) {
        let text = "every name needs as many values as there are speeds";
        return Err(Failed::from(Failure::User(text.to_owned())).into());
    }
    let job = Job::pooled(progress, asked.threads);
    let fired = job.run(py, |stop| Fired::of(&rows, judges, set, stop))?;
    let found = PyDict::new(py);
    found.set_item("speed_m_s", rows.speeds_m_s.into_pyarray(py))?;
    let values = rows.values.into_iter().map(|own| own.into_pyarray(py));
    found.set_item("values", values.collect::<Vec<_>>())?;
    found.set_item("columns", fired.columns.arrays(py)?)?;
    found.set_item("errors", list(py, fired.errors)?)?;
    found.set_item("odd", told(fired.odd))?;
    Ok(found)
}

/// Numbers of several arrays.
pub(crate) fn all_copied(
    py: Python<'_>,
    arrays: &[PyReadonlyArrayDyn<'_, f64>],
) -> PyResult<Vec<Vec<f64>>> {
    arrays.iter().map(|array| copied(py, array)).collect()
}
