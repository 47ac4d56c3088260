//! The elastic collision in closed form.

use std::f64::consts::PI;

use libm::tgamma;

/// Reduced mass m1 m2 / (m1 + m2), kg; an infinite mass is a wall.
pub fn reduced_mass_kg(first_kg: f64, second_kg: f64) -> f64 {
    1.0 / (1.0 / first_kg + 1.0 / second_kg)
}

/// Elastic collision of two bodies, m δ̈ = −k δⁿ, δ(0) = 0, δ̇(0) = v \[Hertz1881\].
///
/// Plain arithmetic on its fields: nonsense in, NaN out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticCollision {
    /// Force exponent n > −1; Hertz 3/2.
    pub exponent: f64,
    /// Contact stiffness k, N/mⁿ.
    pub stiffness: f64,
    /// Reduced mass, kg.
    pub reduced_mass_kg: f64,
    /// Relative speed at first touch, m/s.
    pub speed_m_s: f64,
}

impl ElasticCollision {
    /// Largest overlap δ_max = ((n+1) m v² / (2 k))^{1/(n+1)}, m: all kinetic
    /// energy of the relative motion is elastic.
    pub fn largest_overlap_m(&self) -> f64 {
        let n = self.exponent;
        let twice_energy = self.reduced_mass_kg * self.speed_m_s.powi(2);
        ((n + 1.0) * twice_energy / (2.0 * self.stiffness)).powf(1.0 / (n + 1.0))
    }

    /// Largest force k δ_maxⁿ, N.
    pub fn largest_force_n(&self) -> f64 {
        self.stiffness * self.largest_overlap_m().powf(self.exponent)
    }

    /// Contact time 2 (δ_max / v) ∫₀¹ dy / √(1 − yⁿ⁺¹), s, where the integral is
    /// √π Γ(1 + 1/(n+1)) / Γ(1/2 + 1/(n+1)); Hertz: 3.218 (m/K)^{2/5} v^{−1/5}.
    pub fn contact_time_s(&self) -> f64 {
        let inverse = 1.0 / (self.exponent + 1.0);
        let integral = PI.sqrt() * tgamma(1.0 + inverse) / tgamma(0.5 + inverse);
        2.0 * self.largest_overlap_m() / self.speed_m_s * integral
    }
}
