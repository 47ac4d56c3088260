//! An experiment as the page's controls show it.

use super::words::{GroupReply, groups};
use super::{Edit, Mistake, Refusal, edit, effort};
use hertzchain_experiment::{Experiment, Preset, Units, campaigns, examples, presets as own};
use hertzchain_sim::{describe, describe_theory};
use serde::Serialize;
use serde_json::Value as Json;

/// An experiment that comes with the program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PresetReply {
    /// Name.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// `paper`, `example` or `campaign`.
    pub kind: &'static str,
    /// The file.
    pub text: &'static str,
}

/// A text, and what is understood of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutlineReply {
    /// The text after all edits.
    pub text: String,
    /// Its tables and values; null where it is no TOML.
    pub tree: Option<Json>,
    /// What is wrong with it.
    pub mistakes: Vec<Mistake>,
    /// What is understood, if nothing is wrong.
    pub outline: Option<Outline>,
}

/// What is understood of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outline {
    /// What the experiment is.
    pub title: String,
    /// Whether its numbers have no units.
    pub dimensionless: bool,
    /// Speed of the striker in m/s; null without a striker.
    pub speed_m_s: Option<f64>,
    /// Number of beads.
    pub beads: usize,
    /// The sensor bead.
    pub sensor_bead: usize,
    /// Whether there is a wall signal.
    pub has_wall: bool,
    /// Everything in SI, and what follows from it.
    pub groups: Vec<GroupReply>,
    /// What is noteworthy about it.
    pub warnings: Vec<Mistake>,
}

/// Returns the experiments that come with the program.
pub(super) fn presets() -> Vec<PresetReply> {
    let reply = |kind| {
        move |preset: &Preset| PresetReply {
            name: preset.name,
            title: preset.title(),
            kind,
            text: preset.text,
        }
    };
    let of_paper = own().iter().map(reply("paper"));
    let others = examples().iter().map(reply("example"));
    let of_rigs = campaigns().iter().map(reply("campaign"));
    of_paper.chain(others).chain(of_rigs).collect()
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

/// Returns a text after edits, and what is understood of it.
pub(super) fn check(text: &str, edits: &[Edit]) -> Result<OutlineReply, Refusal> {
    let text = edit::edited(text, edits)?;
    let (outline, mistakes) = match outline(&text) {
        Ok(outline) => (Some(outline), Vec::new()),
        Err(Refusal::Mistakes(mistakes)) => (None, mistakes),
        Err(other) => return Err(other),
    };
    Ok(OutlineReply { tree: edit::tree(&text), text, mistakes, outline })
}

fn outline(text: &str) -> Result<Outline, Refusal> {
    let experiment = experiment(text)?;
    let refused = |mistakes| Refusal::of_text(text, &mistakes);
    let (chain, _system, warnings) = experiment.chain_and_system(None).map_err(refused)?;
    let described = describe(&experiment, &chain);
    Ok(Outline {
        title: experiment.title().to_owned(),
        dimensionless: experiment.units() == Units::Dimensionless,
        speed_m_s: experiment.speed_m_s(),
        beads: experiment.beads(),
        sensor_bead: experiment.sensor_bead(),
        has_wall: experiment.has_wall(),
        groups: groups(&described.map_err(|error| Refusal::of_study(text, error))?),
        warnings: Mistake::all(text, &warnings),
    })
}

/// Returns what theory says of an experiment's waves.
pub(super) fn theory(text: &str) -> Result<Vec<GroupReply>, Refusal> {
    let experiment = experiment(text)?;
    let chain = experiment.chain_and_system(None);
    let (chain, _, _) = chain.map_err(|mistakes| Refusal::of_text(text, &mistakes))?;
    let said = describe_theory(&experiment, &chain);
    Ok(groups(&said.map_err(|error| Refusal::of_study(text, error))?))
}
