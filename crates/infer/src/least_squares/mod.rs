//! Best fits by nonlinear least squares.

mod descent;
mod merit;

pub use descent::Ending;
pub(crate) use descent::{Descent, DescentLimits, run};
pub(crate) use merit::{EXTRAPOLATED, JUMPING, Merit, ROUNDING, jacobian_at};
pub use merit::{Jacobian, Loss};

use crate::identify::{directions, is_weak, sized};
use crate::linear::{dot, norm, svd};
use crate::random::{Purpose, RandomStream};
use crate::{InferError, ModelError, Parameter, Prior, Problem, Residuals};
use descent::{NOTICED, SMALL_FALL};
use merit::{Linear, jacobian};

/// Options of [`fit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitting {
    /// What a residual costs.
    pub loss: Loss,
    /// Number of starts: the first where the parameters start, others spread over what priors and
    /// bounds allow.
    pub starts: usize,
    /// Seed of these others.
    pub seed: u64,
    /// Expected fall of χ²/2 at which the minimum counts as reached.
    pub tolerance: f64,
    /// Most iterations of a start.
    pub iterations: usize,
}

impl Default for Fitting {
    fn default() -> Self {
        Self { loss: Loss::Squares, starts: 1, seed: 0, tolerance: 1e-9, iterations: 200 }
    }
}

impl Fitting {
    fn check(&self) -> Result<(), InferError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let (tolerance, scale) = (self.tolerance, self.loss.scale());
        match () {
            () if self.starts == 0 => {
                InferError::input("number of starts is 0: expected at least 1")
            }
            () if !positive(tolerance) => {
                InferError::input(format!("tolerance is {tolerance}: expected a positive number"))
            }
            () if !positive(scale) => InferError::input(format!(
                "scale of the loss is {scale}: expected a positive number of σ"
            )),
            () => Ok(()),
        }
    }

    pub(crate) fn limits(&self) -> DescentLimits {
        DescentLimits { tolerance: self.tolerance, share: 0.0, iterations: self.iterations }
    }
}

/// The best fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The parameters' values, in their units.
    pub point: Vec<f64>,
    /// ½ Σ ρ(r²) + Σ ln σ + ½ Σ (prior residual)²: minus the logarithm of likelihood and priors,
    /// up to a constant.
    pub cost: f64,
    /// Standardised residuals of the data.
    pub residuals: Vec<f64>,
    /// Residuals of the priors, in their standard deviations.
    pub priors: Vec<f64>,
    /// Degrees of freedom of the data's σ; infinite where they are known.
    pub freedoms: Vec<f64>,
    /// Σ ln σ of the data; 0 if no σ depends on the parameters.
    pub ln_sigmas: f64,
    /// Derivatives at the optimum.
    pub jacobian: Jacobian,
    /// Number of combinations of the parameters that data and priors determine.
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
    pub fn chi_square(&self) -> f64 {
        dot(&self.residuals, &self.residuals)
    }

    /// How many of the starts came to this minimum: within 0.01 of its cost.
    pub fn agreeing_starts(&self) -> usize {
        let agrees = |s: &&Started| s.cost <= self.cost + SAME_COST;
        self.starts.iter().filter(agrees).count()
    }

    /// Minima that other starts came to and that fit as well: their χ² lies at most 9 above the
    /// best, and some parameter differs by more than three of these standard errors from the best
    /// minimum and from those before. Best first; each with the number of its starts.
    pub fn other_minima(&self, sd: &[f64]) -> Vec<(&Started, usize)> {
        let apart = |one: &[f64], other: &[f64]| {
            // A parameter held by a bound has no standard error.
            let mut pairs = one.iter().zip(other).zip(sd).filter(|(_, sd)| **sd > 0.0);
            pairs.any(|((a, b), sd)| (a - b).abs() > APART * sd)
        };
        let as_good = |s: &&Started| {
            s.ending.converged()
                && 2.0 * (s.cost - self.cost) <= NOT_WORSE
                && apart(&s.point, &self.point)
        };
        let mut good: Vec<&Started> = self.starts.iter().filter(as_good).collect();
        good.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut minima: Vec<(&Started, usize)> = Vec::new();
        for start in good {
            let mut known = minima.iter_mut();
            match known.find(|(known, _)| !apart(&start.point, &known.point)) {
                Some((_, count)) => *count += 1,
                None => minima.push((start, 1)),
            }
        }
        minima
    }

    /// How many residuals are farther out than where the loss stops being a square.
    pub fn beyond_loss(&self) -> usize {
        let beyond = |r: &&f64| self.loss != Loss::Squares && r.abs() > self.loss.scale();
        self.residuals.iter().filter(beyond).count()
    }

    /// Whether a parameter is held by a bound.
    pub fn is_bound(&self, parameter: usize) -> bool {
        self.binding.iter().any(|b| b.parameter == parameter)
    }
}

/// Fits a problem.
///
/// # Errors
/// A parameter that cannot be free, fewer numbers than parameters, a model that fails at every
/// start, a parameter that changes nothing. A fit that did not converge is no error: see
/// [`Fit::ending`].
pub fn fit(problem: &dyn Problem, how: &Fitting) -> Result<Fit, InferError> {
    how.check()?;
    check(problem)?;
    let merit = Merit::new(problem, how.loss);
    let all: Vec<usize> = (0..problem.parameters().len()).collect();
    let starts = starts(problem.parameters(), how.starts, how.seed);
    let descent =
        |start: &Vec<f64>| Descent::new(merit.clone(), start.clone(), all.clone(), how.limits());
    let mut descents: Vec<Descent<'_>> = starts.iter().map(descent).collect();
    descents[0] = descent(&starts[0]).checking_start();
    let mut evaluations = run(problem, &mut descents);
    // A parameter that changes nothing where it starts may do so elsewhere.
    if changes_only_elsewhere(problem, &descents[0])? {
        descents[0] = descent(&starts[0]);
        evaluations += run(problem, &mut descents[..1]);
    }
    let best = descents.iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
    let best = best.ok_or_else(nothing_free)?;
    let mut fit = at_optimum(&merit, best)?;
    fit.evaluations += evaluations;
    let pairs = starts.into_iter().zip(&descents);
    fit.starts = pairs
        .map(|(start, reached)| Started {
            start,
            point: reached.point.clone(),
            cost: reached.cost(),
            ending: reached.ending(),
            iterations: reached.iterations,
        })
        .collect();
    Ok(fit)
}

fn nothing_free() -> InferError {
    InferError::Input("no parameter is free: name at least one".into())
}

fn changes_nothing(problem: &dyn Problem, k: usize, point: &[f64]) -> InferError {
    let name = problem.parameters()[k].name.clone();
    InferError::ChangesNothing { name, value: point[k] }
}

/// How far from a start, in units of the scale, a parameter without effect is tried.
const ELSEWHERE: [f64; 6] = [1.0, -1.0, 30.0, -30.0, 1e3, -1e3];

/// Whether a descent ended at its start for a parameter without effect there that has one at other
/// values; an error if it has none anywhere.
fn changes_only_elsewhere(
    problem: &dyn Problem,
    reached: &Descent<'_>,
) -> Result<bool, InferError> {
    let Ending::ChangesNothing(k) = reached.ending() else {
        return Ok(false);
    };
    if reached.iterations > 0 {
        return Ok(false);
    }
    let parameter = &problem.parameters()[k];
    let elsewhere = |factor: &f64| {
        let mut point = reached.point.clone();
        point[k] = (point[k] + factor * parameter.scale).clamp(parameter.lower, parameter.upper);
        point
    };
    let points: Vec<Vec<f64>> = ELSEWHERE.iter().map(elsewhere).collect();
    let here = reached.at.as_ref().map_or(&[][..], |at| &at.rows);
    let differs = |found: Result<Residuals, ModelError>| {
        found.is_ok_and(|found| {
            let pairs = found.standardised.iter().zip(here);
            let squares: f64 = pairs.map(|(there, here)| (there - here).powi(2)).sum();
            squares.sqrt() >= NOTICED
        })
    };
    match problem.residuals(&points).into_iter().any(differs) {
        true => Ok(true),
        false => Err(changes_nothing(problem, k, &reached.point)),
    }
}

/// Change of all residuals together, in σ, that a change by a parameter's whole scale must exceed.
const NO_CHANGE: f64 = 1e-6;

/// The fit at the end of a descent.
fn at_optimum(merit: &Merit<'_>, best: &Descent<'_>) -> Result<Fit, InferError> {
    let (problem, point) = (merit.problem, &best.point);
    let parameters = problem.parameters();
    let at = match (&best.at, best.ending()) {
        (_, Ending::ChangesNothing(k)) => return Err(changes_nothing(problem, k, point)),
        (Some(at), _) => at,
        (None, Ending::ModelFails(error)) => return Err(start_fails(parameters, point, &error)),
        (None, _) => return Err(nothing_free()),
    };
    let (steps, known) = match &best.around {
        Some((steps, found)) => (steps, &found[..]),
        None => (&best.steps, &[][..]),
    };
    let (jacobian, slopes) = jacobian(merit, (point, at), steps, known).map_err(|error| {
        let values = named(parameters, point);
        InferError::Model(format!(
            "the fit came to {values}, next to which the model fails: {error}"
        ))
    })?;
    let no_change = |k: &usize| {
        norm(&jacobian.columns[*k][..jacobian.data_rows]) * parameters[*k].scale < NO_CHANGE
    };
    if let Some(k) = (0..point.len()).find(no_change) {
        return Err(changes_nothing(problem, k, point));
    }
    let linear = merit.linear(at, &slopes);
    let binding = binding(parameters, point, &linear.gradient);
    Ok(Fit {
        rank: directions(&sized(parameters, point), &jacobian, &binding).len(),
        point: point.clone(),
        cost: at.cost,
        residuals: at.rows[..problem.residual_count()].to_vec(),
        priors: at.rows[problem.residual_count()..].to_vec(),
        freedoms: (problem.freedoms(point).ok().flatten())
            .unwrap_or_else(|| vec![f64::INFINITY; problem.residual_count()]),
        ln_sigmas: at.ln_sigmas.iter().sum(),
        ending: ending(parameters, best, (&linear, &jacobian), &binding),
        binding,
        evaluations: 4 * point.len() - known.len(),
        jacobian,
        starts: Vec::new(),
        loss: merit.loss,
    })
}

/// Most values that a message names.
const NAMED: usize = 6;

/// Parameters with their values and units.
fn named(parameters: &[Parameter], point: &[f64]) -> String {
    let values = parameters.iter().zip(point).take(NAMED);
    let values = values.map(|(p, v)| format!("{} = {v:.4e} {}", p.name, p.unit).trim_end().into());
    let values: Vec<String> = values.collect();
    let more = if parameters.len() > NAMED { ", …" } else { "" };
    values.join(", ") + more
}

fn start_fails(parameters: &[Parameter], point: &[f64], error: &ModelError) -> InferError {
    InferError::Model(format!(
        "no residuals at the start: with {}: {error}. Start elsewhere (--start, in SI or with a unit)",
        named(parameters, point)
    ))
}

pub(crate) fn check(problem: &dyn Problem) -> Result<(), InferError> {
    let parameters = problem.parameters();
    if parameters.is_empty() {
        return Err(nothing_free());
    }
    for (k, parameter) in parameters.iter().enumerate() {
        parameter.check()?;
        let name = &parameter.name;
        if parameters[..k].iter().any(|p| p.name == *name) {
            return InferError::input(format!("{name} is free twice: name every parameter once"));
        }
    }
    let priors = parameters.iter().filter(|p| p.prior != Prior::Flat).count();
    let (data, parameters) = (problem.residual_count(), parameters.len());
    match data == 0 || data + priors < parameters {
        true => InferError::input(format!(
            "{data} measured numbers and {priors} priors cannot determine {parameters} parameters: measure more, or free fewer"
        )),
        false => Ok(()),
    }
}

fn binding(parameters: &[Parameter], point: &[f64], gradient: &[f64]) -> Vec<Binding> {
    let held = |k: usize| {
        let (parameter, push) = (&parameters[k], -gradient[k]);
        let outward = (point[k] <= parameter.lower && push < 0.0)
            || (point[k] >= parameter.upper && push > 0.0);
        outward.then_some(Binding { parameter: k, bound: point[k], push: push.abs() })
    };
    (0..point.len()).filter_map(held).collect()
}

/// Disagreement of derivatives by two step sizes from which they do not locate a minimum.
pub(crate) const DOUBTFUL: f64 = 0.1;

/// Why a descent ended, given derivatives by two step sizes: one that came to no rest has converged
/// if all that χ² is still to fall lies along unidentifiable directions. There a descent's own
/// derivatives are noise, and the minimum is a line.
fn ending(
    parameters: &[Parameter],
    best: &Descent<'_>,
    (linear, jacobian): (&Linear, &Jacobian),
    binding: &[Binding],
) -> Ending {
    let ending = best.ending();
    let is_restless = matches!(ending, Ending::Stuck { .. } | Ending::Iterations { .. });
    if !is_restless || jacobian.worst_disagreement() > DOUBTFUL {
        return ending;
    }
    let sizes = sized(parameters, &best.point);
    let is_loose = |k: &usize| binding.iter().all(|b| b.parameter != *k);
    let loose = (0..parameters.len()).filter(is_loose).map(|k| Loose {
        column: linear.columns[k].iter().map(|x| x * sizes[k].scale).collect(),
        slope: linear.gradient[k] * sizes[k].scale,
        doubt: ROUNDING + EXTRAPOLATED * jacobian.disagreement[k],
    });
    match determined_fall(&loose.collect::<Vec<_>>()) {
        Some(expected_fall) if expected_fall < SMALL_FALL => Ending::Open { expected_fall },
        _ => ending,
    }
}

/// A parameter that no bound holds, in units of its size.
struct Loose {
    column: Vec<f64>,
    /// Slope of the cost.
    slope: f64,
    /// Share of the column's length that it may be wrong by.
    doubt: f64,
}

/// Expected fall of the cost along determined combinations; `None` if that is all of them.
fn determined_fall(loose: &[Loose]) -> Option<f64> {
    let columns: Vec<Vec<f64>> = loose.iter().map(|one| one.column.clone()).collect();
    let errors: Vec<f64> = loose.iter().map(|one| one.doubt * norm(&one.column)).collect();
    let (floor, found) = (norm(&errors), svd(&columns));
    let slopes: Vec<f64> = loose.iter().map(|one| one.slope).collect();
    let pairs = found.values.iter().zip(&found.right);
    let known = pairs.filter(|(value, _)| !is_weak(**value, floor));
    let falls = known.map(|(value, direction)| 0.5 * (dot(direction, &slopes) / value).powi(2));
    let falls: Vec<f64> = falls.collect();
    (falls.len() < loose.len()).then(|| falls.iter().sum())
}

/// Two bounds of one sign farther apart than this are spread over by logarithm.
const WIDE_RATIO: f64 = 10.0;
/// Factor to either side of a positive number that has no two bounds; scales to either side of one
/// with bounds of both signs.
const AROUND: f64 = 10.0;

/// `count` points: first where the parameters start, then seeded ones: from the prior if there is
/// one, else between the bounds if both exist, else by the logarithm around a positive start, else
/// a normal number as wide as the scale; never beyond a bound. Bounds of both signs are spread over
/// up to ten scales from the start: an exponent of 5 makes a contact's number absurd at slow shots.
fn starts(parameters: &[Parameter], count: usize, seed: u64) -> Vec<Vec<f64>> {
    let spread = |p: &Parameter, random: &mut RandomStream| {
        let value = match p.prior {
            Prior::Normal { mean, sd } => mean + sd * random.normal(),
            Prior::LogNormal { median, ln_sd } => median * (ln_sd * random.normal()).exp(),
            Prior::Flat
                if p.lower > 0.0 && p.upper.is_finite() && p.upper > WIDE_RATIO * p.lower =>
            {
                p.lower * (p.upper / p.lower).powf(random.uniform())
            }
            Prior::Flat if p.lower.is_finite() && p.upper.is_finite() => {
                let most = if p.lower < 0.0 { AROUND * p.scale } else { f64::INFINITY };
                let (lower, upper) = (p.lower.max(p.start - most), p.upper.min(p.start + most));
                lower + (upper - lower) * random.uniform()
            }
            Prior::Flat if p.lower >= 0.0 && p.start > 0.0 => {
                p.start * AROUND.powf(2.0 * random.uniform() - 1.0)
            }
            Prior::Flat => p.start + p.scale * random.normal(),
        };
        value.clamp(p.lower, p.upper)
    };
    let first = parameters.iter().map(|p| p.start).collect();
    let others = (1..count).map(|number| {
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        let mut random = RandomStream::new(seed, Purpose::Start(number));
        parameters.iter().map(|p| spread(p, &mut random)).collect()
    });
    std::iter::once(first).chain(others).collect()
}

#[cfg(test)]
#[path = "tests/ending.rs"]
mod tests;
