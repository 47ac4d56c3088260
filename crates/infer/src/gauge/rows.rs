//! K and A of the wet contacts, speed by speed.

use super::Gauge;
use super::branches::{Chosen, ENOUGH, Row, smoothest};
use crate::curve::{CurveProblem, MeasuredCurve, Supply};
use crate::data::Data;
use crate::goodness::LEAST_BY_CHANCE;
use crate::least_squares::{DOUBTFUL, Descent, DescentLimits, Merit, run};
use crate::linear::{cholesky, dot, forward, least_squares};
use crate::{Covariance, DataRow, Fit, Fitting, InferError, Loss, Parameter, Problem, fit};
use hertzchain_measure::signal::ChiSquare;
use rayon::prelude::*;

/// K and A of the wet contacts, or the first number of a film, at one speed of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct WetRow {
    /// Line of the wet table.
    pub line: u64,
    /// Speed of the striker in m/s.
    pub speed_m_s: f64,
    /// K and A, or the one combination that is determined, or why neither.
    pub contact: Result<Contact, String>,
}

/// K and A of the wet contacts at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The solution, or the first of those that fit as well.
    pub first: Pair,
    /// Other solutions that fit as well.
    pub others: Vec<Pair>,
    /// Why the first stands before the others.
    pub branch: Branch,
    /// Whether the model has a curve at every A searched; `None` where one number alone was
    /// measured.
    pub is_complete: Option<bool>,
    /// Where only one number was measured: what it determines.
    pub combination: Option<Combination>,
}

/// A solution (K, A) of a row, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// ln K, K in N/m^{3/2}, and ln A, A in s.
    pub ln: [f64; 2],
    /// Covariance of both, with the errors of the dry contacts' numbers.
    pub covariance: [[f64; 2]; 2],
}

/// A positive value of which so many standard errors reach 0 is not determined.
const REACH: f64 = 2.0;

/// Whether a positive number is known well enough to be reported with its standard error.
pub fn is_determined(value: f64, standard_error: f64) -> bool {
    REACH * standard_error < value
}

impl Pair {
    /// K in N/m^{3/2} (or the combination) and A in s, each with its standard error.
    pub fn estimates(&self) -> [(f64, f64); 2] {
        [0, 1].map(|i| {
            let value = self.ln[i].exp();
            (value, value * self.covariance[i][i].sqrt())
        })
    }
}

/// Why a solution stands before the others of its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// There is no other.
    Only,
    /// It continues those of neighbouring speeds; every way through another bends much more.
    Smooth,
    /// The branch is ambiguous.
    Unknown,
}

impl Branch {
    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Only => "only",
            Self::Smooth => "smooth",
            Self::Unknown => "unknown",
        }
    }
}

/// The combination K · (A/A₀)^`exponent` that one number determines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Combination {
    /// For A twice as large, K is less by 2^`exponent`, without any change of what was measured.
    pub exponent: f64,
    /// A₀ in s, that of the dry contacts.
    pub reference_s: f64,
}

impl Contact {
    /// Whether both numbers are known, and on which branch.
    pub fn is_known(&self) -> bool {
        self.combination.is_none() && self.branch != Branch::Unknown
    }

    /// All solutions, the smallest A first.
    pub fn pairs(&self) -> Vec<&Pair> {
        let mut all: Vec<&Pair> = std::iter::once(&self.first).chain(&self.others).collect();
        all.sort_by(|a, b| a.ln[1].total_cmp(&b.ln[1]));
        all
    }
}

/// What is free in a row, by the number of its measurements.
#[derive(Clone, Copy, PartialEq)]
enum Free {
    Both,
    StiffnessAlone,
    /// The first number of a film.
    Film,
}

/// A solution of a row with the fit's results.
struct GaugeSolution {
    pair: Pair,
    chi_square: f64,
    /// Whether the row would have an A beyond the range searched.
    is_beyond: bool,
}

impl GaugeSolution {
    fn ln_a(&self) -> f64 {
        self.pair.ln[1]
    }

    /// Whether A has an error with which the solution says where it is.
    fn is_determined(&self) -> bool {
        let [_, (a, error)] = self.pair.estimates();
        is_determined(a, error)
    }
}

/// Solutions of a row, the smallest A first, and whether the search was complete; or why none.
type Solved = Result<(Vec<GaugeSolution>, Option<bool>), String>;

impl Gauge {
    /// K and A of the wet contacts at each speed of the wet data.
    pub fn rows(&self) -> Vec<WetRow> {
        let moved = |axis: &Vec<f64>| -> Vec<f64> {
            self.dry_fit.point.iter().zip(axis).map(|(x, shift)| x + shift).collect()
        };
        // Independent errors of the dry numbers, each of one standard error.
        let shifted: Vec<Vec<f64>> = self.dry_covariance.axes.iter().map(moved).collect();
        let numbers = (0..self.data.rows.len()).into_par_iter();
        let solved: Vec<Solved> = numbers.map(|at| self.solutions(at, &shifted)).collect();
        let chosen = self.choose(&solved);
        let all = solved.into_iter().zip(chosen).zip(&self.data.rows).enumerate();
        let row = |(at, ((solved, chosen), row)): (usize, ((Solved, Chosen), &DataRow))| {
            let contact = solved.and_then(|found| {
                self.contact(at, found, chosen).map_err(|error| error.to_string())
            });
            WetRow { line: row.line, speed_m_s: row.speed_m_s.value, contact }
        };
        all.map(row).collect()
    }

    fn free(&self, row: usize) -> Free {
        match self.data.rows[row].observables().count() {
            _ if self.film > 0 => Free::Film,
            1 => Free::StiffnessAlone,
            _ => Free::Both,
        }
    }

    /// Of each row's solutions the one that continues its neighbours' most smoothly.
    fn choose(&self, solved: &[Solved]) -> Vec<Chosen> {
        let row = |at: usize| {
            let solutions = &solved[at].as_ref().ok()?.0;
            let known = |of: &usize| solutions[*of].is_determined();
            let mut usable: Vec<usize> = (0..solutions.len()).filter(known).collect();
            if usable.is_empty() {
                usable = (0..solutions.len()).collect();
            }
            let ln_a = usable.iter().map(|of| solutions[*of].ln_a()).collect();
            Some(((at, usable), (self.data.rows[at].speed_m_s.value.ln(), ln_a)))
        };
        let both = (0..solved.len()).filter(|at| self.free(*at) == Free::Both);
        let mut rows: Vec<((usize, Vec<usize>), Row)> = both.filter_map(row).collect();
        rows.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let (places, rows): (Vec<_>, Vec<Row>) = rows.into_iter().unzip();
        let mut chosen = vec![Chosen::default(); solved.len()];
        for ((at, usable), one) in places.into_iter().zip(smoothest(&rows)) {
            let count = solved[at].as_ref().map_or(0, |found| found.0.len());
            let is_clear = one.is_clear && (usable.len() == count || rows.len() >= ENOUGH);
            chosen[at] = Chosen { pair: usable[one.pair], is_clear };
        }
        chosen
    }

    fn contact(
        &self,
        row: usize,
        (mut solutions, is_complete): (Vec<GaugeSolution>, Option<bool>),
        chosen: Chosen,
    ) -> Result<Contact, InferError> {
        let first = solutions.remove(chosen.pair).pair;
        let branch = match (solutions.is_empty(), chosen.is_clear) {
            (true, _) => Branch::Only,
            (_, true) => Branch::Smooth,
            (_, false) => Branch::Unknown,
        };
        Ok(Contact {
            combination: match self.free(row) {
                Free::Both | Free::Film => None,
                Free::StiffnessAlone => Some(self.combination(row, first.ln.map(f64::exp))?),
            },
            first,
            others: solutions.into_iter().map(|solution| solution.pair).collect(),
            branch,
            is_complete,
        })
    }

    /// A row against the wet model with K and A from `at`, the dry contacts' numbers given.
    fn row_problem(&self, row: usize, (free, at): (Free, [f64; 2]), dry: &[f64]) -> CurveProblem {
        let data = Data { rows: vec![self.data.rows[row].clone()], ..self.data.clone() };
        let numbers = &self.wet.numbers;
        let contact = numbers[numbers.len() - self.contact_numbers()..].iter();
        let contact = contact.flat_map(|number| number.parameters(&[])).zip(at);
        let mut start: Vec<Parameter> = contact
            .map(|(parameter, value)| Parameter { start: value, scale: value, ..parameter })
            .collect();
        // Shots through contacts that hardly move take ages.
        if let (Some(relaxation), 0) = (start.last_mut(), self.film) {
            let [lower, upper] = self.scanned_s();
            relaxation.start = relaxation.start.clamp(lower, upper);
            (relaxation.lower, relaxation.upper) = (lower, upper);
        }
        let own = self.wet_own(&data.speeds_m_s());
        let own = own.iter().map(|parameter| parameter.start);
        let common = dry.iter().copied().take(self.common());
        let mut supplies: Vec<Supply> = common.chain(own).map(Supply::Fixed).collect();
        supplies.push(Supply::Free(0));
        supplies.extend((start.len() > 1).then_some(match free {
            Free::Both => Supply::Free(1),
            Free::StiffnessAlone | Free::Film => Supply::Fixed(at[1]),
        }));
        start.truncate(if free == Free::Both { 2 } else { 1 });
        let curve = MeasuredCurve::new(self.wet.clone(), data).supplied(supplies);
        CurveProblem::unchecked(start, vec![curve])
    }

    /// What a change of A is worth in K, from derivatives of the one residual.
    fn combination(&self, row: usize, point: [f64; 2]) -> Result<Combination, InferError> {
        let problem = self.row_problem(row, (Free::Both, point), &self.dry_fit.point);
        let moved = |(at, step): (usize, f64)| {
            let mut moved = point.to_vec();
            moved[at] *= step.exp();
            moved
        };
        let points = [(0, LN_STEP), (0, -LN_STEP), (1, LN_STEP), (1, -LN_STEP)].map(moved);
        let mut first = Vec::new();
        for residuals in problem.residuals(&points) {
            first.push(residuals?.standardised.first().copied().unwrap_or(f64::NAN));
        }
        let exponent = (first[2] - first[3]) / (first[0] - first[1]);
        Ok(Combination { exponent, reference_s: point[1] })
    }

    /// All solutions that the row's numbers do not reject: times of flight need not determine K and
    /// A uniquely.
    fn solutions(&self, row: usize, shifted: &[Vec<f64>]) -> Solved {
        let free = self.free(row);
        let (starts, is_complete) = match free {
            Free::StiffnessAlone | Free::Film => (vec![self.contact], None),
            Free::Both => {
                let (starts, is_complete) = self.starts(row);
                (starts, Some(is_complete))
            }
        };
        let solved = starts.into_iter().map(|start| self.solve(row, free, start, shifted));
        let values = self.data.rows[row].observables().count();
        Ok((distinct(solved.collect(), values, free)?, is_complete))
    }

    /// The smallest and the largest A in s among which solutions are looked for.
    pub fn scanned_s(&self) -> [f64; 2] {
        let low = self.contact[1] * LEAST_TIMES_DRY;
        [low, low * (STEPS as f64 * STEP).exp()]
    }

    /// K and A from which every solution of a row is near: the minima over A of chi-square, K at its
    /// best for each A. Also whether the model has a curve at every A.
    fn starts(&self, row: usize) -> (Vec<[f64; 2]>, bool) {
        let [stiffness, relaxation] = self.contact;
        let problem =
            self.row_problem(row, (Free::Both, [stiffness, relaxation]), &self.dry_fit.point);
        let merit = Merit::new(&problem, Loss::Squares);
        let low = self.scanned_s()[0];
        let limits = DescentLimits { tolerance: ROUGH, share: ROUGH_SHARE, iterations: 10 };
        let descent = |step: usize| {
            let point = vec![stiffness, low * (step as f64 * STEP).exp()];
            Descent::new(merit.clone(), point, vec![0], limits)
        };
        let mut line: Vec<Descent<'_>> = (0..=STEPS).map(descent).collect();
        run(&problem, &mut line);
        let cost =
            |at: Option<usize>| at.and_then(|at| line.get(at)).map_or(f64::INFINITY, Descent::cost);
        let is_lowest = |at: &usize| {
            let own = cost(Some(*at));
            own.is_finite() && own <= cost(at.checked_sub(1)) && own <= cost(Some(at + 1))
        };
        let lowest = (0..line.len()).filter(is_lowest);
        let starts = lowest.map(|at| [line[at].point[0], line[at].point[1]]).collect();
        (starts, line.iter().all(|descent| descent.cost().is_finite()))
    }

    /// K and A of one row, with the errors of the dry contacts' numbers.
    fn solve(
        &self,
        row: usize,
        free: Free,
        start: [f64; 2],
        shifted: &[Vec<f64>],
    ) -> Result<GaugeSolution, InferError> {
        let problem = self.row_problem(row, (free, start), &self.dry_fit.point);
        // Two equations with two unknowns are solved in some ten iterations, to a thousandth of a
        // standard error.
        let how = Fitting { iterations: 30, tolerance: 1e-6, ..Fitting::default() };
        let fit_result = fit(&problem, &how)?;
        if let (true, Some(jump)) = (free != Free::Both, jump(problem.parameters(), &fit_result)) {
            return Err(InferError::NotConverged(format!("not determined: {jump}")));
        }
        let point = [fit_result.point[0], fit_result.point.get(1).copied().unwrap_or(start[1])];
        let columns = fit_result.jacobian.columns.iter().zip(point);
        let slopes: Vec<Vec<f64>> =
            columns.map(|(column, at)| column.iter().map(|slope| slope * at).collect()).collect();
        let mut moves = Vec::new();
        for dry in shifted {
            let problem = self.row_problem(row, (free, point), dry);
            let found =
                problem.residuals(std::slice::from_ref(&fit_result.point)).remove(0)?.standardised;
            let pairs = found.iter().zip(&fit_result.residuals);
            moves.push(pairs.map(|(a, b)| a - b).collect::<Vec<f64>>());
        }
        // What follows them, to first order.
        let rights = moves.iter().map(|change| change.iter().map(|x| -x).collect()).collect();
        let follow = least_squares(slopes.clone(), rights);
        let own = Covariance::new(problem.parameters(), &fit_result).matrix;
        let entry = |i: usize, j: usize| {
            let own =
                own.get(i).and_then(|row| row.get(j)).map_or(0.0, |c| c / (point[i] * point[j]));
            let shared = follow.iter().filter_map(|of| Some(of.get(i)? * of.get(j)?));
            own + shared.sum::<f64>()
        };
        Ok(GaugeSolution {
            chi_square: match free {
                Free::Both => allowing(&fit_result.residuals, &slopes, &moves),
                Free::StiffnessAlone | Free::Film => fit_result.chi_square(),
            },
            is_beyond: free == Free::Both && fit_result.is_bound(1),
            pair: Pair {
                ln: point.map(f64::ln),
                covariance: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
            },
        })
    }

    /// A statement on rows with more than one solution.
    pub fn ambiguous(&self, rows: &[WetRow]) -> Option<String> {
        let at = |of: &dyn Fn(&Contact) -> bool| -> String {
            let solved = rows.iter().filter(|row| row.contact.as_ref().is_ok_and(of));
            solved.map(|row| format!("{:.4}", row.speed_m_s)).collect::<Vec<_>>().join(", ")
        };
        let several = at(&|contact| !contact.others.is_empty());
        if several.is_empty() {
            return None;
        }
        let [from, to] = self.scanned_s().map(|a| 1e9 * a);
        let mut text = format!(
            "Several solutions (K, A) fit at {several} m/s (A from {from:.0} to {to:.0} ns)."
        );
        let sentences = [
            ("Branch ambiguous at", at(&|contact| contact.branch == Branch::Unknown)),
            (
                "The model has no curve at some A at",
                at(&|contact| contact.is_complete == Some(false)),
            ),
        ];
        for (begin, speeds) in sentences.into_iter().filter(|(_, speeds)| !speeds.is_empty()) {
            text += &format!(" {begin} {speeds} m/s.");
        }
        Some(text)
    }
}

/// The smallest A, times that of the dry contacts: no liquid damps less than none by much.
const LEAST_TIMES_DRY: f64 = 0.5;
/// Steps in ln A, to 64 times the dry A.
const STEPS: usize = 60;
const STEP: f64 = 0.0809;
/// Expected fall of chi-square/2 at which K is good enough for a start.
const ROUGH: f64 = 0.5;
/// The same over chi-square/2: where the numbers are far from met at any K, there is no solution.
const ROUGH_SHARE: f64 = 0.01;
/// Half the step in ln K and ln A of the derivatives of a combination.
const LN_STEP: f64 = 0.01;
/// Chi-square above the best solution's from which another is rejected: three standard errors.
const NOT_WORSE: f64 = 9.0;
/// Difference in ln A below which two solutions are one.
const SAME: f64 = 0.02;
/// Changes of ln K and ln A that count as small: of more, residuals are no straight lines.
const SMALL: f64 = 0.05;

/// That a model's curve jumps where a fit has ended, as where two maxima are equally high, so that
/// derivatives by two step sizes differ and no error can be stated.
pub(super) fn jump(parameters: &[Parameter], fit: &Fit) -> Option<String> {
    let (at, share) = fit.jacobian.least_agreeing().filter(|least| least.1 > DOUBTFUL)?;
    let Parameter { name, unit, .. } = &parameters[at];
    Some(format!(
        "the model's curve jumps near {name} = {:.3e} {unit} (its derivatives differ by {:.0} %); try a smaller \
         --accuracy, or --use incident",
        fit.point[at],
        100.0 * share
    ))
}

/// Of what starts came to, the smallest A first, each solution once that `values` numbers do not
/// reject.
fn distinct(
    solved: Vec<Result<GaugeSolution, InferError>>,
    values: usize,
    free: Free,
) -> Result<Vec<GaugeSolution>, String> {
    let (found, failed): (Vec<_>, Vec<_>) = solved.into_iter().partition(Result::is_ok);
    let mut found: Vec<GaugeSolution> = found.into_iter().flatten().collect();
    let count = found.len();
    found.retain(|solution| !solution.is_beyond);
    found.sort_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    let Some(best) = found.first() else {
        let error = failed.into_iter().filter_map(Result::err).next_back();
        return Err(match (count, error) {
            (0, Some(error)) => error.to_string(),
            _ => format!(
                "does not follow: no K and A in the range scanned give these {values} numbers"
            ),
        });
    };
    // Two numbers are met or not.
    let follows = |chi_square: f64| {
        let found = ChiSquare::of(chi_square, values.saturating_sub(2).max(1), 1.0);
        found.is_some_and(|found| found.probability >= LEAST_BY_CHANCE)
    };
    if free == Free::Both && !follows(best.chi_square) {
        return Err(format!(
            "does not follow: no K and A give these {values} numbers, chi-square {:.3} at best (K = {:.4e} N/m^1.5, A = {:.4e} s)",
            best.chi_square,
            best.pair.ln[0].exp(),
            best.ln_a().exp()
        ));
    }
    let most = best.chi_square + NOT_WORSE;
    let mut distinct: Vec<GaugeSolution> = Vec::new();
    for solution in found {
        let same = |other: &GaugeSolution| (solution.ln_a() - other.ln_a()).abs() < SAME;
        let fits = solution.chi_square < most && follows(solution.chi_square);
        if (fits || distinct.is_empty()) && !distinct.iter().any(same) {
            distinct.push(solution);
        }
    }
    distinct.sort_by(|a, b| a.ln_a().total_cmp(&b.ln_a()));
    Ok(distinct)
}

/// Chi-square of residuals r at a minimum that independent numbers, each known to its standard error,
/// may move: rᵀ C⁻¹ r with C = 1 + D Dᵀ + s² S Sᵀ, D the moves and S the slopes by ln K and ln A,
/// which make up for moves by small changes s.
fn allowing(residuals: &[f64], slopes: &[Vec<f64>], moves: &[Vec<f64>]) -> f64 {
    let covariance = |i: usize, j: usize| {
        let own = f64::from(u8::from(i == j));
        let moved: f64 = moves.iter().map(|d| d[i] * d[j]).sum();
        own + moved + SMALL * SMALL * slopes.iter().map(|s| s[i] * s[j]).sum::<f64>()
    };
    let white = cholesky(residuals.len(), covariance).map(|lower| forward(&lower, residuals));
    let white = white.as_deref().unwrap_or(residuals);
    dot(white, white)
}

#[cfg(test)]
#[path = "tests/rows.rs"]
mod tests;
