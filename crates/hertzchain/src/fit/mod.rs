//! `fit`: times of flight to parameters.

mod alternatives;
mod checkpoint;
mod limits;
mod more;
pub mod pulses;
mod results;
mod tables;
mod validation;

pub(crate) use self::tables::tables_of_any;
pub use self::{
    alternatives::{AlternativeModel, AlternativeModels, Unfitted},
    checkpoint::{CHAIN, finished, leave, saved},
    limits::Limit,
    more::{Curves, More, Sampled},
    results::{inferred, joined, json, rows_json},
    tables::tables,
};

use crate::failure::Failure;
use crate::inference::{self, check_cancelled, user};
use crate::options::FitOptions as Arguments;
use hertzchain_experiment::Experiment;
use hertzchain_infer::{
    Advice, Covariance, CurveProblem, Data, Fit, FitCurve, Fitting, FreeNumber, Goodness,
    Identifiability, Loss, MeasuredCurve, Observable, Parameter, Prior, Problem, Started,
    fit as least_squares,
};

/// Residuals beyond so many standard errors count by their size when outliers are expected.
const OUTLIER: f64 = 1.345;

/// Share of a normal distribution within one standard error of its mean.
pub(crate) const SHARE_OF_A_STANDARD_ERROR: f64 = 0.682_689_5;

/// Difference of costs above which two minima are different.
const SAME_COST: f64 = 0.01;

/// What any fit determines.
pub struct Inferred {
    /// The free parameters.
    pub parameters: Vec<Parameter>,
    /// The best fit.
    pub fit: Fit,
    /// Its covariance.
    pub covariance: Covariance,
    /// How well it describes the data.
    pub goodness: Goodness,
    /// What the data determine.
    pub identifiability: Identifiability,
    /// Uncertainty beyond the covariance.
    pub more: More,
    /// Of parameters at bounds.
    pub limits: Result<Vec<Limit>, String>,
}

/// Everything about a fit of a curve.
pub struct FitResult {
    /// What was fitted.
    pub problem: CurveProblem,
    /// What came of it.
    pub inferred: Inferred,
    /// The models at the best fit, one a table.
    pub curves: Vec<FitCurve>,
    /// Largest relative error of the model's times of flight there.
    pub accuracy: f64,
    /// What would settle what the data leave open, if they leave anything open.
    pub advice: Option<Advice>,
    /// Other models of the same data.
    pub alternatives: Option<AlternativeModels>,
    /// The unit that speeds of a table seem to be in, where the model does not follow and they seem
    /// not to be in m/s.
    pub unit_of_speed: Option<(String, &'static str)>,
}

/// A table of a fit and what the fit makes of it.
pub struct TableFit<'a> {
    /// The data and their model.
    pub curve: &'a MeasuredCurve,
    /// The model at the best fit.
    pub fit_curve: &'a FitCurve,
    /// Place of its first residual.
    pub first: usize,
    /// Its residuals.
    pub residuals: &'a [f64],
}

impl TableFit<'_> {
    /// Sum of its squared residuals.
    pub fn chi_square(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }
}

impl Inferred {
    /// Adds what the data determine, and limits of parameters at bounds.
    fn new(
        problem: &dyn Problem,
        (fit, covariance, more): (Fit, Covariance, More),
        goodness: Goodness,
        label: impl Fn(usize) -> String,
    ) -> Result<Self, Failure> {
        let parameters = problem.parameters().to_vec();
        let identifiability = Identifiability::new(&parameters, &fit, label);
        let limits = limits::limits(problem, (&fit, &covariance), &identifiability, &more)?;
        Ok(Self { parameters, fit, covariance, goodness, identifiability, more, limits })
    }

    /// Standard error of a parameter by the covariance; infinite where the data leave
    /// the parameter open, however finite a linear analysis may be.
    pub fn standard_error(&self, at: usize) -> f64 {
        let sd = self.covariance.sd[at];
        match self.identifiability.leaves_open(at, sd) {
            true => f64::INFINITY,
            false => sd,
        }
    }

    /// Whether priors determine what the data leave open.
    pub(crate) fn is_closed_by_priors(&self) -> bool {
        let any = self.parameters.iter().any(|parameter| parameter.prior != Prior::Flat);
        any && (0..self.parameters.len()).all(|at| self.standard_error(at).is_finite())
    }

    /// Minima of other starts that fit as well, and how many starts came to each.
    pub(crate) fn other_minima(&self) -> Vec<(&Started, usize)> {
        let sd: Vec<f64> = (0..self.parameters.len()).map(|at| self.standard_error(at)).collect();
        self.fit.other_minima(&sd)
    }

    /// How far from its bound a parameter may be, if it lies there.
    pub(crate) fn limit(&self, at: usize) -> Option<&Limit> {
        let limits = self.limits.as_ref().ok()?;
        limits.iter().find(|limit| limit.parameter == at)
    }
}

impl FitResult {
    /// The tables, in the order of the pairs that were fitted.
    pub fn tables<'a>(&'a self) -> Vec<TableFit<'a>> {
        let mut end = 0;
        let table = |(curve, fit_curve): (&'a MeasuredCurve, &'a FitCurve)| {
            let first = end;
            end += curve.data.value_count();
            TableFit {
                residuals: &self.inferred.fit.residuals[first..end],
                curve,
                fit_curve,
                first,
            }
        };
        self.problem.curves.iter().zip(&self.curves).map(table).collect()
    }

    /// What was done beyond what was asked for, so that the fit found the minimum, one sentence
    /// each.
    pub(crate) fn unasked(&self, arguments: &Arguments) -> Vec<String> {
        let accuracy = (arguments.modelled.accuracy.0, self.problem.model().accuracy);
        unasked(&self.inferred.fit, accuracy, arguments.starts.0)
    }

    /// That several pairs of K and A may give the data, where both are free and two times of
    /// flight a pair are all that was measured, and how to look for them; nothing if the fit
    /// had several starts.
    pub(crate) fn pair_warning(&self) -> Option<String> {
        let numbers = &self.problem.model().numbers;
        let of = |number: &FreeNumber, short: &str| {
            let (owner, name) = number.name().rsplit_once('.').unwrap_or(("", number.name()));
            (name == short).then(|| owner.to_owned())
        };
        let owners: Vec<String> = numbers.iter().filter_map(|n| of(n, "K")).collect();
        let pair = |n: &&FreeNumber| of(n, "A").is_some_and(|owner| owners.contains(&owner));
        let relaxation = numbers.iter().find(pair)?;
        let data = self.problem.data();
        let pairs = relaxation.parameter_count(data.rows.len());
        let ratios = [Observable::WallOverPassing, Observable::ReturningOverPassing];
        let times_alone = !ratios.iter().any(|of| data.has(*of));
        let few = times_alone && data.value_count() <= 2 * pairs;
        let alone = self.curves.len() == 1 && self.inferred.fit.starts.len() == 1;
        (few && alone).then(|| {
            "Several pairs of K and A may give the same two times of flight, and this fit looked for one: see whether \
             others fit as well by --starts with --bounds of both, or by `hertzchain gauge`, which follows all pairs"
                .to_owned()
        })
    }
}

/// Starts of a fit whose first came to a minimum that the data reject, and most free
/// parameters for which they are tried.
const UNASKED: usize = 8;
const FEW: usize = 8;

/// Half of the difference of χ² of minima that fit as well as each other.
const HARDLY_BETTER: f64 = 4.5;

/// The best fit, as asked; where chance can't be why the data are so far from it, the best of
/// several starts: a minimum may be another than the data's. One that is hardly better than the
/// first is none to prefer: the first is what the model's own numbers lead to.
fn best_of_starts(problem: &dyn Problem, nuisances: usize, how: &Fitting) -> Result<Fit, Failure> {
    let found = least_squares(problem, how);
    check_cancelled()?;
    let first = found.map_err(user)?;
    let one = how.starts == 1 && how.loss == Loss::Squares && first.point.len() <= FEW;
    if !one || !Goodness::with_nuisances(nuisances, problem, &first).is_rejected() {
        return Ok(first);
    }
    let starts = UNASKED;
    let found = least_squares(problem, &Fitting { starts, ..*how });
    check_cancelled()?;
    Ok(match found {
        Ok(found) if first.ending.converged() && first.cost - found.cost < HARDLY_BETTER => {
            Fit { starts: found.starts, ..first }
        }
        Ok(found) => found,
        Err(_) => first,
    })
}

/// What was done beyond what was asked for, so that a fit found the minimum, one sentence each:
/// of the accuracy asked for and of that reached, and of the starts asked for.
fn unasked(fit: &Fit, (asked, reached): (f64, f64), starts: usize) -> Vec<String> {
    let finer = (reached < asked).then(|| {
        format!(
            "Curves were computed to {reached:.0e} in place of {asked:.0e}, to which the fit found no minimum"
        )
    });
    let first = fit.starts.first().map_or(fit.cost, |start| start.cost);
    let more = (fit.starts.len() > starts).then(|| {
        let found = match first > fit.cost + SAME_COST {
            true => "one of them came to a better one, above",
            false => "none came to a better one",
        };
        format!(
            "The data reject the minimum that the first start came to, so {} others were tried; {found}",
            fit.starts.len() - starts
        )
    });
    finer.into_iter().chain(more).collect()
}

/// Times that a fit without a minimum is repeated with curves ten times as accurate.
const MOST_FINER: u32 = 2;

/// The best fit, with the problem that it is of: with more accurate curves, where others have no
/// minimum. Errors of curves jump where the solver takes another number of steps, and hide what is
/// small.
fn best_fit<P: Problem>(
    mut problem: P,
    nuisances: usize,
    how: &Fitting,
    finer: impl Fn(P) -> P,
) -> Result<(P, Fit), Failure> {
    let mut fit = best_of_starts(&problem, nuisances, how)?;
    for _ in 0..MOST_FINER {
        if !fit.ending.converged() {
            problem = finer(problem);
            fit = best_of_starts(&problem, nuisances, how)?;
        }
    }
    Ok((problem, fit))
}

/// The same curves, ten times as accurate.
fn finer(problem: CurveProblem) -> CurveProblem {
    let accuracy = 0.1 * problem.model().accuracy;
    problem.with_accuracy(accuracy)
}

fn fit_settings(arguments: &Arguments) -> Fitting {
    Fitting {
        loss: match arguments.robust {
            true => Loss::Huber { scale: OUTLIER },
            false => Loss::Squares,
        },
        starts: arguments.starts.0,
        seed: arguments.seed,
        ..Fitting::default()
    }
}

/// Fits the free numbers of an experiment to times of flight in memory.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let row = preset("dry")?;
/// let table = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n\
///              0.2,1e-4,9.030e-4,2e-7\n0.5,1e-4,7.565e-4,2e-7\n1.0,1e-4,6.829e-4,2e-7\n";
/// let options = FitOptions::free(["eta"]);
/// let data = inference::parsed("table", table, &options.measured, None)?;
/// let found = fit(&data, &row, &options)?;
/// assert_eq!(found.inferred.parameters[0].name, "eta");
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// Options, data and model that do not fit together; what is in the way of a fit.
pub fn fit(
    data: &Data,
    experiment: &Experiment,
    options: &Arguments,
) -> Result<FitResult, Failure> {
    fit_tables(&[(data.clone(), experiment.clone())], options)
}

/// Fits several tables together, each to its own experiment: free numbers of one name are one
/// parameter, but for those that [`own`](Arguments::own) names.
///
/// # Errors
/// As [`fit`].
pub fn fit_tables(pairs: &[(Data, Experiment)], options: &Arguments) -> Result<FitResult, Failure> {
    fit_result(inference::joint_problem(pairs, options)?, options)
}

/// Fits curves, determines the uncertainty as the method asks, and compares with
/// other models.
///
/// # Errors
/// What is in the way of a fit.
pub fn fit_result(problem: CurveProblem, arguments: &Arguments) -> Result<FitResult, Failure> {
    validation::of_table(arguments)?;
    let (problem, fit) = best_fit(problem, 0, &fit_settings(arguments), finer)?;
    let covariance = Covariance::new(problem.parameters(), &fit);
    let more = more::more(&problem, (&fit, &covariance), arguments)?;
    concluded(problem, None, (fit, covariance, more), arguments)
}

/// The same where `computed` has the problem's residuals from elsewhere, such as
/// [`Spread`](hertzchain_infer::Spread): every curve of a posterior is computed, as
/// with `--direct`.
///
/// # Errors
/// As [`fit_result`].
pub fn fit_from_other_starts(
    problem: CurveProblem,
    computed: &dyn Problem,
    arguments: &Arguments,
) -> Result<FitResult, Failure> {
    validation::of_table(arguments)?;
    let fit = best_of_starts(computed, 0, &fit_settings(arguments))?;
    let covariance = Covariance::new(computed.parameters(), &fit);
    let more =
        more::more_of(computed, computed, (&fit, &covariance), Curves::Computed(None), arguments)?;
    concluded(problem, Some(computed), (fit, covariance, more), arguments)
}

/// Adds what else takes many curves, limits at bounds and other models, by residuals from elsewhere
/// if there are such; and the curves at the best fit.
fn concluded(
    problem: CurveProblem,
    computed: Option<&dyn Problem>,
    found: (Fit, Covariance, More),
    arguments: &Arguments,
) -> Result<FitResult, Failure> {
    let computed = computed.unwrap_or(&problem);
    let goodness = Goodness::new(&problem, &found.0);
    let inferred = Inferred::new(computed, found, goodness, |at| problem.residual_label(at))?;
    let alternatives = alternatives::alternatives((&problem, computed), &inferred.fit, arguments)?;
    let (fit, covariance) = (&inferred.fit, &inferred.covariance);
    let all = &problem.curves;
    let alone = all.len() == 1 && fit.ending.converged() && !inferred.is_closed_by_priors();
    let open = !inferred.identifiability.unidentifiable.is_empty() && alone;
    let curves = all.iter().map(|curve| curve.fit_curve(fit, covariance));
    let accuracies = all.iter().map(|curve| curve.accuracy_reached(&fit.point));
    let accuracies = accuracies.collect::<Result<Vec<f64>, _>>().map_err(user)?;
    let start: Vec<f64> = inferred.parameters.iter().map(|p| p.start).collect();
    let unit =
        |curve: &MeasuredCurve| Some((curve.data.file.clone(), curve.other_unit_of_speed(&start)?));
    let rejected = inferred.goodness.is_rejected();
    Ok(FitResult {
        unit_of_speed: rejected.then(|| all.iter().find_map(unit)).flatten(),
        advice: open.then(|| problem.suggested_measurements(fit)),
        curves: curves.collect::<Result<_, _>>().map_err(user)?,
        accuracy: accuracies.into_iter().fold(0.0, f64::max),
        alternatives,
        inferred,
        problem,
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/mod.rs"]
mod tests;
