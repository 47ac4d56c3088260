//! Options of the verbs, as declared for the command line.

use clap::{Args, Command};
use hertzchain::options::{
    DesignOptions, FitOptions, GaugeOptions, MeasureOptions, SimulationOptions,
};
use pyo3::prelude::*;

/// Names, defaults and descriptions of a verb's options.
#[pyfunction]
pub(crate) fn options(verb: &str) -> Vec<(String, Option<String>, String)> {
    let command = Command::new("options");
    let command = match verb {
        "measure" => MeasureOptions::augment_args(command),
        "fit" => FitOptions::augment_args(command),
        "design" => DesignOptions::augment_args(command),
        "gauge" => GaugeOptions::augment_args(command),
        _ => SimulationOptions::augment_args(command),
    };
    let one = |option: &clap::Arg| {
        let flag = !option.get_action().takes_values();
        let default = option.get_default_values().first();
        let default = default.map(|value| value.to_string_lossy().into_owned());
        Some((
            option.get_long()?.replace('-', "_"),
            default.or_else(|| flag.then(|| "false".to_owned())),
            option.get_help().map(ToString::to_string).unwrap_or_default(),
        ))
    };
    command.get_arguments().filter_map(one).collect()
}
