//! Many speeds, one chain.

use crate::ensemble::{shoot_all, shoot_tuned};
use crate::error::StudyError;
use crate::flight::Flight;
use crate::plan::Plan;
use crate::shot::Shot;
use crate::stop::stopped;
use crate::tuned::Tuned;
use hertzchain_chain::InstructionSet;
use hertzchain_experiment::{Experiment, Mistakes, Warning};
use hertzchain_signal::{FitError, PowerLaw, Uncertainty, power_law, uncertainty};
use rayon::prelude::*;

/// Why one speed has no shot.
#[derive(Clone, Debug, thiserror::Error)]
pub enum PointError {
    /// The experiment can't have this speed.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
    /// The shot failed.
    #[error(transparent)]
    Study(#[from] StudyError),
}

/// One speed of a sweep.
#[derive(Clone, Debug)]
pub struct Point {
    /// Speed of the striker in m/s.
    pub speed_m_s: f64,
    /// Its shot.
    pub shot: Result<Shot, PointError>,
    /// What is odd about the chain at this speed.
    pub warnings: Vec<String>,
}

/// Shots at several speeds and the power laws of their times of flight.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// One a speed, in the order asked for.
    pub points: Vec<Point>,
    /// Incident time of flight in s against speed in m/s.
    pub incident: Result<PowerLaw, FitError>,
    /// Reflected time of flight in s against speed in m/s.
    pub reflected: Result<PowerLaw, FitError>,
    /// The setting that pilots chose, if shots were not judged each.
    pub tuned: Option<Tuned>,
}

impl Sweep {
    /// Speeds and times of flight, incident and reflected where seen, in s.
    #[must_use]
    pub fn flights(&self) -> Vec<(f64, f64, Option<f64>)> {
        let of = |point: &Point| {
            let flight = point.shot.as_ref().ok()?.flight?;
            Some((point.speed_m_s, flight.incident_s, flight.reflected_s))
        };
        self.points.iter().filter_map(of).collect()
    }

    /// What the accuracies of the incident times of flight alone leave open in
    /// their power law: those reached where known, else those asked.
    ///
    /// # Errors
    /// As the fit's.
    pub fn incident_uncertainty(&self) -> Result<Uncertainty, FitError> {
        self.uncertainty(|flight| Some(flight.incident_s))
    }

    /// The same for the reflected times of flight.
    ///
    /// # Errors
    /// As the fit's.
    pub fn reflected_uncertainty(&self) -> Result<Uncertainty, FitError> {
        self.uncertainty(|flight| flight.reflected_s)
    }

    fn uncertainty(&self, seen: fn(&Flight) -> Option<f64>) -> Result<Uncertainty, FitError> {
        let of = |point: &Point| {
            let shot = point.shot.as_ref().ok()?;
            let accuracy = shot.accuracy_reached.unwrap_or(shot.accuracy_asked);
            seen(&shot.flight?).map(|_| (point.speed_m_s, accuracy))
        };
        let (speeds, accuracies): (Vec<f64>, Vec<f64>) = self.points.iter().filter_map(of).unzip();
        uncertainty(&speeds, &accuracies)
    }
}

/// Who tells how right the shots of an ensemble are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Judges {
    /// Two more shots each, with longer steps.
    #[default]
    Each,
    /// Pilots among the speeds, computed much more tightly, for all; each where
    /// that can't be.
    Pilots,
}

/// How a sweep is run.
pub struct Settings<'a> {
    /// Changes the plan that the experiment gives, such as its accuracy.
    pub adjust: &'a (dyn Fn(&mut Plan) + Sync),
    /// Compute every shot twice to learn the accuracy reached.
    pub checked: bool,
    /// Who judges the shots of the ensemble loop.
    pub judges: Judges,
    /// Vector instructions of the ensemble loop.
    pub set: InstructionSet,
    /// Called after every shot, from any thread.
    pub progress: &'a (dyn Fn() + Sync),
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            adjust: &|_| {},
            checked: false,
            judges: Judges::Each,
            set: InstructionSet::default(),
            progress: &|| {},
        }
    }
}

/// Runs a shot at every speed, on all threads of the current rayon pool.
///
/// Plans that ask for times of flight alone (adjusted by
/// [`Plan::for_flights`]) run in the ensemble loop. The result has the same
/// bits whatever the number of threads. A speed that fails does not stop the
/// others.
#[must_use]
pub fn sweep(experiment: &Experiment, speeds_m_s: &[f64], settings: &Settings<'_>) -> Sweep {
    let plan = |speed: &f64| {
        let mut planned = Plan::from_experiment(experiment, Some(*speed));
        if let Ok((plan, _)) = &mut planned {
            (settings.adjust)(plan);
        }
        planned
    };
    let wanted = speeds_m_s.par_iter().take_any_while(|_| !stopped());
    let planned: Vec<Planned> = wanted.map(plan).collect();
    let plans = planned.iter().filter_map(|plan| plan.as_ref().ok());
    let plans: Vec<Plan> = plans.map(|(plan, _)| plan.clone()).collect();
    let tuned = match settings.judges {
        Judges::Pilots => Tuned::new(&Tuned::pilots(&plans), settings.set),
        Judges::Each => None,
    };
    let shots = match &tuned {
        Some(tuned) => shoot_tuned(&plans, tuned, settings.set, settings.progress),
        None => shoot_all(&plans, settings.set, settings.checked, settings.progress),
    };
    let mut sweep = Sweep {
        tuned,
        points: points(speeds_m_s, planned, shots),
        incident: Err(FitError::TooFew),
        reflected: Err(FitError::TooFew),
    };
    let flights = sweep.flights();
    sweep.incident = fit(flights.iter().map(|flight| (flight.0, flight.1)));
    sweep.reflected = fit(flights
        .iter()
        .filter_map(|flight| Some((flight.0, flight.2?))));
    sweep
}

/// A speed's plan with what is odd about it, or why there is none.
type Planned = Result<(Plan, Vec<Warning>), Mistakes>;

/// Speeds with the shots of those that have a plan.
fn points(
    speeds_m_s: &[f64],
    planned: Vec<Planned>,
    shots: Vec<Result<Shot, StudyError>>,
) -> Vec<Point> {
    let mut shots = shots.into_iter();
    let point = |(&speed_m_s, planned): (&f64, Planned)| {
        let (shot, warnings) = match planned {
            Err(mistakes) => (Some(Err(mistakes.into())), Vec::new()),
            Ok((_, warnings)) => (
                shots.next().map(|shot| shot.map_err(PointError::from)),
                warnings,
            ),
        };
        let warnings = warnings.iter().map(Warning::one_line).collect();
        Some(Point {
            speed_m_s,
            shot: shot?,
            warnings,
        })
    };
    speeds_m_s.iter().zip(planned).filter_map(point).collect()
}

fn fit(points: impl Iterator<Item = (f64, f64)>) -> Result<PowerLaw, FitError> {
    let (speeds, times): (Vec<f64>, Vec<f64>) = points.unzip();
    power_law(&speeds, &times, None)
}
