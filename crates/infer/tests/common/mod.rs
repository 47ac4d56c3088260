//! Simulated measurements at the paper's noise.
#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test uses a part; a test that cannot go on should fail"
)]

use hertzchain_experiment::Experiment;
use hertzchain_infer::gauge::Chains;
use hertzchain_infer::{
    CurveProblem, Data, DataRow, FreeNumber, FreeNumbers, Freedom, Model, Observable, Predicted,
    Speeds,
};
use hertzchain_measure::signal::Estimate;
use hertzchain_sim::{Method, Plan, shoot};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::sync::LazyLock;

/// Shots at one speed.
const SHOTS: f64 = 20.0;

/// Names of the dry contacts' free numbers.
static FREE: LazyLock<[String; 2]> = LazyLock::new(|| ["aisi316.eta", "dry.B"].map(str::to_owned));

/// A gauge's chains with the paper's free numbers.
pub(crate) fn chains<'a>(dry: &'a Experiment, wet: &'a Experiment) -> Chains<'a> {
    Chains { dry, wet, free: &*FREE, own: &[], film: &[], systematic: &[], accuracy: 1e-5 }
}

/// Scatter of a shot's speed in m/s, and of its times in s: half a sample of the
/// paper's 1 MS/s.
pub(crate) const SPEED_M_S: f64 = 0.003;
pub(crate) const TIME_S: f64 = 0.5e-6;

/// A model of an experiment with these numbers free.
pub(crate) fn model(experiment: &Experiment, names: &[&str]) -> Model {
    let numbers = names.iter().map(|name| FreeNumber::find(experiment, name, None).unwrap());
    Model::new(experiment, FreeNumbers::new(numbers.collect()).unwrap()).unwrap()
}

/// Speeds in equal ratios over the paper's range.
pub(crate) fn speeds_m_s(count: usize) -> Vec<f64> {
    speeds_between(0.075, 1.23, count)
}

/// Speeds in m/s in equal ratios.
pub(crate) fn speeds_between(slowest: f64, fastest: f64, count: usize) -> Vec<f64> {
    let step = |at: usize| slowest * (fastest / slowest).powf(at as f64 / (count - 1) as f64);
    (0..count).map(step).collect()
}

/// Standard errors of a measured row.
#[derive(Clone, Copy)]
pub(crate) struct Noise {
    /// Of the speed in m/s.
    pub speed_m_s: f64,
    /// Of each time of flight in s.
    pub time_s: f64,
    /// Correlation of both times' errors: −1/2 where three picks are as good.
    pub correlation: f64,
}

impl Noise {
    /// That of the paper: means of 20 shots.
    pub(crate) fn of_the_paper() -> Self {
        Self {
            speed_m_s: SPEED_M_S / SHOTS.sqrt(),
            time_s: TIME_S / SHOTS.sqrt(),
            correlation: 0.0,
        }
    }
}

/// A curve at the experiment's own numbers, a hundred times as accurate as a
/// surrogate's and a thousand times as a fit's, with its slopes d ln y/d ln v from shots 1 % slower and faster.
pub(crate) struct Truth {
    pub speeds_m_s: Vec<f64>,
    pub curve: Vec<Predicted>,
    slopes: Vec<[f64; 4]>,
}

/// Relative accuracy of a true curve: a hundred times that of the curves, right to
/// 1e-6, between which a fit's surrogate interpolates.
pub(crate) const TRUTH: f64 = 1e-8;

/// Relative distance of the shots that determine slopes.
const ASIDE: f64 = 0.01;

impl Truth {
    pub(crate) fn of(experiment: &Experiment, speeds_m_s: &[f64]) -> Self {
        Self::at(&model(experiment, &[]), &[], speeds_m_s)
    }

    /// A model's curve at a point.
    pub(crate) fn at(model: &Model, point: &[f64], speeds_m_s: &[f64]) -> Self {
        let exact = model.clone().with_accuracy(TRUTH);
        let at = |factor: f64| {
            let speeds: Vec<f64> = speeds_m_s.iter().map(|v| v * factor).collect();
            exact.curves(&[point.to_vec()], &Speeds::of_rows(&speeds)).remove(0).unwrap()
        };
        let [below, curve, above] = [1.0 - ASIDE, 1.0, 1.0 + ASIDE].map(at);
        let width = ((1.0 + ASIDE) / (1.0 - ASIDE)).ln();
        let slope = |row: usize| {
            [0, 1, 2, 3].map(|of| (above[row][of].unwrap() / below[row][of].unwrap()).ln() / width)
        };
        Self {
            slopes: (0..curve.len()).map(slope).collect(),
            speeds_m_s: speeds_m_s.to_vec(),
            curve,
        }
    }

    /// Its times again, by classical Runge–Kutta with a fixed step, as a reader of
    /// the paper would.
    pub(crate) fn shot_by_rk4(&mut self, experiment: &Experiment, step_s: f64) {
        for (row, speed) in self.curve.iter_mut().zip(&self.speeds_m_s) {
            let (mut plan, _) = Plan::from_experiment(experiment, Some(*speed)).unwrap();
            (plan.method, plan.step_s) = (Method::Rk4, Some(step_s));
            let flight = shoot(&plan.for_flights()).unwrap().flight.unwrap();
            (row[0], row[1]) = (Some(flight.incident_s), flight.reflected_s);
        }
    }

    /// The largest relative error of a true curve, found by shots of other steps.
    pub(crate) fn accuracy_reached(experiment: &Experiment, speeds_m_s: &[f64]) -> f64 {
        let exact = model(experiment, &[]).with_accuracy(TRUTH);
        let speeds = Speeds::of_rows(speeds_m_s);
        exact.accuracy_reached(&[], &speeds).unwrap()
    }

    /// A repetition whose standard errors come from the scatter of its own twenty
    /// shots, which is reported or not.
    pub(crate) fn measured_by_shots(&self, seed: u64, reported: bool) -> Data {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut mean_of = |scatter: f64| -> Estimate {
            let shots: Vec<f64> = (0..SHOTS as usize)
                .map(|_| {
                    let normal: f64 = StandardNormal.sample(&mut generator);
                    scatter * normal
                })
                .collect();
            let mean = shots.iter().sum::<f64>() / SHOTS;
            let squares: f64 = shots.iter().map(|shot| (shot - mean).powi(2)).sum();
            let sigma = (squares / (SHOTS - 1.0) / SHOTS).sqrt();
            Estimate { value: mean, sigma }
        };
        let mut data = self.measured(seed);
        for (at, row) in data.rows.iter_mut().enumerate() {
            let speed = mean_of(SPEED_M_S);
            row.speed_m_s.sigma = speed.sigma;
            if reported {
                row.freedom = Freedom::of_all(SHOTS - 1.0);
            }
            for of in [Observable::Incident, Observable::Reflected] {
                let exact = self.curve[at][of as usize].unwrap();
                let moved = self.slopes[at][of as usize] * speed.value / row.speed_m_s.value;
                let time = mean_of(TIME_S);
                row.values[of as usize] =
                    Some(Estimate { value: exact * moved.exp() + time.value, sigma: time.sigma });
            }
        }
        data
    }

    /// A repetition of the measurement at the paper's noise.
    pub(crate) fn measured(&self, seed: u64) -> Data {
        self.measured_with(Noise::of_the_paper(), seed)
    }

    /// A repetition of the measurement: the true speeds are not quite what was set.
    pub(crate) fn measured_with(&self, noise: Noise, seed: u64) -> Data {
        self.repeated(noise, None, seed)
    }

    /// The same with the returning over the passing peak, to this relative error.
    pub(crate) fn measured_with_ratios(&self, noise: Noise, relative: f64, seed: u64) -> Data {
        self.repeated(noise, Some(relative), seed)
    }

    fn repeated(&self, noise: Noise, ratio: Option<f64>, seed: u64) -> Data {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        // Ratios leave times as they are without them.
        let mut of_peaks = generator.clone();
        of_peaks.set_stream(1);
        let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
        let (speed_error, time_error) = (noise.speed_m_s, noise.time_s);
        let mut row = |at: usize| {
            let speed = self.speeds_m_s[at];
            let moved = speed_error * normal() / speed;
            let shifted = |of: Observable| {
                let exact = self.curve[at][of as usize].unwrap();
                exact * (self.slopes[at][of as usize] * moved).exp()
            };
            let (first, second) = (normal(), normal());
            let rest = (1.0 - noise.correlation.powi(2)).sqrt();
            let errors = [first, noise.correlation * first + rest * second];
            let times = [Observable::Incident, Observable::Reflected].map(|of| {
                Some(Estimate {
                    value: shifted(of) + time_error * errors[of as usize],
                    sigma: time_error,
                })
            });
            let peaks = ratio.map(|relative| {
                let own: f64 = StandardNormal.sample(&mut of_peaks);
                let value = shifted(Observable::ReturningOverPassing) * (1.0 + relative * own);
                let sigma = relative * value;
                Estimate { value, sigma }
            });
            DataRow {
                line: at as u64 + 2,
                speed_m_s: Estimate { value: speed, sigma: speed_error },
                values: [times[0], times[1], None, peaks],
                correlation: Some(noise.correlation),
                freedom: Freedom::KNOWN,
            }
        };
        Data {
            file: "simulated".to_owned(),
            case: String::new(),
            rows: (0..self.speeds_m_s.len()).map(&mut row).collect(),
        }
    }
}

/// Data against a model whose parameters start at the experiment's numbers.
pub(crate) fn problem(model: &Model, data: Data) -> CurveProblem {
    let parameters = model.numbers.parameters(&data.speeds_m_s());
    CurveProblem::new(model.clone(), data, parameters).unwrap()
}
