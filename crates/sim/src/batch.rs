//! One engine for many shots: sweeps, ensembles over named numbers, and shards of both.

use crate::calibration::Calibration;
use crate::engine::{Control, run_plans};
use crate::error::StudyError;
use crate::fingerprint::Fingerprint;
use crate::plan::Plan;
use crate::result::Rows;
use crate::shard::Shard;
use crate::shot::Shot;
use crate::stop::stopped;
use hertzchain_chain::InstructionSet;
use hertzchain_experiment::{Experiment, Method, Pick, Units, Warning};
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::OnceLock;

/// How the errors of the shots of a batch are controlled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ErrorControl {
    /// Every shot is compared with two more, with longer steps.
    PerShot,
    /// Calibration shots among the batch, computed much more tightly, choose the steps of all,
    /// and each shot estimates its own error; as per shot where that is not possible or not worth it.
    #[default]
    Calibrated,
    /// By the step for the accuracy asked alone; no shot reports an error.
    None,
}

impl ErrorControl {
    /// Its name, as options have it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::PerShot => "per-shot",
            Self::Calibrated => "calibrated",
            Self::None => "none",
        }
    }
}

/// Options of a batch of shots.
#[derive(Clone, Copy, Debug)]
pub struct BatchOptions {
    /// Relative accuracy asked of times of flight.
    pub accuracy: f64,
    /// How the motion is computed.
    pub method: Method,
    /// Step in s of a fixed-step method; without one it is halved until the accuracy is reached.
    pub step_s: Option<f64>,
    /// Duration of a shot in s; until it is over when `None`.
    pub duration_s: Option<f64>,
    /// Where pulses are timed.
    pub pick: Pick,
    /// Follow the striker until it is away for good.
    pub rebound: bool,
    /// Compute every shot of the adaptive loop again at tighter tolerances.
    pub checked: bool,
    /// How errors are controlled in the loop with equal steps.
    pub error_control: ErrorControl,
    /// Vector instructions. Other ones have other last bits: workers of one
    /// batch must have the same.
    pub set: InstructionSet,
}

impl BatchOptions {
    /// What an experiment asks for, times of flight alone.
    pub fn of(experiment: &Experiment) -> Self {
        let asked = experiment.solver();
        Self {
            accuracy: asked.accuracy,
            method: asked.method,
            step_s: asked.step_s,
            duration_s: asked.duration_s,
            pick: experiment.pick(),
            rebound: false,
            checked: false,
            error_control: ErrorControl::default(),
            set: InstructionSet::default(),
        }
    }
}

/// Shots of one experiment at many speeds and, if asked for, with numbers that differ
/// from shot to shot.
///
/// The bits of a shot depend on the batch's inputs alone: not on threads, shards or
/// neighbours.
///
/// ```
/// use hertzchain_sim::{Batch, BatchOptions, Column, Shard};
///
/// let hertz = hertzchain_experiment::preset("hertz")?;
/// let batch = Batch::new(&hertz, vec![0.2, 0.4], BatchOptions::of(&hertz))?;
/// let result = batch.run(Shard::WHOLE, &|| {});
/// assert!(result.rows.column(Column::Incident)[0] > result.rows.column(Column::Incident)[1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Batch {
    experiment: Experiment,
    speeds_m_s: Vec<f64>,
    numbers: Vec<(String, Vec<f64>)>,
    options: BatchOptions,
    /// A hash of all of the above: computed once, however many shards ask for it.
    fingerprint: OnceLock<Fingerprint>,
}

/// One shot of a batch.
#[derive(Clone, Debug)]
pub struct BatchShot {
    /// Its place in the batch, from 0.
    pub place: usize,
    /// Speed of the striker in m/s.
    pub speed_m_s: f64,
    /// What it gave, or why it could not be computed.
    pub shot: Result<Shot, StudyError>,
    /// Warnings about the chain of this shot.
    pub warnings: Vec<String>,
}

/// The results of a batch or of a shard of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchResult {
    /// Fingerprint of all inputs of the batch.
    pub batch: Fingerprint,
    /// Which shard.
    pub shard: Shard,
    /// Shots of the whole batch.
    pub shots: usize,
    /// Title of the experiment.
    pub title: String,
    /// Its units.
    pub units: Units,
    /// Relative accuracy asked of times of flight.
    pub accuracy: f64,
    /// The batch in words, for messages.
    pub about: String,
    /// How errors were controlled, and why, in words.
    pub error_control: String,
    /// The shots.
    pub rows: Rows,
}

/// A shot's plan with its warnings, or why there is none.
type Planned = Result<(Plan, Vec<Warning>), StudyError>;

/// Rows that one thread plans in sequence: neighbours often share their numbers.
const NEIGHBOURS: usize = 256;

/// Plans in memory at a time, in the current rayon pool: enough for each thread that none
/// waits long for the others at the end.
pub(crate) fn piece() -> usize {
    256 * rayon::current_num_threads()
}

impl Batch {
    /// A batch of an experiment at speeds in m/s.
    ///
    /// # Errors
    /// An experiment without a striker. A speed that it can't have is its own
    /// shot's error, and no other's.
    pub fn new(
        experiment: &Experiment,
        speeds_m_s: Vec<f64>,
        options: BatchOptions,
    ) -> Result<Self, StudyError> {
        experiment.needs_striker("a sweep over speeds needs a chain with a striker")?;
        Ok(Self {
            experiment: experiment.clone(),
            speeds_m_s,
            numbers: Vec::new(),
            options,
            fingerprint: OnceLock::new(),
        })
    }

    /// This batch with a number of the experiment that differs from shot to shot,
    /// in SI, by its path or an end of it.
    ///
    /// # Errors
    /// A number that the experiment does not have, or not one value a shot. A
    /// value that it can't have is its own shot's error.
    pub fn with_number(mut self, path: &str, values: Vec<f64>) -> Result<Self, StudyError> {
        let path = self.experiment.place(path)?.path;
        let refused = |why: &str| Err(StudyError::Refused(format!("`{path}`: {why}")));
        if path == "striker.speed" {
            return refused("a batch has one speed a shot already; give these as its speeds");
        }
        if path.starts_with("solver.") {
            return refused(
                "all shots of a batch share the solver; set it in the experiment or by an option",
            );
        }
        if self.numbers.iter().any(|(known, _)| *known == path) {
            return refused("it is named twice");
        }
        let (count, shots) = (values.len(), self.shots());
        if count != shots {
            return Err(StudyError::Refused(format!(
                "`{path}` has {count} values for {shots} shots: expected one a shot"
            )));
        }
        self.numbers.push((path, values));
        self.fingerprint = OnceLock::new();
        Ok(self)
    }

    /// Number of shots.
    pub fn shots(&self) -> usize {
        self.speeds_m_s.len()
    }

    /// Fingerprint of everything that its numbers follow from: the experiment, the bits of
    /// speeds and numbers, options, instruction set, this build of the program. Not of
    /// paths, times or machines.
    pub fn fingerprint(&self) -> Fingerprint {
        *self.fingerprint.get_or_init(|| {
            let experiment = self.experiment.canonical_text();
            Fingerprint::of("sweep", &(experiment, &self.options, &self.speeds_m_s, &self.numbers))
        })
    }

    /// A shard's name, of its file too: a hash of all its inputs.
    pub fn name(&self, shard: Shard) -> String {
        shard_name(&self.fingerprint(), shard)
    }

    /// Runs a shard on all threads of the current rayon pool, and calls
    /// `progress` after every shot, from any thread.
    pub fn run(&self, shard: Shard, progress: &(dyn Fn() + Sync)) -> BatchResult {
        self.run_each(shard, progress, |_| ()).0
    }

    /// Runs a shard and passes every shot whole to `take`, in order, some hundreds at a
    /// time; none more once a stop is asked for. Returns the calibrated setting beside the results.
    pub fn run_each(
        &self,
        shard: Shard,
        progress: &(dyn Fn() + Sync),
        mut take: impl FnMut(BatchShot),
    ) -> (BatchResult, Option<Calibration>) {
        let calibration = self.calibration();
        let control = self.control(&calibration);
        let mut rows = Rows::default();
        let places: Vec<usize> = shard.places(self.shots()).collect();
        for part in places.chunks(piece()) {
            if stopped() {
                break;
            }
            for shot in self.together(part, control, progress) {
                rows.add(&shot);
                take(shot);
            }
        }
        let result = BatchResult {
            error_control: self.control_in_words(&calibration),
            rows,
            ..self.empty(shard)
        };
        (result, calibration.ok())
    }

    /// The results of a shard without its shots.
    pub(crate) fn empty(&self, shard: Shard) -> BatchResult {
        BatchResult {
            batch: self.fingerprint(),
            shard,
            shots: self.shots(),
            title: self.experiment.title().to_owned(),
            units: self.experiment.units(),
            accuracy: self.options.accuracy,
            about: self.about(),
            error_control: String::new(),
            rows: Rows::default(),
        }
    }

    fn about(&self) -> String {
        let ends = |pick: fn(f64, f64) -> f64| {
            let end = self.speeds_m_s.iter().copied().reduce(pick);
            end.unwrap_or(f64::NAN)
        };
        let names = self.numbers.iter().map(|(path, _)| format!(", {path}"));
        format!(
            "{}, {} shots, speeds from {} to {}{}; accuracy {:e}, error control: {}, {}",
            self.experiment.title(),
            self.shots(),
            ends(f64::min),
            ends(f64::max),
            names.collect::<String>(),
            self.options.accuracy,
            self.options.error_control.name(),
            self.options.set.name()
        )
    }

    /// The setting that calibration shots choose: from the whole batch, however few of its shots
    /// are run here, so that every shard has the same; or why there is none.
    fn calibration(&self) -> Result<Calibration, &'static str> {
        match self.options.error_control {
            ErrorControl::PerShot => return Err("as asked"),
            ErrorControl::None => return Err("by the step for the accuracy asked alone"),
            ErrorControl::Calibrated if self.options.rebound => {
                return Err("the striker's rebound takes the adaptive loop");
            }
            ErrorControl::Calibrated => {}
        }
        let numbers = self.numbers.iter().map(|(_, column)| &column[..]);
        let columns: Vec<&[f64]> = std::iter::once(&self.speeds_m_s[..]).chain(numbers).collect();
        let places = Calibration::places(&columns, self.options.accuracy);
        let places = places.ok_or("so few shots are computed sooner so")?;
        let planned = self.planned(&places).into_iter().flatten();
        let plans: Vec<Plan> = planned.map(|(plan, _)| plan).collect();
        Calibration::new(&plans, columns.len() == 1, self.options.set)
    }

    fn control<'a>(&self, calibration: &'a Result<Calibration, &'static str>) -> Control<'a> {
        match (self.options.error_control, calibration) {
            (ErrorControl::None, _) => Control::None,
            (_, Ok(calibration)) => Control::Calibrated(calibration),
            (_, Err(_)) => Control::PerShot { checked: self.options.checked },
        }
    }

    fn control_in_words(&self, calibration: &Result<Calibration, &'static str>) -> String {
        match (self.options.error_control, calibration) {
            (_, Ok(calibration)) => format!("calibrated: {calibration}"),
            (ErrorControl::None, Err(why)) => format!("none: {why}"),
            (_, Err(why)) => format!("per shot: {why}"),
        }
    }

    /// Shots that are in memory side by side.
    fn together(
        &self,
        places: &[usize],
        control: Control<'_>,
        progress: &(dyn Fn() + Sync),
    ) -> Vec<BatchShot> {
        let mut plans = Vec::with_capacity(places.len());
        let mut split = |planned: Planned| match planned {
            Ok((plan, warnings)) => {
                plans.push(plan);
                Ok(warnings)
            }
            Err(error) => {
                progress();
                Err(error)
            }
        };
        let planned = self.planned(places).into_iter();
        let warnings: Vec<Result<Vec<Warning>, StudyError>> = planned.map(&mut split).collect();
        let mut shots = run_plans(&plans, control, self.options.set, progress).into_iter();
        let one = |(place, warnings): (&usize, Result<Vec<Warning>, StudyError>)| {
            let (shot, warnings) = match warnings {
                Ok(warnings) => (shots.next()?, warnings),
                Err(error) => (Err(error), Vec::new()),
            };
            Some(BatchShot {
                place: *place,
                speed_m_s: self.speeds_m_s[*place],
                shot,
                warnings: warnings.iter().map(Warning::one_line).collect(),
            })
        };
        places.iter().zip(warnings).filter_map(one).collect()
    }

    fn planned(&self, places: &[usize]) -> Vec<Planned> {
        let chunks = places.par_chunks(NEIGHBOURS);
        chunks.flat_map_iter(|chunk| self.in_sequence(chunk)).collect()
    }

    /// Plans of consecutive shots: the experiment is changed where numbers do.
    fn in_sequence(&self, places: &[usize]) -> Vec<Planned> {
        let mut latest: Option<Sequence<'_>> = None;
        let plan = |place: &usize| {
            if stopped() {
                return Err(StudyError::Stopped);
            }
            let columns = self.numbers.iter();
            let values: Vec<f64> = columns.map(|(_, column)| column[*place]).collect();
            let sequence = match latest.take() {
                Some(same) if same.values == values => latest.insert(same),
                _ => latest.insert(Sequence::new(self.changed(&values)?, values)),
            };
            sequence.plan(self, self.speeds_m_s[*place])
        };
        places.iter().map(plan).collect()
    }

    fn changed(&self, values: &[f64]) -> Result<Cow<'_, Experiment>, StudyError> {
        if values.is_empty() {
            return Ok(Cow::Borrowed(&self.experiment));
        }
        let paths = self.numbers.iter().map(|(path, _)| path.as_str());
        let numbers: Vec<(&str, f64)> = paths.zip(values.iter().copied()).collect();
        Ok(Cow::Owned(self.experiment.set(&numbers)?))
    }

    fn plan(&self, experiment: &Experiment, speed_m_s: f64) -> Planned {
        let (plan, warnings) = Plan::from_experiment(experiment, Some(speed_m_s))?;
        let plan = Plan {
            accuracy: self.options.accuracy,
            method: self.options.method,
            step_s: self.options.step_s,
            duration_s: self.options.duration_s,
            pick: self.options.pick,
            rebound: self.options.rebound,
            ..plan
        };
        Ok((plan, warnings))
    }
}

/// Consecutive shots of one experiment.
struct Sequence<'a> {
    experiment: Cow<'a, Experiment>,
    values: Vec<f64>,
    shots: usize,
    /// A plan at the batch's highest speed, if others differ from it in speed alone.
    like: Option<Plan>,
}

/// Shots of one experiment that are planned one by one before it is worth to find out whether
/// they differ in speed alone.
const PLANNED_ALONE: usize = 2;

impl<'a> Sequence<'a> {
    fn new(experiment: Cow<'a, Experiment>, values: Vec<f64>) -> Self {
        Self { experiment, values, shots: 0, like: None }
    }

    fn plan(&mut self, batch: &Batch, speed_m_s: f64) -> Planned {
        if self.shots == PLANNED_ALONE && self.experiment.is_same_at_all_speeds() {
            self.like = self.like(batch);
        }
        self.shots += 1;
        let like = self.like.as_ref().filter(|_| speed_m_s.is_finite() && speed_m_s > 0.0);
        match like.and_then(|plan| plan.at_speed(speed_m_s)) {
            Some(plan) => Ok((plan, Vec::new())),
            None => batch.plan(&self.experiment, speed_m_s),
        }
    }

    /// A plan of a chain that is sound at the lowest and the highest speed of the batch, and so
    /// at all between: what is checked grows or falls with speed throughout.
    fn like(&self, batch: &Batch) -> Option<Plan> {
        let ends = [f64::min, f64::max].map(|pick| batch.speeds_m_s.iter().copied().reduce(pick));
        let sound = |speed_m_s: Option<f64>| {
            let (plan, warnings) = batch.plan(&self.experiment, speed_m_s?).ok()?;
            warnings.is_empty().then_some(plan)
        };
        sound(ends[0])?;
        sound(ends[1])
    }
}

/// A shard of a batch by the batch's fingerprint.
fn shard_name(batch: &Fingerprint, shard: Shard) -> String {
    let (number, of) = (shard.number(), shard.of());
    format!("sweep-{}-{number}-of-{of}", batch.short())
}

impl BatchResult {
    /// Its name: a hash of all its inputs.
    pub fn name(&self) -> String {
        shard_name(&self.batch, self.shard)
    }
}
