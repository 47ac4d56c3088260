//! K and A of the wet contacts, speed by speed.

use super::dry::shifts;
use super::neighbours::smoothest;
use super::{CONTACT, Gauge};
use crate::curve::{CurveProblem, Joint, Part, Supply};
use crate::data::{Data, Observable};
use crate::{Covariance, FitError, Fitting, Parameter, Problem, fit};
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
    /// ln K, K in N/m^{3/2}, and ln A, A in s.
    pub ln: [f64; 2],
    /// Covariance of both from this row's measurements alone.
    pub own: [[f64; 2]; 2],
    /// Shifts of both by one standard error of each independent shift of the dry
    /// contacts' numbers: common to all rows.
    pub shared: Vec<[f64; 2]>,
    /// Other pairs ln K, ln A that fit as well.
    pub others: Vec<[f64; 2]>,
    /// Where only one number was measured: what it determines.
    pub combination: Option<Combination>,
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

/// K and A that fit a row.
struct Solution {
    point: [f64; 2],
    covariance: Covariance,
    cost: f64,
}

/// All solutions of a row, the smallest A first, at least one; or why there is none.
type Solved = Result<Vec<Solution>, FitError>;

/// What is free in a row, by the number of its measurements.
#[derive(Clone, Copy, PartialEq)]
enum Free {
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
            .map(|at| self.solutions(at, self.free(at)))
            .collect();
        let taken = self.taken(&solved);
        let all = solved.into_par_iter().zip(taken).enumerate();
        let row = |(at, (solutions, taken)): (usize, (Solved, usize))| {
            let row = &self.data.rows[at];
            let told = solutions.and_then(|found| self.contact(at, (found, taken), &shifts));
            WetRow {
                line: row.line,
                speed_m_s: row.speed_m_s.value,
                told: told.map_err(|error| error.to_string()),
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
    fn taken(&self, solved: &[Solved]) -> Vec<usize> {
        let both = |at: &usize| self.free(*at) == Free::Both;
        let known = |at: usize| {
            let pairs = solved[at].as_ref().ok()?.iter();
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
        let mut taken = vec![0; solved.len()];
        for (place, number) in places.into_iter().zip(smoothest(&rows)) {
            taken[place] = number;
        }
        taken
    }

    fn contact(
        &self,
        row: usize,
        (mut solutions, taken): (Vec<Solution>, usize),
        shifts: &[Vec<f64>],
    ) -> Result<Contact, FitError> {
        let free = self.free(row);
        let Solution {
            point, covariance, ..
        } = solutions.remove(taken);
        let mut shared = Vec::new();
        // Those after them move nothing but the dry chain's own numbers.
        for shift in &shifts[..self.common()] {
            let moved = self.dry_fit.point.iter().zip(shift).map(|(x, s)| x + s);
            let moved: Vec<f64> = moved.collect();
            let other = self.solved(row, free, &moved, point)?.point;
            shared.push([0, 1].map(|i| (other[i] / point[i]).ln()));
        }
        let entry = |i: usize, j: usize| {
            let of = covariance.matrix.get(i).and_then(|row| row.get(j));
            of.map_or(0.0, |c| c / (point[i] * point[j]))
        };
        Ok(Contact {
            ln: point.map(f64::ln),
            own: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
            shared,
            others: solutions
                .into_iter()
                .map(|s| s.point.map(f64::ln))
                .collect(),
            combination: match free {
                Free::Both => None,
                Free::StiffnessAlone => Some(self.combination(row, point)?),
            },
        })
    }

    /// All that fit as well as the best, from several starts, the smallest A first:
    /// times of flight need not determine K and A uniquely.
    fn solutions(&self, row: usize, free: Free) -> Result<Vec<Solution>, FitError> {
        let [stiffness, relaxation] = self.dry_contact;
        let starts = match free {
            Free::Both => &TIMES_DRY[..],
            Free::StiffnessAlone => &TIMES_DRY[..1],
        };
        let mut found: Vec<Solution> = Vec::new();
        let mut failed = None;
        for times in starts {
            match self.from(row, free, [stiffness, times * relaxation]) {
                Ok(solution) => found.push(solution),
                Err(error) => failed = Some(error),
            }
        }
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let Some(best) = found.first().map(|best| best.cost) else {
            return Err(failed.unwrap_or(FitError::NothingFree));
        };
        let mut distinct: Vec<Solution> = Vec::new();
        for solution in found {
            let same = |other: &Solution| (solution.point[1] / other.point[1]).ln().abs() < SAME;
            if solution.cost < best + AS_GOOD && !distinct.iter().any(same) {
                distinct.push(solution);
            }
        }
        distinct.sort_by(|a, b| a.point[1].total_cmp(&b.point[1]));
        Ok(distinct)
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
    fn solved(
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
            cost: fitted.cost,
        })
    }

    /// The last of the wet model's parameters: K and A.
    fn start(&self) -> Vec<Parameter> {
        let numbers = self.wet.numbers().as_slice();
        let contact = numbers[numbers.len() - CONTACT..].iter();
        contact.flat_map(|number| number.parameters(&[])).collect()
    }

    fn row_problem(&self, row: usize, (free, at): (Free, [f64; 2]), dry: &[f64]) -> Joint {
        let data = Data {
            rows: vec![self.data.rows[row].clone()],
            ..self.data.clone()
        };
        let mut start = self.start();
        for (parameter, value) in start.iter_mut().zip(at) {
            parameter.start = value;
            parameter.scale = value;
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

    /// What would tell solutions apart that fit one row equally well.
    #[must_use]
    pub fn ambiguous(rows: &[WetRow]) -> Option<&'static str> {
        let told = rows.iter().filter_map(|row| row.told.as_ref().ok());
        let several = told.into_iter().any(|contact| !contact.others.is_empty());
        several.then_some(
            "At some speeds several pairs of K and A give the same times. Ratios of peaks tell them apart \
             (--use incident,reflected,returning-ratio). Told first, and taken for power laws and the figure, \
             is the pair whose A goes on most smoothly from speed to speed (of fewer than three speeds, the \
             smallest A); the others stand beside it.",
        )
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

/// Half the step in ln K and ln A of the derivatives.
const STEP: f64 = 0.01;
