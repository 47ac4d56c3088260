//! The contact of the highest pressure over its yield strength in a shot.

use super::bracketed_root;
use super::dense::Piece;
use crate::sensor::Sensor;
use crate::system::System;
use std::ops::Range;

/// Numbers that are compared side by side.
const LANES: usize = 8;

/// Follows the contact of the highest pressure so far, p₀² ∝ δ (K/R*)² [Hertz1881], over the yield strength
/// of its weaker body where any is known.
///
/// A step costs a look at the overlaps that its last stage has left, so that the pressures compared are
/// those at the ends of steps; the highest contact's force is that at its largest overlap, where losses that
/// go with the rate are none.
#[derive(Clone, Debug)]
pub(super) struct HardestContact {
    /// (K/R*)² of each contact over its yield strength's square, 0 where none is.
    factors: Vec<f64>,
    contact: usize,
    /// Its overlap times its factor.
    most: f64,
    force_n: f64,
    is_rising: bool,
}

impl HardestContact {
    pub(super) fn new(system: &System) -> Self {
        let factors = system.pressure_factors();
        Self { factors, contact: 0, most: 0.0, force_n: 0.0, is_rising: false }
    }

    /// The contact and its force in N at its largest overlap, if any was pressed.
    pub(super) fn found(&self) -> Option<(usize, f64)> {
        (self.force_n > 0.0).then_some((self.contact, self.force_n))
    }

    /// Looks at a step, at whose end contacts have these overlaps.
    pub(super) fn step(&mut self, piece: &Piece<'_>, overlaps_m: &[f64], contacts: Range<usize>) {
        let columns = [overlaps_m, &self.factors[contacts.clone()]];
        let most = largest(columns);
        if most > self.most {
            let [overlaps_m, factors] = columns;
            let is_most = |i: &usize| overlaps_m[*i] * factors[*i] == most;
            self.contact = contacts.start + (0..factors.len()).find(is_most).unwrap_or(0);
            self.is_rising = true;
            self.note(piece, 1.0);
        }
        let rate = |theta: f64| piece.overlap(self.contact, theta).1;
        if self.is_rising && rate(1.0) <= 0.0 {
            let top =
                if rate(0.0) > 0.0 { bracketed_root(|at| -rate(at), 0.0, 1.0, 1e-9) } else { 0.0 };
            self.note(piece, top);
            self.is_rising = false;
        }
    }

    /// Takes the contact as it is within a step.
    fn note(&mut self, piece: &Piece<'_>, theta: f64) {
        let at_rest_n = piece.system.static_force_n[self.contact];
        self.force_n = piece.signal(Sensor::Contact(self.contact), theta) + at_rest_n;
        self.most = piece.overlap(self.contact, theta).0 * self.factors[self.contact];
    }
}

/// The largest overlap × factor.
fn largest([overlaps_m, factors]: [&[f64]; 2]) -> f64 {
    let mut most = [0.0_f64; LANES];
    let whole = factors.len() - factors.len() % LANES;
    for start in (0..whole).step_by(LANES) {
        let part = |column: &'_ [f64]| -> [f64; LANES] {
            column[start..start + LANES].try_into().unwrap_or_default()
        };
        let (overlap, factor) = (part(overlaps_m), part(factors));
        for lane in 0..LANES {
            let here = overlap[lane] * factor[lane];
            most[lane] = if here > most[lane] { here } else { most[lane] };
        }
    }
    let rest = (whole..factors.len()).map(|i| overlaps_m[i] * factors[i]);
    most.into_iter().chain(rest).fold(0.0, f64::max)
}
