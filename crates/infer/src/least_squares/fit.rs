//! A whole fit: from starts to the optimum and what is known there.

use super::descent::{Descent, Ending, Limits, NOTICED, Reached};
use super::drive::drive;
use super::ending::ending;
use super::jacobian::{Jacobian, jacobian};
use super::merit::Merit;
use super::starts::starts;
use super::{FitError, Loss};
use crate::identify::{directions, sized};
use crate::linear::norm;
use crate::{ModelError, Parameter, Prior, Problem, Residuals};

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitting {
    /// What a residual costs.
    pub loss: Loss,
    /// Number of starts: the first where the parameters start, others spread
    /// over what priors and bounds allow.
    pub starts: usize,
    /// Seed of these others.
    pub seed: u64,
    /// Fall of χ²/2 still to be expected at which the minimum counts as reached.
    pub tolerance: f64,
    /// Most iterations of a start.
    pub iterations: usize,
}

impl Default for Fitting {
    fn default() -> Self {
        Self {
            loss: Loss::Squares,
            starts: 1,
            seed: 0,
            tolerance: 1e-9,
            iterations: 200,
        }
    }
}

impl Fitting {
    fn check(&self) -> Result<(), FitError> {
        let wrong = |name, value, expected| {
            Err(FitError::Option {
                name,
                value,
                expected,
            })
        };
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if self.starts == 0 {
            return wrong("number of starts", 0.0, "at least 1");
        }
        if !positive(self.tolerance) {
            return wrong("tolerance", self.tolerance, "a positive number");
        }
        if !positive(self.loss.scale()) {
            let scale = self.loss.scale();
            return wrong("scale of the loss", scale, "a positive number of σ");
        }
        Ok(())
    }

    pub(crate) fn limits(&self) -> Limits {
        Limits {
            tolerance: self.tolerance,
            iterations: self.iterations,
        }
    }
}

/// The best fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The parameters' values, in their units.
    pub point: Vec<f64>,
    /// ½ Σ ρ(r²) + Σ ln σ + ½ Σ (prior residual)²: minus the logarithm of
    /// likelihood and priors, up to a constant.
    pub cost: f64,
    /// Standardised residuals of the data.
    pub residuals: Vec<f64>,
    /// Σ ln σ of the data; 0 if no σ depends on the parameters.
    pub ln_sigmas: f64,
    /// Derivatives at the optimum.
    pub jacobian: Jacobian,
    /// How many combinations of the parameters data and priors determine.
    pub rank: usize,
    /// Parameters that ended at a bound against which the data push.
    pub binding: Vec<Binding>,
    /// Why the best start's descent ended.
    pub ending: Ending,
    /// Where each start came to, in order.
    pub starts: Vec<Started>,
    /// How often the model was computed.
    pub evaluations: usize,
    /// What a residual cost.
    pub loss: Loss,
}

/// A parameter at a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binding {
    /// Which parameter.
    pub parameter: usize,
    /// The bound, in its unit.
    pub bound: f64,
    /// Fall of the cost for each unit of the parameter beyond the bound.
    pub push: f64,
}

/// What one start led to.
#[derive(Clone, Debug, PartialEq)]
pub struct Started {
    /// Where it started.
    pub start: Vec<f64>,
    /// Where it came to.
    pub point: Vec<f64>,
    /// The cost there; infinite if the model fails at the start.
    pub cost: f64,
    /// Why it ended.
    pub ending: Ending,
    /// Iterations it took.
    pub iterations: usize,
}

/// Difference of costs below which two starts are taken to have found the same minimum.
const SAME_COST: f64 = 0.01;

/// Rise of χ² at which a minimum is no longer as good as the best: three standard errors.
const NOT_WORSE: f64 = 9.0;

/// Standard errors by which a parameter of two minima differs.
const APART: f64 = 3.0;

impl Fit {
    /// Σ r² of the data.
    #[must_use]
    pub fn chi_square(&self) -> f64 {
        crate::linear::dot(&self.residuals, &self.residuals)
    }

    /// How many of the starts came to this minimum: within 0.01 of its cost.
    #[must_use]
    pub fn agreeing_starts(&self) -> usize {
        let agrees = |s: &&Started| s.cost <= self.cost + SAME_COST;
        self.starts.iter().filter(agrees).count()
    }

    /// Minima that other starts came to and that fit as well: their χ² lies at most 9 above the
    /// best, and some parameter differs by more than three of these standard errors from
    /// the best minimum and from those before. Best first; each with its starts' number.
    #[must_use]
    pub fn other_minima(&self, sd: &[f64]) -> Vec<(&Started, usize)> {
        let apart = |one: &[f64], other: &[f64]| {
            let pairs = one.iter().zip(other).zip(sd);
            // Of a parameter held by a bound there is no standard error.
            pairs
                .filter(|(_, sd)| **sd > 0.0)
                .any(|((a, b), sd)| (a - b).abs() > APART * sd)
        };
        let as_good = |s: &&Started| 2.0 * (s.cost - self.cost) <= NOT_WORSE;
        let sound = self.starts.iter().filter(|s| s.ending.converged());
        let mut good: Vec<&Started> = sound.filter(as_good).collect();
        good.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut minima: Vec<(&Started, usize)> = Vec::new();
        for start in good {
            if !apart(&start.point, &self.point) {
                continue;
            }
            match minima
                .iter_mut()
                .find(|(known, _)| !apart(&start.point, &known.point))
            {
                Some((_, count)) => *count += 1,
                None => minima.push((start, 1)),
            }
        }
        minima
    }

    /// How many residuals are farther out than where the loss stops being a square.
    #[must_use]
    pub fn beyond_loss(&self) -> usize {
        let beyond = |r: &&f64| self.loss != Loss::Squares && r.abs() > self.loss.scale();
        self.residuals.iter().filter(beyond).count()
    }

    /// Whether a parameter is held by a bound.
    #[must_use]
    pub fn is_bound(&self, parameter: usize) -> bool {
        self.binding.iter().any(|b| b.parameter == parameter)
    }
}

/// Fits a problem.
///
/// # Errors
/// A parameter that cannot be free, fewer numbers than parameters, a model that
/// fails at every start, a parameter that changes nothing. A fit that did
/// not converge is no error: see [`Fit::ending`].
pub fn fit(problem: &dyn Problem, how: &Fitting) -> Result<Fit, FitError> {
    how.check()?;
    check(problem)?;
    let merit = Merit::new(problem, how.loss);
    let all: Vec<usize> = (0..problem.parameters().len()).collect();
    let starts = starts(problem.parameters(), how.starts, how.seed);
    let descent =
        |start: &Vec<f64>| Descent::new(merit.clone(), start.clone(), all.clone(), how.limits());
    let mut descents: Vec<Descent<'_>> = starts.iter().map(descent).collect();
    descents[0] = descent(&starts[0]).wary();
    let mut driven = drive(problem, descents);
    // What changes nothing where it starts may do so elsewhere.
    if changes_only_elsewhere(problem, &driven.reached[0])? {
        let again = drive(problem, vec![descent(&starts[0])]);
        driven.evaluations += again.evaluations;
        driven.reached.splice(..1, again.reached);
    }
    let best = (driven.reached.iter()).min_by(|a, b| a.cost().total_cmp(&b.cost()));
    let best = best.ok_or(FitError::NothingFree)?;
    started(problem, best)?;
    let mut fit = at_optimum(&merit, best)?;
    fit.evaluations += driven.evaluations;
    fit.starts = (starts.into_iter().zip(&driven.reached))
        .map(|(start, reached)| told(start, reached))
        .collect();
    Ok(fit)
}

/// Whether a descent ended at its start for a parameter without effect there that has
/// one at other values; an error if it has none anywhere.
fn changes_only_elsewhere(problem: &dyn Problem, reached: &Reached) -> Result<bool, FitError> {
    let Ending::ChangesNothing(k) = reached.ending else {
        return Ok(false);
    };
    if reached.iterations > 0 {
        return Ok(false);
    }
    let parameter = &problem.parameters()[k];
    let start = &reached.point;
    let elsewhere = |factor: &f64| {
        let mut point = start.clone();
        point[k] = (start[k] + factor * parameter.scale).clamp(parameter.lower, parameter.upper);
        point
    };
    let points: Vec<Vec<f64>> = ELSEWHERE.iter().map(elsewhere).collect();
    let here = reached.at.as_ref().map_or(&[][..], |at| &at.rows);
    let differs = |found: &Result<Residuals, ModelError>| {
        found.as_ref().is_ok_and(|found| {
            let pairs = found.standardised.iter().zip(here);
            let squares = pairs
                .map(|(there, here)| (there - here).powi(2))
                .sum::<f64>();
            squares.sqrt() >= NOTICED
        })
    };
    match problem.residuals(&points).iter().any(differs) {
        true => Ok(true),
        false => Err(nothing(problem, k, start)),
    }
}

/// How far from a start, in units of the scale, a parameter is tried.
const ELSEWHERE: [f64; 6] = [1.0, -1.0, 30.0, -30.0, 1e3, -1e3];

/// The fit at a point where nothing is left to be done, without descending.
fn at_optimum(merit: &Merit<'_>, best: &Reached) -> Result<Fit, FitError> {
    let problem = merit.problem;
    let Some(at) = &best.at else {
        return Err(FitError::NothingFree);
    };
    let here = (best.point.as_slice(), at);
    let (steps, known) = match &best.beside {
        Some(beside) => (&beside.steps, &beside.found[..]),
        None => (&best.steps, &[][..]),
    };
    let derived = jacobian(merit, here, steps, known);
    let (jacobian, slopes) = derived.map_err(|source| FitError::BesideOptimum {
        point: best.point.clone(),
        source,
    })?;
    changes_something(problem.parameters(), &best.point, &jacobian)?;
    let linear = merit.linear(at, &slopes);
    let binding = binding(problem.parameters(), &best.point, &linear.gradient);
    let sized = sized(problem.parameters(), &best.point);
    Ok(Fit {
        rank: directions(&sized, &jacobian, &binding).len(),
        point: best.point.clone(),
        cost: at.cost,
        residuals: at.rows[..problem.residual_count()].to_vec(),
        ln_sigmas: at.ln_sigmas.iter().sum(),
        ending: ending(problem.parameters(), best, (&linear, &jacobian), &binding),
        binding,
        evaluations: 4 * best.point.len() - known.len(),
        jacobian,
        starts: Vec::new(),
        loss: merit.loss,
    })
}

fn started(problem: &dyn Problem, reached: &Reached) -> Result<(), FitError> {
    match (&reached.at, &reached.ending) {
        (None, Ending::ModelFails(error)) => Err(FitError::Start(at_values(
            problem.parameters(),
            &reached.point,
            error,
        ))),
        (_, Ending::ChangesNothing(k)) => Err(nothing(problem, *k, &reached.point)),
        _ => Ok(()),
    }
}

/// What a model said, with the values that it said it of.
fn at_values(parameters: &[Parameter], point: &[f64], error: &ModelError) -> ModelError {
    let values = parameters.iter().zip(point).take(NAMED);
    let values = values.map(|(p, value)| format!("{} = {value:.4e} {}", p.name, p.unit));
    let values: Vec<String> = values.map(|told| told.trim_end().to_owned()).collect();
    let more = match parameters.len() > NAMED {
        true => ", …",
        false => "",
    };
    ModelError(format!(
        "with {}{more}: {error}. Start elsewhere (--start, in SI or with a unit)",
        values.join(", ")
    ))
}

/// Most values that are named.
const NAMED: usize = 6;

fn nothing(problem: &dyn Problem, parameter: usize, point: &[f64]) -> FitError {
    FitError::ChangesNothing {
        name: problem.parameters()[parameter].name.clone(),
        value: point[parameter],
    }
}

fn told(start: Vec<f64>, reached: &Reached) -> Started {
    Started {
        start,
        point: reached.point.clone(),
        cost: reached.cost(),
        ending: reached.ending.clone(),
        iterations: reached.iterations,
    }
}

/// Checks parameters and their number.
pub(crate) fn check(problem: &dyn Problem) -> Result<(), FitError> {
    let parameters = problem.parameters();
    if parameters.is_empty() {
        return Err(FitError::NothingFree);
    }
    for (k, parameter) in parameters.iter().enumerate() {
        parameter.check()?;
        if parameters[..k].iter().any(|p| p.name == parameter.name) {
            let name = parameter.name.clone();
            return Err(FitError::Twice { name });
        }
    }
    let priors = parameters.iter().filter(|p| p.prior != Prior::Flat).count();
    let (data, parameters) = (problem.residual_count(), parameters.len());
    if data == 0 || data + priors < parameters {
        return Err(FitError::TooFew {
            data,
            priors,
            parameters,
        });
    }
    Ok(())
}

/// Change of all residuals together, in σ, that a change by a parameter's whole
/// scale must exceed to count as one.
const NO_CHANGE: f64 = 1e-6;

fn changes_something(
    parameters: &[Parameter],
    point: &[f64],
    jacobian: &Jacobian,
) -> Result<(), FitError> {
    for (k, parameter) in parameters.iter().enumerate() {
        let data = &jacobian.columns[k][..jacobian.data_rows];
        if norm(data) * parameter.scale < NO_CHANGE {
            let (name, value) = (parameter.name.clone(), point[k]);
            return Err(FitError::ChangesNothing { name, value });
        }
    }
    Ok(())
}

fn binding(parameters: &[Parameter], point: &[f64], gradient: &[f64]) -> Vec<Binding> {
    let held = |k: usize| {
        let (parameter, push) = (&parameters[k], -gradient[k]);
        let outward = (point[k] <= parameter.lower && push < 0.0)
            || (point[k] >= parameter.upper && push > 0.0);
        outward.then_some(Binding {
            parameter: k,
            bound: point[k],
            push: push.abs(),
        })
    };
    (0..point.len()).filter_map(held).collect()
}
