//! Curves of many points as lanes of one ensemble.

use crate::Parameter;
use crate::free::{FreeNumbers, Settings};
use crate::problem::ModelError;
use hertzchain_experiment::{Amplifier, Experiment, Mistakes, PathError};
use hertzchain_sim::{
    Control, InstructionSet, Plan, Shot, StudyError, count_done, run_plans, stopped,
};
use rayon::prelude::*;
use std::collections::HashMap;
use std::fmt::Display;
use std::sync::{Arc, Mutex, PoisonError};

/// What a model predicts at one speed, in the order of
/// [`Observable::ALL`](crate::Observable::ALL); `None` where no such pulse is seen.
pub type Predicted = [Option<f64>; 4];

/// Speeds of a curve in m/s, each with the row of the data that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Speeds {
    /// Rows and speeds.
    pub at: Vec<(usize, f64)>,
    /// Number of rows.
    pub rows: usize,
}

impl Speeds {
    /// One speed a row.
    pub fn of_rows(speeds_m_s: &[f64]) -> Self {
        Self { at: speeds_m_s.iter().copied().enumerate().collect(), rows: speeds_m_s.len() }
    }
}

/// An experiment whose free numbers are parameters.
#[derive(Clone, Debug)]
pub struct Model {
    /// The experiment that its parameters change.
    pub experiment: Experiment,
    /// Its free numbers.
    pub numbers: FreeNumbers,
    /// Relative accuracy of times of flight.
    pub accuracy: f64,
    /// Vector instructions of the ensemble.
    pub set: InstructionSet,
    cache: Option<Cache>,
}

/// A model's curves by point, speeds and accuracy.
type Cache = Arc<Mutex<HashMap<Vec<u64>, Result<Vec<Predicted>, ModelError>>>>;

/// A shot to be computed, and what its signals are multiplied by.
#[derive(Clone, Debug)]
pub(crate) struct Shooting {
    pub(crate) plan: Plan,
    /// Added to incident and reflected times.
    pub(crate) delays_s: [f64; 2],
    /// Sensitivity of the wall's sensor over that of the bead's.
    pub(crate) wall_gain: f64,
    /// That of the bead's sensor and its amplifier in V/N.
    pub(crate) sensor_gain_v_n: f64,
    pub(crate) amplifier: Amplifier,
}

impl Model {
    /// A fit's accuracy: on the paper's chains the steps it takes leave errors
    /// below 2e-6 of every time of flight, a hundredth of a good measurement's.
    pub const ACCURACY: f64 = 1e-5;

    /// A model at [`Self::ACCURACY`].
    ///
    /// # Errors
    /// An experiment without a striker, whose speed is what curves run over.
    pub fn new(experiment: &Experiment, numbers: FreeNumbers) -> Result<Self, Mistakes> {
        experiment.needs_striker("a fit of times of flight needs a chain with a striker")?;
        Ok(Self {
            experiment: experiment.clone(),
            numbers,
            accuracy: Self::ACCURACY,
            set: InstructionSet::default(),
            cache: None,
        })
    }

    /// The same model and its copies compute each curve once.
    pub(super) fn cached(self) -> Self {
        Self { cache: Some(Cache::default()), ..self }
    }

    /// The same model at another accuracy.
    pub fn with_accuracy(mut self, accuracy: f64) -> Self {
        self.accuracy = accuracy;
        self
    }

    /// The same ten times as accurate, for derivatives: where the solver takes another
    /// number of steps its error jumps, by 2e-7 of a time of flight at the usual accuracy, which
    /// is a few percent of what a step of differences changes at some of the speeds.
    pub(super) fn for_slopes(self) -> Self {
        let accuracy = (0.1 * self.accuracy).max(Self::FINEST).min(self.accuracy);
        self.with_accuracy(accuracy)
    }

    const FINEST: f64 = 1e-9;

    /// What names of problems of this model follow from.
    pub(crate) fn inputs(&self, parameters: &[Parameter]) -> String {
        let experiment = self.experiment.canonical_text();
        format!("{:?}", (experiment, &self.numbers, parameters, self.set.name(), self.accuracy))
    }

    /// Predictions at all speeds for every point.
    ///
    /// A point that fails at one speed has no curve: its error says where and why.
    pub fn curves(
        &self,
        points: &[Vec<f64>],
        speeds: &Speeds,
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        let Some(cache) = &self.cache else {
            return self.computed(points, speeds);
        };
        let at = speeds.at.iter().flat_map(|(row, speed)| [*row as u64, speed.to_bits()]);
        let end: Vec<u64> = at.chain([speeds.rows as u64, self.accuracy.to_bits()]).collect();
        let key = |point: &Vec<f64>| -> Vec<u64> {
            point.iter().map(|value| value.to_bits()).chain(end.iter().copied()).collect()
        };
        let mut known = cache.lock().unwrap_or_else(PoisonError::into_inner);
        let new = points.iter().filter(|point| !known.contains_key(&key(point)));
        let new: Vec<Vec<f64>> = new.cloned().collect();
        known.extend(new.iter().map(key).zip(self.computed(&new, speeds)));
        points.iter().map(|point| known[&key(point)].clone()).collect()
    }

    fn computed(
        &self,
        points: &[Vec<f64>],
        speeds: &Speeds,
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        let planned: Vec<Result<Vec<Shooting>, ModelError>> =
            points.par_iter().map(|point| self.plans(point, speeds)).collect();
        let mut plans = Vec::new();
        let mut part = |one: Shooting| {
            plans.push(one.plan);
            (one.wall_gain, one.delays_s)
        };
        let readings: Vec<Result<Vec<Reading>, ModelError>> = planned
            .into_iter()
            .map(|planned| Ok(planned?.into_iter().map(&mut part).collect()))
            .collect();
        let mut shots = run_plans(&plans, Control::None, self.set, &|| {}).into_iter();
        let curve = |readings: Result<Vec<Reading>, ModelError>| {
            let readings = readings?;
            // All of the point's shots, so that the next point's are next.
            let own: Vec<_> = shots.by_ref().take(readings.len()).collect();
            let rows = own.into_iter().zip(readings).zip(&speeds.at);
            rows.map(|((shot, reading), (_, speed))| {
                predicted(&shot.map_err(|error| at(*speed, error))?, reading)
                    .map_err(|error| at(*speed, error))
            })
            .collect()
        };
        let curves = readings.into_iter().map(curve).collect();
        count_done(points.len());
        curves
    }

    /// Predictions at all speeds for one point.
    pub(super) fn curve(
        &self,
        point: &[f64],
        speeds: &Speeds,
    ) -> Result<Vec<Predicted>, ModelError> {
        self.curves(&[point.to_vec()], speeds).remove(0)
    }

    /// The largest relative error of one curve's times of flight, each shot of
    /// which is computed again with longer steps, or more tightly.
    ///
    /// # Errors
    /// What is in the way of a shot.
    pub fn accuracy_reached(&self, point: &[f64], speeds: &Speeds) -> Result<f64, ModelError> {
        let plans = self.plans(point, speeds)?;
        let plans: Vec<Plan> = plans.into_iter().map(|one| one.plan).collect();
        let shots = run_plans(&plans, Control::PerShot { checked: true }, self.set, &|| {});
        let mut worst: f64 = 0.0;
        for (shot, (_, speed)) in shots.into_iter().zip(&speeds.at) {
            let shot = shot.map_err(|error| at(*speed, error))?;
            worst = worst.max(shot.accuracy_reached.unwrap_or(self.accuracy));
        }
        Ok(worst)
    }

    pub(crate) fn plans(
        &self,
        point: &[f64],
        speeds: &Speeds,
    ) -> Result<Vec<Shooting>, ModelError> {
        if stopped() {
            return Err(ModelError(StudyError::Stopped.to_string()));
        }
        let mut latest: Option<(Settings, Experiment)> = None;
        let mut plan = |&(row, speed_m_s): &(usize, f64)| -> Result<Shooting, ModelError> {
            let at_speed = |speed_m_s| self.numbers.settings(point, speeds.rows, (row, speed_m_s));
            // Power laws are of the true speed.
            let true_m_s = speed_m_s * at_speed(speed_m_s).speed_scale;
            let settings = at_speed(true_m_s);
            let experiment = match latest.take() {
                Some((same, experiment)) if same == settings => experiment,
                _ => self.set(&settings).map_err(|error| at(speed_m_s, brief(&error)))?,
            };
            let planned = Plan::from_experiment(&experiment, Some(true_m_s));
            let (plan, _) = planned.map_err(|mistakes| at(speed_m_s, reported(&mistakes)))?;
            let amplifier = experiment.campaign().amplifier;
            let usual_v_n = amplifier.sensitivity_c_n * amplifier.gain_v_c;
            let shooting = Shooting {
                amplifier,
                delays_s: settings.delays_s,
                plan: plan.for_flights().with_accuracy(self.accuracy),
                wall_gain: settings.wall_gain,
                sensor_gain_v_n: settings.sensor_gain_v_n.unwrap_or(usual_v_n),
            };
            latest = Some((settings, experiment));
            Ok(shooting)
        };
        speeds.at.iter().map(&mut plan).collect()
    }

    fn set(&self, settings: &Settings) -> Result<Experiment, PathError> {
        let numbers = settings.numbers.iter();
        let numbers: Vec<(&str, f64)> = numbers.map(|(path, v)| (path.as_str(), *v)).collect();
        self.experiment.set(&numbers)
    }
}

fn at(speed_m_s: f64, error: impl Display) -> ModelError {
    ModelError(format!("at {speed_m_s} m/s: {error}"))
}

fn brief(error: &PathError) -> String {
    match error {
        PathError::Mistakes(mistakes) => reported(mistakes),
        other => other.to_string(),
    }
}

/// The first mistake, without its place: the file has none for a fit's numbers.
fn reported(mistakes: &Mistakes) -> String {
    let first = mistakes.findings().first();
    first.map_or_else(|| mistakes.to_string(), ToString::to_string)
}

/// What multiplies the wall's signal, and what is added to both times.
type Reading = (f64, [f64; 2]);

fn predicted(shot: &Shot, (gain, delays_s): Reading) -> Result<Predicted, String> {
    let passage = shot.passage.as_ref().map_err(ToString::to_string)?;
    let flight = shot.flight.ok_or("no pulse was seen to pass")?;
    let over_passing = |peak: f64| peak / passage.incident.value;
    Ok([
        Some(flight.incident_s + delays_s[0]),
        flight.reflected_s.map(|time| time + delays_s[1]),
        Some(gain * over_passing(passage.wall.value)),
        passage.reflected.map(|peak| over_passing(peak.value)),
    ])
}
