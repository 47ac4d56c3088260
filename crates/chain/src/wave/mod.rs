//! The wave loop: one shot of one chain, from the first touch to its end.

mod bounds;
mod clocks;
mod contact_states;
mod dense;
mod dormand_prince;
mod energy;
mod error_control;
mod forces;
mod gate;
mod hardest;
mod meter;
mod order;
mod outcome;
mod prince_dormand;
mod rk4;
mod run;
mod settings;
mod state;
mod step;
mod table;
mod verlet;
mod window;
mod zones;

pub use self::{
    dense::Piece,
    energy::{Budget, Dissipated},
    outcome::{Flow, Limits, Observer, Outcome, SolveError, Work},
    run::run,
    table::Table,
};
pub(crate) use gate::bracketed_root;

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
#[derive(Clone, Debug)]
pub struct Method {
    /// The numbers.
    pub table: Table,
    /// Numbers of a method of higher order, for stretches in which contacts seldom open or close.
    pub smooth: Option<Table>,
    /// The steps.
    pub control: Control,
    /// Name for people.
    pub name: &'static str,
}

impl Method {
    /// The default: Dormand–Prince 5(4), adaptive, locating contact changes, with a largest
    /// accepted error per step.
    pub fn dormand_prince(tolerance: f64) -> Self {
        Self {
            table: dormand_prince::dormand_prince(),
            smooth: None,
            control: Control::Adaptive { tolerance },
            name: "Dormand–Prince 5(4), adaptive, contact changes located",
        }
    }

    /// For long rows and tight tolerances: Prince–Dormand 8(7) where contacts seldom open or close,
    /// Dormand–Prince 5(4) elsewhere, with a largest accepted error per step.
    pub fn prince_dormand(tolerance: f64) -> Self {
        Self {
            smooth: Some(prince_dormand::prince_dormand()),
            name: "Prince–Dormand 8(7) and Dormand–Prince 5(4), adaptive, contact changes located",
            ..Self::dormand_prince(tolerance)
        }
    }

    /// The paper's classical Runge–Kutta method with a fixed step in s.
    pub fn rk4(step_s: f64) -> Self {
        let (table, control) = (rk4::rk4(), Control::Fixed { step_s });
        Self { table, smooth: None, control, name: "classical Runge–Kutta 4, fixed step" }
    }

    /// Velocity Verlet with a fixed step in s, as discrete-element codes do.
    pub fn verlet(step_s: f64) -> Self {
        let (table, control) = (verlet::verlet(), Control::Fixed { step_s });
        Self { table, smooth: None, control, name: "velocity Verlet, fixed step" }
    }
}
