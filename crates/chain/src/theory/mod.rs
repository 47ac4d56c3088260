//! Theory to hold the simulations against: numbers computed, not typed in.
//!
//! Nothing here integrates a chain; every function works on plain numbers in SI
//! units (set stiffness and mass to 1 for dimensionless ones). The force law is
//! F = k δⁿ, Hertz contacts have n = 3/2 and k in N/m^{3/2}.
//!
//! | module | what it answers | how far to trust it |
//! |---|---|---|
//! | [`solitary`] | the wave of a long row of equal, just touching beads without losses: profile, speed, width, energy, momentum | exact for the lattice, about 14 digits |
//! | [`long_wave`] | the same wave with the beads smeared out (Nesterenko) | asymptotic for waves much longer than a bead; Hertz waves are five beads long, the speed is off by 1 % |
//! | [`linear`] | sound speed, cutoff, band gap, normal modes of a preloaded row | exact for motions much smaller than the static overlap |
//! | [`two_body`] | contact time, largest overlap and force, restitution of two bodies | elastic: closed form; viscoelastic: integration to 1e-13, and a series for weak losses |
//! | [`striker`] | speed, force and momentum of the leading pulse after an impact | exact once its energy share is given, by the equations of motion |
//!
//! What none of this knows: losses along the chain, preload below a large pulse
//! (except [`long_wave::preloaded_speed_beads_s`], asymptotic), beads that
//! differ, ends, the first few beads behind the striker where the pulse forms.
//! A pulse in a real row approaches the solitary wave within about ten beads; how
//! closely is for a simulation to say.
//!
//! Three exact statements make good tests of a simulation: the scaling
//! c ∝ v_m^{(n−1)/(n+1)}, the mean kinetic share (n+1)/(n+3) of a solitary wave's energy
//! ([`solitary::kinetic_share_by_virial`]), and the shift of each bead by the
//! wave's momentum over m c ([`solitary::SolitaryWave::shift_m`]).
//!
//! ```
//! use hertzchain_chain::ChainError;
//! use hertzchain_chain::theory::solitary::{SolitaryShape, SolitaryWave};
//!
//! # fn main() -> Result<(), ChainError> {
//! let shape = SolitaryShape::hertz()?;
//! let (stiffness, mass_kg, peak_bead_speed_m_s) = (8.79e9, 8.54e-3, 0.68);
//! let wave = SolitaryWave::from_peak_bead_speed(&shape, stiffness, mass_kg, peak_bead_speed_m_s)?;
//! let over_33_beads_s = wave.time_of_flight_s(33.0);
//! assert!((over_33_beads_s - 615.41e-6).abs() < 0.01e-6);
//! # Ok(())
//! # }
//! ```

pub mod linear;
pub mod long_wave;
pub mod solitary;
pub mod striker;
pub mod two_body;

use crate::chain::ChainError;

fn require_positive(quantity: &str, value: f64) -> Result<(), ChainError> {
    match value > 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(out_of_range(quantity, value, "positive and finite")),
    }
}

fn out_of_range(quantity: &str, value: f64, expected: &'static str) -> ChainError {
    ChainError::Value { what: quantity.to_owned(), value, expected }
}

fn not_converged(computation: &str, error: f64) -> ChainError {
    ChainError::NotConverged(format!("{computation} did not converge: {error:e} left"))
}
