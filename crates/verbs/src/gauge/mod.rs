//! `gauge`: which oil is on the contacts.

mod results;

pub use results::{contacts_csv, json};

use crate::arguments::infer::Measured;
use crate::failure::Failure;
use crate::inference::{self, user, wanted};
use hertzchain_infer::Data;
use hertzchain_infer::gauge::{Chains, Gauge, GaugeLaws, Oil, Verdict, WetRow, known_oils, oils};
use std::fs;
use std::path::Path;

/// Everything that the gauge says.
pub struct Gauged {
    /// The gauge.
    pub gauge: Gauge,
    /// K and A, speed by speed.
    pub rows: Vec<WetRow>,
    /// Power laws through them, where rows tell both.
    pub laws: Option<GaugeLaws>,
    /// Which oil.
    pub verdict: Verdict,
    /// The oils it was held against.
    pub oils: Vec<Oil>,
}

/// Holds what is measured against models and oils.
///
/// # Errors
/// What is in the way of the dry fit or of the verdict.
pub fn gauged(
    chains: &Chains<'_>,
    (dry, wet): (Data, Data),
    oils: Vec<Oil>,
) -> Result<Gauged, Failure> {
    let gauge = Gauge::new(chains, dry, wet);
    wanted()?;
    let gauge = gauge.map_err(user)?;
    let rows = gauge.rows();
    wanted()?;
    let verdict = gauge.verdict(&oils);
    wanted()?;
    Ok(Gauged {
        laws: GaugeLaws::through(&rows).ok(),
        verdict: verdict.map_err(user)?,
        oils,
        rows,
        gauge,
    })
}

/// The curve of a file, of this case or of the one that holds for all.
///
/// # Errors
/// A table that can't be used.
pub fn data(file: &Path, measured: &Measured, case: Option<&str>) -> Result<Data, Failure> {
    let case = case.map(str::to_owned).or_else(|| measured.case.clone());
    inference::data_of(file, measured, case)
}

/// The program's oils and those of the user's table.
///
/// # Errors
/// A table that can't be used.
pub fn all_oils(file: Option<&Path>) -> Result<Vec<Oil>, Failure> {
    let mut all = known_oils().map_err(|error| Failure::Ours(error.to_string()))?;
    if let Some(file) = file {
        let unread = |error| Failure::User(format!("--oils {}: {error}", file.display()));
        let text = fs::read_to_string(file).map_err(unread)?;
        all.extend(oils(&file.display().to_string(), &text).map_err(user)?);
    }
    Ok(all)
}
