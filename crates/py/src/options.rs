//! Options of the verbs, as declared for the command line.

use crate::failure::PyFailure;
use clap::{Arg, ArgAction, Args, Command};
use hertzchain::failure::Failure;
use hertzchain::options::{
    DesignOptions, FitOptions, GaugeOptions, MeasureOptions, ShotOptions, SweepOptions, from_json,
};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

/// Options that a Python call has otherwise or not at all: data are arguments, results are objects.
const COMMAND_LINE: [&str; 16] = [
    "also",
    "animate",
    "data",
    "dry_preset",
    "file",
    "force",
    "json",
    "npy",
    "out",
    "preset",
    "records",
    "report",
    "resume",
    "shard",
    "dry",
    "wet",
];

/// Returns options from the JSON that Python made of its keywords.
pub(crate) fn parsed<A: Args + DeserializeOwned>(
    verb: &'static str,
    options: &str,
) -> Result<A, PyFailure> {
    let options = serde_json::from_str(options);
    let options = options.map_err(|error| Failure::User(format!("{verb}: {error}")))?;
    Ok(from_json(verb, options)?)
}

/// Names, types, defaults and descriptions of a verb's options.
#[pyfunction]
pub(crate) fn options(verb: &str) -> Vec<(String, String, Option<String>, String)> {
    let command = Command::new("options");
    let command = match verb {
        "measure" => MeasureOptions::augment_args(command),
        "fit" => FitOptions::augment_args(command),
        "design" => DesignOptions::augment_args(command),
        "gauge" => GaugeOptions::augment_args(command),
        "shot" => ShotOptions::augment_args(command),
        _ => SweepOptions::augment_args(command),
    };
    let one = |option: &Arg| {
        let default = option.get_default_values().first();
        let default = default.map(|value| value.to_string_lossy().into_owned());
        let flag = !option.get_action().takes_values();
        (
            option.get_id().to_string(),
            kind(option),
            default.or_else(|| flag.then(|| "false".to_owned())),
            option.get_help().map(ToString::to_string).unwrap_or_default(),
        )
    };
    let shown = |option: &&Arg| !COMMAND_LINE.contains(&option.get_id().as_str());
    command.get_arguments().filter(shown).map(one).collect()
}

/// The type of an option's values in Python.
fn kind(option: &Arg) -> String {
    let names: Vec<String> = option
        .get_possible_values()
        .iter()
        .map(|value| format!("\"{}\"", value.get_name()))
        .collect();
    let value_name = option.get_value_names().and_then(|names| names.first());
    let one = match value_name.map_or("", |name| name.as_str()) {
        _ if !option.get_action().takes_values() => return "bool".to_owned(),
        _ if !names.is_empty() => format!("Literal[{}]", names.join(", ")),
        "FILE" | "CSV" | "DIR" => "Path".to_owned(),
        name if name.contains('=') => return "Mapping[str, Any]".to_owned(),
        "NAME" | "CASE" | "UNIT" => "str | int".to_owned(),
        _ => "Quantity".to_owned(),
    };
    let several = matches!(option.get_action(), ArgAction::Append);
    match several || option.get_value_delimiter().is_some() {
        true => format!("{one} | Iterable[{one}]"),
        false => one,
    }
}
