//! What to measure next.

mod information;
mod space;

use crate::identify::{in_words, sized};
use crate::{Fit, Parameter};
use information::Information;
use space::Space;
use std::cmp::Ordering;

/// Something that could be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Name, as tables show it.
    pub name: String,
    /// Derivatives of its standardised residuals by all parameters at the fit,
    /// one row for each number that it would give, in 1/(unit of θ).
    pub rows: Vec<Vec<f64>>,
    /// How wrong each parameter's derivatives may be, all rows together, in 1/(unit of
    /// θ); empty if they are exact.
    pub doubts: Vec<f64>,
    /// What it costs, in any unit common to all: shots, minutes.
    pub cost: f64,
}

/// What is to be tightened.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// A parameter, by its place.
    Parameter(usize),
    /// A combination of parameters that could be determined, in words; its standard error
    /// is in units of the parameters' sizes.
    Combination(String),
}

/// Candidates by what they are expected to tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What is tightened: the named parameters that something could determine; if there are
    /// none, the combinations that something could.
    pub aims: Vec<Aim>,
    /// Named parameters that neither the data nor any candidate determine, by their places.
    pub hopeless: Vec<usize>,
    /// Combinations that nothing determines, in words.
    pub open: Vec<String>,
    /// Standard errors of the aims now; infinite if undetermined.
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
    /// Standard errors of the aims with it (and, in greedy order, with those before it);
    /// infinite if undetermined.
    pub after: Vec<f64>,
    /// Sum over the aims of ln(standard error before/after), by
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
    /// A fit that found no minimum: derivatives there say nothing of what is to come.
    #[error(
        "the fit to the data so far found no minimum ({ending}): what would tell most is not known where \
         it ended; start nearer (--start), and look at `hertzchain fit` first"
    )]
    NotConverged {
        /// Where the fit ended.
        ending: String,
    },
    /// Neither data nor candidates determine anything.
    #[error("neither the data nor any of the candidates determine anything of these parameters")]
    NothingDetermined,
}

/// Ranks candidates by how much they are expected to tighten `targets`, linearly
/// around a fit: their rows are appended to the Jacobian, information adds
/// [ChalonerVerdinelli1995], and standard errors follow from the sum. No measured value
/// enters, so the answer is as good as the fitted point.
///
/// Combinations of parameters that data and all candidates together leave open are left out
/// of everything: what rows say of them is the derivatives' noise. Parameters that they
/// move can't be aimed at.
///
/// # Errors
/// Nothing to rank, rows that do not fit the parameters, a fit without a minimum, or
/// parameters of which nothing can be known.
pub fn design(
    parameters: &[Parameter],
    fit: &Fit,
    candidates: &[Candidate],
    targets: &[usize],
    picks: usize,
) -> Result<Design, DesignError> {
    check(parameters.len(), candidates, targets)?;
    if !fit.ending.converged() {
        let ending = fit.ending.to_string();
        return Err(DesignError::NotConverged { ending });
    }
    let sized = sized(parameters, &fit.point);
    let space = Space::of(&sized, &fit.jacobian, candidates);
    if space.known.is_empty() {
        return Err(DesignError::NothingDetermined);
    }
    let (hopeless, hopeful): (Vec<usize>, Vec<usize>) =
        targets.iter().partition(|k| space.leaves_open(**k));
    let words = |direction: &Vec<f64>| in_words(&sized, fit, direction);
    let (aims, directions) = match hopeful.is_empty() {
        false => (
            hopeful.iter().map(|k| Aim::Parameter(*k)).collect(),
            hopeful.iter().map(|k| space.parameter(*k)).collect(),
        ),
        true => (
            space
                .known
                .iter()
                .map(|d| Aim::Combination(words(d)))
                .collect(),
            space.known.iter().map(|d| (d.clone(), 1.0)).collect(),
        ),
    };
    let now = Information::new(&fit.jacobian.columns, &space, directions);
    let (ranked, greedy) = ranked(&now, candidates, picks);
    Ok(Design {
        aims,
        hopeless,
        open: space.open.iter().map(words).collect(),
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
    ranked.sort_by(|a, b| before(candidates, a, b));
    let mut greedy = Vec::new();
    let mut sum = now.clone();
    for _ in 0..picks {
        let all = (0..candidates.len()).map(|i| expected(&sum, i));
        let Some(best) = all.min_by(|a, b| before(candidates, a, b)) else {
            break;
        };
        sum = sum.with(&candidates[best.candidate].rows);
        greedy.push(best);
    }
    (ranked, greedy)
}

/// The better one first: by gain over cost; of two that differ by less than anybody could
/// measure the cheaper, then that with fewer numbers, then the first.
fn before(candidates: &[Candidate], a: &Expected, b: &Expected) -> Ordering {
    let gain = |one: &Expected| (one.gain_per_cost / NO_DIFFERENCE).round();
    let [one, other] = [a, b].map(|one| &candidates[one.candidate]);
    let gains = gain(b).total_cmp(&gain(a));
    let costs = gains.then(one.cost.total_cmp(&other.cost));
    costs.then(one.rows.len().cmp(&other.rows.len()))
}

/// A change of ln(standard error) that counts for nothing: a tenth of a percent.
const NO_DIFFERENCE: f64 = 1e-3;

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
    let doubts = |c: &Candidate| c.doubts.is_empty() || row(&c.doubts);
    let sound =
        |c: &&Candidate| c.cost > 0.0 && c.cost.is_finite() && c.rows.iter().all(row) && doubts(c);
    match candidates.iter().find(|c| !sound(c)) {
        Some(candidate) => Err(DesignError::Candidate {
            name: candidate.name.clone(),
        }),
        None => Ok(()),
    }
}
