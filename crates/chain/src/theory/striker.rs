//! What the conservation laws say of a striker and the pulse it sends.
//!
//! How the energy of an impact is shared among the pulses follows from the
//! equations of motion only: nothing here predicts the share. Given it, the
//! exact solitary wave fixes everything else about the leading pulse.

use crate::chain::ChainError;
use crate::theory::solitary::{SolitaryShape, SolitaryWave};

/// The leading pulse of a just touching chain hit by a striker, in units of
/// the striker (mass M, speed v0) and the chain (stiffness k, bead mass m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadingPulse {
    /// Largest bead speed, units of v0.
    pub bead_speed: f64,
    /// Speed in beads per (m/k)^{1/(n+1)} v0^{−(n−1)/(n+1)}.
    pub speed: f64,
    /// Peak contact force, units of k^{1/(n+1)} m^{n/(n+1)} v0^{2n/(n+1)}.
    pub peak_force: f64,
    /// Momentum, units of the striker's M v0.
    pub momentum_share: f64,
}

impl LeadingPulse {
    /// The solitary wave that carries `energy_share` of the energy of a striker
    /// of `mass_ratio` M/m \[Job2007\].
    ///
    /// For an equal striker the momentum share exceeds 1 whenever the energy
    /// share exceeds 1/effective mass: the rest of the chain and the striker then
    /// carry negative momentum, the striker bounces and the first contacts open
    /// \[HinchSaintJean1999\].
    ///
    /// # Errors
    /// [`ChainError::Value`] unless both are positive and finite.
    pub fn from_energy_share(
        shape: &SolitaryShape,
        mass_ratio: f64,
        energy_share: f64,
    ) -> Result<Self, ChainError> {
        let energy = 0.5 * mass_ratio * energy_share;
        let wave = SolitaryWave::from_energy(shape, 1.0, 1.0, energy)?;
        Ok(Self {
            bead_speed: wave.peak_bead_speed_m_s(),
            speed: wave.speed_beads_s(),
            peak_force: wave.peak_force_n(),
            momentum_share: wave.momentum_kg_m_s() / mass_ratio,
        })
    }
}

/// Least number of solitary waves that can carry both the energy and the momentum
/// of a striker of `mass_ratio` M/m that ends at rest, everything else at rest too.
///
/// N waves with energy shares e_i have Σ e_i = 1 and Σ √e_i = √(M / (μ m)), μ the effective
/// mass of a wave; the sum of roots is at most √N, so
/// N ≥ M/(μ m). A lower bound from conservation alone, no prediction of the
/// train: below one, a single wave has momentum to spare and the striker bounces.
pub fn least_waves(shape: &SolitaryShape, mass_ratio: f64) -> f64 {
    mass_ratio / shape.effective_mass()
}
