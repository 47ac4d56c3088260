//! The contact of the highest pressure over its yield strength in a shot.

use super::dense::Piece;
use crate::sensor::Sensor;
use crate::system::System;
use std::ops::Range;

/// Numbers that are compared side by side.
const LANES: usize = 8;

/// A parabola whose maximum is higher by more than this share is none of the force.
const STEEPEST: f64 = 0.1;

/// Follows the contact of the highest pressure so far, p₀³ ∝ F K²/R*³ [Hertz1881], over the yield strength
/// of its weaker body where any is known.
///
/// A step costs a look at the forces that its last stage has left, so that the pressures compared are
/// those at the ends of steps; the force of the highest is interpolated.
#[derive(Clone, Debug)]
pub(super) struct HardestContact {
    /// K²/R*³ of each contact over its yield strength's cube, 0 where none is.
    factors: Vec<f64>,
    contact: usize,
    force_n: f64,
    is_rising: bool,
}

impl HardestContact {
    pub(super) fn new(system: &System) -> Self {
        let factors = system.pressure_factors();
        Self { factors, contact: 0, force_n: 0.0, is_rising: false }
    }

    /// The contact and its largest force in N, if any was pressed.
    pub(super) fn found(&self) -> Option<(usize, f64)> {
        (self.force_n > 0.0).then_some((self.contact, self.force_n))
    }

    /// Looks at a step, at whose end contacts have these dynamic forces.
    pub(super) fn step(&mut self, piece: &Piece<'_>, dynamic_n: &[f64], contacts: Range<usize>) {
        let first = contacts.start;
        let at_rest_n = &piece.system.static_force_n[contacts.clone()];
        let columns = [dynamic_n, at_rest_n, &self.factors[contacts]];
        let most = largest(columns);
        if most > self.force_n * self.factors[self.contact] {
            let [dynamic_n, at_rest_n, factors] = columns;
            let is_most = |i: &usize| (dynamic_n[*i] + at_rest_n[*i]) * factors[*i] == most;
            let found = (0..factors.len()).find(is_most).unwrap_or(0);
            self.force_n = dynamic_n[found] + at_rest_n[found];
            self.contact = first + found;
            self.is_rising = true;
        } else if self.is_rising {
            self.force_n = self.force_n.max(top(piece, self.contact));
            self.is_rising = false;
        }
    }
}

/// The largest (dynamic + static force) × factor.
fn largest([dynamic_n, at_rest_n, factors]: [&[f64]; 3]) -> f64 {
    let mut most = [0.0_f64; LANES];
    let whole = factors.len() - factors.len() % LANES;
    for start in (0..whole).step_by(LANES) {
        let part = |column: &'_ [f64]| -> [f64; LANES] {
            column[start..start + LANES].try_into().unwrap_or_default()
        };
        let (dynamic, at_rest, factor) = (part(dynamic_n), part(at_rest_n), part(factors));
        for lane in 0..LANES {
            let here = (dynamic[lane] + at_rest[lane]) * factor[lane];
            most[lane] = if here > most[lane] { here } else { most[lane] };
        }
    }
    let rest = (whole..factors.len()).map(|i| (dynamic_n[i] + at_rest_n[i]) * factors[i]);
    most.into_iter().chain(rest).fold(0.0, f64::max)
}

/// The largest force of a contact about the start of a step, by a parabola through its value and its
/// slopes there and in the middle.
fn top(piece: &Piece<'_>, contact: usize) -> f64 {
    let here = piece.signal(Sensor::Contact(contact), 0.0) + piece.system.static_force_n[contact];
    let slope = |theta| piece.signal_rate(Sensor::Contact(contact), theta);
    let (rate, curvature) = (slope(0.0), (slope(0.5) - slope(0.0)) / (0.5 * piece.step_s));
    let higher = -0.5 * rate * rate / curvature;
    match (0.0..STEEPEST * here).contains(&higher) {
        true => here + higher,
        false => here,
    }
}
