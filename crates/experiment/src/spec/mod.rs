//! What a file says, typed and in SI, before it becomes a chain.

mod beads;
mod campaign;
mod contacts;
mod ends;
mod instruments;
mod layout;
mod materials;
mod rig;
mod setting;
mod stiffness;

pub use campaign::Campaign;
pub use contacts::SectionSpec;
pub use instruments::{
    Actuator, Amplifier, CHANNELS, Channels, Factor, KINDS, Laying, LowPass, LowPassKind, ORDERS,
    Photogate, Recorder, TRIGGERS, Trigger,
};
pub use rig::{Rig, RigPart, RigPartKind};
pub use setting::{Liquid, METHODS, Method, Solver};

pub(crate) use beads::{Group, sphere_mass_kg};
pub(crate) use campaign::CaseSpec;
pub(crate) use ends::{Far, Near, Shape};
pub(crate) use materials::{MaterialSpec, Materials, as_key};
pub(crate) use setting::{Sensors, SolverSpans};

use crate::finding::Problem;
use crate::reading::Reading;
use crate::value::Units;
use crate::view::View;
use hertzchain_chain::chain::STANDARD_GRAVITY_M_S2;
use hertzchain_chain::{Gap, Initial, Push, Tension};
use std::ops::Range;
use std::path::Path;

/// Coefficient of dry friction between beads and track, where a file has none.
const FRICTION: f64 = 0.05;

/// A file's content.
#[derive(Clone, Debug)]
pub(crate) struct Spec {
    pub(crate) title: String,
    pub(crate) units: Units,
    pub(crate) materials: Materials,
    pub(crate) groups: Vec<Group>,
    /// Beads taken off at the far end by a reading.
    pub(crate) beads_less: usize,
    pub(crate) near: Near,
    pub(crate) push: Push,
    /// What presses the chain together, if anything does.
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
    pub(crate) solver_spans: SolverSpans,
    pub(crate) liquid: Option<Liquid>,
    pub(crate) rig: Option<Rig>,
    pub(crate) friction_coefficient: f64,
    pub(crate) campaign: Campaign,
    pub(crate) cases: Vec<CaseSpec>,
    pub(crate) reading: Reading,
}

impl Spec {
    /// Reads a checked document; files it names lie in `folder`.
    pub(crate) fn read(root: &View<'_>, folder: &Path) -> Result<Self, Problem> {
        let materials = Materials::read(root)?;
        let groups = beads::read(root, &materials)?;
        let count = groups.iter().map(Group::count).sum();
        let track = root.table("track");
        let track_value = |name| track.map_or(Ok(None), |t| t.quantity(name));
        let gravity = match root.units {
            Units::Si => STANDARD_GRAVITY_M_S2,
            Units::Dimensionless => 0.0,
        };
        let near = ends::near(root, &materials, folder)?;
        let spec = Self {
            title: root.text("title").unwrap_or("untitled").to_owned(),
            units: root.units,
            beads_less: 0,
            push: ends::push(root)?,
            load_span: ["near_end", "track", "far_end"]
                .into_iter()
                .find(|key| root.has(key))
                .map_or(0..0, |key| root.span_of(key)),
            far: ends::far(root, &materials)?,
            far_span: root.span_of("far_end"),
            sections: contacts::read(root, &materials, &groups)?,
            gaps: setting::gaps(root)?,
            initial: setting::initial(root)?,
            incline_rad: track_value("incline")?.unwrap_or(0.0),
            gravity_m_s2: track_value("gravity")?.unwrap_or(gravity),
            suspension_m: root
                .table("suspension")
                .map(|t| t.needed("length"))
                .transpose()?,
            suspension_span: root.table("suspension").map(|t| t.span()),
            tension: setting::tension(root),
            sensors: Sensors::read(root, count)?,
            solver: Solver::read(root)?,
            solver_spans: SolverSpans::read(root),
            liquid: Liquid::read(root)?,
            rig: Rig::read(root)?,
            friction_coefficient: track_value("friction")?.unwrap_or(FRICTION),
            campaign: Campaign::read(root, near.speed_m_s())?,
            cases: campaign::cases(root, &materials, &groups)?,
            near,
            reading: reading(root),
            materials,
            groups,
        };
        spec.check_layout()?;
        Ok(spec)
    }

    pub(crate) fn bead_count(&self) -> usize {
        let count: usize = self.groups.iter().map(Group::count).sum();
        count.saturating_sub(self.beads_less)
    }
}

/// The reading of a checked file.
fn reading(root: &View<'_>) -> Reading {
    let mut reading = Reading::default();
    let Some(table) = root.table("reading") else {
        return reading;
    };
    for switch in Reading::switches() {
        let option = table.text(switch.name);
        if let Some(changed) = option.and_then(|o| reading.with(switch.name, o).ok()) {
            reading = changed;
        }
    }
    reading
}
