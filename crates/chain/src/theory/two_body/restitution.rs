//! Viscoelastic collision: the restitution coefficient by series and by integration.
//!
//! The force is F = k δⁿ + A d(k δⁿ)/dt, which for Hertz contacts is
//! K δ^{3/2} + (3/2) A K √δ δ̇ \[Brilliantov1996\]. With lengths in (m v²/k)^{1/(n+1)}
//! and times in that over v the collision has one parameter,
//!
//! > y″ + yⁿ + x yⁿ⁻¹ y′ = 0, y(0) = 0, y′(0) = 1,
//! > x = n A (k/m)^{1/(n+1)} v^{(n−1)/(n+1)}.

use libm::tgamma;

use super::ElasticCollision;
use super::stepper::{State, extrapolated_step};
use crate::chain::ChainError;
use crate::theory::{not_converged, out_of_range};

/// When the bodies count as separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactEnd {
    /// At overlap 0; shortly before, the force pulls.
    ZeroOverlap,
    /// When the force first returns to 0: no tension (clipped).
    ZeroForce,
}

/// A viscoelastic collision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscoelasticCollision {
    /// The same collision without dissipation.
    pub elastic: ElasticCollision,
    /// Dissipation time A, s.
    pub damping_time_s: f64,
}

/// How a viscoelastic collision went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoBodyRebound {
    /// Relative speed after over before, 0 to 1.
    pub restitution: f64,
    /// Duration of the contact: in seconds, or in units of (m v²/k)^{1/(n+1)}/v.
    pub contact_time: f64,
    /// Largest overlap: in metres, or in units of (m v²/k)^{1/(n+1)}.
    pub largest_overlap: f64,
}

impl ViscoelasticCollision {
    /// x = n A (k/m)^{1/(n+1)} v^{(n−1)/(n+1)}; Hertz: (3/2) A (K/m)^{2/5} v^{1/5}.
    pub fn parameter(&self) -> f64 {
        let n = self.elastic.exponent;
        let frequency = (self.elastic.stiffness / self.elastic.reduced_mass_kg)
            * self.elastic.speed_m_s.powf(n - 1.0);
        n * self.damping_time_s * frequency.powf(1.0 / (n + 1.0))
    }

    /// Integrates the collision; contact time in s and overlap in m.
    ///
    /// # Errors
    /// As [`rebound`].
    pub fn rebound(&self, end: ContactEnd) -> Result<TwoBodyRebound, ChainError> {
        let n = self.elastic.exponent;
        let scaled = rebound(n, self.parameter(), end)?;
        let power = self.elastic.reduced_mass_kg * self.elastic.speed_m_s.powi(2);
        let length_m = (power / self.elastic.stiffness).powf(1.0 / (n + 1.0));
        Ok(TwoBodyRebound {
            restitution: scaled.restitution,
            contact_time: scaled.contact_time * length_m / self.elastic.speed_m_s,
            largest_overlap: scaled.largest_overlap * length_m,
        })
    }
}

/// Coefficients C1 and C2 of e = 1 − C1 x + C2 x² + …, for [`ContactEnd::ZeroOverlap`].
///
/// C1 is the work of the damping along the elastic path,
/// 2 ∫₀^Y yⁿ⁻¹ √(1 − 2 yⁿ⁺¹/(n+1)) dy with Y = ((n+1)/2)^{1/(n+1)}, so
/// C1 = (2 Yⁿ/(n+1)) B(n/(n+1), 3/2). C2 = C1² n/(n+1) because the collision run
/// backwards is one with damping −A that starts at the final speed:
/// e(x) e′(x e^{(n−1)/(n+1)}) = 1 with e′(x) = e(−x). Hertz: 1.15345 and 3/5 of
/// its square \[Ramirez1999\].
pub fn restitution_coefficients(exponent: f64) -> (f64, f64) {
    let n = exponent;
    let share = n / (n + 1.0);
    let reach = (0.5 * (n + 1.0)).powf(share);
    let beta = tgamma(share) * tgamma(1.5) / tgamma(share + 1.5);
    let first = 2.0 * reach / (n + 1.0) * beta;
    (first, share * first * first)
}

/// Restitution 1 − C1 x + C2 x², good for small x: what is left out is about
/// 0.5 x³ at [`ContactEnd::ZeroOverlap`]; clipped contacts differ by order x^{5/2} (Hertz).
pub fn restitution_by_series(exponent: f64, parameter: f64) -> f64 {
    let (first, second) = restitution_coefficients(exponent);
    1.0 - parameter * (first - second * parameter)
}

/// Integrates the scaled collision to about 1e-13.
///
/// √δ-like terms spoil any integrator at δ = 0. In the root s = y^β and the
/// time σ with dt = y^{1−β} dσ the problem reads
///
/// > ds/dσ = β w, dw/dσ = −s^{(n+1)/β − 1} − x s^{n/β − 1} w, dt/dσ = s^{1/β − 1},
///
/// polynomial for β = 1/2 and Hertz (and every half-integer n), and eight
/// times differentiable for β = 1/8 otherwise.
///
/// # Errors
/// [`ChainError::Value`] unless 1 ≤ n ≤ 10 and 0 ≤ x ≤ 20,
/// [`ChainError::NotConverged`] if the steps become too many.
pub fn rebound(
    exponent: f64,
    parameter: f64,
    end: ContactEnd,
) -> Result<TwoBodyRebound, ChainError> {
    check_range("force exponent", exponent, 1.0, 10.0, "between 1 and 10")?;
    check_range("damping parameter", parameter, 0.0, 20.0, "between 0 and 20")?;
    let scaled = Desingularised::new(exponent, parameter);
    let rates = |state: &State| scaled.rates(state);
    let peak = advance_until(&rates, [0.0, 1.0, 0.0], |[_, w, _]| *w <= 0.0)?;
    let last = advance_until(&rates, peak, |state| scaled.separated(state, end))?;
    let [peak_root, _, _] = peak;
    let [_, final_speed, contact_time] = last;
    Ok(TwoBodyRebound {
        restitution: -final_speed,
        contact_time,
        largest_overlap: peak_root.powf(scaled.inverse_root),
    })
}

struct Desingularised {
    exponent: f64,
    parameter: f64,
    inverse_root: f64,
}

impl Desingularised {
    fn new(exponent: f64, parameter: f64) -> Self {
        let half_integer = (2.0 * exponent).fract() == 0.0;
        Self { exponent, parameter, inverse_root: if half_integer { 2.0 } else { 8.0 } }
    }

    fn rates(&self, &[root, speed, _]: &State) -> State {
        let q = self.inverse_root;
        let n = self.exponent;
        // The overlap only leaves s >= 0 in trial steps past the end.
        let s = root.abs();
        let damping = self.parameter * s.powf(n * q - 1.0);
        let stiffness = s.powf((n + 1.0) * q - 1.0);
        [speed / q, -stiffness - damping * speed, s.powf(q - 1.0)]
    }

    fn separated(&self, &[root, speed, _]: &State, end: ContactEnd) -> bool {
        let pulls = root.max(0.0).powf(self.inverse_root) + self.parameter * speed <= 0.0;
        root <= 0.0 || (end == ContactEnd::ZeroForce && pulls)
    }
}

/// Steps until `reached` turns true and bisects the last step for that place.
fn advance_until(
    rates: &impl Fn(&State) -> State,
    start: State,
    reached: impl Fn(&State) -> bool,
) -> Result<State, ChainError> {
    const TOLERANCE: f64 = 1e-14;
    const MOST_STEPS: usize = 200_000;
    let mut state = start;
    let mut h = 0.25;
    for _ in 0..MOST_STEPS {
        let (next, error) = extrapolated_step(rates, &state, h);
        if error > TOLERANCE {
            h *= 0.5;
        } else if reached(&next) {
            return Ok(bisect_step(rates, &state, h, reached));
        } else {
            state = next;
            h *= 1.3;
        }
    }
    Err(not_converged("two-body collision", h))
}

fn bisect_step(
    rates: &impl Fn(&State) -> State,
    start: &State,
    h: f64,
    reached: impl Fn(&State) -> bool,
) -> State {
    const HALVINGS: usize = 60;
    let (mut before, mut after) = (0.0, h);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if reached(&extrapolated_step(rates, start, middle).0) {
            after = middle;
        } else {
            before = middle;
        }
    }
    extrapolated_step(rates, start, after).0
}

fn check_range(
    quantity: &'static str,
    value: f64,
    lowest: f64,
    highest: f64,
    expected: &'static str,
) -> Result<(), ChainError> {
    if (lowest..=highest).contains(&value) {
        return Ok(());
    }
    Err(out_of_range(quantity, value, expected))
}
