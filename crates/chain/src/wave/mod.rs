//! The wave loop: one shot of one chain, from the first touch to its end.

mod bounds;
mod clocks;
mod dense;
mod dormand_prince;
mod energy;
mod error_control;
mod forces;
mod gate;
mod meter;
mod outcome;
mod rk4;
mod run;
mod settings;
mod state;
mod step;
mod table;
mod verlet;
mod window;
mod zones;

pub use dense::Piece;
pub use energy::{Budget, Dissipated};
pub(crate) use gate::bracketed_root;
pub use outcome::{Flow, Limits, Observer, Outcome, SolveError, Work};
pub use run::run;
pub use table::Table;

/// How a method chooses its steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// Steps follow an error estimate per step, relative to the motion's own
    /// scale; openings and closings of contacts end a step.
    Adaptive {
        /// Largest accepted error per step.
        tolerance: f64,
    },
    /// Every step is the same, whatever contacts do; the gate is looked at
    /// afresh in every force pass.
    Fixed {
        /// Step in s.
        step_s: f64,
    },
}

/// A solver: a table of numbers and a way to choose steps.
pub trait Method: std::fmt::Debug + Send + Sync {
    /// The numbers.
    fn table(&self) -> Table;
    /// The steps.
    fn control(&self) -> Control;
    /// Name for people.
    fn name(&self) -> &'static str;
}

/// The default: Dormand–Prince 5(4), adaptive, locating contact changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DormandPrince {
    /// Largest accepted error per step.
    pub tolerance: f64,
}

impl Method for DormandPrince {
    fn table(&self) -> Table {
        dormand_prince::dormand_prince()
    }
    fn control(&self) -> Control {
        Control::Adaptive { tolerance: self.tolerance }
    }
    fn name(&self) -> &'static str {
        "Dormand–Prince 5(4), adaptive, contact changes located"
    }
}

/// The paper's classical Runge–Kutta method with a fixed step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rk4 {
    /// Step in s.
    pub step_s: f64,
}

impl Method for Rk4 {
    fn table(&self) -> Table {
        rk4::rk4()
    }
    fn control(&self) -> Control {
        Control::Fixed { step_s: self.step_s }
    }
    fn name(&self) -> &'static str {
        "classical Runge–Kutta 4, fixed step"
    }
}

/// Velocity Verlet with a fixed step, as discrete-element codes do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verlet {
    /// Step in s.
    pub step_s: f64,
}

impl Method for Verlet {
    fn table(&self) -> Table {
        verlet::verlet()
    }
    fn control(&self) -> Control {
        Control::Fixed { step_s: self.step_s }
    }
    fn name(&self) -> &'static str {
        "velocity Verlet, fixed step"
    }
}
