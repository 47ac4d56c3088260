//! Dimensions: powers of the base units, with names for people.

use super::{Exponent, parse_unit};
use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul};
use std::fmt;

/// Powers of metre, kilogram, second, radian and ampere.
///
/// The radian counts as a base unit here, so that an angle without its unit,
/// or a frequency in rad/s, is a mistake and not a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension([Exponent; 5]);

/// Base units as they are stored, and the places in which they are written.
const BASE: [&str; 5] = ["m", "kg", "s", "rad", "A"];
const WRITTEN: [usize; 5] = [1, 0, 2, 3, 4];

/// What people call a dimension: name, SI unit, an example.
static NAMES: &[(&str, &str, &str)] = &[
    ("a plain number", "1", "0.3"),
    ("a length", "m", "6.35 mm"),
    ("a mass", "kg", "8.54 g"),
    ("a time", "s", "10 us"),
    ("an angle", "rad", "0.5 deg"),
    ("a speed", "m/s", "0.5 m/s"),
    ("an acceleration", "m/s^2", "9.80665 m/s^2"),
    ("a force", "N", "0.24 N"),
    ("a pressure", "Pa", "213 GPa"),
    ("a density", "kg/m^3", "7.96 g/cm^3"),
    ("a dynamic viscosity", "Pa s", "32 kPa s"),
    ("a kinematic viscosity", "m^2/s", "55 cSt"),
    ("a frequency", "Hz", "5 kHz"),
    ("an energy", "J", "1 mJ"),
    ("a stiffness", "N/m", "100 N/m"),
    ("a damping constant", "N s/m", "1e-3 N s/m"),
    ("a Hertz stiffness", "N/m^(3/2)", "8.79e9 N/m^(3/2)"),
    ("a cubic damping", "kg s/m^2", "77 kg s/m^2"),
    ("a viscoelastic damping", "N s/m^(3/2)", "4.5e3 N s/m^(3/2)"),
    ("an area", "m^2", "1 mm^2"),
    ("a volume", "m^3", "1 ml"),
    ("a voltage", "V", "10 V"),
    ("a charge", "C", "100 pC"),
    ("a charge sensitivity", "C/N", "20 pC/N"),
    ("a charge amplification", "V/C", "1 mV/pC"),
];

impl Dimension {
    /// Plain numbers.
    pub const NONE: Self = Self::new([0; 4], 0);

    /// Powers of metre, kilogram, second and radian, and of ampere.
    pub(super) const fn new([metre, kilogram, second, radian]: [i64; 4], ampere: i64) -> Self {
        Self([
            Ratio::new_raw(metre, 1),
            Ratio::new_raw(kilogram, 1),
            Ratio::new_raw(second, 1),
            Ratio::new_raw(radian, 1),
            Ratio::new_raw(ampere, 1),
        ])
    }

    /// The dimension of a product; `None` when an exponent overflows.
    pub(super) fn times(self, other: Self) -> Option<Self> {
        let mut out = self.0;
        for (mine, theirs) in out.iter_mut().zip(&other.0) {
            *mine = mine.checked_add(theirs)?;
        }
        Some(Self(out))
    }

    /// The dimension of a power; `None` when an exponent overflows.
    pub(super) fn power(self, exponent: Exponent) -> Option<Self> {
        let mut out = self.0;
        for mine in &mut out {
            *mine = mine.checked_mul(&exponent)?;
        }
        Some(Self(out))
    }

    /// Whether two dimensions agree. Exponents may come from a user's decimal
    /// ("n = 1.3333333"), hence the margin.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let value = |r: &Exponent| *r.numer() as f64 / *r.denom() as f64;
        let pairs = self.0.iter().zip(&other.0);
        pairs
            .into_iter()
            .all(|(a, b)| (value(a) - value(b)).abs() < 1e-6)
    }

    /// "a length", or the SI unit where there is no common name.
    pub fn name(&self) -> String {
        match self.known() {
            Some((name, _, _)) => (*name).to_owned(),
            None => format!("a quantity in {self}"),
        }
    }

    /// "a length"; `None` where there is no common name.
    pub(crate) fn known_name(&self) -> Option<&'static str> {
        self.known().map(|(name, _, _)| *name)
    }

    /// A quantity of this dimension, as an example.
    pub fn example(&self) -> String {
        match self.known() {
            Some((_, _, example)) => (*example).to_owned(),
            None => format!("1 {self}"),
        }
    }

    fn known(&self) -> Option<&'static (&'static str, &'static str, &'static str)> {
        NAMES
            .iter()
            .find(|(_, unit, _)| parse_unit(unit).is_ok_and(|u| u.dimension.agrees_with(self)))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        for at in WRITTEN {
            let (power, unit) = (self.0[at], BASE[at]);
            match (*power.numer(), *power.denom()) {
                (0, _) => {}
                (1, 1) => parts.push(unit.to_owned()),
                (n, 1) => parts.push(format!("{unit}^{n}")),
                (n, d) => parts.push(format!("{unit}^({n}/{d})")),
            }
        }
        f.write_str(&if parts.is_empty() {
            "1".to_owned()
        } else {
            parts.join(" ")
        })
    }
}
