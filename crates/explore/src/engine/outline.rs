//! An experiment as the page's controls show it.

use super::words::groups;
use super::{Edit, Mistake, Refusal, edit, effort};
use hertzchain_experiment::{
    Experiment, Preset, Units, campaigns, examples, film_presets, presets as own,
};
use hertzchain_sim::{describe, describe_theory};
use serde_json::{Value as Json, json};

/// Returns the experiments that come with the program: names, titles, kinds and texts.
pub(super) fn presets() -> Json {
    let reply = |kind: &'static str, presets: &'static [Preset]| {
        presets.iter().map(move |preset| {
            json!({ "name": preset.name, "title": preset.title(), "kind": kind, "text": preset.text })
        })
    };
    let others = reply("example", film_presets()).chain(reply("example", examples()));
    let others = others.chain(reply("campaign", campaigns()));
    reply("paper", own()).chain(others).collect()
}

/// Returns an experiment of a text that the page may ask for.
pub(super) fn experiment(text: &str) -> Result<Experiment, Refusal> {
    edit::check_length(text)?;
    // No folder: files that an experiment names are those beside the program.
    let experiment = Experiment::from_text("experiment.toml", text)
        .map_err(|mistakes| Refusal::of_text(text, &mistakes))?;
    effort::check_beads(experiment.beads())?;
    Ok(experiment)
}

/// Returns a text after edits with its tables and values, null where it is no TOML; its mistakes, and
/// what is understood of it if there are none.
pub(super) fn check(text: &str, edits: &[Edit]) -> Result<Json, Refusal> {
    let text = edit::edited(text, edits)?;
    let (outline, mistakes) = match outline(&text) {
        Ok(outline) => (outline, Vec::new()),
        Err(Refusal::Mistakes(mistakes)) => (Json::Null, mistakes),
        Err(other) => return Err(other),
    };
    let tree = edit::tree(&text);
    Ok(json!({ "tree": tree, "text": text, "mistakes": mistakes, "outline": outline }))
}

fn outline(text: &str) -> Result<Json, Refusal> {
    let experiment = experiment(text)?;
    let refused = |mistakes| Refusal::of_text(text, &mistakes);
    let (chain, _system, warnings) = experiment.chain_and_system(None).map_err(refused)?;
    let described = describe(&experiment, &chain);
    Ok(json!({
        "title": experiment.title(),
        "dimensionless": experiment.units() == Units::Dimensionless,
        "speed_m_s": experiment.speed_m_s(),
        "beads": experiment.beads(),
        "sensor_bead": experiment.sensor_bead(),
        "has_wall": experiment.has_wall(),
        "groups": groups(&described.map_err(|error| Refusal::of_study(text, error))?),
        "warnings": Mistake::all(text, &warnings),
    }))
}

/// Returns what theory says of an experiment's waves.
pub(super) fn theory(text: &str) -> Result<Json, Refusal> {
    let experiment = experiment(text)?;
    let chain = experiment.chain_and_system(None);
    let (chain, _, _) = chain.map_err(|mistakes| Refusal::of_text(text, &mistakes))?;
    let said = describe_theory(&experiment, &chain);
    Ok(groups(&said.map_err(|error| Refusal::of_study(text, error))?))
}
