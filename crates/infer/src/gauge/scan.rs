//! All pairs of K and A that one row allows.
//!
//! For each A there is one K that meets the row's time of flight: a line in the plane of
//! both, along which the row's other numbers determine where all are met. It is walked from end
//! to end, in finer steps where they change sign, jump, or come near.

use super::Gauge;
use super::rows::Free;
use crate::curve::{Predicted, Speeds};
use crate::data::Observable;
use crate::problem::Problem;

/// How far pairs were looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// The smallest and the largest A in s.
    pub between_s: [f64; 2],
    /// Spans of A in s where no K meets the time of flight, or where the model has no such
    /// number as was measured: nothing is known of pairs there.
    pub missing_s: Vec<[f64; 2]>,
}

impl Scan {
    /// Whether the line could be followed all the way.
    pub fn is_complete(&self) -> bool {
        self.missing_s.is_empty()
    }
}

/// A point of the line: ln A, ln K and the row's residuals there, if there are any.
struct ScanPoint {
    ln_a: f64,
    ln_k: f64,
    residuals: Option<Vec<f64>>,
}

impl ScanPoint {
    fn chi_square(&self) -> f64 {
        let squares = |all: &Vec<f64>| all.iter().map(|r| r * r).sum();
        self.residuals.as_ref().map_or(f64::INFINITY, squares)
    }
}

impl Gauge {
    /// Points K, A from which every pair of a row is near, best first, those too far from its
    /// numbers left out, and how far the line was followed; `None` for rows without any time, where K is not determined by A.
    pub(super) fn scan(&self, row: usize) -> Option<(Vec<[f64; 2]>, Scan)> {
        let first = self.data.rows[row].observables().next()?;
        if !first.is_time() {
            return None;
        }
        let between_s = self.scanned_s();
        let (low, stiffness) = (between_s[0].ln(), self.dry_contact[0]);
        let grid = (0..=STEPS).map(|at| (low + at as f64 * STEP, stiffness.ln()));
        let mut line = self.places(row, first, grid.collect());
        for _ in 0..HALVINGS {
            let halves = halves(&line);
            if halves.is_empty() {
                break;
            }
            line.extend(self.places(row, first, halves));
            line.sort_by(|a, b| a.ln_a.total_cmp(&b.ln_a));
        }
        let scan = Scan { between_s, missing_s: missing(&line) };
        Some((candidates(&line), scan))
    }

    /// The smallest and the largest A in s among which pairs are looked for.
    pub(super) fn scanned_s(&self) -> [f64; 2] {
        let low = self.dry_contact[1] * LEAST_TIMES_DRY;
        [low, low * (STEPS as f64 * STEP).exp()]
    }

    /// The line at some ln A, each with a guess of ln K.
    fn places(&self, row: usize, first: Observable, at: Vec<(f64, f64)>) -> Vec<ScanPoint> {
        let met = self.met(row, first, &at);
        let known = at.iter().zip(&met).filter_map(|((a, _), k)| Some((*a, (*k)?)));
        let points: Vec<Vec<f64>> = known.map(|(a, k)| vec![k.exp(), a.exp()]).collect();
        let start = (Free::Both, self.dry_contact);
        let problem = self.row_problem(row, start, &self.dry_fit.point);
        let mut found = problem.residuals(&points).into_iter();
        let mut place = |((ln_a, guess), met): (&(f64, f64), &Option<f64>)| ScanPoint {
            ln_a: *ln_a,
            ln_k: met.unwrap_or(*guess),
            residuals: met.and_then(|_| Some(found.next()?.ok()?.standardised)),
        };
        at.iter().zip(&met).map(&mut place).collect()
    }

    /// ln K that meets the row's first number at each ln A: secants, all at once.
    fn met(&self, row: usize, first: Observable, at: &[(f64, f64)]) -> Vec<Option<f64>> {
        let measured = self.data.rows[row].value(first);
        let near = measured.map_or(0.0, |m| NEAR * m.sigma / m.value);
        let mut roots: Vec<Root> = at.iter().map(|(_, guess)| Root::new(*guess)).collect();
        for _ in 0..SECANTS {
            let open = |number: &usize| !roots[*number].is_done(near);
            let open: Vec<usize> = (0..roots.len()).filter(open).collect();
            if open.is_empty() {
                break;
            }
            let pairs = open.iter().map(|n| [roots[*n].x, at[*n].0]).collect::<Vec<_>>();
            let misses = self.misses(row, first, &pairs);
            for (number, miss) in open.into_iter().zip(misses) {
                roots[number].seen(miss, near);
            }
        }
        let root = |root: Root| (root.miss?.abs() <= near).then_some(root.x);
        roots.into_iter().map(root).collect()
    }

    /// ln of predicted over measured at pairs ln K, ln A.
    fn misses(&self, row: usize, of: Observable, pairs: &[[f64; 2]]) -> Vec<Option<f64>> {
        let measured = &self.data.rows[row];
        let speed = [measured.speed_m_s.value];
        let own = self.wet_own(&speed);
        let common = self.dry_fit.point.iter().copied().take(self.common());
        let begin: Vec<f64> = common.chain(own.iter().map(|p| p.start)).collect();
        let point = |pair: &[f64; 2]| [&begin[..], &pair.map(f64::exp)[..]].concat();
        let points: Vec<Vec<f64>> = pairs.iter().map(point).collect();
        let curves = self.wet.curves(&points, &Speeds::of_rows(&speed));
        let miss = |curve: &Predicted| Some((curve[of.index()]? / measured.value(of)?.value).ln());
        let curves = curves.into_iter();
        curves.map(|curve| miss(curve.ok()?.first()?)).collect()
    }
}

/// A secant on its way.
struct Root {
    x: f64,
    miss: Option<f64>,
    slope: f64,
    failed: bool,
}

impl Root {
    fn new(x: f64) -> Self {
        Self { x, miss: None, slope: SLOPE, failed: false }
    }

    fn is_done(&self, near: f64) -> bool {
        self.failed || self.miss.is_some_and(|miss| miss.abs() <= near)
    }

    /// Takes what was found where it stands, and moves on if that is not near.
    fn seen(&mut self, found: Option<f64>, near: f64) {
        let Some(miss) = found.filter(|miss| miss.is_finite()) else {
            self.failed = true;
            self.miss = None;
            return;
        };
        if let Some((before, step)) = self.miss.zip(self.step()) {
            let slope = (miss - before) / step;
            self.slope = if slope.is_finite() { slope.clamp(STEEPEST, FLATTEST) } else { SLOPE };
        }
        self.miss = Some(miss);
        if miss.abs() > near {
            self.x += self.step().unwrap_or(0.0);
        }
    }

    /// The step from where its miss was found.
    fn step(&self) -> Option<f64> {
        Some((-self.miss? / self.slope).clamp(-LARGEST_STEP, LARGEST_STEP))
    }
}

/// ln A in the middle of every interval in which something may hide, with a guess of ln K.
fn halves(line: &[ScanPoint]) -> Vec<(f64, f64)> {
    let wanted = |at: usize| {
        let (a, b) = (&line[at], &line[at + 1]);
        let wide = b.ln_a - a.ln_a > FINEST;
        let lowest = is_lowest(line, at) || is_lowest(line, at + 1);
        wide && (lowest || ends(a, b) || changes_sign(a, b) || jumps(line, at))
    };
    let half = |at: usize| {
        let (a, b) = (&line[at], &line[at + 1]);
        (0.5 * (a.ln_a + b.ln_a), 0.5 * (a.ln_k + b.ln_k))
    };
    let intervals = 0..line.len().saturating_sub(1);
    intervals.filter(|at| wanted(*at)).map(half).collect()
}

/// Whether chi-square is no larger at a place than beside it.
fn is_lowest(line: &[ScanPoint], at: usize) -> bool {
    let own = line[at].chi_square();
    let beside = |other: Option<&ScanPoint>| other.is_none_or(|other| own <= other.chi_square());
    own.is_finite() && beside(at.checked_sub(1).map(|at| &line[at])) && beside(line.get(at + 1))
}

fn ends(a: &ScanPoint, b: &ScanPoint) -> bool {
    a.residuals.is_some() != b.residuals.is_some()
}

/// The changes of all residuals but that which the line meets.
fn changes(a: &ScanPoint, b: &ScanPoint) -> Vec<(f64, f64)> {
    let (Some(a), Some(b)) = (&a.residuals, &b.residuals) else {
        return Vec::new();
    };
    a.iter().copied().zip(b.iter().copied()).skip(1).collect()
}

fn changes_sign(a: &ScanPoint, b: &ScanPoint) -> bool {
    changes(a, b).iter().any(|(a, b)| a * b <= 0.0)
}

/// Whether a residual changes much faster than in both intervals beside.
fn jumps(line: &[ScanPoint], at: usize) -> bool {
    let rates = |at: usize| {
        let (a, b) = (&line[at], line.get(at + 1)?);
        let rate = |(from, to): (f64, f64)| (to - from).abs() / (b.ln_a - a.ln_a);
        Some(changes(a, b).into_iter().map(rate).collect::<Vec<f64>>())
    };
    let own = rates(at).unwrap_or_default();
    let beside = [at.checked_sub(1).and_then(rates), rates(at + 1)];
    let usual = |of: usize| {
        let all = beside.iter().flatten().filter_map(|rates| rates.get(of));
        all.fold(0.0, |most: f64, rate| most.max(*rate))
    };
    let faster = |(of, rate): (usize, &f64)| *rate > JUMP * usual(of).max(1.0 / STEP);
    own.iter().enumerate().any(faster)
}

/// Where chi-square is lowest along the line, and the better ends of intervals in which a
/// residual changes its sign: points K, A, best first, those that are the same once.
fn candidates(line: &[ScanPoint]) -> Vec<[f64; 2]> {
    let lowest = (0..line.len()).filter(|at| is_lowest(line, *at));
    let crossed = (1..line.len()).filter(|at| changes_sign(&line[at - 1], &line[*at]));
    let better = |at: usize| match line[at - 1].chi_square() < line[at].chi_square() {
        true => at - 1,
        false => at,
    };
    let mut all: Vec<&ScanPoint> = lowest.chain(crossed.map(better)).map(|at| &line[at]).collect();
    all.sort_by(|a, b| a.chi_square().total_cmp(&b.chi_square()));
    let far = |place: &ScanPoint| place.chi_square() > TOO_FAR;
    let mut apart: Vec<&ScanPoint> = Vec::new();
    for place in all {
        // The best stays, to be reported with its distance.
        if !apart.is_empty() && far(place) {
            break;
        }
        if apart.iter().all(|known| (known.ln_a - place.ln_a).abs() > FINEST) {
            apart.push(place);
        }
    }
    apart.iter().map(|place| [place.ln_k.exp(), place.ln_a.exp()]).collect()
}

/// Spans of A in s without residuals.
fn missing(line: &[ScanPoint]) -> Vec<[f64; 2]> {
    let mut spans: Vec<[f64; 2]> = Vec::new();
    let mut within = false;
    for place in line {
        let (a, gap) = (place.ln_a.exp(), place.residuals.is_none());
        match (gap, within, spans.last_mut()) {
            (true, true, Some(span)) => span[1] = a,
            (true, _, _) => spans.push([a, a]),
            _ => {}
        }
        within = gap;
    }
    spans
}

/// The smallest A, times that of the dry contacts: no liquid damps less than none by much.
const LEAST_TIMES_DRY: f64 = 0.5;

/// Steps in ln A, to 64 times the dry A.
const STEPS: usize = 60;
const STEP: f64 = 0.0809;

/// Halvings of a step where something may hide, to this step in ln A.
const HALVINGS: usize = 4;
const FINEST: f64 = 0.0055;

/// How many times faster than beside it a residual changes where it jumps.
const JUMP: f64 = 4.0;

/// Chi-square on the line from which no pair is near: the finest step changes a row's other
/// numbers by a few standard errors, and errors of the dry contacts' numbers by as many; a jump
/// from one side of a number to the other is no pair.
const TOO_FAR: f64 = 400.0;

/// d ln(time of flight)/d ln K of waves in a row of beads that hardly damps: −2/5.
const SLOPE: f64 = -0.4;
const STEEPEST: f64 = -4.0;
const FLATTEST: f64 = -0.04;

/// The largest step of ln K at once.
const LARGEST_STEP: f64 = 1.0;

/// Most secants.
const SECANTS: usize = 12;

/// How near the line meets its number, in standard errors.
const NEAR: f64 = 0.03;

#[cfg(test)]
#[path = "tests/scan.rs"]
mod tests;
