//! `hertzchain gauge`: which oil is on the contacts.

mod pictures;
mod report;

use crate::arguments::infer::{Gauge as Arguments, Measured};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::inference::{self, user};
use crate::print;
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

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let wet = data(
        &arguments.wet,
        &arguments.measured,
        arguments.wet_case.as_deref(),
    )?;
    let dry = data(
        &arguments.dry,
        &arguments.measured,
        arguments.dry_case.as_deref(),
    )?;
    let oils = all_oils(&arguments.oils)?;
    let wet_model = inference::opened(arguments.model.as_deref(), &arguments.preset, &wet.case)?;
    let dry_model = inference::opened(
        arguments.dry_model.as_deref(),
        &arguments.dry_preset,
        &dry.case,
    )?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let pool = inference::pool(arguments.threads)?;
    let chains = Chains {
        dry: &dry_model,
        wet: &wet_model,
        free: &arguments.dry_free,
        accuracy: arguments.accuracy,
    };
    let gauged = pool.install(|| gauged(&chains, (dry, wet), oils))?;
    let all = report::json(&gauged);
    match arguments.json {
        true => print::print_json(&all)?,
        false => print::print(&report::text(&gauged))?,
    }
    folder.map_or(Ok(()), |folder| write(folder, &gauged, &all))
}

fn gauged(
    chains: &Chains<'_>,
    (dry, wet): (Data, Data),
    oils: Vec<Oil>,
) -> Result<Gauged, Failure> {
    let gauge = Gauge::new(chains, dry, wet).map_err(user)?;
    let rows = gauge.rows();
    Ok(Gauged {
        laws: GaugeLaws::through(&rows).ok(),
        verdict: gauge.verdict(&oils).map_err(user)?,
        oils,
        rows,
        gauge,
    })
}

fn data(file: &Path, measured: &Measured, case: Option<&str>) -> Result<Data, Failure> {
    let case = case.map(str::to_owned).or_else(|| measured.case.clone());
    inference::data_of(file, measured, case)
}

/// The program's oils and those of the user's table.
fn all_oils(file: &Option<std::path::PathBuf>) -> Result<Vec<Oil>, Failure> {
    let mut all = known_oils().map_err(|error| Failure::Ours(error.to_string()))?;
    if let Some(file) = file {
        let unread = |error| Failure::User(format!("--oils {}: {error}", file.display()));
        let text = fs::read_to_string(file).map_err(unread)?;
        all.extend(oils(&file.display().to_string(), &text).map_err(user)?);
    }
    Ok(all)
}

fn write(mut folder: Folder, gauged: &Gauged, all: &serde_json::Value) -> Result<(), Failure> {
    folder.write("gauge.json", format!("{all:#}\n").as_bytes())?;
    folder.write("contacts.csv", report::contacts_csv(gauged).as_bytes())?;
    if gauged.rows.iter().any(|row| row.told.is_ok()) {
        folder.figure("contacts", &pictures::contacts(gauged))?;
    }
    eprint!("Written:\n{}", folder.list());
    Ok(())
}
