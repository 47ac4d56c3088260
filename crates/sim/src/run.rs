//! A sweep with everything that its numbers follow from, to be run in parts.

use crate::fingerprint::{Fingerprint, Inputs};
use crate::plan::{Pick, Plan, Solver};
use crate::rows::Rows;
use crate::several::{Planned, Several};
use crate::shard::Shard;
use crate::sweep::{Judges, Point, PointError, Settings};
use hertzchain_chain::InstructionSet;
use hertzchain_experiment::{Experiment, Mistakes, PathError, Units};
use std::sync::OnceLock;

/// How the shots of a run are computed, as data: what a plan says of it, and
/// who judges.
#[derive(Clone, Copy, Debug)]
pub struct How {
    /// Relative accuracy asked of times of flight.
    pub accuracy: f64,
    /// How the motion is computed.
    pub solver: Solver,
    /// Duration of a shot in s; until it is over when `None`.
    pub duration_s: Option<f64>,
    /// Where pulses are timed.
    pub pick: Pick,
    /// Follow the striker until it is away for good.
    pub rebound: bool,
    /// Compute every shot of the wave loop twice.
    pub checked: bool,
    /// Who judges the shots of the ensemble loop.
    pub judges: Judges,
    /// Vector instructions. Other ones have other last bits: workers of one
    /// run must have the same.
    pub set: InstructionSet,
}

impl How {
    /// As an experiment asks for, times of flight alone.
    #[must_use]
    pub fn of(experiment: &Experiment) -> Self {
        let asked = experiment.solver();
        Self {
            accuracy: asked.accuracy,
            solver: asked.into(),
            duration_s: asked.duration_s,
            pick: experiment.pick().into(),
            rebound: false,
            checked: false,
            judges: Judges::Each,
            set: InstructionSet::default(),
        }
    }

    fn adjust(&self, plan: &mut Plan) {
        plan.accuracy = self.accuracy;
        plan.solver = self.solver;
        plan.duration_s = self.duration_s;
        plan.pick = self.pick;
        plan.rebound = self.rebound;
    }
}

/// Why there is no such run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// An experiment without a striker.
    #[error(transparent)]
    Mistakes(#[from] Box<Mistakes>),
    /// A number that the experiment does not have.
    #[error(transparent)]
    Number(#[from] PathError),
    /// A column of another length.
    #[error("`{path}` has {values} values for {shots} shots: expected one a shot")]
    Length {
        /// Path of the number.
        path: String,
        /// How many values it has.
        values: usize,
        /// How many shots there are.
        shots: usize,
    },
}

/// A sweep that can be run in parts: shots of one experiment at speeds and, if
/// asked for, with numbers that differ from shot to shot.
///
/// A part's bits depend on the run's inputs alone, not on where, in which order
/// or beside what it is run.
#[derive(Clone, Debug)]
pub struct Run {
    experiment: Experiment,
    speeds_m_s: Vec<f64>,
    /// Full paths with one value a shot.
    numbers: Vec<(String, Vec<f64>)>,
    how: How,
    /// A hash of all of the above: once, however many parts ask for it.
    fingerprint: OnceLock<Fingerprint>,
}

/// A part of a run with its results.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Of everything that the whole run follows from.
    pub run: Fingerprint,
    /// Which part.
    pub shard: Shard,
    /// Shots of the whole run.
    pub shots: usize,
    /// What the experiment is.
    pub title: String,
    /// Its units.
    pub units: Units,
    /// Relative accuracy asked of times of flight.
    pub accuracy: f64,
    /// The run in words.
    pub about: String,
    /// The setting that pilots of the whole run chose, in words.
    pub tuned: Option<String>,
    /// The shots.
    pub rows: Rows,
}

impl Run {
    /// Of an experiment at speeds in m/s.
    ///
    /// # Errors
    /// An experiment without a striker. A speed that it can't have is its own
    /// shot's error, and no other's.
    pub fn new(experiment: &Experiment, speeds_m_s: Vec<f64>, how: How) -> Result<Self, RunError> {
        let striker = experiment.needs_striker("a sweep over speeds needs a chain with a striker");
        striker.map_err(Box::new)?;
        Ok(Self {
            experiment: experiment.clone(),
            speeds_m_s,
            numbers: Vec::new(),
            how,
            fingerprint: OnceLock::new(),
        })
    }

    /// This run with a number of the experiment that differs from shot to shot,
    /// in SI, by its path or an end of it.
    ///
    /// # Errors
    /// A number that the experiment does not have, or not one value a shot. A
    /// value that it can't have is its own shot's error.
    pub fn with_number(mut self, path: &str, values: Vec<f64>) -> Result<Self, RunError> {
        let path = self.experiment.place(path)?.path;
        let (values_given, shots) = (values.len(), self.speeds_m_s.len());
        if values_given != shots {
            return Err(RunError::Length {
                path,
                values: values_given,
                shots,
            });
        }
        self.numbers.push((path, values));
        self.fingerprint = OnceLock::new();
        Ok(self)
    }

    /// Number of shots.
    #[must_use]
    pub fn shots(&self) -> usize {
        self.speeds_m_s.len()
    }

    /// How it is computed.
    #[must_use]
    pub fn how(&self) -> &How {
        &self.how
    }

    /// Of everything that its numbers follow from: the experiment as it is
    /// understood, the bits of speeds and numbers, how it is computed, the instruction
    /// set, this build of the program. Not of paths, times or machines.
    #[must_use]
    pub fn fingerprint(&self) -> Fingerprint {
        *self.fingerprint.get_or_init(|| self.hashed())
    }

    fn hashed(&self) -> Fingerprint {
        let How {
            accuracy,
            solver,
            duration_s,
            pick,
            rebound,
            checked,
            judges,
            set,
        } = self.how;
        let steps = match solver {
            Solver::Adaptive => None,
            Solver::Rk4 { step_s } | Solver::Verlet { step_s } => step_s,
        };
        let fraction = match pick {
            Pick::Flank(fraction) => fraction,
            Pick::Peak | Pick::CrossCorrelation => f64::NAN,
        };
        let times = [steps, duration_s].map(|time_s| time_s.unwrap_or(f64::NAN));
        let words = format!(
            "{solver:?} {pick:?} {rebound} {checked} {judges:?} {}",
            set.name()
        );
        let inputs = Inputs::of("sweep")
            .text("experiment", &self.experiment.understood())
            .text("how", &words)
            .numbers("how", &[accuracy, times[0], times[1], fraction])
            .numbers("speeds_m_s", &self.speeds_m_s);
        let numbers = self.numbers.iter();
        let inputs = numbers.fold(inputs, |inputs, (path, values)| {
            inputs.numbers(path, values)
        });
        inputs.fingerprint()
    }

    /// A part's name, of its file too: a hash of all its inputs.
    #[must_use]
    pub fn name(&self, shard: Shard) -> String {
        shard_name(&self.fingerprint(), shard)
    }

    /// Runs a part on all threads of the current rayon pool, and calls
    /// `progress` after every shot, from any thread.
    #[must_use]
    pub fn part(&self, shard: Shard, progress: &(dyn Fn() + Sync)) -> Part {
        let settings = Settings {
            checked: self.how.checked,
            judges: self.how.judges,
            set: self.how.set,
            progress,
            ..Settings::default()
        };
        let plan = |place| self.planned(place);
        let several = Several {
            count: self.shots(),
            plan: &plan,
            settings: &settings,
        };
        let tuned = several.tuned();
        let places: Vec<usize> = shard.places(self.shots()).collect();
        let mut rows = Rows::default();
        several.shoot(&places, tuned.as_ref(), |place, (shot, warnings)| {
            let point = Point {
                speed_m_s: self.speeds_m_s[place],
                shot,
                warnings,
            };
            rows.add(place, &point);
        });
        Part {
            tuned: tuned.map(|tuned| tuned.to_string()),
            rows,
            ..self.empty(shard)
        }
    }

    /// A part without its shots.
    #[must_use]
    pub fn empty(&self, shard: Shard) -> Part {
        Part {
            run: self.fingerprint(),
            shard,
            shots: self.shots(),
            title: self.experiment.title().to_owned(),
            units: self.experiment.units(),
            accuracy: self.how.accuracy,
            about: self.about(),
            tuned: None,
            rows: Rows::default(),
        }
    }

    fn about(&self) -> String {
        let ends = |pick: fn(f64, f64) -> f64| self.speeds_m_s.iter().copied().reduce(pick);
        let (least, most) = (ends(f64::min), ends(f64::max));
        let numbers: String = self
            .numbers
            .iter()
            .map(|(path, _)| format!(", {path}"))
            .collect();
        let judges = match self.how.judges {
            Judges::Each => "each",
            Judges::Pilots => "pilots",
        };
        format!(
            "{}, {} shots, speeds from {} to {}{numbers}; accuracy {:e}, judges: {judges}, {}",
            self.experiment.title(),
            self.shots(),
            least.unwrap_or(f64::NAN),
            most.unwrap_or(f64::NAN),
            self.how.accuracy,
            self.how.set.name()
        )
    }

    fn planned(&self, place: usize) -> Planned {
        let speed_m_s = self.speeds_m_s.get(place).copied();
        let numbers = self.numbers.iter();
        let numbers: Vec<(&str, f64)> = numbers
            .filter_map(|(path, values)| Some((path.as_str(), *values.get(place)?)))
            .collect();
        let (mut plan, warnings) = match numbers.is_empty() {
            true => Plan::from_experiment(&self.experiment, speed_m_s)?,
            false => {
                let changed = self.experiment.set(&numbers).map_err(PointError::Number)?;
                Plan::from_experiment(&changed, speed_m_s)?
            }
        };
        self.how.adjust(&mut plan);
        Ok((plan, warnings))
    }
}

/// A part of a run by the run's fingerprint.
#[must_use]
pub(crate) fn shard_name(run: &Fingerprint, shard: Shard) -> String {
    format!("sweep-{}-{}-of-{}", run.short(), shard.number(), shard.of())
}

impl Part {
    /// Its name: a hash of all its inputs.
    #[must_use]
    pub fn name(&self) -> String {
        shard_name(&self.run, self.shard)
    }
}
