//! What to measure next.

use crate::linear::svd;
use crate::{Fit, Parameter};

/// Something that could be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Name, as tables show it.
    pub name: String,
    /// Derivatives of its standardised residuals by all parameters at the fit,
    /// one row for each number that it would give, in 1/(unit of θ).
    pub rows: Vec<Vec<f64>>,
    /// What it costs, in any unit common to all: shots, minutes.
    pub cost: f64,
}

/// Candidates by what they are expected to tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The named parameters.
    pub targets: Vec<usize>,
    /// Their standard errors now; infinite if undetermined.
    pub before: Vec<f64>,
    /// Each candidate alone, most information for its cost first.
    pub ranked: Vec<Expected>,
    /// Measurements to add one after another, each the best for its cost after
    /// those before it; a candidate may come again.
    pub greedy: Vec<Expected>,
}

/// What a candidate is expected to tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Which candidate.
    pub candidate: usize,
    /// Standard errors of the named parameters with it (and, in greedy order,
    /// with those before it); infinite if undetermined.
    pub after: Vec<f64>,
    /// Sum over the named parameters of ln(standard error before/after), by
    /// itself; an undetermined one counts as known to 10⁴ scales.
    pub gain: f64,
    /// Gain over cost, by which candidates are ordered.
    pub gain_per_cost: f64,
}

/// Why there is no design.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// No candidate, or no parameter to tighten.
    #[error("name at least one parameter and one candidate to measure")]
    Nothing,
    /// A named parameter that there is not.
    #[error("there is no parameter {number}: the fit has {parameters}")]
    Target {
        /// As asked for, from 0.
        number: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// A candidate's derivatives or cost cannot be used.
    #[error("{name}: expected a positive cost and, in each row, one finite derivative a parameter")]
    Candidate {
        /// The candidate.
        name: String,
    },
}

/// Knowledge assumed of every parameter, in units of its scale, so that the sum
/// of information can always be inverted: next to none.
const KNOWN_TO: f64 = 1e4;
/// Standard errors above this, in units of scales, are called infinite.
const UNDETERMINED: f64 = 1e2;

/// Ranks candidates by how much they are expected to tighten `targets`, linearly
/// around a fit: their rows are appended to the Jacobian, information adds
/// [ChalonerVerdinelli1995], and standard errors follow from the sum. No measured value
/// enters, so the answer is as good as the fitted point.
///
/// # Errors
/// Nothing to rank, or rows that do not fit the parameters.
pub fn design(
    parameters: &[Parameter],
    fit: &Fit,
    candidates: &[Candidate],
    targets: &[usize],
    picks: usize,
) -> Result<Design, DesignError> {
    check(parameters.len(), candidates, targets)?;
    let scales: Vec<f64> = parameters.iter().map(|p| p.scale).collect();
    let now = Information::new(&fit.jacobian.columns, &scales);
    let mut ranked: Vec<Expected> = (0..candidates.len())
        .map(|i| now.expected(candidates, i, targets))
        .collect();
    ranked.sort_by(|a, b| b.gain_per_cost.total_cmp(&a.gain_per_cost));
    let mut greedy = Vec::new();
    let mut sum = now.clone();
    for _ in 0..picks {
        let all = (0..candidates.len()).map(|i| sum.expected(candidates, i, targets));
        // Of equal ones the first.
        let best = all.reduce(|best, next| {
            if next.gain_per_cost > best.gain_per_cost {
                next
            } else {
                best
            }
        });
        let Some(best) = best else { break };
        sum = sum.with(&candidates[best.candidate].rows);
        greedy.push(best);
    }
    Ok(Design {
        targets: targets.to_vec(),
        before: now.shown(targets),
        ranked,
        greedy,
    })
}

fn check(
    parameters: usize,
    candidates: &[Candidate],
    targets: &[usize],
) -> Result<(), DesignError> {
    if candidates.is_empty() || targets.is_empty() {
        return Err(DesignError::Nothing);
    }
    if let Some(number) = targets.iter().copied().find(|k| *k >= parameters) {
        return Err(DesignError::Target { number, parameters });
    }
    let row = |row: &Vec<f64>| row.len() == parameters && row.iter().all(|x| x.is_finite());
    let sound = |c: &&Candidate| c.cost > 0.0 && c.cost.is_finite() && c.rows.iter().all(row);
    match candidates.iter().find(|c| !sound(c)) {
        Some(candidate) => Err(DesignError::Candidate {
            name: candidate.name.clone(),
        }),
        None => Ok(()),
    }
}

/// What is known, as rows whose squares sum to the information; parameters in
/// units of their scales.
#[derive(Clone)]
struct Information<'a> {
    rows: Vec<Vec<f64>>,
    scales: &'a [f64],
}

impl<'a> Information<'a> {
    fn new(columns: &[Vec<f64>], scales: &'a [f64]) -> Self {
        let count = columns.first().map_or(0, Vec::len);
        let row = |i: usize| columns.iter().map(|column| column[i]).collect();
        let rows: Vec<Vec<f64>> = (0..count).map(row).collect();
        let assumed = (0..scales.len()).map(|k| {
            let mut row = vec![0.0; scales.len()];
            row[k] = KNOWN_TO.recip();
            row
        });
        Self {
            rows: assumed.collect(),
            scales,
        }
        .with(&rows)
    }

    /// Together with further rows, as many rows as parameters.
    fn with(&self, further: &[Vec<f64>]) -> Self {
        let scaled = |row: &Vec<f64>| {
            let pairs = row.iter().zip(self.scales);
            pairs.map(|(x, scale)| x * scale).collect()
        };
        let mut rows = self.rows.clone();
        rows.extend(further.iter().map(scaled));
        let columns: Vec<Vec<f64>> = (0..self.scales.len())
            .map(|k| rows.iter().map(|row| row[k]).collect())
            .collect();
        let found = svd(&columns);
        let compact = found.values.iter().zip(&found.right);
        Self {
            rows: compact
                .map(|(value, v)| v.iter().map(|x| x * value).collect())
                .collect(),
            scales: self.scales,
        }
    }

    /// Standard errors of all parameters, in units of their scales. Rows are
    /// orthogonal here, each its singular value long.
    fn sds(&self) -> Vec<f64> {
        let variance = |k: usize| {
            let parts = self.rows.iter().map(|row| {
                let square = crate::linear::dot(row, row);
                (row[k] / square).powi(2)
            });
            parts.sum::<f64>().sqrt()
        };
        (0..self.scales.len()).map(variance).collect()
    }

    fn shown(&self, targets: &[usize]) -> Vec<f64> {
        let sds = self.sds();
        let known = |k: &usize| match sds[*k] {
            sd if sd > UNDETERMINED => f64::INFINITY,
            sd => sd * self.scales[*k],
        };
        targets.iter().map(known).collect()
    }

    fn expected(&self, candidates: &[Candidate], i: usize, targets: &[usize]) -> Expected {
        let after = self.with(&candidates[i].rows);
        let (old, new) = (self.sds(), after.sds());
        let gain: f64 = targets.iter().map(|k| (old[*k] / new[*k]).ln()).sum();
        Expected {
            candidate: i,
            after: after.shown(targets),
            gain,
            gain_per_cost: gain / candidates[i].cost,
        }
    }
}
