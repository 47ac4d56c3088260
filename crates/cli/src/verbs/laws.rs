//! `hertzchain laws`: every contact law, from the registry.

use crate::arguments::Laws;
use crate::bibliography::Work;
use crate::failure::Failure;
use crate::{format, print};
use hertzchain_chain::laws::{LAWS, LawInfo, Nature, Parameter, Source, find};
use serde_json::{Value as Json, json};

/// Runs the verb.
pub fn run(arguments: &Laws) -> Result<(), Failure> {
    let infos: Vec<&LawInfo> = match &arguments.name {
        Some(name) => vec![&find(name).ok_or_else(|| unknown(name))?.info],
        None => LAWS.iter().map(|row| &row.info).collect(),
    };
    if arguments.json {
        return print::print_json(&infos.iter().map(|info| as_json(info)).collect::<Json>());
    }
    let texts: Vec<String> = infos.iter().map(|info| as_text(info)).collect();
    print::print(texts.join("\n").trim_end())
}

fn unknown(name: &str) -> Failure {
    let names: Vec<&str> = LAWS.iter().map(|row| row.info.name).collect();
    Failure::User(format!(
        "there is no law `{name}`; expected one of: {}",
        names.join(", ")
    ))
}

fn nature(info: &LawInfo) -> &'static str {
    match info.nature {
        Nature::Elastic => "elastic",
        Nature::Dissipative => "dissipative",
        Nature::ElasticPlastic => "elastic-plastic",
    }
}

fn as_text(info: &LawInfo) -> String {
    let gate = if info.gated {
        "while the contact is closed"
    } else {
        "always, also across gaps"
    };
    let mut rows = vec![
        ("equation".to_owned(), info.equation.to_owned()),
        ("kind".to_owned(), nature(info).to_owned()),
        ("acts".to_owned(), gate.to_owned()),
        ("validity".to_owned(), info.validity.to_owned()),
        ("source".to_owned(), source(info)),
    ];
    rows.extend(
        info.parameters
            .iter()
            .map(|p| (p.name.to_owned(), parameter(p))),
    );
    format!("{}\n{}", print::heading(info.name), format::pairs(&rows))
}

/// The work that a law is from, and its key in the bibliography.
fn source(info: &LawInfo) -> String {
    let key = format!("[{}]", info.reference);
    match Work::of_key(info.reference) {
        Some(work) => format!("{} {key}", work.lines().join("\n")),
        None => key,
    }
}

fn source_json(info: &LawInfo) -> Json {
    Work::of_key(info.reference).map_or(Json::Null, |work| {
        json!({
            "authors": work.authors,
            "title": work.title,
            "journal": work.journal,
            "volume": work.volume,
            "pages": work.pages,
            "year": work.year.parse::<i32>().ok(),
        })
    })
}

fn default(parameter: &Parameter) -> String {
    match parameter.source {
        Source::Required => "required".to_owned(),
        Source::Materials => "default: from the materials".to_owned(),
        Source::Hertz => "default: the section's elastic_hertz, else the materials".to_owned(),
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

fn as_json(info: &LawInfo) -> Json {
    let parameter = |p: &Parameter| {
        let value = match p.source {
            Source::Default(value) => json!(value),
            Source::Required | Source::Materials | Source::Hertz => Json::Null,
        };
        json!({
            "name": p.name,
            "unit": p.unit,
            "meaning": p.meaning,
            "required": p.source == Source::Required,
            "from_elastic_hertz": p.source == Source::Hertz,
            "from_materials": p.source.is_derived(),
            "default": value,
            "least": p.least,
        })
    };
    json!({
        "name": info.name,
        "equation": info.equation,
        "nature": nature(info),
        "gated": info.gated,
        "validity": info.validity,
        "reference": info.reference,
        "source": source_json(info),
        "parameters": info.parameters.iter().map(parameter).collect::<Json>(),
    })
}
