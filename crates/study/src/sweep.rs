//! Many speeds, one chain.

use crate::error::StudyError;
use crate::plan::Plan;
use crate::shot::{Shot, shoot, shoot_checked};
use hertzchain_experiment::{Experiment, Mistakes};
use hertzchain_signal::{FitError, PowerLaw, power_law};
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
}

/// How a sweep is run.
pub struct Settings<'a> {
    /// Changes the plan that the experiment gives, such as its accuracy.
    pub adjust: &'a (dyn Fn(&mut Plan) + Sync),
    /// Compute every shot twice to learn the accuracy reached.
    pub checked: bool,
    /// Called after every shot, from any thread.
    pub progress: &'a (dyn Fn() + Sync),
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            adjust: &|_| {},
            checked: false,
            progress: &|| {},
        }
    }
}

/// Runs a shot at every speed, on all threads of the current rayon pool.
///
/// Every shot is computed by itself, so the result has the same bits whatever
/// the number of threads. A speed that fails does not stop the others.
#[must_use]
pub fn sweep(experiment: &Experiment, speeds_m_s: &[f64], settings: &Settings<'_>) -> Sweep {
    let point = |speed: &f64| {
        let point = point(experiment, *speed, settings);
        (settings.progress)();
        point
    };
    let points = speeds_m_s.par_iter().map(point).collect();
    let mut sweep = Sweep {
        points,
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

fn point(experiment: &Experiment, speed_m_s: f64, settings: &Settings<'_>) -> Point {
    let (shot, warnings) = match Plan::from_experiment(experiment, Some(speed_m_s)) {
        Err(mistakes) => (Err(mistakes.into()), Vec::new()),
        Ok((mut plan, warnings)) => {
            (settings.adjust)(&mut plan);
            let shot = if settings.checked {
                shoot_checked(&plan)
            } else {
                shoot(&plan)
            };
            let lines = warnings.iter().map(|warning| warning.one_line()).collect();
            (shot.map_err(PointError::from), lines)
        }
    };
    Point {
        speed_m_s,
        shot,
        warnings,
    }
}

fn fit(points: impl Iterator<Item = (f64, f64)>) -> Result<PowerLaw, FitError> {
    let (speeds, times): (Vec<f64>, Vec<f64>) = points.unzip();
    power_law(&speeds, &times, None)
}
