//! The uniform preloaded chain in closed form.

use std::f64::consts::PI;

use super::Ends;

/// Stiffness dF/dδ = n k^{1/n} F0^{(n−1)/n} of a contact F = k δⁿ under the static
/// force F0, N/m; Hertz: (3/2) K^{2/3} F0^{1/3} \[CosteGilles1999\].
pub fn contact_stiffness_n_m(exponent: f64, stiffness: f64, static_force_n: f64) -> f64 {
    let n = exponent;
    n * stiffness.powf(1.0 / n) * static_force_n.powf((n - 1.0) / n)
}

/// Equal beads with equal linear contacts: ω(q) = 2 √(κ/m) |sin(q/2)|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformChain {
    /// Bead mass m, kg.
    pub mass_kg: f64,
    /// Contact stiffness κ at the preload, N/m.
    pub contact_stiffness_n_m: f64,
}

impl UniformChain {
    /// Speed √(κ/m) of long waves, beads per second.
    pub fn sound_speed_beads_s(&self) -> f64 {
        (self.contact_stiffness_n_m / self.mass_kg).sqrt()
    }

    /// Angular frequency at wave number q, rad/s.
    pub fn angular_frequency_rad_s(&self, wavenumber_per_bead: f64) -> f64 {
        2.0 * self.sound_speed_beads_s() * (0.5 * wavenumber_per_bead).sin().abs()
    }

    /// Group speed dω/dq for 0 ≤ q ≤ π, beads per second.
    pub fn group_speed_beads_s(&self, wavenumber_per_bead: f64) -> f64 {
        self.sound_speed_beads_s() * (0.5 * wavenumber_per_bead).cos()
    }

    /// Cutoff √(κ/m)/π in hertz: no wave passes above it.
    pub fn cutoff_frequency_hz(&self) -> f64 {
        self.sound_speed_beads_s() / PI
    }

    /// Decay of an evanescent wave above the cutoff, per bead:
    /// amplitude e^{−γ} with cosh(γ/2) = ω/ω_cutoff; 0 below it.
    pub fn decay_per_bead(&self, frequency_hz: f64) -> f64 {
        2.0 * (frequency_hz / self.cutoff_frequency_hz()).max(1.0).acosh()
    }

    /// Angular frequency of normal mode `index` (0 lowest) of `beads` beads, rad/s:
    /// the dispersion relation at the wave number that fits the ends.
    pub fn mode_angular_frequency_rad_s(&self, beads: usize, ends: Ends, index: usize) -> f64 {
        let (n, j) = (beads as f64, index as f64);
        let wavenumber = match ends {
            Ends::FreeFree => PI * j / n,
            Ends::FreeFixed | Ends::FixedFree => PI * (2.0 * j + 1.0) / (2.0 * n + 1.0),
            Ends::FixedFixed => PI * (j + 1.0) / (n + 1.0),
            // Every wave number but 0 (and π) comes twice.
            Ends::Periodic => 2.0 * PI * index.div_ceil(2) as f64 / n,
        };
        self.angular_frequency_rad_s(wavenumber)
    }
}
