//! Model comparison: information criteria and cross-validation.

use crate::goodness::{LEAST_BY_CHANCE, chi_square_of_fit};
use crate::least_squares::{Descent, Merit, run};
use crate::random::{Purpose, RandomStream};
use crate::{Fit, Fitting, InferError, Loss, Problem};
use hertzchain_measure::signal::ChiSquare;

/// Information criteria of one model: small is good, and only differences between models of the
/// same data mean something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Fitted combinations of parameters.
    pub parameters: usize,
    /// Measured numbers and priors.
    pub data: usize,
    /// Chi-square of data and priors; `None` if no freedom is left.
    pub chi_square: Option<ChiSquare>,
    /// −2 ln likelihood of data and priors at the optimum, up to a constant of them.
    pub deviance: f64,
    /// Deviance + 2 parameters [Akaike1974].
    pub aic: f64,
    /// AIC + 2 k (k + 1)/(n − k − 1) for k parameters and n data [HurvichTsai1989]; infinite if
    /// n ≤ k + 1.
    pub aicc: f64,
    /// Deviance + parameters × ln data [Schwarz1978].
    pub bic: f64,
}

impl Criteria {
    /// Of a fit by least squares; combinations of parameters that nothing determines, and
    /// parameters held by a bound, do not count.
    pub fn new(fit: &Fit) -> Self {
        let (data, parameters) = (fit.residuals.len() + fit.priors.len(), fit.rank);
        let (n, k) = (data as f64, parameters as f64);
        let deviance = 2.0 * fit.cost;
        let aic = deviance + 2.0 * k;
        let freedom = n - k - 1.0;
        let small = match freedom > 0.0 {
            true => 2.0 * k * (k + 1.0) / freedom,
            false => f64::INFINITY,
        };
        Self {
            parameters,
            data,
            chi_square: chi_square_of_fit(fit, parameters),
            deviance,
            aic,
            aicc: aic + small,
            bic: deviance + k * n.ln(),
        }
    }

    /// Whether the data reject the model (p < 0.001).
    pub(crate) fn is_rejected(&self) -> bool {
        self.chi_square.is_some_and(|found| found.probability < LEAST_BY_CHANCE)
    }
}

/// A model to be compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its fit.
    pub fit: &'a Fit,
    /// Its errors of prediction, with the same folds as the others'.
    pub cross_validation: Option<&'a CrossValidation>,
}

/// Models of the same data, best first.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Places in the list given, by AICc.
    pub order: Vec<usize>,
    /// Criteria, in the order given.
    pub criteria: Vec<Criteria>,
    /// AICc above the best model's, in the order given.
    pub aicc_above_best: Vec<f64>,
    /// Akaike weights exp(−Δ/2)/Σ, in the order given.
    pub weights: Vec<f64>,
    /// The model that the data favour; `None` where they reject even the best, or do not decide.
    pub favoured: Option<usize>,
    /// Which model is supported and by how much.
    pub sentence: String,
}

/// Difference of AICc below which models are not distinguished, and above which the worse has no
/// support left, after [BurnhamAnderson2002].
const UNDECIDED: f64 = 2.0;
const NO_SUPPORT: f64 = 10.0;

/// Compares models of the same data.
///
/// # Errors
/// Fewer than two models, other data, robust or unconverged fits.
pub fn compare(models: &[Compared<'_>]) -> Result<Comparison, InferError> {
    check(models)?;
    let criteria: Vec<Criteria> = models.iter().map(|m| Criteria::new(m.fit)).collect();
    let mut order: Vec<usize> = (0..models.len()).collect();
    order.sort_by(|i, j| criteria[*i].aicc.total_cmp(&criteria[*j].aicc));
    let best = criteria[order[0]].aicc;
    if !best.is_finite() {
        return InferError::input(
            "no model has at least two more data than parameters: measure more",
        );
    }
    let aicc_above_best: Vec<f64> = criteria.iter().map(|c| c.aicc - best).collect();
    let shares: Vec<f64> = aicc_above_best.iter().map(|d| (-0.5 * d).exp()).collect();
    let sum: f64 = shares.iter().sum();
    let is_decided = criteria[order[1]].aicc - best >= UNDECIDED;
    let favoured = is_decided && !criteria[order[0]].is_rejected();
    Ok(Comparison {
        favoured: favoured.then_some(order[0]),
        sentence: sentence(models, &criteria, &order),
        weights: shares.iter().map(|share| share / sum).collect(),
        order,
        criteria,
        aicc_above_best,
    })
}

fn check(models: &[Compared<'_>]) -> Result<(), InferError> {
    let [first, _, ..] = models else {
        return InferError::input("two models are needed for a comparison");
    };
    for Compared { name, fit, .. } in models {
        let (found, expected) = (fit.residuals.len(), first.fit.residuals.len());
        if found != expected {
            return InferError::input(format!(
                "{name} was fitted to {found} numbers, {} to {expected}: only models of the same data can be compared",
                first.name
            ));
        }
        if fit.loss != Loss::Squares {
            return InferError::input(format!(
                "{name} was fitted with a robust loss, which is no likelihood: compare fits by least squares"
            ));
        }
        if !fit.ending.converged() {
            let why = &fit.ending;
            return Err(InferError::NotConverged(format!("{name} has not converged: {why}")));
        }
    }
    Ok(())
}

fn sentence(models: &[Compared<'_>], criteria: &[Criteria], order: &[usize]) -> String {
    let (best, second) = (order[0], order[1]);
    let (first, next) = (models[best].name, models[second].name);
    if let (true, Some(found)) = (criteria[best].is_rejected(), criteria[best].chi_square) {
        return format!(
            "No model follows the data: {first}, the nearest, has chi-square {:.4} with {} degrees of freedom (p = {:.1e}).",
            found.value, found.freedom, found.probability
        );
    }
    let above = criteria[second].aicc - criteria[best].aicc;
    let support = match above {
        above if above < UNDECIDED => format!("The data do not decide between {first} and {next}"),
        above if above < NO_SUPPORT => format!("The data favour {first} over {next}"),
        above if above.is_finite() => {
            format!("The data support {first} alone: {next}, the next, is rejected")
        }
        _ => format!("The data support {first}; {next} has too many parameters for them"),
    };
    let bic = criteria[second].bic - criteria[best].bic;
    let scores = scores(models, best, second);
    format!("{support} ({next} less {first}: AICc {above:+.1}, BIC {bic:+.1}{scores}).")
}

/// Difference of two models' cross-validated scores, mean of the differences row by row.
fn scores(models: &[Compared<'_>], best: usize, second: usize) -> String {
    let rows = |i: usize| models[i].cross_validation.map(|c| &c.rows);
    match (rows(best), rows(second)) {
        (Some(first), Some(next)) => {
            let differences: Vec<f64> = next.iter().zip(first).map(|(b, a)| b - a).collect();
            let (mean, error) = mean_and_error(&differences);
            format!(", cross-validated score r² + 2 ln σ {mean:+.2} ± {error:.2}")
        }
        _ if models.iter().any(|model| model.cross_validation.is_some()) => {
            ", too few speeds for cross-validation".to_owned()
        }
        _ => String::new(),
    }
}

/// Which rows are left out together.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Folding {
    /// Rows with the same number stay together, as both times of flight of one shot must; empty if
    /// each row stands for itself.
    pub groups: Vec<usize>,
    /// Number of parts into which groups are shuffled; `None` leaves out one group at a time.
    pub parts: Option<usize>,
    /// Seed of the shuffling.
    pub seed: u64,
}

/// Errors of prediction by re-fits without the rows predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossValidation {
    /// Mean over rows of r² + 2 ln σ (constants left out): about 1 + parameters/rows for a right
    /// model, if σ are constant.
    pub mean: f64,
    /// Standard error of the mean.
    pub error: f64,
    /// r² + 2 ln σ of each row.
    pub rows: Vec<f64>,
    /// Number of re-fits.
    pub folds: usize,
    /// Re-fits that did not converge; their predictions are counted all the same.
    pub unconverged: usize,
}

/// Cross-validation: all re-fits side by side, each from the whole fit's optimum.
///
/// # Errors
/// Groups that are not one a row, fewer than two parts, a model that fails at a re-fit's optimum.
pub fn cross_validate(
    problem: &dyn Problem,
    fit: &Fit,
    how: &Folding,
) -> Result<CrossValidation, InferError> {
    let folds = folds(problem.residual_count(), how)?;
    let count = folds.iter().max().map_or(0, |last| last + 1);
    let merit = Merit::new(problem, fit.loss);
    let all: Vec<usize> = (0..fit.point.len()).collect();
    let (limits, steps) = (Fitting::default().limits(), &fit.jacobian.steps);
    let descent = |fold| {
        let merit = merit.only(|row| folds[row] != fold);
        Descent::new(merit, fit.point.clone(), all.clone(), limits).with_steps(steps)
    };
    let mut descents: Vec<Descent<'_>> = (0..count).map(descent).collect();
    run(problem, &mut descents);
    let points: Vec<Vec<f64>> = descents.iter().map(|r| r.point.clone()).collect();
    let mut rows = vec![f64::NAN; folds.len()];
    for (fold, found) in problem.residuals(&points).into_iter().enumerate() {
        let found = found?;
        for row in (0..folds.len()).filter(|row| folds[*row] == fold) {
            let width = found.ln_sigmas.get(row).copied().unwrap_or(0.0);
            let residual = found.standardised.get(row).copied().unwrap_or(f64::NAN);
            rows[row] = residual * residual + 2.0 * width;
        }
    }
    if let Some(row) = rows.iter().position(|x| !x.is_finite()) {
        let label = problem.residual_label(row);
        let text = format!("{label} cannot be predicted by a fit without it");
        return Err(InferError::Model(text));
    }
    let (mean, error) = mean_and_error(&rows);
    let unconverged = descents.iter().filter(|r| !r.ending().converged()).count();
    Ok(CrossValidation { mean, error, rows, folds: count, unconverged })
}

fn mean_and_error(rows: &[f64]) -> (f64, f64) {
    let n = rows.len() as f64;
    let mean = rows.iter().sum::<f64>() / n;
    let square = rows.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    (mean, (square / (n * (n - 1.0).max(1.0))).sqrt())
}

fn folds(rows: usize, how: &Folding) -> Result<Vec<usize>, InferError> {
    let groups: Vec<usize> = match how.groups.is_empty() {
        true => (0..rows).collect(),
        false => how.groups.clone(),
    };
    let mut numbers = groups.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let (count, parts) = (groups.len(), how.parts.unwrap_or(numbers.len()));
    if count != rows {
        return InferError::input(format!(
            "number of rows with a group is {count}: expected one a row"
        ));
    }
    if parts < 2 || parts > numbers.len() {
        return InferError::input(format!(
            "number of parts is {parts}: expected at least 2, at most one a group"
        ));
    }
    let mut random = RandomStream::new(how.seed, Purpose::Folds);
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    for last in (1..numbers.len()).rev() {
        order.swap(last, random.below(last + 1));
    }
    let fold = |group: &usize| order[numbers.binary_search(group).unwrap_or(0)] % parts;
    Ok(groups.iter().map(fold).collect())
}
