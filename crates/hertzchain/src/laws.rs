//! The registry of contact laws as data.

use crate::bibliography::Publication;
use crate::failure::Failure;
use hertzchain_chain::laws::{LAWS, LawInfo, Nature, Parameter, Source, find};
use serde_json::{Value as Json, json};

/// The law of this name, or all.
///
/// # Errors
/// A name that no law has.
pub fn infos(name: Option<&str>) -> Result<Vec<&'static LawInfo>, Failure> {
    match name {
        Some(name) => Ok(vec![&find(name).ok_or_else(|| unknown(name))?.info]),
        None => Ok(LAWS.iter().map(|row| &row.info).collect()),
    }
}

/// Laws with equation, parameters, units and source.
pub fn json(infos: &[&LawInfo]) -> Json {
    infos.iter().map(|info| as_json(info)).collect()
}

fn unknown(name: &str) -> Failure {
    let names: Vec<&str> = LAWS.iter().map(|row| row.info.name).collect();
    Failure::User(format!("there is no law `{name}`; expected one of: {}", names.join(", ")))
}

/// What a law does with energy, in a word.
pub fn nature(info: &LawInfo) -> &'static str {
    match info.nature {
        Nature::Elastic => "elastic",
        Nature::Dissipative => "dissipative",
        Nature::ElasticPlastic => "elastic-plastic",
        Nature::WithState => "with state",
        Nature::Adhesive => "adhesive",
    }
}

fn as_json(info: &LawInfo) -> Json {
    let parameter = |p: &Parameter| {
        let value = match p.source {
            Source::Default(value) => json!(value),
            Source::Required | Source::Liquid | Source::Materials | Source::Hertz => Json::Null,
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
        "source": Publication::of_key(info.reference),
        "parameters": info.parameters.iter().map(parameter).collect::<Json>(),
    })
}
