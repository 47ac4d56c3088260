//! K and A of the wet contacts, speed by speed.

use super::{CONTACT, Gauge, Scan};
use crate::curve::{CurveProblem, MeasuredCurve, Supply};
use crate::data::{Data, Observable};
use crate::goodness::LEAST_BY_CHANCE;
use crate::linear::{combine, dot, least_squares};
use crate::{Covariance, Fitting, InferError, Parameter, Problem, fit};
use hertzchain_measure::signal::ChiSquare;
use rayon::prelude::*;

/// K and A of the wet contacts at one speed of the data.
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
    /// Range of A searched; `None` where one number alone was measured.
    pub scan: Option<Scan>,
    /// Where only one number was measured: what it determines.
    pub combination: Option<Combination>,
}

/// A solution (K, A) of a row, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// ln K, K in N/m^{3/2}, and ln A, A in s.
    pub ln: [f64; 2],
    /// Covariance of both from this row's measurements alone.
    pub own: [[f64; 2]; 2],
    /// Shifts of both by one standard error of each independent shift of the dry contacts' numbers:
    /// common to all rows.
    pub shared: Vec<[f64; 2]>,
}

/// A value of which so many standard errors reach 0 is not determined, as neither K nor A can be
/// less: its error is no ellipse's any more.
const REACH: f64 = 2.0;

/// Whether a positive number is known well enough to be reported with its standard error.
pub fn is_determined(value: f64, standard_error: f64) -> bool {
    REACH * standard_error < value
}

impl Pair {
    /// Whole covariance of ln K and ln A.
    pub fn covariance(&self) -> [[f64; 2]; 2] {
        let mut sum = self.own;
        for shift in &self.shared {
            for (row, x) in sum.iter_mut().zip(shift) {
                row.iter_mut().zip(shift).for_each(|(entry, y)| *entry += x * y);
            }
        }
        sum
    }

    /// K in N/m^{3/2} (or the combination) and A in s, each with its standard error.
    pub fn estimates(&self) -> [(f64, f64); 2] {
        let covariance = self.covariance();
        [0, 1].map(|i| {
            let value = self.ln[i].exp();
            (value, value * covariance[i][i].sqrt())
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
pub(super) enum Free {
    Both,
    StiffnessAlone,
}

/// A solution of a row with the fit's results.
struct GaugeSolution {
    point: [f64; 2],
    covariance: Covariance,
    chi_square: f64,
    /// Whether the row would have an A beyond the range searched.
    is_beyond: bool,
    residuals: Vec<f64>,
    /// Derivatives of the residuals by ln K and ln A.
    slopes: Vec<Vec<f64>>,
}

/// All solutions of a row, the smallest A first, at least one, and the range searched; or why there
/// is none.
type Solved = Result<(Vec<GaugeSolution>, Option<Scan>), String>;

impl Gauge {
    /// K and A of the wet contacts at each speed of the wet data.
    pub fn rows(&self) -> Vec<WetRow> {
        // What follows them moves nothing but the dry chain's own numbers.
        let shifts = shifts(&self.dry_covariance.matrix);
        let moved = |shift: &Vec<f64>| -> Vec<f64> {
            self.dry_fit.point.iter().zip(shift).map(|(x, s)| x + s).collect()
        };
        let shifted: Vec<Vec<f64>> = shifts[..self.common()].iter().map(moved).collect();
        let numbers = (0..self.data.rows.len()).into_par_iter();
        let solved: Vec<Solved> = numbers.map(|at| self.solutions(at, &shifted)).collect();
        let chosen = self.choose(&solved);
        let all = solved.into_par_iter().zip(chosen).enumerate();
        let row = |(at, (solved, chosen)): (usize, (Solved, Chosen))| {
            let row = &self.data.rows[at];
            let contact = solved.and_then(|found| {
                self.contact(at, found, chosen, &shifted).map_err(|error| error.to_string())
            });
            WetRow { line: row.line, speed_m_s: row.speed_m_s.value, contact }
        };
        all.map(row).collect()
    }

    fn free(&self, row: usize) -> Free {
        match self.data.rows[row].observables().count() {
            1 => Free::StiffnessAlone,
            _ => Free::Both,
        }
    }

    /// Of each row's solutions the one that continues its neighbours' most smoothly.
    fn choose(&self, solved: &[Solved]) -> Vec<Chosen> {
        let row = |at: usize| {
            let pairs = solved[at].as_ref().ok()?.0.iter();
            let ln_speed = self.data.rows[at].speed_m_s.value.ln();
            Some((at, (ln_speed, pairs.map(|pair| pair.point[1].ln()).collect())))
        };
        let both = (0..solved.len()).filter(|at| self.free(*at) == Free::Both);
        let mut rows: Vec<(usize, Row)> = both.filter_map(row).collect();
        rows.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let (places, rows): (Vec<usize>, Vec<Row>) = rows.into_iter().unzip();
        let mut chosen = vec![Chosen::default(); solved.len()];
        for (place, one) in places.into_iter().zip(smoothest(&rows)) {
            chosen[place] = one;
        }
        chosen
    }

    fn contact(
        &self,
        row: usize,
        (mut solutions, scan): (Vec<GaugeSolution>, Option<Scan>),
        chosen: Chosen,
        shifted: &[Vec<f64>],
    ) -> Result<Contact, InferError> {
        let first = solutions.remove(chosen.pair);
        let branch = match (solutions.is_empty(), chosen.is_clear) {
            (true, _) => Branch::Only,
            (_, true) => Branch::Smooth,
            (_, false) => Branch::Unknown,
        };
        let other = |solution: GaugeSolution| {
            self.pair(row, &solution, shifted).unwrap_or_else(|_| Pair {
                ln: solution.point.map(f64::ln),
                own: [[f64::INFINITY, 0.0], [0.0, f64::INFINITY]],
                shared: Vec::new(),
            })
        };
        Ok(Contact {
            first: self.pair(row, &first, shifted)?,
            others: solutions.into_iter().map(other).collect(),
            branch,
            scan,
            combination: match self.free(row) {
                Free::Both => None,
                Free::StiffnessAlone => Some(self.combination(row, first.point)?),
            },
        })
    }

    /// A solution with its errors: the row's own, and those of the dry contacts' numbers.
    fn pair(
        &self,
        row: usize,
        solution: &GaugeSolution,
        shifted: &[Vec<f64>],
    ) -> Result<Pair, InferError> {
        let point = solution.point;
        let mut shared = Vec::new();
        for dry in shifted {
            let other = self.solve(row, self.free(row), dry, point)?.point;
            shared.push([0, 1].map(|i| (other[i] / point[i]).ln()));
        }
        let entry = |i: usize, j: usize| {
            let of = solution.covariance.matrix.get(i).and_then(|row| row.get(j));
            of.map_or(0.0, |c| c / (point[i] * point[j]))
        };
        let own = [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]];
        Ok(Pair { ln: point.map(f64::ln), own, shared })
    }

    /// A row against the wet model with K and A from `at`, A within the range searched, the dry
    /// contacts' numbers given.
    pub(super) fn row_problem(
        &self,
        row: usize,
        (free, at): (Free, [f64; 2]),
        dry: &[f64],
    ) -> CurveProblem {
        let data = Data { rows: vec![self.data.rows[row].clone()], ..self.data.clone() };
        let numbers = self.wet.numbers().as_slice();
        let contact = numbers[numbers.len() - CONTACT..].iter();
        let contact = contact.flat_map(|number| number.parameters(&[])).zip(at);
        let mut start: Vec<Parameter> = contact
            .map(|(parameter, value)| Parameter { start: value, scale: value, ..parameter })
            .collect();
        // Shots through contacts that hardly move take ages.
        if let Some(relaxation) = start.last_mut() {
            let [lower, upper] = self.scanned_s();
            relaxation.start = relaxation.start.clamp(lower, upper);
            (relaxation.lower, relaxation.upper) = (lower, upper);
        }
        let own = self.wet_own(&data.speeds_m_s());
        let own = own.iter().map(|parameter| parameter.start);
        let common = dry.iter().copied().take(self.common());
        let mut supplies: Vec<Supply> = common.chain(own).map(Supply::Fixed).collect();
        supplies.push(Supply::Free(0));
        supplies.push(match free {
            Free::Both => Supply::Free(1),
            Free::StiffnessAlone => Supply::Fixed(at[1]),
        });
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
        let (free, dry) = (self.free(row), &self.dry_fit.point);
        let scanned = if free == Free::Both { self.scan(row) } else { None };
        let (starts, scan) = scanned.unzip();
        let along = |start| self.solve(row, Free::StiffnessAlone, dry, start);
        let [stiffness, relaxation] = self.dry_contact;
        let solved: Vec<Result<GaugeSolution, InferError>> = match (starts, free) {
            (Some(starts), _) => {
                let starts = starts.into_iter().take(POLISHED);
                starts.map(|start| self.solve(row, free, dry, start)).collect()
            }
            (None, Free::StiffnessAlone) => vec![along(self.dry_contact)],
            // Without a time no line can be followed: first the K that suits an A, then both.
            (None, Free::Both) => TIMES_DRY
                .iter()
                .map(|times| along([stiffness, times * relaxation]))
                .map(|found| self.solve(row, free, dry, found?.point))
                .collect(),
        };
        let allowed = |solution: Result<GaugeSolution, InferError>| match free {
            Free::Both => self.allow_for_dry_errors(row, solution?, shifted),
            Free::StiffnessAlone => solution,
        };
        let solved = solved.into_iter().map(allowed).collect();
        Ok((distinct(solved, self.data.rows[row].observables().count(), free)?, scan))
    }

    /// A solution whose chi-square allows for the errors of the dry contacts' numbers.
    fn allow_for_dry_errors(
        &self,
        row: usize,
        mut solution: GaugeSolution,
        shifted: &[Vec<f64>],
    ) -> Result<GaugeSolution, InferError> {
        let mut moves = Vec::new();
        for dry in shifted {
            let problem = self.row_problem(row, (Free::Both, solution.point), dry);
            let found = problem.residuals(&[solution.point.to_vec()]).remove(0)?.standardised;
            let pairs = found.iter().zip(&solution.residuals);
            moves.push(pairs.map(|(a, b)| a - b).collect::<Vec<f64>>());
        }
        solution.chi_square = allowing(&solution.residuals, &solution.slopes, &moves);
        Ok(solution)
    }

    /// K and A of one row, with given numbers of the dry contacts.
    fn solve(
        &self,
        row: usize,
        free: Free,
        dry: &[f64],
        start: [f64; 2],
    ) -> Result<GaugeSolution, InferError> {
        let problem = self.row_problem(row, (free, start), dry);
        // Two equations with two unknowns are solved in some ten iterations, to a thousandth of a
        // standard error.
        let how = Fitting { iterations: 30, tolerance: 1e-6, ..Fitting::default() };
        let fit_result = fit(&problem, &how)?;
        let columns = fit_result.jacobian.columns.iter().zip(&fit_result.point);
        let slopes = columns.map(|(column, at)| column.iter().map(|slope| slope * at).collect());
        Ok(GaugeSolution {
            covariance: Covariance::new(problem.parameters(), &fit_result),
            point: [fit_result.point[0], fit_result.point.get(1).copied().unwrap_or(start[1])],
            chi_square: fit_result.chi_square(),
            is_beyond: free == Free::Both && fit_result.is_bound(1),
            slopes: slopes.collect(),
            residuals: fit_result.residuals,
        })
    }

    /// A statement on rows with more than one solution.
    pub fn ambiguous(&self, rows: &[WetRow]) -> Option<String> {
        let solved =
            || rows.iter().filter_map(|row| Some((row.speed_m_s, row.contact.as_ref().ok()?)));
        if solved().all(|(_, contact)| contact.others.is_empty()) {
            return None;
        }
        let at = |of: &dyn Fn(&Contact) -> bool| -> String {
            let speeds = solved().filter(|(_, contact)| of(contact));
            speeds.map(|(speed, _)| format!("{speed:.4}")).collect::<Vec<_>>().join(", ")
        };
        let mut text =
            "At some speeds more than one solution (K, A) fits; all found are listed.".to_owned();
        if !at(&|contact| contact.branch == Branch::Smooth).is_empty() {
            text += " The first continues those of neighbouring speeds most smoothly.";
        }
        let ambiguous = at(&|contact| contact.branch == Branch::Unknown);
        if !ambiguous.is_empty() {
            let ratios = match self.data.has(Observable::ReturningOverPassing) {
                true => "smaller errors",
                false => "ratios of peaks (--use incident,reflected,returning-ratio)",
            };
            text +=
                &format!(" Branch ambiguous at {ambiguous} m/s: measure more speeds, or {ratios}.");
        }
        let is_incomplete =
            |contact: &Contact| !contact.scan.as_ref().is_none_or(Scan::is_complete);
        let incomplete = at(&is_incomplete);
        match solved().find_map(|(_, contact)| contact.scan.as_ref()) {
            None => text += " Found from seven starts of A: there may be others.",
            Some(scan) => {
                let [from, to] = scan.between_s.map(|a| 1e9 * a);
                text += &format!(" A was scanned from {from:.0} to {to:.0} ns");
                text += &match incomplete.is_empty() {
                    true => ", completely.".to_owned(),
                    false => format!(", not completely at {incomplete} m/s."),
                };
            }
        }
        Some(text)
    }
}

/// Half the step in ln K and ln A of the derivatives of a combination.
const LN_STEP: f64 = 0.01;
/// Most candidates of a scan that are followed to their solutions, best first.
const POLISHED: usize = 16;
/// Starts of A where there is no scan, times that of the dry contacts: oils make it larger.
pub(super) const TIMES_DRY: [f64; 7] = [1.0, 1.8, 3.2, 5.8, 10.5, 19.0, 34.0];
/// Chi-square above the best solution's from which another is rejected: three standard errors.
const NOT_WORSE: f64 = 9.0;
/// Difference in ln A below which two solutions are one.
pub(super) const SAME: f64 = 0.02;
/// Changes of ln K and ln A that count as small: of more, residuals are no straight lines.
const SMALL: f64 = 0.05;

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
        let found = ChiSquare::of(chi_square, values.saturating_sub(2).max(1));
        found.is_some_and(|found| found.probability >= LEAST_BY_CHANCE)
    };
    if free == Free::Both && !follows(best.chi_square) {
        return Err(format!(
            "does not follow: no K and A give these {values} numbers, chi-square {:.3} at best (K = {:.4e} N/m^1.5, A = {:.4e} s)",
            best.chi_square, best.point[0], best.point[1]
        ));
    }
    let most = best.chi_square + NOT_WORSE;
    let mut distinct: Vec<GaugeSolution> = Vec::new();
    for solution in found {
        let same = |other: &GaugeSolution| (solution.point[1] / other.point[1]).ln().abs() < SAME;
        let fits = solution.chi_square < most && follows(solution.chi_square);
        if (fits || distinct.is_empty()) && !distinct.iter().any(same) {
            distinct.push(solution);
        }
    }
    distinct.sort_by(|a, b| a.point[1].total_cmp(&b.point[1]));
    Ok(distinct)
}

/// Square root of a covariance by columns (Cholesky): shifts of all parameters that are independent
/// of each other and one standard error long; parameters without an error do not move.
pub(super) fn shifts(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for at in 0..matrix.len() {
        let entry = |row: usize| {
            let known: f64 = columns.iter().map(|c| c[row] * c[at]).sum();
            matrix[row][at] - known
        };
        let pivot = entry(at);
        let shift = |row| match pivot > 0.0 && row >= at {
            true => entry(row) / pivot.sqrt(),
            false => 0.0,
        };
        columns.push((0..matrix.len()).map(shift).collect());
    }
    columns
}

/// Chi-square of residuals that independent numbers, each known to its standard error, may move: the
/// least of |r + Σ c d|² + |c|², where each move d is what small changes of ln K and ln A leave of
/// it.
fn allowing(residuals: &[f64], slopes: &[Vec<f64>], moves: &[Vec<f64>]) -> f64 {
    // Rows, and behind them one for each unknown, 1 in that of its own.
    let with = |rows: &[f64], factor: f64, count: usize, own: Option<usize>| -> Vec<f64> {
        let ends = (0..count).map(|at| if Some(at) == own { 1.0 } else { 0.0 });
        rows.iter().map(|x| x * factor).chain(ends).collect()
    };
    let (pairs, dry) = (slopes.len(), moves.len());
    let numbered = slopes.iter().enumerate();
    let pair: Vec<Vec<f64>> = numbered.map(|(k, c)| with(c, SMALL, pairs, Some(k))).collect();
    let rights = moves.iter().map(|d| with(d, -1.0, pairs, None)).collect();
    let weights = least_squares(pair.clone(), rights);
    let left = moves.iter().zip(&weights).enumerate().map(|(at, (d, weights))| {
        let taken = combine(&pair, weights);
        let rest: Vec<f64> = d.iter().zip(taken).map(|(d, taken)| d + taken).collect();
        with(&rest, 1.0, dry, Some(at))
    });
    let left: Vec<Vec<f64>> = left.collect();
    let own = with(residuals, 1.0, dry, None);
    let right = own.iter().map(|x| -x).collect();
    let Some(weights) = least_squares(left.clone(), vec![right]).pop() else {
        return dot(&own, &own);
    };
    let taken = combine(&left, &weights);
    let rest = own.iter().enumerate().map(|(at, x)| x + taken.get(at).unwrap_or(&0.0));
    let rest: Vec<f64> = rest.collect();
    dot(&rest, &rest)
}

/// The solution of a row to take, and whether that is clear: every way through another bends much
/// more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Chosen {
    pair: usize,
    is_clear: bool,
}

/// ln speed and ln A of a row's solutions.
type Row = (f64, Vec<f64>);

/// Rows that make three bends: of fewer, chance alone makes a way straight.
const ENOUGH: usize = 5;
/// Odds against every other way where one is clear.
const ODDS: f64 = 1000.0;
/// Least ratio of two sums of squares that means anything.
const LEAST_RATIO: f64 = 4.0;

/// For each row the solution to take: contacts change smoothly with speed, and solutions that belong
/// to nothing do not. Of all ways to take them that with the least sum of squared changes of the
/// slope d ln A/d ln v from speed to speed; the first of each row where there are fewer than three.
///
/// Of n bends that are normal with one unknown variance, a way with the sum S of squares has the
/// likelihood S^(−n/2): odds of a thousand to one are a factor 1000^(2/n). Bends that are errors of
/// A are not independent of their neighbours, so that many of them say less than that.
fn smoothest(rows: &[Row]) -> Vec<Chosen> {
    let Some((least, way)) = straightest(rows) else {
        return vec![Chosen::default(); rows.len()];
    };
    let bends = rows.len().saturating_sub(2).max(1) as f64;
    let much_more = ODDS.powf(2.0 / bends).max(LEAST_RATIO);
    let others = |row: usize| {
        let mut others = rows.to_vec();
        others[row].1.remove(way[row]);
        straightest(&others).map_or(f64::INFINITY, |(cost, _)| cost)
    };
    let chosen = |row: usize| Chosen {
        pair: way[row],
        is_clear: rows[row].1.len() == 1 || rows.len() >= ENOUGH && others(row) > much_more * least,
    };
    (0..rows.len()).map(chosen).collect()
}

/// Distance in ln speed by which two rows of one speed count as apart.
const USUALLY_APART: f64 = 0.1;

/// The way of least cost, and that (dynamic programming over neighbours); `None` of fewer than three
/// rows, or where one has no solution.
fn straightest(rows: &[Row]) -> Option<(f64, Vec<usize>)> {
    if rows.len() < 3 || rows.iter().any(|(_, pairs)| pairs.is_empty()) {
        return None;
    }
    let slope = |row: usize, before: usize, at: usize| {
        let [(v0, from), (v1, to)] = [&rows[row - 1], &rows[row]];
        let apart = if v1 > v0 { v1 - v0 } else { USUALLY_APART };
        (to[at] - from[before]) / apart
    };
    let numbers = |row: usize| 0..rows[row].1.len();
    let first = numbers(0).flat_map(|a| numbers(1).map(move |b| (0.0, vec![a, b])));
    let mut ways: Vec<(f64, Vec<usize>)> = first.collect();
    for row in 2..rows.len() {
        let mut next: Vec<(f64, Vec<usize>)> = Vec::new();
        for (cost, way) in &ways {
            for number in numbers(row) {
                let [a, b] = [way[row - 2], way[row - 1]];
                let bend = slope(row, b, number) - slope(row - 1, a, b);
                let longer = (cost + bend * bend, [&way[..], &[number]].concat());
                // Only the last two matter for what follows.
                let same = |other: &&mut (f64, Vec<usize>)| other.1[row - 1..] == [b, number];
                match next.iter_mut().find(same) {
                    Some(known) if known.0 <= longer.0 => {}
                    Some(known) => *known = longer,
                    None => next.push(longer),
                }
            }
        }
        ways = next;
    }
    ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
#[path = "tests/rows.rs"]
mod tests;
