//! A solitary wave with units.

use super::SolitaryShape;
use crate::chain::ChainError;
use crate::theory::require_positive;

/// The exact solitary wave of a row of equal, just touching beads.
///
/// Force law F = k δⁿ with `stiffness` k in N/mⁿ, bead mass m in kg. Positions
/// are in beads from the wave's centre, positive ahead of it; a contact and a
/// bead are each taken at their own place (a bead's contacts are half a bead
/// before and behind it). \[FrieseckeWattis1994\], \[EnglishPego2005\].
#[derive(Debug, Clone, PartialEq)]
pub struct SolitaryWave<'shape> {
    shape: &'shape SolitaryShape,
    stiffness: f64,
    mass_kg: f64,
    peak_overlap_m: f64,
}

impl<'shape> SolitaryWave<'shape> {
    /// The wave with peak overlap δ_m.
    ///
    /// # Errors
    /// [`ChainError::Value`] unless all three are positive and finite.
    pub fn from_peak_overlap(
        shape: &'shape SolitaryShape,
        stiffness: f64,
        mass_kg: f64,
        peak_overlap_m: f64,
    ) -> Result<Self, ChainError> {
        require_positive("contact stiffness", stiffness)?;
        require_positive("bead mass", mass_kg)?;
        require_positive("size of the solitary wave", peak_overlap_m)?;
        Ok(Self { shape, stiffness, mass_kg, peak_overlap_m })
    }

    /// The wave with peak contact force F_m = k δ_mⁿ in newton.
    ///
    /// # Errors
    /// As [`SolitaryWave::from_peak_overlap`].
    pub fn from_peak_force(
        shape: &'shape SolitaryShape,
        stiffness: f64,
        mass_kg: f64,
        peak_force_n: f64,
    ) -> Result<Self, ChainError> {
        let peak_overlap_m = (peak_force_n / stiffness).powf(1.0 / shape.exponent());
        Self::from_peak_overlap(shape, stiffness, mass_kg, peak_overlap_m)
    }

    /// The wave with speed c in beads per second: σ k δ_mⁿ⁻¹ = m c².
    ///
    /// # Errors
    /// As [`SolitaryWave::from_peak_overlap`].
    pub fn from_speed(
        shape: &'shape SolitaryShape,
        stiffness: f64,
        mass_kg: f64,
        speed_beads_s: f64,
    ) -> Result<Self, ChainError> {
        let power = mass_kg * speed_beads_s.powi(2) / (shape.speed_squared() * stiffness);
        let peak_overlap_m = power.powf(1.0 / (shape.exponent() - 1.0));
        Self::from_peak_overlap(shape, stiffness, mass_kg, peak_overlap_m)
    }

    /// The wave with largest bead speed v_m in m/s.
    ///
    /// # Errors
    /// As [`SolitaryWave::from_peak_overlap`].
    pub fn from_peak_bead_speed(
        shape: &'shape SolitaryShape,
        stiffness: f64,
        mass_kg: f64,
        peak_bead_speed_m_s: f64,
    ) -> Result<Self, ChainError> {
        let n = shape.exponent();
        let speed_beads_s = shape.speed_per_velocity_power()
            * (stiffness / mass_kg).powf(1.0 / (n + 1.0))
            * peak_bead_speed_m_s.powf((n - 1.0) / (n + 1.0));
        Self::from_speed(shape, stiffness, mass_kg, speed_beads_s)
    }

    /// The wave with total energy E in joule.
    ///
    /// # Errors
    /// As [`SolitaryWave::from_peak_overlap`].
    pub fn from_energy(
        shape: &'shape SolitaryShape,
        stiffness: f64,
        mass_kg: f64,
        energy_j: f64,
    ) -> Result<Self, ChainError> {
        let power = energy_j / (stiffness * shape.energy());
        let peak_overlap_m = power.powf(1.0 / (shape.exponent() + 1.0));
        Self::from_peak_overlap(shape, stiffness, mass_kg, peak_overlap_m)
    }

    /// Speed c = √(σ k δ_mⁿ⁻¹ / m), beads per second.
    pub fn speed_beads_s(&self) -> f64 {
        let n = self.shape.exponent();
        let stiffening = self.stiffness * self.peak_overlap_m.powf(n - 1.0);
        (self.shape.speed_squared() * stiffening / self.mass_kg).sqrt()
    }

    /// Peak overlap δ_m, m.
    pub fn peak_overlap_m(&self) -> f64 {
        self.peak_overlap_m
    }

    /// Peak contact force F_m = k δ_mⁿ, N.
    pub fn peak_force_n(&self) -> f64 {
        self.stiffness * self.peak_overlap_m.powf(self.shape.exponent())
    }

    /// Peak of a bead sensor's signal, N.
    pub fn peak_sensor_force_n(&self) -> f64 {
        self.peak_force_n() * self.shape.sensor_peak()
    }

    /// Largest bead speed v_m, m/s.
    pub fn peak_bead_speed_m_s(&self) -> f64 {
        self.bead_speed_m_s(0.0)
    }

    /// Energy, J: the same at every instant.
    pub fn energy_j(&self) -> f64 {
        let scale = self.stiffness * self.peak_overlap_m.powf(self.shape.exponent() + 1.0);
        scale * self.shape.energy()
    }

    /// Momentum, kg m/s: the same at every instant.
    pub fn momentum_kg_m_s(&self) -> f64 {
        self.mass_kg * self.speed_beads_s() * self.shift_m()
    }

    /// How far each bead has moved once the wave has passed, m.
    pub fn shift_m(&self) -> f64 {
        self.peak_overlap_m * self.shape.momentum()
    }

    /// Overlap of a contact at `position_beads` from the centre, m.
    pub fn overlap_m(&self, position_beads: f64) -> f64 {
        self.peak_overlap_m * self.shape.overlap(position_beads)
    }

    /// Force of a contact at `position_beads` from the centre, N.
    pub fn force_n(&self, position_beads: f64) -> f64 {
        self.peak_force_n() * self.shape.force(position_beads)
    }

    /// Velocity of a bead whose centre is at `position_beads`, m/s.
    pub fn bead_speed_m_s(&self, position_beads: f64) -> f64 {
        let scale = self.peak_force_n() / (self.mass_kg * self.speed_beads_s());
        scale * self.shape.velocity(position_beads)
    }

    /// Full width at half maximum of a contact's force in time, s.
    pub fn force_width_s(&self) -> f64 {
        self.shape.force_width_beads() / self.speed_beads_s()
    }

    /// Time the wave takes over `distance_beads`, s.
    pub fn time_of_flight_s(&self, distance_beads: f64) -> f64 {
        distance_beads / self.speed_beads_s()
    }
}
