//! What could be measured next, and how it depends on the parameters.

use super::joint::CurveProblem;
use super::model::{Model, Speeds};
use crate::data::{Data, DataRow, Freedom, Observable};
use crate::free::{Form, apart};
use crate::least_squares::{JUMPING, jacobian_at};
use crate::linear::norm;
use crate::{Candidate, Fit, InferError, ModelError};
use hertzchain_experiment::Experiment;
use hertzchain_experiment::reading::PRELOAD_N;
use hertzchain_measure::signal::{Estimate, median};

/// What a way to measure asks of the rig, beyond another speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing: incident times.
    Incident,
    /// That returns are seen.
    Reflected,
    /// That heights of peaks are trusted.
    Ratio,
    /// A sensor in another bead.
    Sensor,
    /// A push.
    Preload,
}

impl Kind {
    /// All of them, in their order.
    pub(crate) const ALL: [Self; 5] =
        [Self::Incident, Self::Reflected, Self::Ratio, Self::Sensor, Self::Preload];
}

/// A way to measure: a chain, and what is read from it.
#[derive(Clone, Debug)]
pub struct Way {
    /// What it asks for.
    pub kind: Kind,
    /// What one speed of it costs, in whatever unit the others do.
    pub cost: f64,
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
    /// Of measured values, in the order of [`Observable::ALL`].
    pub values: [f64; 4],
    /// Correlation of the errors of both times at one speed.
    pub correlation: f64,
    /// How well these standard errors are known: candidates are widened as data are.
    pub freedom: Freedom,
}

/// Where a file has the push on bead 1.
const PUSH: &str = "near_end.force";

/// Ratios of peaks are measured to this, where no data determine.
const USUAL_RATIO_ERROR: f64 = 0.005;

impl ExpectedErrors {
    /// As in data taken so far: medians, those of the other time or the other ratio where an
    /// observable has not been measured.
    pub fn like(data: &Data) -> Self {
        let rows = || data.rows.iter();
        let own = Observable::ALL.map(|of| {
            let measured = || rows().filter_map(move |row| Some((row, row.value(of)?.sigma)));
            let freedom = measured().map(|(row, _)| row.freedom.values[of.index()]);
            Some((middle(measured().map(|(_, sigma)| sigma))?, middle(freedom)?))
        });
        let all = Observable::ALL.map(|of| {
            let at = of.index();
            let usual = if of.is_time() { f64::NAN } else { USUAL_RATIO_ERROR };
            // Both times stand side by side, and so do both ratios.
            own[at].or(own[at ^ 1]).unwrap_or((usual, f64::INFINITY))
        });
        let both = rows().filter(|row| row.values[..2].iter().all(Option::is_some));
        let correlations = both.filter_map(|row| row.correlation);
        let of_speed = middle(rows().map(|row| row.freedom.speed));
        Self {
            speed_m_s: middle(rows().map(|row| row.speed_m_s.sigma)).unwrap_or(0.0),
            values: all.map(|(sigma, _)| sigma),
            correlation: middle(correlations).unwrap_or(0.0),
            freedom: Freedom {
                speed: of_speed.unwrap_or(f64::INFINITY),
                values: all.map(|(_, freedom)| freedom),
            },
        }
    }
}

fn middle(values: impl Iterator<Item = f64>) -> Option<f64> {
    median(&values.collect::<Vec<_>>())
}

/// What could be done otherwise, beside shooting at other speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Choices {
    /// Constant pushes on bead 1 in N.
    pub preloads_n: Vec<f64>,
    /// Beads that could hold the sensor; an eighth, a half and three quarters down the
    /// chain where none are reported.
    pub sensor_beads: Option<Vec<usize>>,
    /// Cost of a measurement of each kind, by which its information is divided.
    pub costs: [f64; Kind::ALL.len()],
}

impl Default for Choices {
    fn default() -> Self {
        Self { preloads_n: vec![PRELOAD_N], sensor_beads: None, costs: [1.0; Kind::ALL.len()] }
    }
}

impl Choices {
    fn cost(&self, kind: Kind) -> f64 {
        self.costs[kind as usize]
    }

    fn sensor_beads(&self, beads: usize) -> Vec<usize> {
        let usual = || vec![beads / 8, beads / 2, 3 * beads / 4];
        self.sensor_beads.clone().unwrap_or_else(usual)
    }
}

/// The chain with more read from it, with the sensor in other beads, and pushed.
///
/// # Errors
/// A chain that does not bear it, or a bead that there is not.
pub fn ways(experiment: &Experiment, choices: &Choices) -> Result<Vec<Way>, InferError> {
    use Observable::{Incident, Reflected, ReturningOverPassing};
    let way = |kind: Kind, name: &str, experiment: &Experiment, observables: &[Observable]| Way {
        kind,
        cost: choices.cost(kind),
        name: name.to_owned(),
        experiment: experiment.clone(),
        observables: observables.to_vec(),
    };
    let both = [Incident, Reflected];
    let mut ways = vec![
        way(Kind::Incident, "incident", experiment, &[Incident]),
        way(Kind::Reflected, "incident, reflected", experiment, &both),
        way(
            Kind::Ratio,
            "incident, reflected, returning ratio",
            experiment,
            &[Incident, Reflected, ReturningOverPassing],
        ),
    ];
    let (now, beads) = (experiment.sensor_bead(), experiment.beads());
    for bead in choices.sensor_beads(beads) {
        if choices.sensor_beads.is_some() && !(1..beads).contains(&bead) {
            return Err(InferError::Input(format!(
                "a sensor in bead {bead}: expected one from 1 to {}, before the last of the chain",
                beads - 1
            )));
        }
        if bead != now && (1..beads).contains(&bead) {
            let moved = experiment.set(&[("sensors.bead", bead as f64)])?;
            let name = format!("incident, reflected, sensor in bead {bead}");
            ways.push(way(Kind::Sensor, &name, &moved, &both));
        }
    }
    for force_n in &choices.preloads_n {
        let pushed = experiment.with_push(*force_n)?;
        let name = format!("incident, reflected, pushed with {force_n} N");
        ways.push(way(Kind::Preload, &name, &pushed, &both));
    }
    Ok(ways)
}

impl CurveProblem {
    /// Each way at each speed as something to measure, with derivatives at a fit's
    /// optimum by central differences, all speeds of a way in one ensemble.
    pub fn candidates(
        &self,
        fit: &Fit,
        ways: &[Way],
        speeds_m_s: &[f64],
        errors: &ExpectedErrors,
    ) -> Result<Vec<Candidate>, InferError> {
        let numbers = &self.model().numbers;
        let each = numbers.iter().find(|n| n.form == Form::EachSpeed);
        if let Some(number) = each {
            return Err(InferError::Input(format!(
                "{} has one value for each speed of the data, which says nothing of other speeds",
                number.name()
            )));
        }
        // Where the push is free, the fit's own stands in the place of any other.
        let is_free = |way: &&Way| way.kind != Kind::Preload || !numbers.is_free(PUSH);
        let mut all = Vec::new();
        // Ways that read more or less from the same shots compute these once.
        let mut latest: Option<(String, Model)> = None;
        for way in ways.iter().filter(is_free) {
            let text = way.experiment.canonical_text();
            let model = match latest.take() {
                Some((same, model)) if same == text => model,
                _ => Model::new(&way.experiment, numbers.clone())?
                    .with_accuracy(self.model().accuracy)
                    .cached(),
            };
            let found = of_way(model.clone(), fit, way, speeds_m_s, errors);
            latest = Some((text, model));
            all.extend(found.map_err(|error| InferError::from(error).about(&way.name))?);
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
    let problem = CurveProblem::of_curves(vec![(model.for_slopes(), data)], &[]);
    let jacobian = jacobian_at(&problem, fit)?;
    let measured = problem.measured();
    let candidate = |(row, speed): (usize, String)| {
        let own = measured.iter().enumerate();
        let own: Vec<usize> = own.filter(|(_, (_, of, _))| *of == row).map(|(at, _)| at).collect();
        let columns = || jacobian.columns.iter();
        let length =
            |column: &Vec<f64>| norm(&own.iter().map(|at| column[*at]).collect::<Vec<_>>());
        let doubts = columns().zip(&jacobian.disagreement);
        Candidate {
            name: format!("{speed} m/s: {}", way.name),
            rows: own.iter().map(|at| columns().map(|column| column[*at]).collect()).collect(),
            doubts: doubts
                .map(|(column, disagreement)| JUMPING * disagreement * length(column))
                .collect(),
            cost: way.cost,
        }
    };
    Ok(apart(speeds_m_s).into_iter().enumerate().map(candidate).collect())
}

/// Data as they would be at the fit, without noise.
fn expected(
    model: &Model,
    fit: &Fit,
    way: &Way,
    speeds_m_s: &[f64],
    errors: &ExpectedErrors,
) -> Result<Data, ModelError> {
    let speeds = Speeds::of_rows(speeds_m_s);
    let curve = model.curve(&fit.point, &speeds)?;
    let row = |(at, speed): (usize, &f64)| {
        let value = |of: Observable| {
            let sigma = errors.values[of.index()];
            let wanted = way.observables.contains(&of);
            let value = curve.get(at)?[of.index()].filter(|_| wanted)?;
            Some(Estimate { value, sigma })
        };
        DataRow {
            line: at as u64 + 1,
            speed_m_s: Estimate { value: *speed, sigma: errors.speed_m_s },
            values: Observable::ALL.map(value),
            correlation: Some(errors.correlation),
            freedom: errors.freedom,
        }
    };
    Ok(Data {
        file: way.name.clone(),
        case: String::new(),
        rows: speeds_m_s.iter().enumerate().map(row).collect(),
    })
}
