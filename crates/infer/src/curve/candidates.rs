//! What could be measured next, and how it depends on the parameters.

use super::model::{Model, Speeds};
use super::problem::CurveProblem;
use crate::data::{Data, DataRow, Observable};
use crate::free::Form;
use crate::{Candidate, Fit, ModelError, Problem};
use hertzchain_experiment::reading::PreloadReading;
use hertzchain_experiment::{Experiment, Mistakes, PathError, Reading};
use hertzchain_signal::Estimate;

/// A way to measure: a chain, and what is read from it.
#[derive(Clone, Debug)]
pub struct Way {
    /// What it is called.
    pub name: String,
    /// The chain.
    pub experiment: Experiment,
    /// What is read.
    pub observables: Vec<Observable>,
}

/// Standard errors that measurements to come are expected to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedErrors {
    /// Of speeds in m/s.
    pub speed_m_s: f64,
    /// Of times of flight in s.
    pub time_s: f64,
    /// Of ratios of peaks.
    pub ratio: f64,
}

/// Ratios of peaks are measured to this, where no data tell.
const USUAL_RATIO_ERROR: f64 = 0.005;

impl ExpectedErrors {
    /// As in data taken so far: medians.
    #[must_use]
    pub fn like(data: &Data) -> Self {
        let of = |times: bool| {
            let rows = data.rows.iter();
            let values = rows.flat_map(move |row| {
                let wanted = Observable::ALL
                    .into_iter()
                    .filter(move |of| of.is_time() == times);
                wanted.filter_map(|of| Some(row.value(of)?.sigma))
            });
            median(values.collect())
        };
        let speeds = data.rows.iter().map(|row| row.speed_m_s.sigma).collect();
        Self {
            speed_m_s: median(speeds).unwrap_or(0.0),
            time_s: of(true).unwrap_or(f64::NAN),
            ratio: of(false).unwrap_or(USUAL_RATIO_ERROR),
        }
    }
}

impl ExpectedErrors {
    /// Of an observable.
    pub(super) fn of(&self, observable: Observable) -> f64 {
        match observable.is_time() {
            true => self.time_s,
            false => self.ratio,
        }
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Why a way to measure is no candidate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WayError {
    /// A chain that can't be.
    #[error(transparent)]
    Chain(#[from] PathError),
    /// A chain that can't be in this reading.
    #[error(transparent)]
    Reading(#[from] Mistakes),
    /// Numbers of one speed say nothing of another.
    #[error("{0} has one value for each speed of the data: that tells nothing of other speeds")]
    EachSpeed(String),
    /// The model at the fit.
    #[error("{name}: {error}")]
    Model {
        /// The way.
        name: String,
        /// What is in the way of a shot.
        error: ModelError,
    },
}

/// The chain with more read from it, other sensor beads, and a push on bead 1.
///
/// # Errors
/// A chain that does not bear it.
pub fn usual_ways(experiment: &Experiment) -> Result<Vec<Way>, WayError> {
    use Observable::{Incident, Reflected, ReturningOverPassing};
    let way = |name: &str, experiment: &Experiment, observables: &[Observable]| Way {
        name: name.to_owned(),
        experiment: experiment.clone(),
        observables: observables.to_vec(),
    };
    let mut ways = vec![
        way("incident", experiment, &[Incident]),
        way("incident, reflected", experiment, &[Incident, Reflected]),
        way(
            "incident, reflected, returning ratio",
            experiment,
            &[Incident, Reflected, ReturningOverPassing],
        ),
    ];
    let now = experiment.sensor_bead();
    let beads = experiment.beads();
    for bead in [beads / 8, beads / 2, 3 * beads / 4] {
        if bead != now && bead >= 1 && bead < beads {
            let moved = experiment.set(&[("sensors.bead", bead as f64)])?;
            let name = format!("incident, reflected, sensor in bead {bead}");
            ways.push(way(&name, &moved, &[Incident, Reflected]));
        }
    }
    if let Some(pushed) = pushed(experiment)? {
        let name = "incident, reflected, pushed with 0.24 N";
        ways.push(way(name, &pushed, &[Incident, Reflected]));
    }
    Ok(ways)
}

/// The chain with a push of 0.24 N on bead 1, if it has none.
pub(super) fn pushed(experiment: &Experiment) -> Result<Option<Experiment>, Mistakes> {
    let reading = experiment.reading();
    let none = reading.preload == PreloadReading::None;
    let preload = PreloadReading::Constant;
    let pushed = none.then(|| experiment.with_reading(&Reading { preload, ..reading }));
    pushed.transpose()
}

impl CurveProblem {
    /// Each way at each speed as something to measure, with derivatives at a fit's
    /// optimum by central differences, all speeds of a way in one ensemble.
    ///
    /// # Errors
    /// See [`WayError`].
    pub fn candidates(
        &self,
        fit: &Fit,
        ways: &[Way],
        speeds_m_s: &[f64],
        errors: &ExpectedErrors,
    ) -> Result<Vec<Candidate>, WayError> {
        let numbers = self.model().numbers();
        let each = numbers
            .as_slice()
            .iter()
            .find(|n| n.form() == Form::EachSpeed);
        if let Some(number) = each {
            return Err(WayError::EachSpeed(number.name().to_owned()));
        }
        let mut all = Vec::new();
        for way in ways {
            let model = Model::new(&way.experiment, numbers.clone())?;
            let model = model.with_accuracy(self.model().accuracy);
            let found = of_way(model, fit, way, speeds_m_s, errors);
            all.extend(found.map_err(|error| WayError::Model {
                name: way.name.clone(),
                error,
            })?);
        }
        Ok(all)
    }
}

fn of_way(
    model: Model,
    fit: &Fit,
    way: &Way,
    speeds_m_s: &[f64],
    errors: &ExpectedErrors,
) -> Result<Vec<Candidate>, ModelError> {
    let data = expected(&model, fit, way, speeds_m_s, errors)?;
    let problem = CurveProblem::part(model, data);
    let sides = (0..fit.point.len()).flat_map(|at| [(at, 1.0), (at, -1.0)]);
    let moved = |(at, sign): (usize, f64)| {
        let mut point = fit.point.clone();
        point[at] += sign * fit.jacobian.steps[at];
        point
    };
    let points: Vec<Vec<f64>> = sides.map(moved).collect();
    let found = problem.residuals(&points);
    let found: Vec<Vec<f64>> = found
        .into_iter()
        .map(|residuals| Ok(residuals?.standardised))
        .collect::<Result<_, ModelError>>()?;
    let slope = |residual: usize| -> Vec<f64> {
        let of = |at: usize| {
            let difference = found[2 * at][residual] - found[2 * at + 1][residual];
            difference / (2.0 * fit.jacobian.steps[at])
        };
        (0..fit.point.len()).map(of).collect()
    };
    let measured = problem.measured();
    let candidate = |(row, speed): (usize, &f64)| {
        let own = measured
            .iter()
            .enumerate()
            .filter(|(_, (of, _))| *of == row);
        Candidate {
            name: format!("{speed:.3} m/s: {}", way.name),
            rows: own.map(|(residual, _)| slope(residual)).collect(),
            cost: 1.0,
        }
    };
    Ok(speeds_m_s.iter().enumerate().map(candidate).collect())
}

/// Data as they would be at the fit, without noise.
pub(super) fn expected(
    model: &Model,
    fit: &Fit,
    way: &Way,
    speeds_m_s: &[f64],
    errors: &ExpectedErrors,
) -> Result<Data, ModelError> {
    let speeds = Speeds::of_rows(speeds_m_s);
    let curve = model.curves(std::slice::from_ref(&fit.point), &speeds);
    let curve = curve
        .into_iter()
        .next()
        .unwrap_or_else(|| Err(ModelError("no curve was computed".into())))?;
    let row = |(at, speed): (usize, &f64)| {
        let value = |of: Observable| {
            let sigma = errors.of(of);
            let wanted = way.observables.contains(&of);
            let value = curve.get(at)?[of.index()].filter(|_| wanted)?;
            Some(Estimate { value, sigma })
        };
        DataRow {
            line: at as u64 + 1,
            speed_m_s: Estimate {
                value: *speed,
                sigma: errors.speed_m_s,
            },
            values: Observable::ALL.map(value),
        }
    };
    Ok(Data {
        file: way.name.clone(),
        case: String::new(),
        rows: speeds_m_s.iter().enumerate().map(row).collect(),
    })
}
