//! The crate `diffsol`: its explicit pair of Tsitouras, orders 5 and 4.

use crate::case::{Case, Shot};
use crate::motion::{STATE, State, derivative, start};
use crate::tool::{Timed, timed};
use crate::watch::Watch;
use diffsol::{NalgebraMat, NalgebraVec, OdeBuilder, OdeSolverMethod, Vector};

/// The ensemble at one tolerance.
pub fn run(case: Case, tolerance: f64, speeds_m_s: &[f64]) -> Timed {
    timed(case, speeds_m_s, |shot| {
        let tofs = match case {
            Case::Hertz => one::<1>(shot, tolerance),
            Case::HertzViscoelastic => one::<2>(shot, tolerance),
            _ => one::<3>(shot, tolerance),
        };
        tofs.unwrap_or((f64::NAN, f64::NAN))
    })
}

/// The cells of a vector of the crate as a state.
fn state(cells: &[f64]) -> &State {
    cells
        .try_into()
        .expect("all vectors have the length of the first state")
}

fn one<const TERMS: u8>(shot: &Shot, tolerance: f64) -> anyhow::Result<(f64, f64)> {
    let mut problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(0.0)
        .atol([tolerance])
        .h0(1e-3)
        .rhs(|y, _p, _t, dydt| {
            let out = dydt.try_into().expect("as long as the state");
            derivative::<TERMS>(shot, state(y), out);
        })
        .init(|_p, _t, y| y.copy_from_slice(&start()), STATE)
        .build()?;
    // Its own limits let a step only double.
    problem.ode_options.max_timestep_growth = Some(5.0);
    problem.ode_options.min_timestep_shrink = Some(0.2);
    let mut solver = problem.tsit45()?;
    let mut watch = Watch::new();
    let mut dense = NalgebraVec::zeros(STATE, *problem.context());
    loop {
        let before = solver.state().t;
        solver.step()?;
        let now = solver.state();
        let end = *state(now.y.batch_as_slice(0));
        let at = |t: f64| match solver.interpolate_inplace(t, &mut dense) {
            Ok(()) => *state(dense.batch_as_slice(0)),
            Err(_) => end,
        };
        if watch.step(shot, (before, now.t), &end, at) {
            return Ok(watch.tofs_s(shot));
        }
    }
}
