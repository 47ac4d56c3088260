//! Pairs of K and A that one row allows, each once.

use super::Gauge;
use super::contacts::Free;
use super::scan::Scan;
use crate::linear::{combine, dot, least_squares};
use crate::{Covariance, FitError, Fitting, Problem, fit};
use hertzchain_measure::signal::ChiSquare;

/// K and A that fit a row.
pub(super) struct Solution {
    pub(super) point: [f64; 2],
    pub(super) covariance: Covariance,
    pub(super) chi_square: f64,
    /// Whether the row would have an A beyond those that are looked at.
    is_beyond: bool,
    /// Residuals, and their derivatives to ln K and ln A.
    residuals: Vec<f64>,
    slopes: Vec<Vec<f64>>,
}

/// All solutions of a row, the smallest A first, at least one, and how far they were looked
/// for; or why there is none.
pub(super) type Solved = Result<(Vec<Solution>, Option<Scan>), String>;

impl Gauge {
    /// All pairs that the row's numbers do not reject, the smallest A first: times of flight
    /// need not determine K and A uniquely.
    pub(super) fn solutions(&self, row: usize, free: Free, shifts: &[Vec<f64>]) -> Solved {
        let scanned = match free {
            Free::Both => self.scan(row),
            Free::StiffnessAlone => None,
        };
        let (starts, scan) = scanned.unzip();
        let solved: Vec<Result<Solution, FitError>> = match (starts, free) {
            (Some(starts), _) => (starts.into_iter().take(POLISHED))
                .map(|start| self.solved(row, free, &self.dry_fit.point, start))
                .collect(),
            (None, Free::StiffnessAlone) => vec![self.from(row, free, self.dry_contact)],
            (None, Free::Both) => self.several(row),
        };
        let judged = |solution: Result<Solution, FitError>| match free {
            Free::Both => self.judged(row, solution?, shifts),
            Free::StiffnessAlone => solution,
        };
        let solved = solved.into_iter().map(judged).collect();
        let found = sound(solved, self.data.rows[row].observables().count(), free)?;
        Ok((found, scan))
    }

    /// A solution whose chi-square allows for the errors of the dry contacts' numbers.
    fn judged(
        &self,
        row: usize,
        solution: Solution,
        shifts: &[Vec<f64>],
    ) -> Result<Solution, FitError> {
        let point = solution.point.to_vec();
        let mut moves = Vec::new();
        for shift in &shifts[..self.common()] {
            let dry = self.dry_fit.point.iter().zip(shift).map(|(x, s)| x + s);
            let dry: Vec<f64> = dry.collect();
            let problem = self.row_problem(row, (Free::Both, solution.point), &dry);
            let found = problem.residuals(std::slice::from_ref(&point)).remove(0);
            let found = found.map_err(FitError::Start)?.standardised;
            let moved = found.iter().zip(&solution.residuals).map(|(a, b)| a - b);
            moves.push(moved.collect::<Vec<f64>>());
        }
        Ok(Solution {
            chi_square: allowing(&solution.residuals, &solution.slopes, &moves),
            ..solution
        })
    }

    /// Solutions from several starts, where no line can be followed.
    fn several(&self, row: usize) -> Vec<Result<Solution, FitError>> {
        let [stiffness, relaxation] = self.dry_contact;
        let start = |times: &f64| [stiffness, times * relaxation];
        let starts = TIMES_DRY.iter().map(start);
        starts
            .map(|start| self.from(row, Free::Both, start))
            .collect()
    }

    /// The solution next to an A: first the K that suits it, then both.
    fn from(&self, row: usize, free: Free, start: [f64; 2]) -> Result<Solution, FitError> {
        let dry = &self.dry_fit.point;
        let along = self.solved(row, Free::StiffnessAlone, dry, start)?;
        match free {
            Free::StiffnessAlone => Ok(along),
            Free::Both => self.solved(row, free, dry, along.point),
        }
    }

    /// K and A that one row asks for, with given numbers of the dry contacts.
    pub(super) fn solved(
        &self,
        row: usize,
        free: Free,
        dry: &[f64],
        start: [f64; 2],
    ) -> Result<Solution, FitError> {
        let problem = self.row_problem(row, (free, start), dry);
        let how = Fitting {
            iterations: ITERATIONS,
            tolerance: TOLERANCE,
            ..Fitting::default()
        };
        let fitted = fit(&problem, &how)?;
        Ok(Solution {
            covariance: Covariance::new(problem.parameters(), &fitted),
            point: [
                fitted.point[0],
                fitted.point.get(1).copied().unwrap_or(start[1]),
            ],
            chi_square: fitted.chi_square(),
            is_beyond: free == Free::Both && fitted.is_bound(1),
            slopes: (fitted.jacobian.columns.iter().zip(&fitted.point))
                .map(|(column, at)| column.iter().map(|slope| slope * at).collect())
                .collect(),
            residuals: fitted.residuals,
        })
    }
}

/// Of what starts came to, the smallest A first, each pair once that chance alone may have
/// moved so far from `values` numbers.
fn sound(
    solved: Vec<Result<Solution, FitError>>,
    values: usize,
    free: Free,
) -> Result<Vec<Solution>, String> {
    let mut failed = None;
    let mut found: Vec<Solution> = Vec::new();
    for solution in solved {
        match solution {
            Ok(solution) => found.push(solution),
            Err(error) => failed = Some(error),
        }
    }
    let count = found.len();
    found.retain(|solution| !solution.is_beyond);
    found.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    let Some(best) = found.first() else {
        return Err(match count {
            0 => failed.unwrap_or(FitError::NothingFree).to_string(),
            _ => format!(
                "does not follow: no K and A among those looked at give these {values} numbers"
            ),
        });
    };
    if free == Free::Both && !is_followed(best.chi_square, values) {
        return Err(format!(
            "does not follow: no K and A give these {values} numbers, chi-square {:.3} at best (K = {:.4e} N/m^1.5, A = {:.4e} s)",
            best.chi_square, best.point[0], best.point[1]
        ));
    }
    let most = best.chi_square + NOT_WORSE;
    let mut distinct: Vec<Solution> = Vec::new();
    for solution in found {
        let same = |other: &Solution| (solution.point[1] / other.point[1]).ln().abs() < SAME;
        let fits = solution.chi_square < most && is_followed(solution.chi_square, values);
        if (fits || distinct.is_empty()) && !distinct.iter().any(same) {
            distinct.push(solution);
        }
    }
    distinct.sort_by(|a, b| a.point[1].total_cmp(&b.point[1]));
    Ok(distinct)
}

/// Chi-square of residuals that independent numbers, each known to its standard error, may
/// move: the least of |r + Σ c d|² + |c|², where each move d is what small changes of ln K
/// and ln A leave of it.
fn allowing(residuals: &[f64], slopes: &[Vec<f64>], moves: &[Vec<f64>]) -> f64 {
    let with = |rows: Vec<f64>, count: usize, own: Option<usize>| {
        let ends = (0..count).map(|at| if Some(at) == own { 1.0 } else { 0.0 });
        rows.into_iter().chain(ends).collect::<Vec<f64>>()
    };
    let minus = |rows: &[f64]| rows.iter().map(|x| -x).collect::<Vec<f64>>();
    let small = |column: &Vec<f64>| column.iter().map(|x| x * SMALL).collect::<Vec<f64>>();
    let pair = slopes.iter().enumerate();
    let pair: Vec<Vec<f64>> = pair
        .map(|(k, c)| with(small(c), slopes.len(), Some(k)))
        .collect();
    let rights = moves
        .iter()
        .map(|d| with(minus(d), slopes.len(), None))
        .collect();
    let weights = least_squares(pair.clone(), rights);
    let left = moves.iter().zip(&weights).map(|(d, weights)| {
        let taken = combine(&pair, weights);
        d.iter()
            .zip(taken)
            .map(|(d, taken)| d + taken)
            .collect::<Vec<f64>>()
    });
    let left = left
        .enumerate()
        .map(|(at, d)| with(d, moves.len(), Some(at)));
    let left: Vec<Vec<f64>> = left.collect();
    let own = with(residuals.to_vec(), moves.len(), None);
    let Some(weights) = least_squares(left.clone(), vec![minus(&own)]).pop() else {
        return dot(&own, &own);
    };
    let taken = combine(&left, &weights);
    let rest: Vec<f64> = own
        .iter()
        .enumerate()
        .map(|(at, x)| x + taken.get(at).unwrap_or(&0.0))
        .collect();
    dot(&rest, &rest)
}

/// Changes of ln K and ln A that count as small: of more, residuals are no straight lines.
const SMALL: f64 = 0.05;

/// Whether chance alone gives such a chi-square of a pair; two numbers are met or not.
fn is_followed(value: f64, values: usize) -> bool {
    let freedom = values.saturating_sub(MEASURED).max(1);
    let found = ChiSquare::of(value, freedom);
    found.is_some_and(|found| found.probability >= LEAST_BY_CHANCE)
}

/// Numbers that determine a pair.
const MEASURED: usize = 2;

/// A row whose best pair chance gives less often does not follow the model: of a curve of
/// 25 speeds one row in forty curves is lost to chance.
const LEAST_BY_CHANCE: f64 = 1e-3;

/// Most candidates of a scan that are followed to their pairs, best first.
const POLISHED: usize = 16;

/// Chi-square above the best pair's from which a pair is rejected: three standard errors.
const NOT_WORSE: f64 = 9.0;

/// Iterations of one row's fit: two equations with two unknowns are solved in some ten.
const ITERATIONS: usize = 30;

/// Starts of A in a row's fit, times that of the dry contacts: oils make it larger.
pub(super) const TIMES_DRY: [f64; 7] = [1.0, 1.8, 3.2, 5.8, 10.5, 19.0, 34.0];

/// Difference of cost within which two solutions are equally good.
pub(super) const AS_GOOD: f64 = 1.0;

/// Difference in ln A below which two solutions are one.
pub(super) const SAME: f64 = 0.02;

/// Fall of chi-square/2 below which a row is solved: a thousandth of a standard error.
const TOLERANCE: f64 = 1e-6;

#[cfg(test)]
#[path = "tests/solutions.rs"]
mod tests;
