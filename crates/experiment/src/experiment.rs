//! An experiment: a file that has been read and checked; and those that come with the program.

use crate::assemble;
use crate::check::check;
use crate::contacts::SectionSpec;
use crate::document::{self, Node, TomlNumber, TomlValue};
use crate::keys::ROOT;
use crate::reading::{Pick, Reading};
use crate::report::{FileProblem, Mistakes, Source, UnknownName, Warning};
use crate::rig::{Campaign, Rig};
use crate::settings::{Liquid, Solver};
use crate::spec::Spec;
use crate::validity;
use crate::values::{TableView, Units};
use hertzchain_chain::wave::SolveError;
use hertzchain_chain::{Chain, Sensor, System};
use miette::NamedSource;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A described experiment, valid and in SI.
#[derive(Clone, Debug)]
pub struct Experiment {
    source: Source,
    folder: PathBuf,
    tree: Node,
    /// As the file says, before any reading.
    written: Spec,
    /// As it holds in the reading.
    spec: Spec,
}

/// Why an experiment file can't be used.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The file can't be read at all.
    #[error("{path} can't be read: {error}")]
    Unreadable {
        /// File.
        path: String,
        /// Why.
        error: std::io::Error,
    },
    /// The file has mistakes.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
}

impl Experiment {
    /// Reads an experiment file.
    ///
    /// # Errors
    /// An unreadable file, or every mistake found in it.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let text = document::read_text(path)
            .map_err(|error| OpenError::Unreadable { path: path.display().to_string(), error })?;
        Ok(Self::from_text(&path.display().to_string(), &text)?)
    }

    /// Reads an experiment from text. `name` is used in messages, and its
    /// folder is where files named in the text are looked for.
    ///
    /// # Errors
    /// Every mistake found in the text.
    pub fn from_text(name: &str, text: &str) -> Result<Self, Mistakes> {
        let source = Arc::new(NamedSource::new(name, text.to_owned()).with_language("toml"));
        let tree = document::parse(text).map_err(|problems| Mistakes::new(problems, &source))?;
        let folder = Path::new(name).parent().unwrap_or(Path::new("")).to_owned();
        Self::from_tree(source, folder, tree, None)
    }

    /// The experiment of a tree, in a reading or the tree's own.
    fn from_tree(
        source: Source,
        folder: PathBuf,
        tree: Node,
        reading: Option<&Reading>,
    ) -> Result<Self, Mistakes> {
        let refused = |problem| Mistakes::new(vec![problem], &source);
        if tree.entries().is_empty() {
            let problem =
                FileProblem::new(&(0..0), "this experiment is empty", "expected keys here");
            let help = "`hertzchain presets dry` prints an experiment to start from";
            return Err(refused(problem.help(help)));
        }
        let units = match tree.get("units").and_then(Node::text) {
            Some("dimensionless") => Units::Dimensionless,
            _ => Units::Si,
        };
        check(&tree, units).map_err(|problems| Mistakes::new(problems, &source))?;
        let (node, fields) = (&tree, &ROOT);
        let written = Spec::read(&TableView { node, fields, units }, &folder).map_err(refused)?;
        let reading = *reading.unwrap_or(&written.reading);
        let spec = written.clone();
        let experiment = Self { source, folder, tree, written, spec };
        experiment.with_reading(&reading)
    }

    /// This experiment in another reading.
    ///
    /// # Errors
    /// When the reading leaves something outside the chain.
    pub fn with_reading(&self, reading: &Reading) -> Result<Self, Mistakes> {
        let spec = reading.apply(&self.written);
        spec.check_layout().map_err(|p| self.mistake(p))?;
        let experiment = Self { spec, ..self.clone() };
        experiment.chain(None)?;
        Ok(experiment)
    }

    /// The chain, hit at this speed in m/s or at the file's own, and warnings
    /// about it. Materials may depend on the speed.
    ///
    /// # Errors
    /// A speed without a striker, not positive or not finite; numbers that
    /// leave their limits at this speed; laws that can't be built.
    pub fn chain(&self, speed_m_s: Option<f64>) -> Result<(Chain, Vec<Warning>), Mistakes> {
        let (chain, warnings) =
            assemble::chain(&self.spec, speed_m_s).map_err(|p| self.mistake(p))?;
        let warnings = warnings.into_iter().map(|p| p.warning(&self.source));
        Ok((chain, warnings.collect()))
    }

    /// The chain as [`Experiment::chain`] gives it, at rest and ready for a
    /// shot, and warnings about it.
    ///
    /// # Errors
    /// Those of [`Experiment::chain`]; laws that the materials can't serve; no
    /// static equilibrium, or beads that are crushed at rest or by the impact;
    /// dissipation that stops all motion at once; a step longer than a contact,
    /// or more steps than a shot can have.
    pub fn system(&self, speed_m_s: Option<f64>) -> Result<(System, Vec<Warning>), Mistakes> {
        let (_, system, warnings) = self.chain_and_system(speed_m_s)?;
        Ok((system, warnings))
    }

    /// The chain and its system, each computed once, and warnings.
    ///
    /// # Errors
    /// Those of [`Experiment::system`].
    pub fn chain_and_system(
        &self,
        speed_m_s: Option<f64>,
    ) -> Result<(Chain, System, Vec<Warning>), Mistakes> {
        let (chain, warnings) = self.chain(speed_m_s)?;
        let refused = |error| self.mistake(self.spec.chain_problem(&error));
        let system = System::new(&chain).map_err(refused)?;
        let problem = validity::overlapped_at_start(&self.spec, &chain, &system)
            .or_else(|| validity::refusal(&self.spec, &chain))
            .or_else(|| validity::effort_problem(&self.spec, &chain, &system));
        match problem {
            Some(problem) => Err(self.mistake(problem)),
            None => Ok((chain, system, warnings)),
        }
    }

    /// The error of a solver, at the laws of the contact where the motion ended, or at the
    /// solver's settings.
    pub fn unsolved(&self, error: &SolveError) -> Mistakes {
        self.mistake(self.spec.solver_problem(error))
    }

    /// The reason why a solver does not reach what it was asked for, at its settings.
    pub fn unreached(&self, why: &str) -> Mistakes {
        self.mistake(self.spec.unreached(why))
    }

    /// Whether chains at different speeds of the striker differ in nothing else.
    pub fn is_same_at_all_speeds(&self) -> bool {
        self.spec.materials.is_constant()
    }

    /// Refuses an experiment without a striker where a speed is asked for,
    /// with what sets its chain in motion instead.
    ///
    /// # Errors
    /// An experiment that is driven or starts by itself.
    pub fn needs_striker(&self, why: &str) -> Result<(), Mistakes> {
        match self.speed_m_s() {
            Some(_) => Ok(()),
            None => Err(self.mistake(assemble::no_striker(&self.spec, why))),
        }
    }

    fn mistake(&self, problem: FileProblem) -> Mistakes {
        Mistakes::new(vec![problem], &self.source)
    }

    /// The experiment of a changed tree, in the present reading.
    pub(crate) fn with_tree(&self, tree: Node) -> Result<Self, Mistakes> {
        let (source, folder) = (self.source.clone(), self.folder.clone());
        Self::from_tree(source, folder, tree, Some(&self.spec.reading))
    }

    pub(crate) fn tree(&self) -> &Node {
        &self.tree
    }

    /// Name of the file or preset.
    pub fn name(&self) -> &str {
        self.source.name()
    }

    /// The file's text, as provenance.
    pub fn text(&self) -> &str {
        self.source.inner()
    }

    /// What the experiment is.
    pub fn title(&self) -> &str {
        &self.spec.title
    }

    /// Unit system of the file.
    pub fn units(&self) -> Units {
        self.spec.units
    }

    /// Speed of the striker in m/s; `None` without a striker.
    pub fn speed_m_s(&self) -> Option<f64> {
        self.spec.near.speed_m_s()
    }

    /// Number of beads N in the reading.
    pub fn beads(&self) -> usize {
        self.spec.bead_count()
    }

    /// Whether bead N leans on something, so that there is a wall signal.
    pub fn has_wall(&self) -> bool {
        self.spec.has_wall()
    }

    /// The sensor bead n of the ToF.
    pub fn sensor_bead(&self) -> usize {
        self.spec.sensors.bead
    }

    /// All sensors: the sensor bead, the wall if there is one, the paper's
    /// channel if asked for, then those the file lists.
    pub fn sensors(&self) -> Vec<Sensor> {
        let sensors = &self.spec.sensors;
        let wall = self.has_wall().then(|| Sensor::Contact(self.beads()));
        let channel = sensors.channel.as_ref();
        let channel = channel.map(|_| Sensor::BeadPlusWall(sensors.bead));
        let listed = [
            (&sensors.beads, Sensor::Bead as fn(usize) -> Sensor),
            (&sensors.contacts, Sensor::Contact),
            (&sensors.positions, Sensor::Position),
            (&sensors.velocities, Sensor::Velocity),
        ];
        let listed = listed.into_iter();
        let listed = listed.flat_map(|(list, sensor)| list.iter().map(move |(at, _)| sensor(*at)));
        let first = [Some(Sensor::Bead(sensors.bead)), wall, channel];
        let mut all: Vec<Sensor> = Vec::new();
        for sensor in first.into_iter().flatten().chain(listed) {
            if !all.contains(&sensor) {
                all.push(sensor);
            }
        }
        all
    }

    /// Solver, accuracy, step and duration.
    pub fn solver(&self) -> Solver {
        self.spec.solver
    }

    /// The choices that the paper leaves open.
    pub fn reading(&self) -> Reading {
        self.spec.reading
    }

    /// Where a pulse is timed.
    pub fn pick(&self) -> Pick {
        self.spec.reading.pick
    }

    /// The liquid of the wet contacts, if the file has one.
    pub fn liquid(&self) -> Option<&Liquid> {
        self.spec.liquid.as_ref()
    }

    /// What stands around the chain, if the file has one; nothing is computed
    /// from it.
    pub fn rig(&self) -> Option<&Rig> {
        self.spec.rig.as_ref()
    }

    /// What a rig does with this experiment, shot after shot.
    pub fn campaign(&self) -> &Campaign {
        &self.spec.campaign
    }

    /// Names of the chains that a campaign measures, in the file's order;
    /// none where the file's one chain is all.
    pub fn cases(&self) -> Vec<&str> {
        let cases = self.spec.cases.iter();
        cases.map(|case| case.name.as_str()).collect()
    }

    /// This experiment with the contacts and the liquid of one of its cases;
    /// `None` if it has no case of this name.
    ///
    /// # Errors
    /// When the reading leaves something outside the chain.
    pub fn case(&self, name: &str) -> Option<Result<Self, Mistakes>> {
        let case = self.written.cases.iter().find(|case| case.name == name)?;
        let mut written = self.written.clone();
        if let Some(sections) = &case.sections {
            written.sections.clone_from(sections);
        }
        if case.liquid.is_some() {
            written.liquid.clone_from(&case.liquid);
        }
        // The case's own in the places of the file's, so that paths lead to them and setting a
        // number keeps them.
        let mut tree = self.tree.clone();
        let all = self.tree.get("campaign").map_or(&[][..], |table| table.list("cases"));
        let own = all.iter().find(|case| case.get("name").and_then(Node::text) == Some(name));
        for key in ["contacts", "liquid"] {
            if let Some(node) = own.and_then(|case| case.get(key)) {
                *tree.entry_mut(key) = node.clone();
            }
        }
        let chosen = Self { written, tree, ..self.clone() };
        Some(chosen.with_reading(&self.spec.reading))
    }

    /// Coefficient of dry friction between beads and track, which acts
    /// between shots.
    pub fn friction_coefficient(&self) -> f64 {
        self.spec.friction_coefficient
    }

    /// Name of the effective material of a section's contacts, if it has one.
    pub fn effective_material(&self, section: &SectionSpec) -> Option<&str> {
        let material = self.spec.materials.0.get(section.material?)?;
        Some(&material.name)
    }

    /// Names of the materials that bodies or contacts of the chain have; a file may
    /// hold others, for its cases.
    pub fn used_materials(&self) -> Vec<&str> {
        let used = self.spec.used_materials();
        let named = self.spec.materials.0.iter().enumerate();
        let named = named.filter(|(at, _)| used.contains(at));
        named.map(|(_, material)| material.name.as_str()).collect()
    }

    /// Sections of contacts with their laws, in the reading.
    pub fn sections(&self) -> &[SectionSpec] {
        &self.spec.sections
    }

    /// One text that two experiments share if the same results follow from them: keys and values
    /// with the numbers that a program has set, the reading, and the contacts of the chosen case.
    ///
    /// Comments, blanks, and where the file lies do not matter; a number is its
    /// bits. For fingerprints: not for reading.
    pub fn canonical_text(&self) -> String {
        let mut text = format!("{:?}\n", self.reading());
        for SectionSpec { from, to, wet, material, laws, .. } in self.sections() {
            text += &format!("{from} {to:?} {wet} {material:?}");
            for law in laws {
                let given = law.given.iter();
                let given = given.map(|(name, value)| format!(" {name}={:016x}", value.to_bits()));
                text += &format!(" {}{};", law.name(), given.collect::<String>());
            }
            text.push('\n');
        }
        // Files that the text names are read by what needs them; a chain whose
        // end they move has no striker, and is neither swept nor shot at by a rig.
        append_canonical(&self.tree.value, &mut text);
        text
    }
}

fn append_canonical(value: &TomlValue, text: &mut String) {
    // A text takes whatever is written into it.
    let _ = match value {
        TomlValue::Text(words) => writeln!(text, "{words:?}"),
        TomlValue::Number(TomlNumber { value, .. }) => writeln!(text, "{:016x}", value.to_bits()),
        TomlValue::Flag(flag) => writeln!(text, "{flag}"),
        TomlValue::Date => writeln!(text, "a date or time"),
        TomlValue::List(items) => {
            text.push_str("[\n");
            items.iter().for_each(|item| append_canonical(&item.value, text));
            writeln!(text, "]")
        }
        TomlValue::Table(entries) => {
            text.push_str("{\n");
            for entry in entries {
                text.push_str(&format!("{:?}=\n", entry.key));
                append_canonical(&entry.node.value, text);
            }
            writeln!(text, "}}")
        }
    };
}

/// An experiment file compiled in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name, the file's without its ending.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
}

impl Preset {
    /// The file's title.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find(|line| line.starts_with("title"));
        line.and_then(|line| line.split('"').nth(1)).unwrap_or(self.name)
    }
}

macro_rules! files {
    ($($name:literal),+ $(,)?) => {
        &[$(Preset {
            name: $name,
            text: include_str!(concat!("../experiments/", $name, ".toml")),
        }),+]
    };
}

static PRESETS: &[Preset] = files!["dry", "hertz", "hertz-viscoelastic", "pump", "gear", "motor"];

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

static FILMS: &[Preset] = files!["pump-film", "gear-film", "motor-film"];

static CAMPAIGNS: &[Preset] = files!["paper"];

/// The paper's chains.
pub const fn presets() -> &'static [Preset] {
    PRESETS
}

/// Chains of other works, each with something to learn.
pub const fn examples() -> &'static [Preset] {
    EXAMPLES
}

/// The paper's row with films of its oils, by their own properties: for the adaptive loop alone.
pub const fn film_presets() -> &'static [Preset] {
    FILMS
}

/// Campaigns of a rig: chains, speeds, shots and instruments.
pub const fn campaigns() -> &'static [Preset] {
    CAMPAIGNS
}

/// A preset, example or campaign by its name.
///
/// # Errors
/// An unknown name, with those that exist and the nearest of them.
pub fn preset(name: &str) -> Result<Experiment, UnknownName> {
    let all = || [PRESETS, EXAMPLES, FILMS, CAMPAIGNS].into_iter().flatten();
    let found = all().find(|preset| preset.name == name);
    let open = |p: &Preset| Experiment::from_text(&format!("{}.toml", p.name), p.text).ok();
    let experiment = found.and_then(open);
    experiment.ok_or_else(|| {
        UnknownName::new(format!("preset `{name}`"), name, all().map(|p| p.name).collect())
    })
}

#[cfg(test)]
#[path = "tests/canonical.rs"]
mod tests;
