//! Power laws through K and A of the wet contacts.

use super::contacts::{Pair, WetRow};
use hertzchain_measure::signal::{FitError, PowerLaw, power_law};

/// A power law of speed through values that share a part of their errors.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedLaw {
    /// The law, with standard errors from the rows' own.
    pub law: PowerLaw,
    /// Standard error of ln prefactor with what the rows share.
    pub ln_prefactor_sd: f64,
    /// Standard error of the exponent with what the rows share.
    pub exponent_sd: f64,
    /// Chi-square of the rows' own errors over degrees of freedom: well above 1,
    /// the values follow no power law.
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
    /// Through all rows that tell both, and by which pair.
    ///
    /// # Errors
    /// Fewer than three such rows.
    pub fn through(rows: &[WetRow]) -> Result<Self, FitError> {
        let both = |row: &WetRow| {
            let contact = row.told.as_ref().ok()?;
            // A law through pairs of several branches is none.
            let both = contact.is_known();
            both.then(|| (row.speed_m_s, contact.first.clone()))
        };
        let known: Vec<(f64, Pair)> = rows.iter().filter_map(both).collect();
        Ok(Self {
            stiffness: law(&known, 0)?,
            relaxation: law(&known, 1)?,
        })
    }
}

fn law(known: &[(f64, Pair)], of: usize) -> Result<SharedLaw, FitError> {
    if known.len() < 3 {
        return Err(FitError::TooFew);
    }
    let speeds: Vec<f64> = known.iter().map(|(speed, _)| *speed).collect();
    let relative: Vec<f64> = known.iter().map(|(_, c)| c.own[of][of].sqrt()).collect();
    let through = |shift: &dyn Fn(&Pair) -> f64| {
        let value = |(_, pair): &(f64, Pair)| (pair.ln[of] + shift(pair)).exp();
        let values: Vec<f64> = known.iter().map(value).collect();
        let sigmas: Vec<f64> = values.iter().zip(&relative).map(|(v, r)| v * r).collect();
        power_law(&speeds, &values, Some(&sigmas))
    };
    let own = through(&|_| 0.0)?;
    let shifts = known.iter().map(|(_, c)| c.shared.len()).min().unwrap_or(0);
    let mut variances = [
        (own.prefactor_error / own.prefactor).powi(2),
        own.exponent_error.powi(2),
    ];
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
