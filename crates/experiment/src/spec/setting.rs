//! What surrounds the chain: gaps, initial deviations, sensors, solver, liquid.

use crate::finding::Problem;
use crate::view::View;
use hertzchain_chain::{Gap, Initial, Tension};
use std::ops::Range;

/// How the motion is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// An embedded pair that chooses its step by the accuracy.
    #[default]
    Adaptive,
    /// Classical Runge–Kutta with a fixed step, as in the paper.
    Rk4,
    /// Velocity Verlet with a fixed step, as in discrete-element codes.
    Verlet,
}

/// Names of the methods in a file, in the order of [`Method`].
pub const METHODS: &[&str] = &["adaptive", "rk4", "verlet"];

/// Solver and its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// Method.
    pub method: Method,
    /// Relative accuracy asked for.
    pub accuracy: f64,
    /// Step of a fixed-step method in s; `None` lets the program decide.
    pub step_s: Option<f64>,
    /// Duration of a shot in s; `None` until the reflected pulse has passed
    /// the sensor.
    pub duration_s: Option<f64>,
}

/// A liquid, for reports: no law uses it.
#[derive(Clone, Debug, PartialEq)]
pub struct Liquid {
    /// Name.
    pub name: String,
    /// Kinematic viscosity in m²/s.
    pub kinematic_viscosity_m2_s: Option<f64>,
    /// Density in kg/m³.
    pub density_kg_m3: Option<f64>,
}

impl Liquid {
    /// Dynamic viscosity in Pa s.
    pub fn dynamic_viscosity_pa_s(&self) -> Option<f64> {
        Some(self.kinematic_viscosity_m2_s? * self.density_kg_m3?)
    }

    pub(super) fn read(root: &View<'_>) -> Result<Option<Self>, Problem> {
        let Some(table) = root.table("liquid") else {
            return Ok(None);
        };
        Ok(Some(Self {
            name: table.text("name").unwrap_or("liquid").to_owned(),
            kinematic_viscosity_m2_s: table.quantity("kinematic_viscosity")?,
            density_kg_m3: table.quantity("density")?,
        }))
    }
}

impl Solver {
    /// The accuracy when a file names none.
    pub const DEFAULT_ACCURACY: f64 = 1e-6;

    pub(super) fn read(root: &View<'_>) -> Result<Self, Problem> {
        let table = root.table("solver");
        let number = |key| table.map_or(Ok(None), |t| t.quantity(key));
        let method = match table.and_then(|t| t.text("method")) {
            Some("rk4") => Method::Rk4,
            Some("verlet") => Method::Verlet,
            _ => Method::Adaptive,
        };
        let step_s = number("step")?;
        match (table, method) {
            (Some(table), Method::Adaptive) if step_s.is_some() => {
                let message = "the adaptive method chooses its own steps";
                let label = "expected no `step`, or method = \"rk4\" or \"verlet\"";
                return Err(Problem::new(&table.span_of("step"), message, label));
            }
            _ => {}
        }
        Ok(Self {
            method,
            accuracy: number("accuracy")?.unwrap_or(Self::DEFAULT_ACCURACY),
            step_s,
            duration_s: number("duration")?,
        })
    }
}

/// Where a file gives times to the solver.
#[derive(Clone, Debug)]
pub(crate) struct SolverSpans {
    pub(crate) table: Option<Range<usize>>,
    pub(crate) step: Range<usize>,
    pub(crate) duration: Range<usize>,
}

impl SolverSpans {
    pub(super) fn read(root: &View<'_>) -> Self {
        let table = root.table("solver");
        let span = |key| table.map_or(root.span(), |t| t.span_of(key));
        Self {
            table: table.map(|t| t.span()),
            step: span("step"),
            duration: span("duration"),
        }
    }
}

/// Where the chain is watched.
#[derive(Clone, Debug)]
pub(crate) struct Sensors {
    /// The sensor bead n of the ToF.
    pub(crate) bead: usize,
    pub(crate) span: Range<usize>,
    pub(crate) beads: Vec<(usize, Range<usize>)>,
    pub(crate) contacts: Vec<(usize, Range<usize>)>,
    pub(crate) positions: Vec<(usize, Range<usize>)>,
    pub(crate) velocities: Vec<(usize, Range<usize>)>,
    /// Where the paper's channel is asked for.
    pub(crate) channel: Option<Range<usize>>,
}

impl Sensors {
    pub(super) fn read(root: &View<'_>, beads: usize) -> Result<Self, Problem> {
        let usual = if beads >= 8 { 7 } else { 1 };
        let table = root.table("sensors");
        let list = |key| table.map_or(Ok(Vec::new()), |t| t.counts(key));
        let bead = table.map_or(Ok(None), |t| t.count("bead"))?;
        Ok(Self {
            bead: bead.unwrap_or(usual),
            span: table.map_or(root.span(), |t| t.span_of("bead")),
            beads: list("beads")?,
            contacts: list("contacts")?,
            positions: list("positions")?,
            velocities: list("velocities")?,
            channel: table
                .filter(|t| t.flag("channel"))
                .map(|t| t.span_of("channel")),
        })
    }
}

/// Gaps with their places in the file.
pub(super) fn gaps(root: &View<'_>) -> Result<Vec<(Gap, Range<usize>)>, Problem> {
    let gap = |table: &View<'_>| {
        let gap = Gap {
            contact: table.count("contact")?.unwrap_or(0),
            gap_m: table.needed("gap")?,
        };
        Ok((gap, table.span_of("contact")))
    };
    root.tables("gaps").iter().map(gap).collect()
}

/// Initial deviations with their places in the file.
pub(super) fn initial(root: &View<'_>) -> Result<Vec<(Initial, Range<usize>)>, Problem> {
    let initial = |table: &View<'_>| {
        if !table.has("displacement") && !table.has("velocity") {
            let message = "this bead is neither displaced nor moving";
            let label = "expected `displacement` or `velocity`, or no such table";
            return Err(Problem::new(&table.span(), message, label));
        }
        let initial = Initial {
            bead: table.count("bead")?.unwrap_or(0),
            displacement_m: table.quantity("displacement")?.unwrap_or(0.0),
            velocity_m_s: table.quantity("velocity")?.unwrap_or(0.0),
        };
        Ok((initial, table.span_of("bead")))
    };
    root.tables("initial").iter().map(initial).collect()
}

pub(super) fn tension(root: &View<'_>) -> Tension {
    match root.text("tension") {
        Some("clipped") => Tension::Clipped,
        _ => Tension::Allowed,
    }
}
