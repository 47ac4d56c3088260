//! `gauge`: which oil is on the contacts.

mod results;
mod tables;

pub use self::{results::json, tables::tables};

use crate::failure::Failure;
use crate::inference::{self, check_cancelled, user};
use crate::input::assumed_preset;
use crate::options::GaugeOptions as Arguments;
use hertzchain_experiment::Experiment;
use hertzchain_infer::gauge::{Chains, Gauge, Oil, Verdict, WetRow, known_oils, oils};
use hertzchain_infer::{CurveProblem, Data, Fit};
use hertzchain_measure::records::text;
use hertzchain_measure::signal::ChiSquare;
use std::path::Path;

/// Everything that the gauge says.
pub struct GaugeResult {
    /// The gauge.
    pub gauge: Gauge,
    /// K and A, speed by speed.
    pub rows: Vec<WetRow>,
    /// Which oil.
    pub verdict: Verdict,
    /// The oils it was held against.
    pub oils: Vec<Oil>,
    /// The film's numbers over both curves together and chi-square of the wet data, where they were
    /// asked for in place of oils.
    pub film: Option<(CurveProblem, Fit, Option<ChiSquare>)>,
}

/// Compares known oils with a row's contacts, from times of flight of the wet and of the dry row.
///
/// ```no_run
/// use hertzchain::prelude::*;
///
/// let options = GaugeOptions::default();
/// let measured = measure(&["shots".into()], &MeasureOptions::default())?;
/// let data = [measured.curve("wet")?, measured.curve("dry")?];
/// let oils = hertzchain::gauge::all_oils(None)?;
/// let found = gauge(data, [&preset("pump")?, &preset("dry")?], oils, &options)?;
/// println!("{:#}", hertzchain::gauge::json(&found)["verdict"]);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// Data and models that do not fit together; what is in the way of the dry fit or of the verdict.
pub fn gauge(
    [wet, dry]: [Data; 2],
    [wet_row, dry_row]: [&Experiment; 2],
    oils: Vec<Oil>,
    options: &Arguments,
) -> Result<GaugeResult, Failure> {
    let dry_row = inference::in_case(dry_row.clone(), &dry.case)?;
    let systematic = options.systematic.iter().map(|one| inference::systematic(&dry_row, one));
    let chains = Chains {
        wet: &inference::in_case(wet_row.clone(), &wet.case)?,
        dry: &dry_row,
        systematic: &systematic.collect::<Result<Vec<_>, _>>().map_err(user)?,
        free: &options.dry_free,
        own: &options.own,
        film: &options.film,
        accuracy: options.accuracy.0,
    };
    let gauge = Gauge::new(&chains, dry, wet);
    check_cancelled()?;
    let gauge = gauge.map_err(user)?;
    let rows = gauge.rows();
    check_cancelled()?;
    let film = (!options.film.is_empty()).then(|| gauge.film());
    let verdict = match &film {
        None => gauge.verdict(&oils),
        Some(_) => Ok(Verdict { matches: Vec::new(), failed: Vec::new() }),
    };
    check_cancelled()?;
    let film = film.transpose().map_err(user)?;
    Ok(GaugeResult { verdict: verdict.map_err(user)?, oils, rows, film, gauge })
}

/// Presets of the paper where no model is named.
const USUAL: [&str; 2] = ["pump", "dry"];

/// The wet chain and the dry one, each in the case of its data.
pub(crate) fn models(arguments: &Arguments, cases: [&str; 2]) -> Result<[Experiment; 2], Failure> {
    let (wet, dry) = (arguments.model.as_deref(), arguments.dry_model.as_deref());
    Ok([
        inference::opened_or((wet, &arguments.preset), USUAL[0], cases[0])?,
        inference::opened_or((dry, &arguments.dry_preset), USUAL[1], cases[1])?,
    ])
}

/// That models which were not named are those of the paper.
pub(crate) fn assumed_models(wet_is_named: bool, dry_is_named: bool) -> Option<String> {
    let wet = "--model FILE or --preset NAME";
    let dry = "--dry-model FILE or --dry-preset NAME";
    let wet = (!wet_is_named)
        .then(|| assumed_preset("model of the wet chain", "row of 40 beads", USUAL[0], wet));
    let dry = (!dry_is_named)
        .then(|| assumed_preset("model of the dry chain", "row of 40 beads", USUAL[1], dry));
    let all: Vec<String> = wet.into_iter().chain(dry).collect();
    (!all.is_empty()).then(|| all.join(". "))
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
        let own = oils(&file.display().to_string(), &text).map_err(user)?;
        if let Some(known) = own.iter().find(|oil| all.iter().any(|known| known.name == oil.name)) {
            let name = &known.name;
            return Err(Failure::User(format!(
                "--oils {}: {name} is an oil that the program knows; give yours another name",
                file.display()
            )));
        }
        all.extend(own);
    }
    Ok(all)
}
