//! How often intervals hold the truth: a table of `docs/explanation/inference.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-infer --example coverage -- 500 50        # data sets, of them by posterior
//! cargo run --release -p hertzchain-infer --example coverage -- 500 50 wet    # one case by its name
//! cargo run --release -p hertzchain-infer --example coverage -- 500 50 delay  # and so: unaware, speed_scale, radius_error,
//!                                                                             # joint, joint-delay
//! cargo run --release -p hertzchain-infer --example coverage -- 500 50 wet 501    # other data sets: seeds from 501
//! ```
//!
//! Curves are right to 1e-8, a hundred times as right as those of the surrogate by which
//! they are fitted, once by Runge–Kutta of order 4 with a fixed step, and measured at the paper's noise:
//! 20 shots a speed, speeds ±0.003 m/s; that of `bent` at so much more noise that the
//! three kinds of intervals differ; those of `scatter` and `widened` have standard errors
//! from the scatter of their own twenty shots, as they are or widened; in those of `delay` incident times
//! are late by a normal number of 0.2 µs, new in each set, which is a nuisance parameter or (`unaware`) not; in those of
//! `speed_scale` and `radius_error` all speeds or radii are other than stated, by 1 % and 1 µm;
//! those of `joint` have a second table, of a sensor in bead 20. Fits use a surrogate of the model, whose error
//! is printed in standard errors.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Noise, TRUTH, Truth, speeds_between, speeds_m_s};
use hertzchain_experiment::{Experiment, preset};
use hertzchain_infer::{
    Chain, Covariance, CurveProblem, Data, Fit, Fitting, FreeNumber, FreeNumbers, InferError,
    Model, Observable, Predicted, Problem, Profiling, Requirements, Sampling, Surrogate, fit,
    profile,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::error::Error;
use std::ops::Range;

/// What is inferred from which curve.
struct Case {
    name: &'static str,
    preset: &'static str,
    free: [&'static str; 2],
    exact: [f64; 2],
    /// Numbers of the file that differ from the preset's.
    set: [(&'static str, f64); 2],
    /// Whether Runge–Kutta makes the curve.
    by_rk4: bool,
    measured: Measured,
    /// The systematic error and its standard deviation.
    systematic: Option<(&'static str, f64)>,
    /// Whether the fit has it as a nuisance parameter.
    is_aware: bool,
    /// Whether there is a second table, of a sensor in another bead.
    is_joint: bool,
}

/// How a curve is measured.
#[derive(Clone, Copy, PartialEq)]
enum Measured {
    /// 25 speeds, both times, the paper's noise.
    Well,
    /// Six speeds, incident times alone, to 5 µs.
    Poorly,
    /// As well, with standard errors from the scatter of the shots, widened or not.
    ByShots(bool),
}

impl Measured {
    fn speeds_m_s(self) -> Vec<f64> {
        match self {
            Measured::Well | Measured::ByShots(_) => speeds_m_s(25),
            Measured::Poorly => speeds_between(0.1, 1.2, 6),
        }
    }

    fn data(self, truth: &Truth, seed: u64) -> Data {
        let noise = Noise { speed_m_s: 0.0005, time_s: 5e-6, correlation: 0.0 };
        match self {
            Measured::Well => truth.measured(seed),
            Measured::ByShots(widened) => truth.measured_by_shots(seed, widened),
            Measured::Poorly => {
                let both = truth.measured_with(noise, seed);
                both.only(&[Observable::Incident])
            }
        }
    }
}

const STIFFNESS: f64 = 8.792_630_379_6e9;
const RELAXATION_S: f64 = 3.385_289_514_9e-7;

const DRY: Case = Case {
    name: "dry",
    preset: "dry",
    free: ["eta", "B"],
    exact: [3.2e4, 77.0],
    set: [("aisi316.shear_viscosity", 3.2e4), ("aisi316.bulk_viscosity", 3.2e4)],
    by_rk4: false,
    measured: Measured::Well,
    systematic: None,
    is_aware: true,
    is_joint: false,
};

/// Systematic errors with their standard deviations in SI.
const DELAY: (&str, f64) = ("delay", 0.2e-6);
const SPEED_SCALE: (&str, f64) = ("speed_scale", 0.01);
const RADIUS_ERROR: (&str, f64) = ("radius_error", 1e-6);

/// The sensor's bead in the second table.
const OTHER_BEAD: f64 = 20.0;

const CASES: [Case; 13] = [
    DRY,
    Case { name: "rk4", by_rk4: true, ..DRY },
    Case {
        name: "contacts",
        preset: "hertz-viscoelastic",
        free: ["K", "A"],
        exact: [STIFFNESS, RELAXATION_S],
        set: [
            ("contacts[0].laws.elastic_hertz.stiffness", STIFFNESS),
            ("contacts[0].laws.damping_viscoelastic.relaxation_time", RELAXATION_S),
        ],
        ..DRY
    },
    Case {
        name: "wet",
        preset: "pump",
        free: ["wet.K", "wet.A"],
        exact: [9e9, 8e-7],
        set: [
            ("contacts[1].laws.elastic_hertz.stiffness", 9e9),
            ("contacts[1].laws.damping_viscoelastic.relaxation_time", 8e-7),
        ],
        ..DRY
    },
    Case { name: "delay", systematic: Some(DELAY), ..DRY },
    Case { name: "unaware", systematic: Some(DELAY), is_aware: false, ..DRY },
    Case { name: "speed_scale", systematic: Some(SPEED_SCALE), ..DRY },
    Case { name: "radius_error", systematic: Some(RADIUS_ERROR), ..DRY },
    Case { name: "joint", is_joint: true, ..DRY },
    Case { name: "joint-delay", is_joint: true, systematic: Some(DELAY), ..DRY },
    Case { name: "bent", measured: Measured::Poorly, ..DRY },
    Case { name: "scatter", measured: Measured::ByShots(false), ..DRY },
    Case { name: "widened", measured: Measured::ByShots(true), ..DRY },
];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let count = |at: usize, usual| words.get(at).map_or(Ok(usual), |word| word.parse());
    let (sets, sampled): (usize, usize) = (count(0, 500)?, count(1, 50)?);
    let from = count(3, 1)?;
    let asked = |case: &&Case| words.get(2).is_none_or(|name| name == case.name);
    for case in CASES.iter().filter(asked) {
        study(case, from..from + sets, sampled).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// Where the true value is beside the intervals of both levels, for both parameters:
/// below, within (`Equal`) or above.
type Held = [[Ordering; 2]; 2];

/// What one data set says.
struct Said {
    /// By covariance, profile and, if asked, posterior.
    held: [Option<Held>; 3],
    /// How many of its standard errors each parameter is off.
    pulls: [f64; 2],
    chi_square: f64,
}

fn study(case: &Case, seeds: Range<usize>, sampled: usize) -> Result<(), Box<dyn Error>> {
    let near = preset(case.preset)?;
    let mut rows = vec![near.clone()];
    if case.is_joint {
        rows.push(near.set(&[("sensors.bead", OTHER_BEAD)])?);
    }
    let truths = rows.iter().map(|row| truth(case, row)).collect::<Result<Vec<_>, _>>()?;
    let moved = rows.iter().map(|row| logarithmic_slopes(case, row));
    let slopes = moved.collect::<Result<Vec<_>, _>>()?;
    let data = |seed: usize| repetition(case, &truths, &slopes, seed as u64);
    let models = rows.iter().map(|row| uncertain(case, row)).collect::<Result<Vec<_>, _>>()?;
    let first = CurveProblem::of_curves(models.into_iter().zip(data(0)).collect(), &[]);
    let best = fit(&first, &Fitting::default())?;
    let around = Covariance::new(first.parameters(), &best);
    let surrogate = Surrogate::within(REACH, &first, &best, &around)?;
    let from = seeds.start;
    let one = |seed: usize| -> Result<Said, String> {
        let repeated = surrogate.with_data(data(seed));
        let repeated = repeated.map_err(|error| error.to_string())?;
        said(&repeated, case, seed, seed < from + sampled).map_err(|error| error.to_string())
    };
    let said: Vec<Said> = seeds.into_par_iter().map(one).collect::<Result<_, _>>()?;
    println!(
        "{}: {} and {}; surrogate right to {:.4} standard errors",
        case.name, case.free[0], case.free[1], surrogate.error
    );
    println!(
        "| method | data sets | {0} 68 % | {0} 95 % | below, above | {1} 68 % | {1} 95 % | below, above |",
        case.free[0], case.free[1]
    );
    for (at, method) in ["covariance", "profile", "posterior"].iter().enumerate() {
        let held: Vec<Held> = said.iter().filter_map(|said| said.held[at]).collect();
        println!("| {method} | {} | {} |", held.len(), shares(&held));
    }
    for (at, name) in case.free.iter().enumerate() {
        let pulls: Vec<f64> = said.iter().map(|said| said.pulls[at]).collect();
        println!("{name} off by {} standard errors", moments(&pulls));
    }
    let freedom = (first.residual_count() - 2) as f64;
    let chi_squares: Vec<f64> = said.iter().map(|said| said.chi_square / freedom).collect();
    println!("chi-square over freedom {}", moments(&chi_squares));
    Ok(())
}

/// Mean with its error and standard deviation with its own, as of normal numbers.
fn moments(values: &[f64]) -> String {
    let of = values.len().max(2) as f64;
    let mean = values.iter().sum::<f64>() / of;
    let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
    let sd = (squares / (of - 1.0)).sqrt();
    let (error, error_of_sd) = (sd / of.sqrt(), sd / (2.0 * of).sqrt());
    format!("{mean:.3} ± {error:.3}, scattering by {sd:.3} ± {error_of_sd:.3}")
}

/// Half the surrogate's box: best fits scatter about the first one's, and
/// samples about each.
const REACH: f64 = 10.0;

/// The curve that is measured.
fn truth(case: &Case, row: &Experiment) -> Result<Truth, Box<dyn Error>> {
    let experiment = row.set(&case.set)?;
    let speeds_m_s = case.measured.speeds_m_s();
    let reached = Truth::accuracy_reached(&experiment, &speeds_m_s);
    if reached > TRUTH {
        return Err(format!("{}: the true curve is right to {reached:e} only", case.name).into());
    }
    println!("{}: true curve right to {reached:.1e}", case.name);
    let mut truth = Truth::of(&experiment, &speeds_m_s);
    if case.by_rk4 {
        let exact = truth.curve.clone();
        truth.shot_by_rk4(&experiment, 1e-7);
        let times = |row: &Predicted| row.iter().take(2).copied().flatten().collect::<Vec<_>>();
        let pairs = exact.iter().zip(&truth.curve);
        let off = pairs.flat_map(|(a, b)| times(a).into_iter().zip(times(b)));
        let off = off.map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max);
        println!("{}: off that by {off:.1e}", case.name);
    }
    Ok(truth)
}

/// The model of a row.
fn uncertain(case: &Case, row: &Experiment) -> Result<Model, Box<dyn Error>> {
    let free = case.free.iter().map(|name| FreeNumber::find(row, name, None));
    let known = case.systematic.filter(|_| case.is_aware);
    let known = known.map(|(name, sd)| FreeNumber::systematic(row, name, sd));
    let numbers = FreeNumbers::new(free.chain(known).collect::<Result<_, _>>()?)?;
    Ok(Model::new(row, numbers)?)
}

/// What a standard deviation of the systematic error changes the logarithms of both times by, a row of
/// the table each: from curves of other speeds or other radii, not from the model's own parameter.
fn logarithmic_slopes(case: &Case, row: &Experiment) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let speeds_m_s = case.measured.speeds_m_s();
    let curve = |sds: f64| -> Result<Vec<Predicted>, Box<dyn Error>> {
        let (mut row, mut speeds_m_s) = (row.set(&case.set)?, speeds_m_s.clone());
        match case.systematic {
            Some(SPEED_SCALE) => {
                speeds_m_s.iter_mut().for_each(|v| *v *= 1.0 + sds * SPEED_SCALE.1)
            }
            Some(RADIUS_ERROR) => {
                let radii =
                    row.places().into_iter().filter(|place| place.path.ends_with(".radius"));
                let moved = radii.filter_map(|p| Some((p.path, p.value? + sds * RADIUS_ERROR.1)));
                let moved: Vec<(String, f64)> = moved.collect();
                let moved: Vec<(&str, f64)> = moved.iter().map(|(path, m)| (&**path, *m)).collect();
                row = row.set(&moved)?;
            }
            _ => {}
        }
        Ok(Truth::of(&row, &speeds_m_s).curve)
    };
    let (below, above) = (curve(-1.0)?, curve(1.0)?);
    let of = |(below, above): (&Predicted, &Predicted)| {
        [0, 1].map(|at| match (below[at], above[at]) {
            (Some(below), Some(above)) => 0.5 * (above / below).ln(),
            _ => 0.0,
        })
    };
    Ok(below.iter().zip(&above).map(of).collect())
}

/// A simulated repetition of each table.
fn repetition(case: &Case, truths: &[Truth], slopes: &[Vec<[f64; 2]>], seed: u64) -> Vec<Data> {
    let normal: f64 = StandardNormal.sample(&mut ChaCha8Rng::seed_from_u64(seed + LATE));
    let late_s = case.systematic.filter(|it| *it == DELAY).map_or(0.0, |(_, sd)| sd * normal);
    let table = |(at, (truth, slopes)): (u64, (&Truth, &Vec<[f64; 2]>))| {
        let mut data = case.measured.data(truth, seed + at * OTHER_TABLE);
        for (row, slopes) in data.rows.iter_mut().zip(slopes) {
            for (time, slope) in row.values.iter_mut().zip(slopes) {
                time.iter_mut().for_each(|time| time.value *= (slope * normal).exp());
            }
            row.values[0].iter_mut().for_each(|incident| incident.value += late_s);
        }
        data
    };
    (0..).zip(truths.iter().zip(slopes)).map(table).collect()
}

/// What seeds of systematic errors and of second tables are apart from those of the first.
const LATE: u64 = 1_000_000;
const OTHER_TABLE: u64 = 2_000_000;

/// Shares in percent with their binomial errors; beside the wider intervals, how often
/// the truth was below them and above.
fn shares(held: &[Held]) -> String {
    let of = held.len().max(1) as f64;
    let share = |at: usize, level: usize, place: Ordering| {
        let share = held.iter().filter(|held| held[at][level] == place).count() as f64 / of;
        let error = (share * (1.0 - share) / of).sqrt();
        format!("{:.1} ± {:.1}", 100.0 * share, 100.0 * error)
    };
    let parameter = |at: usize| {
        let [narrow, wide] = [0, 1].map(|level| share(at, level, Ordering::Equal));
        let [below, above] = [Ordering::Less, Ordering::Greater].map(|place| share(at, 1, place));
        format!("{narrow} | {wide} | {below}, {above}")
    };
    format!("{} | {}", parameter(0), parameter(1))
}

fn said(
    problem: &Surrogate,
    case: &Case,
    seed: usize,
    sampled: bool,
) -> Result<Said, Box<dyn Error>> {
    let best = fit(problem, &Fitting::default())?;
    let covariance = Covariance::new(problem.parameters(), &best);
    let held = |interval: &dyn Fn(usize, usize) -> [f64; 2]| -> Held {
        [0, 1].map(|at| {
            [0, 1].map(|level| {
                let ([lower, upper], exact) = (interval(at, level), case.exact[at]);
                match (exact < lower, exact > upper) {
                    (true, _) => Ordering::Less,
                    (_, true) => Ordering::Greater,
                    _ => Ordering::Equal,
                }
            })
        })
    };
    let by_covariance = held(&|at, level| {
        let reach = [1.0, 1.959_964][level] * covariance.sd[at];
        [best.point[at] - reach, best.point[at] + reach]
    });
    let profiles = profile(problem, &best, &covariance, &[0, 1], &Profiling::default())?;
    let by_profile = held(&|at, level| {
        let interval = profiles[at].intervals[level];
        let lower = interval.lower.closed().unwrap_or(f64::NEG_INFINITY);
        [lower, interval.upper.closed().unwrap_or(f64::INFINITY)]
    });
    let mut by_posterior = None;
    if sampled {
        let posterior = posterior(problem, (&best, &covariance), seed)?;
        by_posterior = Some(held(&|at, level| posterior.interval(at, [0.682_689, 0.95][level])));
    }
    Ok(Said {
        held: [Some(by_covariance), Some(by_profile), by_posterior],
        pulls: [0, 1].map(|at| (best.point[at] - case.exact[at]) / covariance.sd[at]),
        chi_square: best.chi_square(),
    })
}

/// A posterior sampled until its quantiles may be believed.
fn posterior(
    problem: &Surrogate,
    (best, covariance): (&Fit, &Covariance),
    seed: usize,
) -> Result<hertzchain_infer::Posterior, Box<dyn Error>> {
    let how = Sampling { seed: seed as u64, ..Sampling::default() };
    let mut chain = Chain::start(problem, best, covariance, &how)?;
    let found = chain
        .lead(problem, &Requirements::default(), MOST_STEPS, &mut |_| Ok::<(), InferError>(()))?;
    Ok(found.map_err(|short| short.to_string())?)
}

/// Most steps of walkers.
const MOST_STEPS: u64 = 50_000;
