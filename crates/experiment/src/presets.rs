//! Experiment files that come with the program.

use crate::experiment::Experiment;
use crate::nearest;

/// An experiment file compiled in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name, the file's without its ending.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
}

impl Preset {
    /// What it is: the file's title.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find(|line| line.starts_with("title"));
        line.and_then(|line| line.split('"').nth(1))
            .unwrap_or(self.name)
    }
}

/// A name that is neither a preset nor an example nor a campaign.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no preset `{name}`; expected one of: {}{}", .known.join(", "), hint(.nearest))]
pub struct UnknownPreset {
    /// The name.
    pub name: String,
    /// The name probably meant.
    pub nearest: Option<&'static str>,
    /// All names.
    pub known: Vec<&'static str>,
}

fn hint(nearest: &Option<&'static str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

macro_rules! files {
    ($($name:literal),+ $(,)?) => {
        &[$(Preset {
            name: $name,
            text: include_str!(concat!("../experiments/", $name, ".toml")),
        }),+]
    };
}

static PRESETS: &[Preset] = files![
    "dry",
    "hertz",
    "hertz-viscoelastic",
    "pump",
    "gear",
    "motor"
];

static EXAMPLES: &[Preset] = files![
    "dimer-steel-ptfe",
    "tapered",
    "light-intruder",
    "precompressed",
    "heavy-striker",
    "exponent-section",
    "vertical-on-specimen",
    "newtons-cradle",
];

static CAMPAIGNS: &[Preset] = files!["paper"];

/// The paper's chains.
pub const fn presets() -> &'static [Preset] {
    PRESETS
}

/// Chains of other works, each with something to learn.
pub const fn examples() -> &'static [Preset] {
    EXAMPLES
}

/// Campaigns of a rig: chains, speeds, shots and instruments.
pub const fn campaigns() -> &'static [Preset] {
    CAMPAIGNS
}

/// A preset, example or campaign by its name.
///
/// # Errors
/// An unknown name, with those that exist and the nearest of them.
pub fn preset(name: &str) -> Result<Experiment, UnknownPreset> {
    let all = || PRESETS.iter().chain(EXAMPLES).chain(CAMPAIGNS);
    let found = all().find(|preset| preset.name == name);
    let experiment = found.and_then(|p| Experiment::from_text(&file_name(p), p.text).ok());
    experiment.ok_or_else(|| UnknownPreset {
        name: name.to_owned(),
        nearest: nearest::of(name, all().map(|preset| preset.name)),
        known: all().map(|preset| preset.name).collect(),
    })
}

fn file_name(preset: &Preset) -> String {
    format!("{}.toml", preset.name)
}
