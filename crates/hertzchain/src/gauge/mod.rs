//! `gauge`: which oil is on the contacts.

mod results;
mod tables;

pub use results::json;
pub use tables::tables;

use crate::failure::Failure;
use crate::inference::{self, user, wanted};
use crate::input::assumed_preset;
use crate::options::{CurveOptions as Measured, GaugeOptions as Arguments, WetForm};
use hertzchain_experiment::Experiment;
use hertzchain_infer::Data;
use hertzchain_infer::gauge::{Chains, Gauge, GaugeLaws, Oil, Verdict, WetRow, known_oils, oils};
use hertzchain_measure::records::text;
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
    form: WetForm,
) -> Result<Gauged, Failure> {
    if form == WetForm::Power {
        return Err(Failure::User(
            "gauge fits no power laws of whole curves any more: use \
             `hertzchain fit WET --free wet.K:power,wet.A:power`"
                .to_owned(),
        ));
    }
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

impl Gauged {
    /// What speaks against believing it.
    #[must_use]
    pub fn doubts(&self) -> Option<String> {
        self.gauge.doubts(&self.verdict)
    }

    /// What to add to data that do not tell K and A apart, if nothing else does.
    #[must_use]
    pub fn to_add(&self) -> Option<&'static str> {
        self.gauge.to_add()
    }
}

/// Presets of the paper where no model is named.
const USUAL: [&str; 2] = ["pump", "dry"];

/// The wet chain and the dry one, each in the case of its data.
///
/// # Errors
/// A model that can't be read or has no such case.
pub fn models(arguments: &Arguments, cases: [&str; 2]) -> Result<[Experiment; 2], Failure> {
    let (wet, dry) = (arguments.model.as_deref(), arguments.dry_model.as_deref());
    Ok([
        inference::opened_or((wet, &arguments.preset), USUAL[0], cases[0])?,
        inference::opened_or((dry, &arguments.dry_preset), USUAL[1], cases[1])?,
    ])
}

/// That models which were not named are those of the paper.
#[must_use]
pub fn assumed_models(wet_is_named: bool, dry_is_named: bool) -> Option<String> {
    let wet = "--model FILE or --preset NAME";
    let dry = "--dry-model FILE or --dry-preset NAME";
    let wet = (!wet_is_named)
        .then(|| assumed_preset("model of the wet chain", "row of 40 beads", USUAL[0], wet));
    let dry = (!dry_is_named)
        .then(|| assumed_preset("model of the dry chain", "row of 40 beads", USUAL[1], dry));
    let all: Vec<String> = wet.into_iter().chain(dry).collect();
    (!all.is_empty()).then(|| all.join(". "))
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
        let text = text(file).map_err(unread)?;
        all.extend(oils(&file.display().to_string(), &text).map_err(user)?);
    }
    Ok(all)
}
