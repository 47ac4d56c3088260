//! Optimal design: which measurements tighten which parameters.

use crate::identify::{MOVED, Scaled, in_words, is_weak, sized};
use crate::linear::{dot, norm, svd, unit};
use crate::{Fit, InferError, Parameter};
use std::cmp::Ordering;

/// Something that could be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Name, as tables show it.
    pub name: String,
    /// Derivatives of its standardised residuals by all parameters at the fit, one row for each
    /// number that it would give, in 1/(unit of θ).
    pub rows: Vec<Vec<f64>>,
    /// How wrong each parameter's derivatives may be, all rows together, in 1/(unit of θ); empty if
    /// they are exact.
    pub doubts: Vec<f64>,
    /// Its cost, in any unit common to all: shots, minutes.
    pub cost: f64,
}

impl Candidate {
    /// With derivatives by a parameter that are no larger than they may be wrong as 0: where a
    /// maximum of a pulse becomes another's, its jump would hide what all others determine.
    fn without_jumps(&self) -> Self {
        let mut left = self.clone();
        for (k, doubt) in left.doubts.iter_mut().enumerate() {
            let column: Vec<f64> = self.rows.iter().map(|row| row[k]).collect();
            if *doubt >= norm(&column) {
                left.rows.iter_mut().for_each(|row| row[k] = 0.0);
                *doubt = 0.0;
            }
        }
        left
    }
}

/// What is to be tightened.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// A parameter, by its place.
    Parameter(usize),
    /// An identifiable combination of parameters, in words; its standard error is in units of the
    /// parameters' sizes.
    Combination(String),
}

/// Candidates by their expected information.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What is tightened: the named parameters that something could determine; if there are none,
    /// the combinations that something could.
    pub aims: Vec<Aim>,
    /// Named parameters that neither the data nor any candidate determine, by their places.
    pub not_identifiable: Vec<usize>,
    /// Combinations that nothing determines, in words.
    pub open: Vec<String>,
    /// Standard errors of the aims now; infinite if undetermined.
    pub before: Vec<f64>,
    /// Each candidate alone, most information for its cost first.
    pub ranked: Vec<Expected>,
    /// Measurements to add one after another, each the best for its cost after those before it; a
    /// candidate may come again.
    pub greedy: Vec<Expected>,
}

/// Expected information of a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// Which candidate.
    pub candidate: usize,
    /// Standard errors of the aims with it (and, in greedy order, with those before it); infinite
    /// if undetermined.
    pub after: Vec<f64>,
    /// Sum over the aims of ln(standard error before/after), by itself; an undetermined one counts
    /// as known to 10⁴ scales.
    pub gain: f64,
    /// Gain over cost, by which candidates are ordered.
    pub gain_per_cost: f64,
}

/// A change of ln(standard error) that counts for nothing: a tenth of a percent.
const NO_DIFFERENCE: f64 = 1e-3;

/// Knowledge assumed of every direction, in sizes, so that information can be inverted.
const KNOWN_TO: f64 = 1e4;

/// Standard errors above this, in units of sizes, are called infinite.
const UNDETERMINED: f64 = 1e2;

/// Ranks candidates by how much they are expected to tighten `targets`, linearly around a fit: their
/// rows are appended to the Jacobian, information adds [ChalonerVerdinelli1995], and standard errors
/// follow from the sum. No measured value enters, so the answer is as good as the fitted point.
///
/// Combinations of parameters that data and all candidates together leave open are left out: what
/// rows say of them is the derivatives' noise.
///
/// # Errors
/// Nothing to rank, rows that do not fit the parameters, a fit without a minimum, or parameters of
/// which nothing can be known.
pub fn design(
    parameters: &[Parameter],
    fit: &Fit,
    candidates: &[Candidate],
    targets: &[usize],
    picks: usize,
) -> Result<Design, InferError> {
    check(parameters.len(), candidates, targets)?;
    let candidates: Vec<Candidate> = candidates.iter().map(Candidate::without_jumps).collect();
    if !fit.ending.converged() {
        return Err(InferError::NotConverged(format!(
            "the fit to the data so far found no minimum ({}): what would determine most is not known where \
             it ended; start nearer (--start), and look at `hertzchain fit` first",
            fit.ending
        )));
    }
    let sized = sized(parameters, &fit.point);
    let sizes: Vec<f64> = sized.iter().map(|p| p.scale).collect();
    // What data, priors and all candidates together determine, best first.
    let all = candidates.iter().fold(Scaled::with_priors(&sized, &fit.jacobian), |sum, one| {
        sum.and(&Scaled::of_rows(&sized, &one.rows, &one.doubts))
    });
    let (found, floor) = all.decomposed();
    let pairs = found.values.into_iter().zip(found.right);
    let (open, known): (Vec<_>, Vec<_>) = pairs.partition(|(value, _)| is_weak(*value, floor));
    let [open, known] = [open, known].map(|pairs| -> Vec<Vec<f64>> {
        pairs.into_iter().map(|(_, direction)| direction).collect()
    });
    if known.is_empty() {
        return InferError::input(
            "neither the data nor any of the candidates determine anything of these parameters",
        );
    }
    let is_open = |k: &&usize| open.iter().any(|direction| direction[**k].abs() > MOVED);
    let (not_identifiable, named): (Vec<usize>, Vec<usize>) = targets.iter().partition(is_open);
    let words = |direction: &Vec<f64>| in_words(&sized, fit, direction);
    let (aims, directions): (Vec<Aim>, Vec<(Vec<f64>, f64)>) = match named.is_empty() {
        false => {
            named.iter().map(|k| (Aim::Parameter(*k), (unit(sizes.len(), *k), sizes[*k]))).unzip()
        }
        true => known.iter().map(|d| (Aim::Combination(words(d)), (d.clone(), 1.0))).unzip(),
    };
    let now = Information::new(&fit.jacobian.columns, (&sizes, &known), &directions);
    let (ranked, greedy) = ranked(&now, &candidates, picks);
    Ok(Design {
        aims,
        not_identifiable,
        open: open.iter().map(words).collect(),
        before: now.shown(),
        ranked,
        greedy,
    })
}

/// Candidates alone, best first, and a series of them.
fn ranked(
    now: &Information<'_>,
    candidates: &[Candidate],
    picks: usize,
) -> (Vec<Expected>, Vec<Expected>) {
    let expected = |sum: &Information<'_>, i: usize| sum.expected(&candidates[i], i);
    let mut ranked: Vec<Expected> = (0..candidates.len()).map(|i| expected(now, i)).collect();
    let least_cost = candidates.iter().map(|one| one.cost).fold(f64::INFINITY, f64::min);
    let before = |a: &Expected, b: &Expected| before(candidates, least_cost, a, b);
    ranked.sort_by(before);
    let (mut greedy, mut sum) = (Vec::new(), now.clone());
    for _ in 0..picks {
        let all = (0..candidates.len()).map(|i| expected(&sum, i));
        let Some(best) = all.min_by(before) else {
            break;
        };
        sum = sum.with(&candidates[best.candidate].rows);
        greedy.push(best);
    }
    (ranked, greedy)
}

/// By gain over cost in units of the least cost; of two that differ by no difference the cheaper, then
/// that with fewer numbers, then the first.
fn before(candidates: &[Candidate], least_cost: f64, a: &Expected, b: &Expected) -> Ordering {
    let gain = |one: &Expected| match one.gain < NO_DIFFERENCE {
        true => f64::NEG_INFINITY,
        false => ((one.gain_per_cost * least_cost).ln() / NO_DIFFERENCE).round(),
    };
    let [one, other] = [a, b].map(|one| &candidates[one.candidate]);
    let gains = gain(b).total_cmp(&gain(a));
    let costs = gains.then(one.cost.total_cmp(&other.cost));
    costs.then(one.rows.len().cmp(&other.rows.len()))
}

fn check(parameters: usize, candidates: &[Candidate], targets: &[usize]) -> Result<(), InferError> {
    if candidates.is_empty() || targets.is_empty() {
        return InferError::input("name at least one parameter and one candidate to measure");
    }
    if let Some(number) = targets.iter().find(|k| **k >= parameters) {
        return InferError::input(format!(
            "there is no parameter {number}: the fit has {parameters}"
        ));
    }
    let row = |row: &Vec<f64>| row.len() == parameters && row.iter().all(|x| x.is_finite());
    let is_valid = |c: &&Candidate| {
        let doubts = c.doubts.is_empty() || row(&c.doubts);
        c.cost > 0.0 && c.cost.is_finite() && c.rows.iter().all(row) && doubts
    };
    match candidates.iter().find(|c| !is_valid(c)) {
        Some(Candidate { name, .. }) => InferError::input(format!(
            "{name}: expected a positive cost and, in each row, one finite derivative a parameter"
        )),
        None => Ok(()),
    }
}

/// Information along the known directions, as rows whose squares sum.
#[derive(Clone)]
struct Information<'a> {
    /// Orthogonal to each other, each as long as its singular value.
    rows: Vec<Vec<f64>>,
    sizes: &'a [f64],
    known: &'a [Vec<f64>],
    /// Aims along the known directions, each with its size.
    aims: Vec<(Vec<f64>, f64)>,
}

impl<'a> Information<'a> {
    /// Of the columns of a Jacobian, for aims in units of the parameters' sizes.
    fn new(
        columns: &[Vec<f64>],
        (sizes, known): (&'a [f64], &'a [Vec<f64>]),
        aims: &[(Vec<f64>, f64)],
    ) -> Self {
        let count = columns.first().map_or(0, Vec::len);
        let row = |i: usize| columns.iter().map(|column| column[i]).collect();
        let rows: Vec<Vec<f64>> = (0..count).map(row).collect();
        let assumed = |k: usize| {
            let entry = |i: usize| if i == k { KNOWN_TO.recip() } else { 0.0 };
            (0..known.len()).map(entry).collect()
        };
        let along = |(direction, size): &(Vec<f64>, f64)| {
            (known.iter().map(|known| dot(known, direction)).collect(), *size)
        };
        Self {
            rows: (0..known.len()).map(assumed).collect(),
            sizes,
            known,
            aims: aims.iter().map(along).collect(),
        }
        .with(&rows)
    }

    /// Together with further rows, in 1/(unit of θ); as many rows as directions.
    fn with(&self, further: &[Vec<f64>]) -> Self {
        let mut rows = self.rows.clone();
        rows.extend(further.iter().map(|row| {
            // What a row says of other directions is noise.
            let scaled: Vec<f64> = row.iter().zip(self.sizes).map(|(x, size)| x * size).collect();
            self.known.iter().map(|known| dot(known, &scaled)).collect()
        }));
        let column = |k: usize| rows.iter().map(|row| row[k]).collect();
        let found = svd(&(0..self.known.len()).map(column).collect::<Vec<_>>());
        let pairs = found.values.iter().zip(&found.right);
        let compact = pairs.map(|(value, v)| v.iter().map(|x| x * value).collect());
        Self { rows: compact.collect(), ..self.clone() }
    }

    /// Standard errors of the aims, in units of sizes.
    fn sds(&self) -> Vec<f64> {
        let sd = |(aim, _): &(Vec<f64>, f64)| {
            let parts = self.rows.iter().map(|row| (dot(row, aim) / dot(row, row)).powi(2));
            parts.sum::<f64>().sqrt()
        };
        self.aims.iter().map(sd).collect()
    }

    /// Standard errors of the aims in their units; infinite if undetermined.
    fn shown(&self) -> Vec<f64> {
        let pairs = self.sds().into_iter().zip(&self.aims);
        pairs
            .map(|(sd, (_, size))| if sd > UNDETERMINED { f64::INFINITY } else { sd * size })
            .collect()
    }

    fn expected(&self, candidate: &Candidate, place: usize) -> Expected {
        let after = self.with(&candidate.rows);
        let pairs = self.sds().into_iter().zip(after.sds());
        let gain: f64 = pairs.map(|(old, new)| (old / new).ln()).sum();
        Expected {
            candidate: place,
            after: after.shown(),
            gain,
            gain_per_cost: gain / candidate.cost,
        }
    }
}
