//! The chain of two alternating beads and two alternating contacts.

use std::f64::consts::PI;

/// Diatomic chain: m1 –κ1– m2 –κ2– m1 …; waves obey, with q the phase per cell,
///
/// > m1 m2 ω⁴ − (κ1 + κ2)(m1 + m2) ω² + 4 κ1 κ2 sin²(q/2) = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimer {
    /// Masses of the two beads of a cell, kg.
    pub masses_kg: [f64; 2],
    /// Stiffness of the contacts within and between cells, N/m.
    pub contact_stiffnesses_n_m: [f64; 2],
}

/// Edges of the two bands, Hz. Waves pass from 0 to `acoustic_top_hz` and from
/// `optical_bottom_hz` to `optical_top_hz`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandEdges {
    /// Upper edge of the acoustic band (q = π).
    pub acoustic_top_hz: f64,
    /// Lower edge of the optical band (q = π).
    pub optical_bottom_hz: f64,
    /// Upper edge of the optical band, the cutoff (q = 0).
    pub optical_top_hz: f64,
}

impl Dimer {
    /// Angular frequencies of the acoustic and the optical branch at a phase of
    /// `wavenumber_per_cell` per cell, rad/s.
    pub fn branches_rad_s(&self, wavenumber_per_cell: f64) -> (f64, f64) {
        let [m1, m2] = self.masses_kg;
        let [k1, k2] = self.contact_stiffnesses_n_m;
        let half_sum = 0.5 * (k1 + k2) * (m1 + m2) / (m1 * m2);
        let product = 4.0 * k1 * k2 * (0.5 * wavenumber_per_cell).sin().powi(2) / (m1 * m2);
        let optical = half_sum + (half_sum * half_sum - product).max(0.0).sqrt();
        // Not the difference: it would cancel for long acoustic waves.
        ((product / optical).sqrt(), optical.sqrt())
    }

    /// Edges of the bands; the gap closes when both pairs are equal.
    pub fn band_edges(&self) -> BandEdges {
        let (acoustic, bottom) = self.branches_rad_s(PI);
        let (_, top) = self.branches_rad_s(0.0);
        BandEdges {
            acoustic_top_hz: acoustic / (2.0 * PI),
            optical_bottom_hz: bottom / (2.0 * PI),
            optical_top_hz: top / (2.0 * PI),
        }
    }

    /// Speed √(κ1 κ2 / ((κ1 + κ2)(m1 + m2))) of long waves, cells (of two beads) per second.
    pub fn sound_speed_cells_s(&self) -> f64 {
        let [m1, m2] = self.masses_kg;
        let [k1, k2] = self.contact_stiffnesses_n_m;
        (k1 * k2 / ((k1 + k2) * (m1 + m2))).sqrt()
    }
}
