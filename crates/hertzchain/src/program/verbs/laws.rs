//! `hertzchain laws`: every contact law, from the registry.

use crate::bibliography::Publication;
use crate::laws::{self, nature};
use crate::program::arguments::LawsArguments;
use crate::program::{Failure, format, print};
use hertzchain_chain::laws::{LawInfo, Parameter, Source};

pub(crate) fn run(arguments: &LawsArguments) -> Result<(), Failure> {
    let infos = laws::infos(arguments.name.as_deref())?;
    if arguments.json {
        return print::print_json(&laws::json(&infos));
    }
    let texts: Vec<String> = infos.iter().map(|info| as_text(info)).collect();
    print::print(texts.join("\n").trim_end())
}

fn as_text(info: &LawInfo) -> String {
    let gate = if info.gated { "while the contact is closed" } else { "always, also across gaps" };
    let rows = [
        ("equation", info.equation.to_owned()),
        ("kind", nature(info).to_owned()),
        ("acts", gate.to_owned()),
        ("validity", info.validity.to_owned()),
        ("source", source(info)),
    ];
    let parameters = info.parameters.iter().map(|p| (p.name, parameter(p)));
    let rows = format::pairs(rows.into_iter().chain(parameters));
    format!("{}\n{rows}", print::heading(info.name))
}

/// The work that a law is from, and its key in the bibliography.
fn source(info: &LawInfo) -> String {
    let key = format!("[{}]", info.reference);
    match Publication::of_key(info.reference) {
        Some(work) => format!("{} {key}", work.lines().join("\n")),
        None => key,
    }
}

fn default(parameter: &Parameter) -> String {
    match parameter.source {
        Source::Required => "required".to_owned(),
        Source::Materials => "default: from the materials".to_owned(),
        Source::Hertz => "default: the section's elastic_hertz, else the materials".to_owned(),
        Source::Liquid => "default: of [liquid]".to_owned(),
        Source::Default(f64::INFINITY) => "default: of [liquid], else without limit".to_owned(),
        Source::Default(value) => format!("default: {value}"),
    }
}

fn parameter(parameter: &Parameter) -> String {
    let unit = match parameter.unit {
        "1" => "plain number",
        unit => unit,
    };
    format!("{} [{unit}]; {}", parameter.meaning, default(parameter))
}
