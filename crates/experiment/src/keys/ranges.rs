//! Ranges of numbers that a chain of solid bodies can have.
//!
//! They are far wider than any material or laboratory and only keep out slips
//! such as a lost exponent, whose consequences (no overlap that a number can
//! hold, a pulse that never arrives) could not be reported at their place in the
//! file. A rigid body is within them.

use super::Limits;

/// Of any quantity that is not 0, in SI or dimensionless.
pub(crate) const SMALLEST: f64 = 1e-100;
/// Of any quantity.
pub(crate) const LARGEST: f64 = 1e100;

/// What stands for a positive range in a dimensionless file.
pub(crate) const PLAIN: Limits = range(SMALLEST, LARGEST, "positive, from 1e-100 to 1e100");

/// From a cluster of atoms to a moon.
pub(crate) const LENGTH: Limits = range(1e-9, 1e6, "from 1 nm to 1000 km");
/// Up to the same length, 0 included.
pub(super) const GAP: Limits = range(0.0, 1e6, "from 0 to 1000 km");
/// From less than an atom's thousandth to a planet.
pub(crate) const MASS: Limits = range(1e-30, 1e25, "from 1e-30 kg to 1e25 kg");
/// From a thousandth of an aerogel's to fifty times that of osmium.
pub(super) const DENSITY: Limits = range(1e-3, 1e6, "from 1e-3 kg/m^3 to 1e6 kg/m^3");
/// From a gel too soft to stand to a billion times diamond, for rigid walls.
pub(super) const YOUNG_MODULUS: Limits = range(1.0, 1e21, "from 1 Pa to 1e21 Pa");
/// Up to the Earth's mantle and beyond.
pub(super) const VISCOSITY: Limits = range(0.0, 1e24, "from 0 to 1e24 Pa s");
/// From a creep to a hundred times any bullet.
pub(crate) const SPEED: Limits = range(1e-12, 1e6, "from 1e-12 m/s to 1e6 m/s");
/// Of a bead that starts moving, either way.
pub(super) const VELOCITY: Limits = range(-1e6, 1e6, "from -1e6 m/s to 1e6 m/s");
/// Of a body, either way.
pub(super) const DISPLACEMENT: Limits = range(-1e6, 1e6, "from -1000 km to 1000 km");
/// From light crossing an atom to thirty years.
pub(super) const TIME: Limits = range(1e-18, 1e9, "from 1e-18 s to 1e9 s");
/// The inverse of a time.
pub(super) const FREQUENCY: Limits = range(1e-9, 1e18, "from 1e-9 Hz to 1e18 Hz");
/// Up to the surface of a dense star.
pub(super) const GRAVITY: Limits = range(0.0, 1e12, "from 0 to 1e12 m/s^2");

const fn range(least: f64, most: f64, words: &'static str) -> Limits {
    Limits::new(least, most, true, words)
}
