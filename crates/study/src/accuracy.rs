//! From the accuracy that is asked to a solver that delivers it.

use crate::plan::{Plan, Solver};
use hertzchain_chain::System;
use hertzchain_chain::wave::{DormandPrince, Method, Rk4, Verlet};

/// Tightest tolerance per step: below it rounding, not the step, decides.
pub(crate) const TIGHTEST: f64 = 1e-13;

/// Times of flight are twice as wrong as one step is allowed to be, up to
/// thirteen times behind a strong loss, whose loosened chain amplifies errors.
const OF_TIMES: f64 = 10.0;

/// The residual of the energy budget sums over steps and is this much worse.
const OF_BUDGET: f64 = 200.0;

/// Chains longer than this take so many more steps that the sum needs more.
const LONG_CHAIN: f64 = 200.0;

/// First step of a fixed-step method, in contact times.
const FIRST_STEP: f64 = 1.0 / 20.0;

/// Tolerance per step that gives a plan's accuracy, and whether rounding forbids it.
pub(crate) fn tolerance(plan: &Plan) -> (f64, bool) {
    let steps = (plan.chain.beads.len() as f64 / LONG_CHAIN).max(1.0);
    let share = if plan.budget {
        OF_BUDGET * steps
    } else {
        OF_TIMES
    };
    let wanted = plan.accuracy / share;
    (wanted.max(TIGHTEST), wanted < TIGHTEST)
}

/// The adaptive solver at a tolerance.
pub(crate) fn adaptive(tolerance: f64) -> Box<dyn Method> {
    Box::new(DormandPrince { tolerance })
}

/// A fixed-step solver and its step in s; `None` for the adaptive one.
pub(crate) fn given_step(solver: Solver) -> Option<f64> {
    match solver {
        Solver::Adaptive => None,
        Solver::Rk4 { step_s } | Solver::Verlet { step_s } => step_s,
    }
}

/// The step in s that a search for a fixed step begins with.
pub(crate) fn first_step_s(system: &System) -> f64 {
    FIRST_STEP * system.scales().time_s
}

/// A fixed-step solver.
pub(crate) fn fixed(solver: Solver, step_s: f64) -> Box<dyn Method> {
    match solver {
        Solver::Verlet { .. } => Box::new(Verlet { step_s }),
        Solver::Rk4 { .. } | Solver::Adaptive => Box::new(Rk4 { step_s }),
    }
}
