//! Many speeds, one chain.

use crate::error::StudyError;
use crate::plan::Plan;
use crate::rows::{Column, Law, Rows};
use crate::several::{Planned, Several};
use crate::shot::Shot;
use crate::stop::stopped;
use crate::tuned::Tuned;
use hertzchain_chain::InstructionSet;
use hertzchain_experiment::{Experiment, Mistakes, PathError};
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty};

/// Why one shot of several is none.
#[derive(Clone, Debug, thiserror::Error)]
pub enum PointError {
    /// The experiment can't have this speed.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
    /// A number that the experiment does not take.
    #[error(transparent)]
    Number(PathError),
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
        Rows::of(&self.points).flights()
    }

    /// What the accuracies of the incident times of flight alone leave open in
    /// their power law: those reached where known, else those asked.
    ///
    /// # Errors
    /// As the fit's.
    pub fn incident_uncertainty(&self) -> Result<Uncertainty, FitError> {
        self.law(Column::Incident).1
    }

    /// The same for the reflected times of flight.
    ///
    /// # Errors
    /// As the fit's.
    pub fn reflected_uncertainty(&self) -> Result<Uncertainty, FitError> {
        self.law(Column::Reflected).1
    }

    fn law(&self, of: Column) -> Law {
        let shots = self
            .points
            .iter()
            .filter_map(|point| point.shot.as_ref().ok());
        let asked = shots.map(|shot| shot.accuracy_asked).fold(0.0, f64::max);
        Rows::of(&self.points).law(of, asked)
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

/// Runs a shot at every speed, on all threads of the current rayon pool. Velocities at the end
/// are not kept: [`sweep_each`] hands them over.
///
/// Plans that ask for times of flight alone (adjusted by
/// [`Plan::for_flights`]) run in the ensemble loop. The result has the same
/// bits whatever the number of threads. A speed that fails does not stop the
/// others.
#[must_use]
pub fn sweep(experiment: &Experiment, speeds_m_s: &[f64], settings: &Settings<'_>) -> Sweep {
    let mut points = Vec::new();
    // Of a hundred thousand shots of a thousand beads these alone would take 0.8 GB.
    let take = |mut point: Point| {
        if let Ok(shot) = &mut point.shot {
            shot.velocity_m_s = Vec::new();
        }
        points.push(point);
    };
    let tuned = sweep_each(experiment, speeds_m_s, settings, take);
    let mut sweep = Sweep {
        tuned,
        points,
        incident: Err(FitError::TooFew),
        reflected: Err(FitError::TooFew),
    };
    if stopped() {
        return sweep;
    }
    sweep.incident = sweep.law(Column::Incident).0;
    sweep.reflected = sweep.law(Column::Reflected).0;
    sweep
}

/// The same for whoever keeps no whole shots: points are handed over in the order
/// of their speeds, some hundreds at a time; none more once it is asked to stop.
/// Gives the setting that pilots chose.
pub fn sweep_each(
    experiment: &Experiment,
    speeds_m_s: &[f64],
    settings: &Settings<'_>,
    mut take: impl FnMut(Point),
) -> Option<Tuned> {
    let plan = |place: usize| -> Planned {
        let speed_m_s = speeds_m_s.get(place).copied();
        let (mut plan, warnings) = Plan::from_experiment(experiment, speed_m_s)?;
        (settings.adjust)(&mut plan);
        Ok((plan, warnings))
    };
    let several = Several {
        count: speeds_m_s.len(),
        plan: &plan,
        settings,
    };
    let tuned = several.tuned();
    let places: Vec<usize> = (0..speeds_m_s.len()).collect();
    several.shoot(&places, tuned.as_ref(), |place, (shot, warnings)| {
        take(Point {
            speed_m_s: speeds_m_s[place],
            shot,
            warnings,
        });
    });
    tuned
}
