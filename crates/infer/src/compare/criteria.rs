//! Information criteria.

use super::CrossValidation;
use super::cross_validation::mean_and_error;
use crate::goodness::LEAST_BY_CHANCE;
use crate::{Fit, Loss};
use hertzchain_measure::signal::{ChiSquare, Estimate, chi_square};

/// Criteria of one model: small is good, and only differences between models of
/// the same data mean something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Fitted combinations of parameters.
    pub parameters: usize,
    /// Measured numbers.
    pub data: usize,
    /// Chi-square of the data, its degrees of freedom and its probability by chance; `None` if
    /// no freedom is left.
    pub chi_square: Option<ChiSquare>,
    /// −2 ln likelihood of the data at the optimum, up to a constant of the data.
    pub deviance: f64,
    /// Deviance + 2 parameters [Akaike1974].
    pub aic: f64,
    /// AIC + 2 k (k + 1)/(n − k − 1) for k parameters and n data
    /// [HurvichTsai1989]; infinite if n ≤ k + 1.
    pub aicc: f64,
    /// Deviance + parameters × ln data [Schwarz1978].
    pub bic: f64,
}

impl Criteria {
    /// Of a fit by least squares; combinations of parameters that nothing determines, and
    /// parameters held by a bound, do not count.
    #[must_use]
    pub fn new(fit: &Fit) -> Self {
        let (data, parameters) = (fit.residuals.len(), fit.rank);
        let (n, k) = (data as f64, parameters as f64);
        let deviance = fit.chi_square() + 2.0 * fit.ln_sigmas;
        let aic = deviance + 2.0 * k;
        let freedom = n - k - 1.0;
        let small = if freedom > 0.0 {
            2.0 * k * (k + 1.0) / freedom
        } else {
            f64::INFINITY
        };
        let rows = fit.residuals.iter().map(|value| Estimate {
            value: *value,
            sigma: 1.0,
        });
        Self {
            parameters,
            data,
            chi_square: chi_square(&rows.collect::<Vec<_>>(), &vec![0.0; data], parameters),
            deviance,
            aic,
            aicc: aic + small,
            bic: deviance + k * n.ln(),
        }
    }

    /// Whether chance can't be why the data are so far from the model.
    #[must_use]
    pub fn is_rejected(&self) -> bool {
        let found = self.chi_square;
        found.is_some_and(|found| found.probability < LEAST_BY_CHANCE)
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
    /// The model that the data favour; `None` where they do not follow even the best, or do not
    /// decide.
    pub favoured: Option<usize>,
    /// Which model is supported and by how much.
    pub sentence: String,
}

/// Why models cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// Fewer than two.
    #[error("two models are needed for a comparison")]
    Alone,
    /// Fits of different data.
    #[error(
        "{name} was fitted to {found} numbers, {first} to {expected}: only models of the same data can be compared"
    )]
    OtherData {
        /// The model.
        name: String,
        /// Its data.
        found: usize,
        /// The first model.
        first: String,
        /// The first model's data.
        expected: usize,
    },
    /// A robust loss is no likelihood.
    #[error(
        "{name} was fitted with a robust loss, which is no likelihood: compare fits by least squares"
    )]
    Robust {
        /// The model.
        name: String,
    },
    /// A fit that is no optimum.
    #[error("{name} has not converged: {why}")]
    NotConverged {
        /// The model.
        name: String,
        /// How its fit ended.
        why: String,
    },
    /// No model has a finite AICc.
    #[error("no model has at least two more data than parameters: measure more")]
    TooFew,
}

/// Compares models of the same data.
///
/// # Errors
/// Fewer than two models, other data, robust or unconverged fits.
pub fn compare(models: &[Compared<'_>]) -> Result<Comparison, CompareError> {
    check(models)?;
    let criteria: Vec<Criteria> = models.iter().map(|m| Criteria::new(m.fit)).collect();
    let mut order: Vec<usize> = (0..models.len()).collect();
    order.sort_by(|i, j| criteria[*i].aicc.total_cmp(&criteria[*j].aicc));
    let best = criteria[order[0]].aicc;
    if !best.is_finite() {
        return Err(CompareError::TooFew);
    }
    let aicc_above_best: Vec<f64> = criteria.iter().map(|c| c.aicc - best).collect();
    let shares: Vec<f64> = aicc_above_best.iter().map(|d| (-0.5 * d).exp()).collect();
    let sum: f64 = shares.iter().sum();
    let decided = criteria[order[1]].aicc - best >= UNDECIDED;
    let favoured = decided && !criteria[order[0]].is_rejected();
    Ok(Comparison {
        favoured: favoured.then_some(order[0]),
        sentence: sentence(models, &criteria, &order),
        weights: shares.iter().map(|share| share / sum).collect(),
        order,
        criteria,
        aicc_above_best,
    })
}

fn check(models: &[Compared<'_>]) -> Result<(), CompareError> {
    let [first, _, ..] = models else {
        return Err(CompareError::Alone);
    };
    for model in models {
        let name = model.name.to_owned();
        let (found, expected) = (model.fit.residuals.len(), first.fit.residuals.len());
        if found != expected {
            let first = first.name.to_owned();
            return Err(CompareError::OtherData {
                name,
                found,
                first,
                expected,
            });
        }
        if model.fit.loss != Loss::Squares {
            return Err(CompareError::Robust { name });
        }
        if !model.fit.ending.converged() {
            let why = model.fit.ending.to_string();
            return Err(CompareError::NotConverged { name, why });
        }
    }
    Ok(())
}

/// Difference of AICc below which models are not told apart, and above which the
/// worse has no support left, after [BurnhamAnderson2002].
const UNDECIDED: f64 = 2.0;
const NO_SUPPORT: f64 = 10.0;

/// Odds beyond are not told: no error is so exactly normal.
const MOST_ODDS: f64 = 1e9;

fn sentence(models: &[Compared<'_>], criteria: &[Criteria], order: &[usize]) -> String {
    let (best, second) = (order[0], order[1]);
    let (first, next) = (models[best].name, models[second].name);
    if let Some(found) = criteria[best]
        .chi_square
        .filter(|_| criteria[best].is_rejected())
    {
        return format!(
            "None of these models follows the data, and none is favoured: {first}, the nearest, has chi-square {:.4} with \
             {} degrees of freedom (p = {:.1e}). Look for what all of them leave out, or at the data's errors.",
            found.value, found.freedom, found.probability
        );
    }
    let above = criteria[second].aicc - criteria[best].aicc;
    let bic = criteria[second].bic - criteria[best].bic;
    let odds = (0.5 * above).exp();
    let judged = match above {
        above if above < UNDECIDED => format!(
            "The data do not decide between {first} and {next} (AICc differs by {above:.1})"
        ),
        above if above < NO_SUPPORT => format!(
            "The data favour {first}: {next}, the next, is {odds:.0} times less supported (AICc higher by {above:.1})"
        ),
        above if above.is_finite() => format!(
            "The data support {first} alone: {next}, the next, is rejected (AICc higher by {above:.1}, {})",
            match odds < MOST_ODDS {
                true => format!("odds of 1 to {odds:.1e}"),
                false => format!("odds below 1 to {MOST_ODDS:.0e}"),
            }
        ),
        _ => format!("The data support {first}; {next} has too many parameters for them"),
    };
    let schwarz = match bic {
        bic if bic < 0.0 => format!("; BIC prefers {next}, by {:.1}", -bic),
        bic => format!("; BIC agrees, by {bic:.1}"),
    };
    judged + &schwarz + &foretold(models, best, second) + "."
}

/// What cross-validation says of two models, by the differences row by row.
fn foretold(models: &[Compared<'_>], best: usize, second: usize) -> String {
    let rows = |i: usize| models[i].cross_validation.map(|c| &c.rows);
    let (Some(first), Some(next)) = (rows(best), rows(second)) else {
        return match models.iter().any(|model| model.cross_validation.is_some()) {
            true => "; too few speeds for cross-validation of both".to_owned(),
            false => String::new(),
        };
    };
    let differences: Vec<f64> = next.iter().zip(first).map(|(b, a)| b - a).collect();
    let (mean, error) = mean_and_error(&differences);
    let verdict = match mean / error {
        z if z > 2.0 => "left out, points are foretold better by it",
        z if z < -2.0 => "but points left out are foretold worse by it",
        _ => "points left out are foretold about equally well by both",
    };
    format!(
        "; {verdict} (the cross-validated score r² + 2 ln σ, mean of all numbers, differs by {mean:.2} ± {error:.2})"
    )
}
