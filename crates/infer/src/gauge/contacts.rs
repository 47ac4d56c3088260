//! K and A of the wet contacts, speed by speed.

use super::dry::shifts;
use super::neighbours::{Chosen, smoothest};
use super::scan::Scan;
use super::solutions::{Solution, Solved};
use super::{CONTACT, Gauge};
use crate::curve::{CurveProblem, Joint, Part, Supply};
use crate::data::{Data, Observable};
use crate::{FitError, Parameter, Problem};
use rayon::prelude::*;

/// What one speed tells of the wet contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct WetRow {
    /// Line of the wet table.
    pub line: u64,
    /// Speed of the striker in m/s.
    pub speed_m_s: f64,
    /// K and A, or the one combination that is determined, or why neither.
    pub told: Result<Contact, String>,
}

/// K and A of the wet contacts at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The pair that is told, or that stands first of several.
    pub first: Pair,
    /// Other pairs that fit as well.
    pub others: Vec<Pair>,
    /// Why the first pair stands before the others.
    pub branch: Branch,
    /// How far pairs were looked for; `None` where one number alone was measured.
    pub scan: Option<Scan>,
    /// Where only one number was measured: what it determines.
    pub combination: Option<Combination>,
}

/// K and A that fit a row, and how well they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// ln K, K in N/m^{3/2}, and ln A, A in s.
    pub ln: [f64; 2],
    /// Covariance of both from this row's measurements alone.
    pub own: [[f64; 2]; 2],
    /// Shifts of both by one standard error of each independent shift of the dry
    /// contacts' numbers: common to all rows.
    pub shared: Vec<[f64; 2]>,
}

/// A value of which so many standard errors reach 0 is not determined, as neither K nor A can
/// be less: its error is no ellipse's any more.
const REACH: f64 = 2.0;

/// Whether a positive number is known well enough to be told with its standard error.
#[must_use]
pub fn is_told(value: f64, standard_error: f64) -> bool {
    REACH * standard_error < value
}

impl Pair {
    /// One whose errors could not be computed.
    fn unknown(ln: [f64; 2]) -> Self {
        Self {
            ln,
            own: [[f64::INFINITY, 0.0], [0.0, f64::INFINITY]],
            shared: Vec::new(),
        }
    }

    /// Whole covariance of ln K and ln A.
    #[must_use]
    pub fn covariance(&self) -> [[f64; 2]; 2] {
        let mut sum = self.own;
        for shift in &self.shared {
            for i in 0..2 {
                for j in 0..2 {
                    sum[i][j] += shift[i] * shift[j];
                }
            }
        }
        sum
    }

    /// K in N/m^{3/2} (or the combination) and A in s, each with its standard error.
    #[must_use]
    pub fn estimates(&self) -> [(f64, f64); 2] {
        let covariance = self.covariance();
        [0, 1].map(|i| {
            let value = self.ln[i].exp();
            (value, value * covariance[i][i].sqrt())
        })
    }
}

/// Why a pair stands before the others of its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// There is no other.
    Only,
    /// It goes on from those of neighbouring speeds; every way through another bends much more.
    Smooth,
    /// Nothing tells it from the others.
    Unknown,
}

impl Branch {
    /// What it is called.
    #[must_use]
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
    /// Exponent of A: how many times less K must be for A twice as large is
    /// 2^`exponent`, without any change of what was measured.
    pub exponent: f64,
    /// A₀ in s, that of the dry contacts.
    pub reference_s: f64,
}

impl Contact {
    /// Whether both numbers are told, and by which pair.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.combination.is_none() && self.branch != Branch::Unknown
    }

    /// All pairs, the smallest A first.
    #[must_use]
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

impl Gauge {
    /// What each speed of the wet data tells of the wet contacts.
    #[must_use]
    pub fn rows(&self) -> Vec<WetRow> {
        let shifts = shifts(&self.dry_covariance.matrix);
        let numbers = (0..self.data.rows.len()).into_par_iter();
        let solved: Vec<Solved> = numbers
            .map(|at| self.solutions(at, self.free(at), &shifts))
            .collect();
        let taken = self.taken(&solved);
        let all = solved.into_par_iter().zip(taken).enumerate();
        let row = |(at, (solved, chosen)): (usize, (Solved, Chosen))| {
            let row = &self.data.rows[at];
            let told = solved.and_then(|found| {
                let told = self.contact(at, (found, chosen), &shifts);
                told.map_err(|error| error.to_string())
            });
            WetRow {
                line: row.line,
                speed_m_s: row.speed_m_s.value,
                told,
            }
        };
        all.map(row).collect()
    }

    fn free(&self, row: usize) -> Free {
        match self.data.rows[row].observables().count() {
            1 => Free::StiffnessAlone,
            _ => Free::Both,
        }
    }

    /// Of each row's solutions the one that goes on most smoothly from its neighbours'.
    fn taken(&self, solved: &[Solved]) -> Vec<Chosen> {
        let both = |at: &usize| self.free(*at) == Free::Both;
        let known = |at: usize| {
            let pairs = solved[at].as_ref().ok()?.0.iter();
            let speed = self.data.rows[at].speed_m_s.value;
            Some((
                at,
                (speed.ln(), pairs.map(|pair| pair.point[1].ln()).collect()),
            ))
        };
        let mut rows: Vec<(usize, (f64, Vec<f64>))> =
            (0..solved.len()).filter(both).filter_map(known).collect();
        rows.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let (places, rows): (Vec<usize>, Vec<(f64, Vec<f64>)>) = rows.into_iter().unzip();
        let mut taken = vec![Chosen::default(); solved.len()];
        for (place, chosen) in places.into_iter().zip(smoothest(&rows)) {
            taken[place] = chosen;
        }
        taken
    }

    fn contact(
        &self,
        row: usize,
        ((mut solutions, scan), chosen): ((Vec<Solution>, Option<Scan>), Chosen),
        shifts: &[Vec<f64>],
    ) -> Result<Contact, FitError> {
        let free = self.free(row);
        let first = solutions.remove(chosen.pair);
        let branch = match (solutions.is_empty(), chosen.is_clear) {
            (true, _) => Branch::Only,
            (_, true) => Branch::Smooth,
            (_, false) => Branch::Unknown,
        };
        let other = |solution: Solution| {
            let known = self.pair(row, &solution, shifts);
            known.unwrap_or_else(|_| Pair::unknown(solution.point.map(f64::ln)))
        };
        Ok(Contact {
            first: self.pair(row, &first, shifts)?,
            others: solutions.into_iter().map(other).collect(),
            branch,
            scan,
            combination: match free {
                Free::Both => None,
                Free::StiffnessAlone => Some(self.combination(row, first.point)?),
            },
        })
    }

    /// A solution with its errors: the row's own, and those of the dry contacts' numbers.
    fn pair(&self, row: usize, solution: &Solution, shifts: &[Vec<f64>]) -> Result<Pair, FitError> {
        let point = solution.point;
        let mut shared = Vec::new();
        // Those after them move nothing but the dry chain's own numbers.
        for shift in &shifts[..self.common()] {
            let moved = self.dry_fit.point.iter().zip(shift).map(|(x, s)| x + s);
            let moved: Vec<f64> = moved.collect();
            let other = self.solved(row, self.free(row), &moved, point)?.point;
            shared.push([0, 1].map(|i| (other[i] / point[i]).ln()));
        }
        let entry = |i: usize, j: usize| {
            let of = solution.covariance.matrix.get(i).and_then(|row| row.get(j));
            of.map_or(0.0, |c| c / (point[i] * point[j]))
        };
        Ok(Pair {
            ln: point.map(f64::ln),
            own: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
            shared,
        })
    }

    /// The last of the wet model's parameters: K and A.
    fn start(&self) -> Vec<Parameter> {
        let numbers = self.wet.numbers().as_slice();
        let contact = numbers[numbers.len() - CONTACT..].iter();
        contact.flat_map(|number| number.parameters(&[])).collect()
    }

    pub(super) fn row_problem(
        &self,
        row: usize,
        (free, at): (Free, [f64; 2]),
        dry: &[f64],
    ) -> Joint {
        let data = Data {
            rows: vec![self.data.rows[row].clone()],
            ..self.data.clone()
        };
        let mut start = self.start();
        for (parameter, value) in start.iter_mut().zip(at) {
            parameter.start = value;
            parameter.scale = value;
        }
        // Beyond the line nobody looked, and shots through contacts that hardly move take ages.
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
        let parameters = match free {
            Free::Both => {
                supplies.push(Supply::Free(1));
                start
            }
            Free::StiffnessAlone => {
                supplies.push(Supply::Fixed(at[1]));
                start.into_iter().take(1).collect()
            }
        };
        let problem = CurveProblem::part(self.wet.clone(), data);
        Joint::new(parameters, vec![Part { problem, supplies }])
    }

    /// What a change of A is worth in K, from derivatives of the one residual.
    fn combination(&self, row: usize, point: [f64; 2]) -> Result<Combination, FitError> {
        let problem = self.row_problem(row, (Free::Both, point), &self.dry_fit.point);
        let moved = |at: usize, sign: f64| {
            let mut moved = point.to_vec();
            moved[at] *= (sign * STEP).exp();
            moved
        };
        let points = [moved(0, 1.0), moved(0, -1.0), moved(1, 1.0), moved(1, -1.0)];
        let found = problem.residuals(&points);
        let mut first = Vec::new();
        for residuals in found {
            let residuals = residuals.map_err(FitError::Start)?.standardised;
            first.push(residuals.first().copied().unwrap_or(f64::NAN));
        }
        let slopes = [first[0] - first[1], first[2] - first[3]];
        Ok(Combination {
            exponent: slopes[1] / slopes[0],
            reference_s: point[1],
        })
    }

    /// Whether any row has more than one number, so that K and A come apart.
    #[must_use]
    pub fn tells_both(&self) -> bool {
        let rows = &self.data.rows;
        rows.iter().any(|row| row.observables().count() > 1)
    }

    /// What to add to data that do not tell K and A apart.
    #[must_use]
    pub fn to_add(&self) -> Option<&'static str> {
        let missing = !self.tells_both() && !self.data.has(Observable::Reflected);
        missing.then_some(
            "add reflected times of flight (a column tof_reflected_s with its errors), or ratios of \
             the returning to the passing peak (--use incident,returning-ratio); or state that K and A are \
             power laws of speed, which a whole curve can tell where speeds are known well (--form power)",
        )
    }
}

/// Half the step in ln K and ln A of the derivatives.
const STEP: f64 = 0.01;

#[cfg(test)]
#[path = "tests/contacts.rs"]
mod tests;
