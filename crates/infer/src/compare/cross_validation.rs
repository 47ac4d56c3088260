//! How well a model foretells what it was not fitted to.

use crate::chance::{Chance, Purpose};
use crate::least_squares::{Descent, Merit, drive};
use crate::{Fit, FitError, Fitting, ModelError, Problem};

/// Which rows are left out together.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Folding {
    /// Rows with the same number stay together, as both times of flight of one
    /// shot must; empty if each row stands for itself.
    pub groups: Vec<usize>,
    /// Number of parts into which groups are shuffled; `None` leaves out one
    /// group at a time.
    pub parts: Option<usize>,
    /// Seed of the shuffling.
    pub seed: u64,
}

/// Errors of prediction by re-fits without the rows predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossValidation {
    /// Mean over rows of r² + 2 ln σ (constants left out): about 1 + parameters/rows
    /// for a right model, if σ are constant.
    pub mean: f64,
    /// Standard error of the mean.
    pub error: f64,
    /// r² + 2 ln σ of each row.
    pub rows: Vec<f64>,
    /// Re-fits.
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
) -> Result<CrossValidation, FitError> {
    let folds = folds(problem.residual_count(), how)?;
    let count = folds.iter().max().map_or(0, |last| last + 1);
    let merit = Merit::new(problem, fit.loss);
    let all: Vec<usize> = (0..fit.point.len()).collect();
    let descents = (0..count)
        .map(|fold| {
            let merit = merit.only(|row| folds[row] != fold);
            Descent::new(
                merit,
                fit.point.clone(),
                all.clone(),
                Fitting::default().limits(),
            )
            .with_steps(&fit.jacobian.steps)
        })
        .collect();
    let reached = drive(problem, descents).reached;
    let points: Vec<Vec<f64>> = reached.iter().map(|r| r.point.clone()).collect();
    let predicted = problem.residuals(&points);
    let mut rows = vec![f64::NAN; folds.len()];
    for (fold, found) in predicted.into_iter().enumerate() {
        let found = found.map_err(FitError::Start)?;
        let own = (0..folds.len()).filter(|row| folds[*row] == fold);
        for row in own {
            let width = found.ln_sigmas.get(row).copied().unwrap_or(0.0);
            let residual = found.standardised.get(row).copied().unwrap_or(f64::NAN);
            rows[row] = residual * residual + 2.0 * width;
        }
    }
    if let Some(row) = rows.iter().position(|x| !x.is_finite()) {
        let label = problem.residual_label(row);
        let text = format!("{label} cannot be predicted by a fit without it");
        return Err(FitError::Start(ModelError(text)));
    }
    let (mean, error) = mean_and_error(&rows);
    let unconverged = reached.iter().filter(|r| !r.ending.converged()).count();
    Ok(CrossValidation {
        mean,
        error,
        rows,
        folds: count,
        unconverged,
    })
}

/// Mean of rows and its standard error.
pub(super) fn mean_and_error(rows: &[f64]) -> (f64, f64) {
    let n = rows.len() as f64;
    let mean = rows.iter().sum::<f64>() / n;
    let square = rows.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    (mean, (square / (n * (n - 1.0).max(1.0))).sqrt())
}

/// The fold of each row.
fn folds(rows: usize, how: &Folding) -> Result<Vec<usize>, FitError> {
    let own: Vec<usize> = (0..rows).collect();
    let groups = if how.groups.is_empty() {
        &own
    } else {
        &how.groups
    };
    let mut numbers = groups.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let parts = how.parts.unwrap_or(numbers.len());
    let wrong = |name, value: usize, expected| {
        let value = value as f64;
        Err(FitError::Option {
            name,
            value,
            expected,
        })
    };
    if groups.len() != rows {
        return wrong("number of rows with a group", groups.len(), "one a row");
    }
    if parts < 2 || parts > numbers.len() {
        return wrong("number of parts", parts, "at least 2, at most one a group");
    }
    let order = shuffled(numbers.len(), how.seed);
    let fold = |group: &usize| {
        let place = numbers.binary_search(group).unwrap_or(0);
        order[place] % parts
    };
    Ok(groups.iter().map(fold).collect())
}

/// Numbers below `count` in an order of chance.
fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut chance = Chance::new(seed, Purpose::Folds);
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, chance.below(last + 1));
    }
    order
}
