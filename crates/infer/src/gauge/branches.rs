//! Which solution of each row to take, and power laws of speed through all rows.

use super::rows::{Pair, WetRow};
use hertzchain_measure::signal::{FitError, PowerLaw, power_law};

/// The solution of a row to take, and whether that is clear: every way through another bends much
/// more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Chosen {
    pub(super) pair: usize,
    pub(super) is_clear: bool,
}

/// ln speed and ln A of a row's solutions.
pub(super) type Row = (f64, Vec<f64>);

/// Rows that make three bends: of fewer, chance alone makes a way straight.
pub(super) const ENOUGH: usize = 5;
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
pub(super) fn smoothest(rows: &[Row]) -> Vec<Chosen> {
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

/// A power law of speed through values that share a part of their errors.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedLaw {
    /// The law, with standard errors from the rows' own.
    pub law: PowerLaw,
    /// Standard error of ln prefactor with what the rows share.
    pub ln_prefactor_sd: f64,
    /// Standard error of the exponent with what the rows share.
    pub exponent_sd: f64,
    /// Chi-square of the rows' own errors over degrees of freedom: well above 1, the values follow
    /// no power law.
    pub reduced_chi_square: f64,
}

/// Power laws of K and of A against speed.
#[derive(Clone, Debug, PartialEq)]
pub struct GaugeLaws {
    /// K in N/m^{3/2}.
    pub stiffness: SharedLaw,
    /// A in s.
    pub relaxation: SharedLaw,
}

impl GaugeLaws {
    /// Through all rows whose K and A are known.
    ///
    /// # Errors
    /// Fewer than three such rows.
    pub fn through(rows: &[WetRow]) -> Result<Self, FitError> {
        let known = rows.iter().filter_map(|row| {
            let contact = row.contact.as_ref().ok().filter(|contact| contact.is_known())?;
            Some((row.speed_m_s, &contact.first))
        });
        let known: Vec<(f64, &Pair)> = known.collect();
        Ok(Self { stiffness: law(&known, 0)?, relaxation: law(&known, 1)? })
    }
}

fn law(known: &[(f64, &Pair)], of: usize) -> Result<SharedLaw, FitError> {
    if known.len() < 3 {
        return Err(FitError::TooFew);
    }
    let speeds: Vec<f64> = known.iter().map(|(speed, _)| *speed).collect();
    let relative: Vec<f64> = known.iter().map(|(_, c)| c.own[of][of].sqrt()).collect();
    let through = |shift: &dyn Fn(&Pair) -> f64| {
        let values = known.iter().map(|(_, pair)| (pair.ln[of] + shift(pair)).exp());
        let values: Vec<f64> = values.collect();
        let sigmas: Vec<f64> = values.iter().zip(&relative).map(|(v, r)| v * r).collect();
        power_law(&speeds, &values, Some(&sigmas))
    };
    let own = through(&|_| 0.0)?;
    let shifts = known.iter().map(|(_, c)| c.shared.len()).min().unwrap_or(0);
    let ln_prefactor = own.prefactor_error / own.prefactor;
    let mut variances = [ln_prefactor.powi(2), own.exponent_error.powi(2)];
    for number in 0..shifts {
        let moved = through(&|pair| pair.shared[number][of])?;
        variances[0] += (moved.prefactor / own.prefactor).ln().powi(2);
        variances[1] += (moved.exponent - own.exponent).powi(2);
    }
    let misses = own.residuals.iter().zip(&relative);
    let chi_square: f64 = misses.map(|(miss, sigma)| (miss / sigma).powi(2)).sum();
    Ok(SharedLaw {
        ln_prefactor_sd: variances[0].sqrt(),
        exponent_sd: variances[1].sqrt(),
        reduced_chi_square: chi_square / (known.len() as f64 - 2.0),
        law: own,
    })
}

#[cfg(test)]
#[path = "tests/branches.rs"]
mod tests;
