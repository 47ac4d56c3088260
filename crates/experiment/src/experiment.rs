//! An experiment: a file that has been read, checked and understood.

use crate::apply::apply;
use crate::assemble;
use crate::check::{self, Check};
use crate::document::{self, Entry, Node, Value};
use crate::effort;
use crate::file;
use crate::finding::{Mistakes, Problem, Source, Warning};
use crate::keys::ROOT;
use crate::locate;
use crate::reading::{Pick, Reading};
use crate::spec::{Campaign, Liquid, MaterialSpec, Rig, SectionSpec, Solver, Spec};
use crate::validity;
use crate::value::Units;
use crate::view::View;
use hertzchain_chain::wave::SolveError;
use hertzchain_chain::{Chain, Sensor, System};
use miette::NamedSource;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A described experiment, valid and in SI.
#[derive(Clone, Debug)]
pub struct Experiment {
    source: Source,
    folder: PathBuf,
    tree: Node,
    /// What the file says, before any reading.
    written: Spec,
    /// What holds in the reading.
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
        let text = file::read(path).map_err(|error| OpenError::Unreadable {
            path: path.display().to_string(),
            error,
        })?;
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
    pub(crate) fn from_tree(
        source: Source,
        folder: PathBuf,
        tree: Node,
        reading: Option<&Reading>,
    ) -> Result<Self, Mistakes> {
        if tree.entries().is_empty() {
            let problem = Problem::new(&(0..0), "this experiment is empty", "expected keys here");
            let help = "`hertzchain presets dry` prints an experiment to start from";
            return Err(Mistakes::one(problem.help(help), &source));
        }
        let units = units(&tree);
        let mut check = Check::new(units, &tree);
        check.table(&tree, &ROOT, None);
        if !check.problems.is_empty() {
            let problems = check::merge_unit_slips(check.problems, check.fitting, units, &tree);
            return Err(Mistakes::new(problems, &source));
        }
        let root = View {
            node: &tree,
            fields: &ROOT,
            units,
        };
        let written = Spec::read(&root, &folder).map_err(|p| Mistakes::one(p, &source))?;
        let reading = *reading.unwrap_or(&written.reading);
        let experiment = Self {
            spec: written.clone(),
            source,
            folder,
            tree,
            written,
        };
        experiment.with_reading(&reading)
    }

    /// This experiment in another reading.
    ///
    /// # Errors
    /// When the reading leaves something outside the chain.
    pub fn with_reading(&self, reading: &Reading) -> Result<Self, Mistakes> {
        let spec = apply(&self.written, reading);
        spec.check_layout().map_err(|p| self.mistake(p))?;
        let experiment = Self {
            spec,
            ..self.clone()
        };
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
        let refused = |error| self.mistake(locate::problem(&self.spec, &error));
        let system = System::new(&chain).map_err(refused)?;
        let problem = validity::overlapped_at_start(&self.spec, &chain, &system)
            .or_else(|| validity::refusal(&self.spec, &chain))
            .or_else(|| effort::problem(&self.spec, &chain, &system));
        match problem {
            Some(problem) => Err(self.mistake(problem)),
            None => Ok((chain, system, warnings)),
        }
    }

    /// What a solver says of this experiment's motion, at the laws of the
    /// contact where it ended, or at the solver's settings.
    pub fn unsolved(&self, error: &SolveError) -> Mistakes {
        self.mistake(locate::unsolved(&self.spec, error))
    }

    /// Why a solver does not reach what it was asked for, at its settings.
    pub fn unreached(&self, why: &str) -> Mistakes {
        self.mistake(locate::unreached(&self.spec, why))
    }

    /// Whether chains at different speeds of the striker differ in nothing else.
    pub fn is_same_at_all_speeds(&self) -> bool {
        self.spec.materials.0.iter().all(MaterialSpec::is_constant)
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

    fn mistake(&self, problem: Problem) -> Mistakes {
        Mistakes::one(problem, &self.source)
    }

    /// The experiment of a changed tree, in the present reading.
    pub(crate) fn with_tree(&self, tree: Node) -> Result<Self, Mistakes> {
        let reading = self.spec.reading;
        Self::from_tree(
            self.source.clone(),
            self.folder.clone(),
            tree,
            Some(&reading),
        )
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
        let channel = sensors
            .channel
            .as_ref()
            .map(|_| Sensor::BeadPlusWall(sensors.bead));
        let first = [Some(Sensor::Bead(sensors.bead)), wall, channel];
        let mut all: Vec<Sensor> = first.into_iter().flatten().collect();
        let lists = [
            (&sensors.beads, Sensor::Bead as fn(usize) -> Sensor),
            (&sensors.contacts, Sensor::Contact),
            (&sensors.positions, Sensor::Position),
            (&sensors.velocities, Sensor::Velocity),
        ];
        for (list, sensor) in lists {
            let more = list.iter().map(|(index, _)| sensor(*index));
            let fresh: Vec<Sensor> = more.filter(|s| !all.contains(s)).collect();
            all.extend(fresh);
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
        self.spec
            .cases
            .iter()
            .map(|case| case.name.as_str())
            .collect()
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
        let chosen = Self {
            written,
            tree: self.tree_of_case(name),
            ..self.clone()
        };
        Some(chosen.with_reading(&self.spec.reading))
    }

    /// The file with the contacts and the liquid of a case in the places of its
    /// own, so that paths lead to them and setting a number keeps them.
    fn tree_of_case(&self, name: &str) -> Node {
        let mut tree = self.tree.clone();
        let cases = self
            .tree
            .get("campaign")
            .and_then(|table| table.get("cases"));
        let is_named = |case: &&Node| {
            let own = case.get("name").map(|node| &node.value);
            matches!(own, Some(Value::Text(own)) if own == name)
        };
        let case = cases.and_then(|cases| cases.members().iter().find(is_named));
        for key in ["contacts", "liquid"] {
            if let Some(node) = case.and_then(|case| case.get(key)) {
                put(&mut tree, key, node);
            }
        }
        tree
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
}

/// Puts a value in the place of a table's entry, or behind all others.
fn put(table: &mut Node, key: &str, node: &Node) {
    let Value::Table(entries) = &mut table.value else {
        return;
    };
    match entries.iter_mut().find(|entry| entry.key == key) {
        Some(entry) => entry.node = node.clone(),
        None => entries.push(Entry {
            key: key.to_owned(),
            key_span: node.span.clone(),
            node: node.clone(),
        }),
    }
}

/// The unit system, before anything else is read.
fn units(tree: &Node) -> Units {
    match tree.get("units").map(|node| &node.value) {
        Some(Value::Text(text)) if text == "dimensionless" => Units::Dimensionless,
        _ => Units::Si,
    }
}
