//! The crate `ode_solvers`: translations of Hairer's DOPRI5 and DOP853.

use crate::case::{Case, Shot};
use crate::motion::{STATE, State, derivative, start};
use crate::tool::{Timed, timed};
use crate::watch::{LONGEST, Watch, resolved};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Dopri5, SVector, System};
use std::cell::RefCell;

/// Its methods, by name.
pub const METHODS: [&str; 2] = ["DOPRI5", "DOP853"];

/// RK4 steps from the start of a step to a time within it: the crate gives
/// its dense output only at times chosen in advance.
const PARTS: u32 = 12;

type Vector = SVector<f64, STATE>;

struct Chain<'a, const TERMS: u8> {
    shot: &'a Shot,
    seen: &'a RefCell<(Watch, f64, State)>,
}

impl<const TERMS: u8> System<f64, Vector> for Chain<'_, TERMS> {
    fn system(&self, _t: f64, y: &Vector, dydt: &mut Vector) {
        derivative::<TERMS>(self.shot, &y.data.0[0], &mut dydt.data.0[0]);
    }

    fn solout(&mut self, t: f64, y: &Vector, _dydt: &Vector) -> bool {
        let mut seen = self.seen.borrow_mut();
        let (watch, before, from) = &mut *seen;
        let dense = |at| resolved(self.shot, (*before, from), at, PARTS);
        let over = watch.step(self.shot, (*before, t), &y.data.0[0], dense);
        (*before, *from) = (t, y.data.0[0]);
        over
    }
}

/// The ensemble by one method at one tolerance.
pub fn run(method: &str, case: Case, tolerance: f64, speeds_m_s: &[f64]) -> Timed {
    timed(case, speeds_m_s, |shot| match case {
        Case::Hertz => one::<1>(method, shot, tolerance),
        Case::HertzViscoelastic => one::<2>(method, shot, tolerance),
        _ => one::<3>(method, shot, tolerance),
    })
}

fn one<const TERMS: u8>(method: &str, shot: &Shot, tolerance: f64) -> (f64, f64) {
    let seen = RefCell::new((Watch::new(), 0.0, start()));
    let chain = Chain::<TERMS> { shot, seen: &seen };
    let y = Vector::from_column_slice(&start());
    // Safety factor, PI term, bounds of the change of step, longest and first
    // step, most steps, and how often it looks for stiffness: never.
    macro_rules! integrate {
        ($solver:ident) => {
            $solver::from_param(
                chain,
                0.0,
                LONGEST,
                LONGEST,
                y,
                0.0,
                tolerance,
                0.9,
                0.0,
                0.2,
                6.0,
                LONGEST,
                1e-3,
                10_000_000,
                u32::MAX,
                OutputType::Sparse,
            )
            .integrate()
            .is_ok()
        };
    }
    let done = match method {
        "DOPRI5" => integrate!(Dopri5),
        _ => integrate!(Dop853),
    };
    match done {
        true => seen.into_inner().0.tofs_s(shot),
        false => (f64::NAN, f64::NAN),
    }
}
