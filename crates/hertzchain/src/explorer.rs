//! The explorer's engine: what the page asks for beyond simulation, by the verbs of this library.

use crate::measure::MeasureResult;
use crate::options::{FitOptions, MeasureOptions, from_json};
use crate::{Failure, fit, inference, laws, measure};
use hertzchain_experiment::Experiment;
use hertzchain_explore::engine::Array;
use hertzchain_explore::{Recording, Verbs};
use hertzchain_infer::{Data, DataRow, Observable};
use hertzchain_measure::speeds_csv;
use serde_json::{Value, json};
use std::io;
use std::path::Path;

/// Answers one request of the page from standard input on standard output: the engine as a
/// program, which in WebAssembly the page runs anew for each request.
///
/// # Errors
/// Standard input that can't be read, or standard output that can't be written.
pub fn run_engine() -> io::Result<()> {
    // WebAssembly has no folder for temporary files of its own; the page provides this one.
    if cfg!(target_family = "wasm") {
        let _ = tempfile::env::override_temp_dir(Path::new("/tmp"));
    }
    hertzchain_explore::respond(&Library, io::stdin().lock(), io::stdout().lock())
}

pub(crate) struct Library;

impl Verbs for Library {
    fn laws(&self) -> Value {
        laws::infos(None).map_or(Value::Null, |infos| laws::json(&infos))
    }

    fn measure(&self, recording: &Recording) -> Result<Value, String> {
        measured(recording).map_err(|failure| failure.to_string())
    }

    fn fit(&self, text: &str, table: &str, options: &Value) -> Result<Value, String> {
        fit_of(text, table, options).map_err(|failure| failure.to_string())
    }
}

/// A recording, or a table if its first line names a column of speeds. Readers take files, so it is
/// one for a while.
fn measured(recording: &Recording) -> Result<Value, Failure> {
    let options: MeasureOptions = from_json("measure", recording.options.clone())?;
    let unwritten =
        |error: io::Error| Failure::Ours(format!("a temporary file can't be written: {error}"));
    let folder = tempfile::tempdir().map_err(unwritten)?;
    let file = folder.path().join(plain(&recording.name));
    std::fs::write(&file, &recording.bytes).map_err(unwritten)?;
    let found = match inference::is_table(&file, true)? {
        true => table(&recording.name, &recording.bytes),
        false => recorded(&file, &options),
    };
    let shown = folder.path().display().to_string() + std::path::MAIN_SEPARATOR_STR;
    found
        .map(|found| without(found, &shown))
        .map_err(|failure| Failure::User(failure.to_string().replace(&shown, "")))
}

/// A name without anything that leads out of a folder.
fn plain(name: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || matches!(c, '.' | '-' | '_' | ' ');
    let name: String = name.chars().filter(kept).take(100).collect();
    // A name of dots alone would be a folder.
    match name.trim_matches(['.', ' ']) {
        "" => "recording".to_owned(),
        kept => kept.to_owned(),
    }
}

/// A result whose texts no longer name the folder of temporary files.
fn without(found: Value, folder: &str) -> Value {
    match found {
        Value::String(text) => Value::String(text.replace(folder, "")),
        Value::Array(all) => all.into_iter().map(|one| without(one, folder)).collect(),
        Value::Object(all) => {
            let entries = all.into_iter();
            Value::Object(entries.map(|(key, one)| (key, without(one, folder))).collect())
        }
        other => other,
    }
}

fn table(name: &str, bytes: &[u8]) -> Result<Value, Failure> {
    let text = String::from_utf8_lossy(bytes);
    let options = FitOptions::default();
    let data = inference::parsed(name, &text, &options.measured, None)?;
    Ok(json!({ "kind": "table", "table": text, "points": points(&data) }))
}

fn points(data: &Data) -> Value {
    let one = |row: &DataRow| {
        let estimate = |of| row.value(of).map(|of| json!([of.value, of.sigma]));
        json!({
            "speed_m_s": [row.speed_m_s.value, row.speed_m_s.sigma],
            "tof_incident_s": estimate(Observable::Incident),
            "tof_reflected_s": estimate(Observable::Reflected),
        })
    };
    data.rows.iter().map(one).collect()
}

fn recorded(file: &Path, options: &MeasureOptions) -> Result<Value, Failure> {
    let MeasureResult { shots, curves } = crate::measure(&[file.to_owned()], options)?;
    let examples = shots.examples.iter().map(|example| {
        json!({
            "names": example.names,
            "case": example.shot.case,
            "interval_s": example.shot.interval_s,
            "volts": example.volts.iter().map(Array::of).collect::<Vec<_>>(),
        })
    });
    let first = curves.cases.first().map(|case| case.name.clone());
    let table = speeds_csv(&curves);
    let of_case = first.filter(|name| !name.is_empty());
    // Recordings without speeds have no curve, which is no mistake here.
    let data = inference::parsed("measured", &table, &FitOptions::default().measured, of_case);
    Ok(json!({
        "kind": "recording",
        "examples": examples.collect::<Value>(),
        "measured": measure::json(&shots, &curves),
        "table": table,
        "points": data.map_or(Value::Null, |data| points(&data)),
    }))
}

fn fit_of(text: &str, table: &str, options: &Value) -> Result<Value, Failure> {
    let options: FitOptions = from_json("fit", options.clone())?;
    let experiment = Experiment::from_text("experiment.toml", text)?;
    let data = inference::parsed("the table", table, &options.measured, None)?;
    let found = crate::fit(&data, &experiment, &options)?;
    let numbers = &found.problem.model().numbers;
    let places: Vec<Value> = numbers
        .iter()
        .map(|number| json!({ "name": number.name(), "path": number.path() }))
        .collect();
    let residuals = found.curves[0].predicted.iter().zip(&data.rows).map(|(predicted, row)| {
        // Predictions stand in the order of the observables.
        let [there, back, ..] = *predicted;
        let of = |what, predicted: Option<f64>| {
            let measured = row.value(what)?;
            Some(json!([measured.value - predicted?, measured.sigma]))
        };
        json!({
            "speed_m_s": row.speed_m_s.value,
            "tof_incident_s": of(Observable::Incident, there),
            "tof_reflected_s": of(Observable::Reflected, back),
        })
    });
    Ok(fit::joined(
        json!({ "places": places, "residuals": residuals.collect::<Value>() }),
        fit::json(&found, &options),
    ))
}
