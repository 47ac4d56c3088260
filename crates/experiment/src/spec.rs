//! A file's content, typed and in SI: its parts fit together, and errors of the physics are
//! reported at their place.

use crate::bodies::{self, BeadGroup, Materials};
use crate::contacts::{self, SectionSpec};
use crate::reading::Reading;
use crate::report::FileProblem;
use crate::rig::{self, Campaign, CaseSpec, Rig};
use crate::settings::{self, Far, Liquid, Near, Sensors, Solver};
use crate::values::{TableView, Units};
use hertzchain_chain::STANDARD_GRAVITY_M_S2;
use hertzchain_chain::laws::LawError;
use hertzchain_chain::wave::SolveError;
use hertzchain_chain::{ChainError, Gap, Initial, Push, Tension};
use std::ops::{Range, RangeInclusive};
use std::path::Path;

/// Advice on the numbers of beads.
pub(crate) const BEADS: &str =
    "beads are counted from 1, the first that the striker meets; 0 is the striker itself";

/// A file's content.
#[derive(Clone, Debug)]
pub(crate) struct Spec {
    pub(crate) title: String,
    pub(crate) units: Units,
    pub(crate) materials: Materials,
    pub(crate) groups: Vec<BeadGroup>,
    /// Beads taken off at the far end by a reading.
    pub(crate) beads_less: usize,
    pub(crate) near: Near,
    pub(crate) push: Push,
    /// Where the file says what presses the chain together, if anything does.
    pub(crate) load_span: Range<usize>,
    pub(crate) far: Far,
    pub(crate) far_span: Range<usize>,
    pub(crate) sections: Vec<SectionSpec>,
    pub(crate) gaps: Vec<(Gap, Range<usize>)>,
    pub(crate) initial: Vec<(Initial, Range<usize>)>,
    pub(crate) incline_rad: f64,
    pub(crate) gravity_m_s2: f64,
    pub(crate) suspension_m: Option<f64>,
    pub(crate) suspension_span: Option<Range<usize>>,
    pub(crate) tension: Tension,
    pub(crate) sensors: Sensors,
    pub(crate) solver: Solver,
    /// Where the file gives a solver, its step and its duration.
    pub(crate) solver_span: Option<Range<usize>>,
    pub(crate) step_span: Range<usize>,
    pub(crate) duration_span: Range<usize>,
    pub(crate) liquid: Option<Liquid>,
    pub(crate) rig: Option<Rig>,
    pub(crate) friction_coefficient: f64,
    pub(crate) campaign: Campaign,
    pub(crate) cases: Vec<CaseSpec>,
    pub(crate) reading: Reading,
}

impl Spec {
    /// Reads a checked document; files it names lie in `folder`.
    pub(crate) fn read(root: &TableView<'_>, folder: &Path) -> Result<Self, FileProblem> {
        /// Coefficient of dry friction between beads and track, where a file has none.
        const FRICTION: f64 = 0.05;
        let materials = Materials::read(root)?;
        let groups = bodies::groups(root, &materials)?;
        let count = groups.iter().map(BeadGroup::count).sum();
        let track = |name| root.table("track").map_or(Ok(None), |t| t.quantity(name));
        let gravity = match root.units {
            Units::Si => STANDARD_GRAVITY_M_S2,
            Units::Dimensionless => 0.0,
        };
        let near = Near::read(root, &materials, folder)?;
        let far = Far::read(root, &materials)?;
        let loads = ["near_end", "track", "far_end"];
        let load = loads.into_iter().find(|key| root.has(key));
        let suspension = root.table("suspension");
        let solver = root.table("solver");
        let liquid = Liquid::read_from(root)?;
        without_si(root)?;
        let in_solver = |key| solver.map_or(root.span(), |t| t.span_of(key));
        let spec = Self {
            title: root.text("title").unwrap_or("untitled").to_owned(),
            units: root.units,
            beads_less: 0,
            push: settings::push(root)?,
            load_span: load.map_or(0..0, |key| root.span_of(key)),
            far_span: root.span_of("far_end"),
            sections: contacts::read(root, &materials, &groups, liquid.as_ref())?,
            gaps: settings::gaps(root, contact_ends(&near, &far, count))?,
            initial: settings::initial(root)?,
            incline_rad: track("incline")?.unwrap_or(0.0),
            gravity_m_s2: track("gravity")?.unwrap_or(gravity),
            suspension_m: suspension.map(|t| t.needed("length")).transpose()?,
            suspension_span: suspension.map(|t| t.span()),
            tension: match root.text("tension") {
                Some("clipped") => Tension::Clipped,
                _ => Tension::Allowed,
            },
            sensors: Sensors::read(root, count)?,
            solver: Solver::read(root)?,
            solver_span: solver.map(|t| t.span()),
            step_span: in_solver("step"),
            duration_span: in_solver("duration"),
            rig: Rig::read(root)?,
            friction_coefficient: track("friction")?.unwrap_or(FRICTION),
            campaign: Campaign::read(root, near.speed_m_s())?,
            cases: rig::cases(root, &materials, &groups, liquid.as_ref())?,
            liquid,
            near,
            far,
            reading: Reading::read(root),
            materials,
            groups,
        };
        spec.check_layout()?;
        Ok(spec)
    }

    pub(crate) fn bead_count(&self) -> usize {
        let count: usize = self.groups.iter().map(BeadGroup::count).sum();
        count.saturating_sub(self.beads_less)
    }

    fn beads_span(&self) -> Range<usize> {
        self.groups.first().map_or(0..0, |group| group.span.clone())
    }

    /// Whether bead N leans on something.
    pub(crate) const fn has_wall(&self) -> bool {
        matches!(self.far, Far::Wall { .. })
    }

    /// Indices of the materials that bodies or contacts of the chain have.
    pub(crate) fn used_materials(&self) -> Vec<usize> {
        let parts = self.groups.iter().flat_map(|group| &group.cell);
        let sections = self.sections.iter().map(|section| section.material);
        let used = parts.map(|part| part.material).chain(sections);
        let ends = [self.near.shape(), self.far.shape()];
        let ends = ends.into_iter().flatten().map(|shape| shape.material);
        used.chain(ends).flatten().collect()
    }

    /// Everything must lie inside the chain, whatever a reading did to it.
    pub(crate) fn check_layout(&self) -> Result<(), FileProblem> {
        let beads = self.bead_count();
        if beads == 0 {
            let message = "the chain has no beads";
            return Err(FileProblem::new(&self.beads_span(), message, "expected at least one"));
        }
        // Bodies that move: the beads, body 0 if there is one, and a stop of finite mass.
        let first = usize::from(matches!(self.near, Near::Free { .. }));
        let bodies = first..=beads + usize::from(self.far.stop_kg().is_some());
        let (first, last) = contact_ends(&self.near, &self.far, beads);
        let contacts = first..=last;
        let sensors = &self.sensors;
        self.inside("sensor bead", sensors.bead, &(1..=beads), &sensors.span)?;
        for (bead, span) in &sensors.beads {
            self.inside("sensor bead", *bead, &(1..=beads), span)?;
        }
        for (contact, span) in &sensors.contacts {
            self.inside("contact", *contact, &contacts, span)?;
        }
        for (body, span) in sensors.positions.iter().chain(&sensors.velocities) {
            self.inside("body", *body, &bodies, span)?;
        }
        if let (Some(span), false) = (&sensors.channel, self.has_wall()) {
            let message = "the channel adds the wall's signal, but there is no wall";
            return Err(FileProblem::new(span, message, "expected a [far_end] to lean on"));
        }
        for (gap, span) in &self.gaps {
            self.inside("contact", gap.contact, &contacts, span)?;
        }
        for (initial, span) in &self.initial {
            self.inside("bead", initial.bead, &(1..=beads), span)?;
        }
        repeated("contact", self.gaps.iter().map(|(gap, span)| (gap.contact, span)))?;
        repeated("bead", self.initial.iter().map(|(state, span)| (state.bead, span)))?;
        self.check_motion()
    }

    fn inside(
        &self,
        what: &str,
        found: usize,
        there: &RangeInclusive<usize>,
        span: &Range<usize>,
    ) -> Result<(), FileProblem> {
        if there.contains(&found) {
            return Ok(());
        }
        let beads = self.bead_count();
        let message = format!("{what} {found} is outside the chain of {beads} beads");
        let label = match there.is_empty() {
            true => "expected nothing: this chain has none".to_owned(),
            false => format!("expected a number from {} to {}", there.start(), there.end()),
        };
        let problem = FileProblem::new(span, message, label);
        Err(match (what, found) {
            ("sensor bead" | "bead", 0) => problem.help(BEADS),
            _ => problem,
        })
    }

    /// Without striker or driven end some bead must move or be displaced; a ring has no end to
    /// strike, to drive or to push.
    fn check_motion(&self) -> Result<(), FileProblem> {
        let is_free = matches!(self.near, Near::Free { .. });
        let still = |i: &Initial| i.displacement_m == 0.0 && i.velocity_m_s == 0.0;
        if let Some((_, span)) = self.initial.first()
            && is_free
            && self.initial.iter().all(|(initial, _)| still(initial))
        {
            let label = "all [[initial]] are 0: expected a bead that moves or is displaced";
            return Err(FileProblem::new(span, "nothing sets the chain in motion", label));
        }
        let pushed = !matches!(self.push, Push::None);
        if matches!(self.far, Far::Periodic { .. }) && (pushed || !is_free) {
            let label = "expected [[initial]] and neither striker, driven nor near_end";
            let message = "a periodic chain has no near end";
            return Err(FileProblem::new(&self.far_span, message, label));
        }
        if let (Near::Driven { .. }, Push::Spring { .. }) = (&self.near, self.push) {
            let message = "a driven body carries the load itself, and leaves no room for a spring";
            let label =
                "expected push = \"constant\": the force between driven body and bead 1 at rest";
            return Err(FileProblem::new(&self.load_span, message, label));
        }
        Ok(())
    }

    /// The problem in the file behind a chain that can't be set up.
    pub(crate) fn chain_problem(&self, error: &ChainError) -> FileProblem {
        match error {
            ChainError::Law { contact, error } => self.law_problem(*contact, error),
            ChainError::Equilibrium(why) => self.equilibrium_problem(why),
            ChainError::Value { what, value, expected } => {
                let label = format!("expected it to be {expected}");
                FileProblem::new(&self.beads_span(), format!("{what} is {value}"), label)
            }
            ChainError::Layout(why) | ChainError::NotConverged(why) => {
                FileProblem::new(&self.beads_span(), why, "expected parts that fit together")
            }
        }
    }

    /// No rest position: nothing holds the far end, or no law carries the load.
    fn equilibrium_problem(&self, why: &str) -> FileProblem {
        let message = format!("the chain has no rest position: {why}");
        if let Some(span) = &self.suspension_span {
            let label = "expected no [near_end] push and no incline with threads";
            return FileProblem::new(span, message, label);
        }
        let inelastic = self.sections.iter().find(|section| !section.is_elastic());
        match inelastic.filter(|_| self.has_wall()) {
            None => {
                let label = "expected a far end that holds what pushes and pulls";
                FileProblem::new(&self.far_span, message, label)
            }
            Some(section) => {
                let message =
                    "the chain has no rest position: no law of these contacts carries a load";
                let label = "expected a law that pushes the beads apart";
                FileProblem::new(&section.laws_span, message, label)
                    .help("add \"elastic_hertz\" to `laws`")
            }
        }
    }

    /// The problem behind a motion that a solver does not finish: at the laws of the contact
    /// where it ended, or at the solver's settings.
    pub(crate) fn solver_problem(&self, error: &SolveError) -> FileProblem {
        match error {
            SolveError::StepTooSmall { contact, .. }
            | SolveError::NotFinite { contact, .. }
            | SolveError::TooMuchWork { contact, .. } => {
                let contact = (*contact).min(self.bead_count());
                self.problem_of_contact(contact, &error.to_string())
            }
            _ => self.unreached(&error.to_string()),
        }
    }

    /// A result that a solver does not reach, at its settings; without any, at the laws.
    pub(crate) fn unreached(&self, why: &str) -> FileProblem {
        match &self.solver_span {
            Some(table) => FileProblem::new(table, why, "the solver is chosen here"),
            None => self.problem_of_contact(0, why),
        }
    }

    fn problem_of_contact(&self, contact: usize, why: &str) -> FileProblem {
        let section = self.section_of(contact);
        let span = section.map_or(0..0, |section| section.laws_span.clone());
        FileProblem::new(&span, why, format!("the laws of contact {contact}"))
    }

    fn section_of(&self, contact: usize) -> Option<&SectionSpec> {
        let beads = self.bead_count();
        let mut sections = self.sections.iter();
        sections.find(|section| (section.from..=section.last(beads)).contains(&contact))
    }

    fn law_problem(&self, contact: usize, error: &LawError) -> FileProblem {
        let section = self.section_of(contact);
        let law = section.and_then(|s| s.laws.iter().find(|law| law.name() == error.law));
        let span = law.map_or(0..0, |law| law.span.clone());
        let message = format!("law `{}` can't be used on contact {contact}", error.law);
        let problem = FileProblem::new(&span, message, &error.what);
        let left: Vec<String> = law.map_or(Vec::new(), |law| {
            let parameters = law.row.info.parameters.iter();
            let left = parameters.filter(|p| p.source.is_derived() && law.value(p.name).is_none());
            left.map(|p| format!("`{}`", p.name)).collect()
        });
        let mut parts = self.groups.iter().flat_map(|group| &group.cell);
        let bare = section.is_some_and(|section| section.material.is_none())
            && parts.all(|part| part.material.is_none());
        match left.is_empty() {
            true if bare => {
                problem.help("it needs the stiffness of a material: name one in [[beads]]")
            }
            true => problem,
            false => problem.help(format!(
                "the materials must set {}, unless the law gives it",
                left.join(" and ")
            )),
        }
    }
}

/// Refuses what acts by the Earth's gravity, or is a number in SI, in a file without units.
fn without_si(root: &TableView<'_>) -> Result<(), FileProblem> {
    if root.units == Units::Si {
        return Ok(());
    }
    let in_table = |name: &str, key: &str| root.table(name).is_some_and(|t| t.has(key));
    let falls = match [root.has("suspension"), in_table("track", "incline")] {
        [true, _] => Some("suspension"),
        [_, true] => Some("track"),
        _ => None,
    };
    if let Some(key) = falls.filter(|_| !in_table("track", "gravity")) {
        let message = "a dimensionless chain has no gravity unless it is given";
        let problem = root.problem(key, message, "this has no effect without");
        return Err(problem.help("add `gravity` to [track], such as `gravity = 1`"));
    }
    let reading = Reading::read(root).changes();
    let of_si = ["preload", "incline", "stop"];
    match reading.iter().find(|(switch, _)| of_si.contains(switch)) {
        Some((switch, option)) => {
            let message =
                format!("the reading {switch} = \"{option}\" is of the paper's row in SI");
            Err(root.problem("reading", message, "expected a file with SI units"))
        }
        None => Ok(()),
    }
}

/// First and last contact between two bodies; a free end has none.
fn contact_ends(near: &Near, far: &Far, beads: usize) -> (usize, usize) {
    let first = usize::from(matches!(near, Near::Free { .. }));
    (first, beads - usize::from(matches!(far, Far::Free)).min(beads))
}

/// Two gaps in one contact, or two initial states of one bead.
fn repeated<'a>(
    what: &str,
    found: impl Iterator<Item = (usize, &'a Range<usize>)>,
) -> Result<(), FileProblem> {
    let mut found: Vec<_> = found.collect();
    found.sort_by_key(|(index, span)| (*index, span.start));
    match found.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        None => Ok(()),
        Some(pair) => {
            let message = format!("{what} {} stands here a second time", pair[1].0);
            let problem = FileProblem::new(pair[1].1, message, "expected each at most once");
            Err(problem.also(pair[0].1, "the first one is here"))
        }
    }
}
