//! The crate `differential-equations`: adaptive explicit Runge–Kutta methods.

use crate::case::{Case, Shot};
use crate::motion::{STATE, State, derivative, start};
use crate::tool::{Timed, timed};
use crate::watch::{LONGEST, Watch};
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::ExplicitRungeKutta;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;
use differential_equations::traits;

/// Its methods, by name.
pub const METHODS: [&str; 6] = [
    "DOPRI5", "DOP853", "RKV655e", "RKV766e", "RKV877e", "RKV988e",
];

/// A state whose sums are written for the vector unit; what the crate's own
/// array state does element by element through `get_component`.
#[derive(Clone, Debug)]
struct Packed(State);

impl traits::State<f64> for Packed {
    fn len(&self) -> usize {
        STATE
    }
    fn get_component(&self, index: usize) -> f64 {
        self.0[index]
    }
    fn set_component(&mut self, index: usize, value: f64) {
        self.0[index] = value;
    }
    fn map_components_mut<F: FnMut(usize, &mut f64)>(&mut self, mut f: F) {
        self.0.iter_mut().enumerate().for_each(|(i, x)| f(i, x));
    }
    fn zeros_like(&self) -> Self {
        Self([0.0; STATE])
    }
    fn zeros() -> Self {
        Self([0.0; STATE])
    }
    fn mul_add_assign(&mut self, alpha: f64, other: &Self) {
        self.add_scaled(alpha, other);
    }
    fn scale_mut(&mut self, alpha: f64) {
        self.0.iter_mut().for_each(|x| *x *= alpha);
    }
    /// Tableaux are half empty: a zero coefficient costs nothing.
    #[inline(always)]
    fn add_scaled(&mut self, alpha: f64, other: &Self) -> &mut Self {
        if alpha != 0.0 {
            for i in 0..STATE {
                self.0[i] = alpha.mul_add(other.0[i], self.0[i]);
            }
        }
        self
    }
}

struct Chain<'a, const TERMS: u8>(&'a Shot);

impl<const TERMS: u8> ODE<f64, Packed> for Chain<'_, TERMS> {
    #[inline]
    fn diff(&self, _t: f64, y: &Packed, dydt: &mut Packed) {
        derivative::<TERMS>(self.0, &y.0, &mut dydt.0);
    }
}

/// The ensemble by one method at one tolerance.
pub fn run(method: &str, case: Case, tolerance: f64, speeds_m_s: &[f64]) -> Timed {
    match case {
        Case::Hertz => by_terms::<1>(method, case, tolerance, speeds_m_s),
        Case::HertzViscoelastic => by_terms::<2>(method, case, tolerance, speeds_m_s),
        _ => by_terms::<3>(method, case, tolerance, speeds_m_s),
    }
}

fn by_terms<const TERMS: u8>(method: &str, case: Case, tolerance: f64, speeds: &[f64]) -> Timed {
    macro_rules! shots {
        ($constructor:ident) => {
            timed(case, speeds, |shot| {
                let solver = ExplicitRungeKutta::$constructor()
                    .rtol(0.0)
                    .atol(tolerance)
                    .h0(1e-3)
                    .max_steps(10_000_000);
                one(solver, Chain::<TERMS>(shot), shot)
            })
        };
    }
    match method {
        "DOPRI5" => shots!(dopri5),
        "DOP853" => shots!(dop853),
        "RKV655e" => shots!(rkv655e),
        "RKV766e" => shots!(rkv766e),
        "RKV877e" => shots!(rkv877e),
        _ => shots!(rkv988e),
    }
}

/// One shot, stepped by hand: `solve_ode` would copy both states every step.
fn one<S, F>(mut solver: S, chain: F, shot: &Shot) -> (f64, f64)
where
    S: OrdinaryNumericalMethod<f64, Packed> + Interpolation<f64, Packed>,
    F: ODE<f64, Packed>,
{
    let mut watch = Watch::new();
    if solver.init(&chain, 0.0, LONGEST, &Packed(start())).is_err() {
        return (f64::NAN, f64::NAN);
    }
    solver.set_status(Status::Solving);
    loop {
        if solver.step(&chain).is_err() {
            return (f64::NAN, f64::NAN);
        }
        if matches!(solver.status(), Status::RejectedStep) {
            continue;
        }
        let times = (solver.t_prev(), solver.t());
        let end = solver.y().0;
        let dense = |t| solver.interpolate(t).map_or(end, |y| y.0);
        if watch.step(shot, times, &end, dense) {
            return watch.tofs_s(shot);
        }
    }
}
