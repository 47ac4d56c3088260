//! Records against a model with free numbers.

use super::align::{Traced, residuals};
use super::record::Pulses;
use crate::curve::{Model, Shooting, Speeds};
use crate::problem::{ModelError, Problem, Residuals};
use crate::{InferError, Parameter};
use hertzchain_chain::Sensor;
use hertzchain_experiment::Amplifier;
use hertzchain_sim::{Fingerprint, Shot, count_done, shoot, stopped};
use rayon::prelude::*;
use std::fmt;

/// What an amplifier's filters make of a signal, with a gain of one in the middle of their band:
/// samples of a signal and their interval in s to samples of the filtered one.
pub type Respond = fn(&Amplifier, &[f64], f64) -> Vec<f64>;

/// Shots recorded sample by sample against those of a model.
///
/// A residual is (mean of neighbouring samples − model's)/σ, σ from the noise
/// before the pulses, made white by the autoregression that it has there. Each record's baseline
/// (offset, slope and curvature), moment of impact and error of the speed are at their best for
/// every set of parameters.
#[derive(Clone, Debug)]
pub struct PulseProblem {
    /// The model.
    pub model: Model,
    respond: Respond,
    /// The records that it is compared with.
    pub records: Vec<Pulses>,
    /// Which of the programmed speeds of the striker each record has.
    rows: Vec<usize>,
    speeds_m_s: Vec<f64>,
    parameters: Vec<Parameter>,
    /// How long each record's shot is followed, and how densely, in s.
    grids: Vec<(f64, f64)>,
    /// Records whose shot shows no pulse, and why.
    pub left_out: Vec<String>,
}

/// Share of the model's first passing time by which it may become later.
const LATER: f64 = 0.5;

/// Samples of the model in an incident time of flight, at the least, and the longest time
/// between them in s. Filters are exact for straight lines between samples, so that an error
/// goes as the square of that time: 2 µs made a sensitivity wrong by 2.5e-4 of itself.
const LEAST_SAMPLES: f64 = 2500.0;
const LONGEST_INTERVAL_S: f64 = 0.25e-6;

/// Relative change of the speed by which its effect is reported.
const ASIDE: f64 = 1e-3;

/// The name of the sensors' sensitivity.
const GAIN: &str = "sensor_gain";

impl PulseProblem {
    /// A model against records. Its parameters start where the model has them,
    /// the sensors' sensitivity where the first record has it. Records whose shot shows no
    /// pulse there are [left out](Self::left_out).
    pub fn new(model: Model, records: Vec<Pulses>, respond: Respond) -> Result<Self, InferError> {
        let mut speeds_m_s: Vec<f64> = records.iter().map(|r| r.programmed_m_s).collect();
        speeds_m_s.sort_by(f64::total_cmp);
        speeds_m_s.dedup();
        let row = |record: &Pulses| {
            let own = speeds_m_s.iter().position(|v| *v == record.programmed_m_s);
            own.unwrap_or_default()
        };
        let mut problem = Self {
            rows: records.iter().map(row).collect(),
            parameters: model.numbers.parameters(&speeds_m_s),
            grids: Vec::new(),
            left_out: Vec::new(),
            model,
            respond,
            records,
            speeds_m_s,
        };
        problem.lay_out()?;
        if problem.left_out.is_empty() {
            return Ok(problem);
        }
        // Speeds that no shot has any more have no values a speed either.
        let left_out = std::mem::take(&mut problem.left_out);
        let mut fewer = Self::new(problem.model, problem.records, problem.respond)?;
        fewer.left_out.splice(..0, left_out);
        Ok(fewer)
    }

    /// The same with other starts, bounds and priors of its parameters.
    ///
    /// # Errors
    /// Parameters that are not sound, or none.
    pub fn with_parameters(mut self, parameters: Vec<Parameter>) -> Result<Self, InferError> {
        parameters.iter().try_for_each(Parameter::check)?;
        if parameters.is_empty() {
            return Err(nothing_free());
        }
        self.parameters = parameters;
        Ok(self)
    }

    /// The same with a model of another relative accuracy.
    pub fn with_accuracy(mut self, accuracy: f64) -> Self {
        self.model = self.model.with_accuracy(accuracy);
        self
    }

    /// Of everything that residuals follow from: the experiment as it is understood,
    /// amplifier among it, its free numbers, the records, accuracy and instruction set, this
    /// build of the program; not where the records lie.
    pub fn fingerprint(&self) -> Fingerprint {
        let record = |of: &Pulses| {
            let times = [of.interval_s, of.start_s, of.passing_s];
            let speeds = (of.speed_m_s, of.programmed_m_s);
            format!("{:?}", (speeds, times, of.width, (&of.sigma_v, &of.whitening), &of.means_v))
        };
        let records: Vec<String> = self.records.iter().map(record).collect();
        Fingerprint::of("pulse problem", &(self.model.inputs(&self.parameters), records))
    }

    /// Numbers fitted to single records: baselines, moments and errors of speeds.
    pub fn nuisance_count(&self) -> usize {
        self.records.iter().map(Pulses::nuisance_count).sum()
    }

    /// Times in s after the passing maximum, measured means and the model's, of
    /// one channel of a record at a point: for a picture.
    ///
    /// # Errors
    /// What is in the way of the shot.
    pub fn picture(
        &self,
        point: &[f64],
        record: usize,
        channel: usize,
    ) -> Result<[Vec<f64>; 3], ModelError> {
        let of = &self.records[record];
        let found = self.record_residuals(point, record)?;
        let count = of.means_v[channel].len();
        let before: usize = of.means_v[..channel].iter().map(Vec::len).sum();
        let sigma = of.sigma_v[channel];
        let mean_s = of.width as f64 * of.interval_s;
        let time = |at: usize| of.start_s - of.passing_s + (at as f64 + 0.5) * mean_s;
        let mut left = found[before..before + count].to_vec();
        of.whitening[channel].undo(&mut left);
        let model = |at: usize| of.means_v[channel][at] - sigma * left[at];
        Ok([
            (0..count).map(time).collect(),
            of.means_v[channel].clone(),
            (0..count).map(model).collect(),
        ])
    }

    /// Follows each record's first shot to learn how long others need to be.
    fn lay_out(&mut self) -> Result<(), InferError> {
        if self.records.is_empty() {
            return Err(no_records());
        }
        if self.parameters.is_empty() {
            return Err(nothing_free());
        }
        let start: Vec<f64> = self.parameters.iter().map(|p| p.start).collect();
        let mut passing = Vec::new();
        let mut missing = None;
        for (at, record) in self.records.iter().enumerate() {
            let found = self.shootings(&start, at);
            match found.and_then(|[shooting, _]| first_shot(record, &shooting)) {
                Ok(first) => {
                    self.grids.push(first.grid);
                    passing.push(Some(first));
                }
                Err(error) if stopped() => return Err(at_start(&error)),
                Err(error) => {
                    passing.push(None);
                    self.left_out.push(format!("the model where it starts: {error}"));
                    missing = missing.or(Some(error));
                }
            }
        }
        let mut seen = passing.iter().map(Option::is_some);
        self.records.retain(|_| seen.next().unwrap_or(false));
        let first = passing.into_iter().flatten().next();
        match (first, missing) {
            (Some(first), _) => {
                self.start_gain(&first);
                Ok(())
            }
            (None, Some(error)) => Err(at_start(&error)),
            (None, None) => Err(no_records()),
        }
    }

    /// The sensors' sensitivity, if it is free, from the first record and the model's force.
    fn start_gain(&mut self, first: &FirstShot) {
        let gain = first.sensor_gain_v_n;
        let height_v = self.records.first().map_or(0.0, |record| record.height_v);
        let own = self.parameters.iter_mut().find(|p| p.name == GAIN);
        if let Some(parameter) = own {
            let start = gain * height_v / (gain * first.passing_n);
            (parameter.start, parameter.scale) = (start, start);
        }
    }

    /// A record's shot at its speed, and a little faster.
    fn shootings(&self, point: &[f64], record: usize) -> Result<[Shooting; 2], ModelError> {
        let speed = self.records[record].speed_m_s.value;
        let row = self.rows[record];
        let speeds = Speeds {
            at: vec![(row, speed), (row, speed * (1.0 + ASIDE))],
            rows: self.speeds_m_s.len(),
        };
        let mut found = self.model.plans(point, &speeds)?.into_iter();
        let none = || ModelError("no shot was planned".into());
        let (one, other) = (found.next(), found.next());
        Ok([one.ok_or_else(none)?, other.ok_or_else(none)?])
    }

    fn record_residuals(&self, point: &[f64], at: usize) -> Result<Vec<f64>, ModelError> {
        let record = &self.records[at];
        let [shooting, faster] = self.shootings(point, at)?;
        let (shot, volts) = self.traced(&shooting, at)?;
        let (_, moved) = self.traced(&faster, at)?;
        let passage = shot.passage.as_ref().map_err(|error| named(record, error))?;
        let slopes = |(one, other): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
            let pairs = one.iter().zip(other);
            pairs.map(|(a, b)| (b - a) / ASIDE.ln_1p()).collect()
        };
        let traced = Traced {
            interval_s: self.grids[at].1,
            passing_s: passage.incident.time_s,
            by_ln_speed: volts.iter().zip(&moved).map(slopes).collect(),
            volts,
        };
        Ok(residuals(record, &traced))
    }

    /// A shot and its channels in V.
    fn traced(&self, shooting: &Shooting, at: usize) -> Result<(Shot, Vec<Vec<f64>>), ModelError> {
        let record = &self.records[at];
        let (length_s, interval_s) = self.grids[at];
        let wall = Sensor::Contact(shooting.plan.chain.beads.len());
        let sensors = vec![Sensor::Bead(shooting.plan.sensor_bead), wall];
        let mut plan = shooting.plan.clone().watching(sensors, Some(interval_s));
        plan.duration_s = Some(length_s);
        let shot = shoot(&plan).map_err(|error| named(record, error))?;
        let columns = shot.trace.as_ref().map_or(&[][..], |trace| &trace.columns);
        let [bead, wall] = columns else {
            return Err(named(record, "nothing was sampled"));
        };
        let gain = shooting.sensor_gain_v_n;
        let wall_gain = gain * shooting.wall_gain;
        let channels: Vec<Vec<f64>> = match record.means_v.len() {
            1 => {
                let both = bead.iter().zip(wall);
                vec![both.map(|(b, w)| gain * b + wall_gain * w).collect()]
            }
            _ => vec![
                bead.iter().map(|b| gain * b).collect(),
                wall.iter().map(|w| wall_gain * w).collect(),
            ],
        };
        let filtered =
            channels.iter().map(|channel| (self.respond)(&shooting.amplifier, channel, interval_s));
        let filtered = filtered.collect();
        Ok((shot, filtered))
    }

    /// Which record a residual belongs to, and its number there.
    fn place(&self, index: usize) -> Option<(&Pulses, usize)> {
        let mut rest = index;
        for record in &self.records {
            let count = record.residual_count();
            if rest < count {
                return Some((record, rest));
            }
            rest -= count;
        }
        None
    }
}

fn nothing_free() -> InferError {
    InferError::Input("no parameter is free: name some, such as eta,B,sensor_gain".into())
}

fn no_records() -> InferError {
    InferError::Input("no record is left to be fitted".into())
}

fn at_start(error: &ModelError) -> InferError {
    InferError::Model(format!("the model where it starts: {error}"))
}

/// What a record's first shot determines.
struct FirstShot {
    sensor_gain_v_n: f64,
    passing_n: f64,
    /// How long others are to be followed, and how densely, in s.
    grid: (f64, f64),
}

fn first_shot(record: &Pulses, shooting: &Shooting) -> Result<FirstShot, ModelError> {
    let shot = shoot(&shooting.plan).map_err(|error| named(record, error))?;
    let passage = shot.passage.as_ref();
    let passage = passage.map_err(|error| named(record, error))?;
    let (passing, wall) = (passage.incident, passage.wall);
    let length_s = (1.0 + LATER) * passing.time_s + record.after_s();
    let least_s = (wall.time_s - passing.time_s) / LEAST_SAMPLES;
    Ok(FirstShot {
        sensor_gain_v_n: shooting.sensor_gain_v_n,
        passing_n: passing.value,
        grid: (length_s, least_s.min(record.interval_s).min(LONGEST_INTERVAL_S)),
    })
}

fn named(record: &Pulses, error: impl fmt::Display) -> ModelError {
    ModelError(format!("{}: {error}", record.source))
}

impl Problem for PulseProblem {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn residual_count(&self) -> usize {
        self.records.iter().map(Pulses::residual_count).sum()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let records = self.records.len();
        let all: Vec<Result<Vec<f64>, ModelError>> = (0..points.len() * records)
            .into_par_iter()
            .map(|n| {
                let found = self.record_residuals(&points[n / records], n % records);
                count_done(1);
                found
            })
            .collect();
        let mut all = all.into_iter();
        let point = |_| {
            let own: Vec<_> = all.by_ref().take(records).collect();
            let own: Result<Vec<Vec<f64>>, ModelError> = own.into_iter().collect();
            own.map(|own| Residuals::new(own.concat()))
        };
        points.iter().map(point).collect()
    }

    fn residual_label(&self, index: usize) -> String {
        let Some((record, at)) = self.place(index) else {
            return String::new();
        };
        let means = record.means_v.first().map_or(1, Vec::len).max(1);
        if at >= means * record.means_v.len() {
            return format!("{}, speed", record.source);
        }
        let samples = ((at % means) as f64 + 0.5) * record.width as f64;
        let time_s = record.start_s - record.passing_s + samples * record.interval_s;
        let which = match (record.means_v.len(), at / means) {
            (1, _) => "",
            (_, 0) => " of the bead",
            _ => " of the wall",
        };
        format!("{}, {:.1} µs after the passing maximum{which}", record.source, 1e6 * time_s)
    }
}
