//! Long-wave (continuum) theory of the solitary wave, for comparison with the
//! exact lattice wave of [`super::solitary`].
//!
//! Both forms expand the lattice in gradients although the wave is only about
//! five beads long, so their numbers are asymptotic at best: for Hertz the
//! speed at a given overlap is 1.2 % low ([`LongWaveForm::Displacement`]) or
//! 0.8 % high ([`LongWaveForm::Strain`]). The profiles end at a finite
//! distance where the exact wave has a double-exponential tail.

use std::f64::consts::PI;

/// Which quantity the gradient expansion is made in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LongWaveForm {
    /// Nesterenko's: in the displacement, strain ξ = −u′ \[Nesterenko1983\].
    /// m V² ξ²/2 = k (ξⁿ⁺¹/(n+1) + (n/24) ξⁿ⁻¹ ξ′²).
    Displacement,
    /// In the overlap itself \[AhnertPikovsky2009\]:
    /// m V² δ = k (δⁿ + (δⁿ)″/12).
    Strain,
}

/// The long-wave solitary wave of a touching chain with force law F = k δⁿ, n > 1:
/// δ(x) = δ_m cos^{2/(n−1)}(κ x) on |κ x| < π/2, x in beads; cos⁴ for Hertz.
///
/// Plain arithmetic on its arguments: nonsense in, NaN out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LongWave {
    /// Which expansion.
    pub form: LongWaveForm,
    /// Force exponent n.
    pub exponent: f64,
}

impl LongWave {
    /// Nesterenko's theory for Hertz contacts.
    pub const HERTZ: Self = Self { form: LongWaveForm::Displacement, exponent: 1.5 };

    /// m V² / (k δ_mⁿ⁻¹): 2/(n+1), or (n+1)/(2n) in the strain form.
    pub fn speed_squared(&self) -> f64 {
        let n = self.exponent;
        match self.form {
            LongWaveForm::Displacement => 2.0 / (n + 1.0),
            LongWaveForm::Strain => (n + 1.0) / (2.0 * n),
        }
    }

    /// Speed V = √(s k δ_mⁿ⁻¹ / m) in beads per second, s of [`LongWave::speed_squared`];
    /// Hertz, Nesterenko: 0.894427 (K/m)^{1/2} δ_m^{1/4}.
    pub fn speed_beads_s(&self, stiffness: f64, mass_kg: f64, peak_overlap_m: f64) -> f64 {
        let stiffening = stiffness * peak_overlap_m.powf(self.exponent - 1.0);
        (self.speed_squared() * stiffening / mass_kg).sqrt()
    }

    /// Speed in beads per second from the largest bead speed v_m, with the
    /// long-wave relation v_m = V δ_m; Hertz, Nesterenko:
    /// (16/25)^{1/5} (K/m)^{2/5} v_m^{1/5}.
    pub fn speed_from_bead_speed_beads_s(
        &self,
        stiffness: f64,
        mass_kg: f64,
        peak_bead_speed_m_s: f64,
    ) -> f64 {
        let n = self.exponent;
        let scale = self.speed_squared() * stiffness / mass_kg;
        (scale * peak_bead_speed_m_s.powf(n - 1.0)).powf(1.0 / (n + 1.0))
    }

    /// Wave number κ of the profile, radians per bead: (n−1) √(6/(n(n+1))), or
    /// √3 (n−1)/n in the strain form.
    pub(crate) fn wavenumber_per_bead(&self) -> f64 {
        let n = self.exponent;
        match self.form {
            LongWaveForm::Displacement => (n - 1.0) * (6.0 / (n * (n + 1.0))).sqrt(),
            LongWaveForm::Strain => 3f64.sqrt() * (n - 1.0) / n,
        }
    }

    /// Full length π/κ of the wave, beads; Hertz, Nesterenko: 4.97.
    pub fn length_beads(&self) -> f64 {
        PI / self.wavenumber_per_bead()
    }

    /// Overlap in units of its peak at `x` beads from the centre.
    pub fn overlap(&self, x: f64) -> f64 {
        let phase = self.wavenumber_per_bead() * x;
        if phase.abs() >= 0.5 * PI {
            return 0.0;
        }
        phase.cos().powf(2.0 / (self.exponent - 1.0))
    }

    /// Contact force in units of its peak at `x` beads from the centre.
    pub fn force(&self, x: f64) -> f64 {
        self.overlap(x).powf(self.exponent)
    }

    /// Full width at half maximum of the contact force, beads.
    pub fn force_width_beads(&self) -> f64 {
        let n = self.exponent;
        let cosine = 0.5f64.powf((n - 1.0) / (2.0 * n));
        2.0 * cosine.acos() / self.wavenumber_per_bead()
    }
}

/// Speed in beads per second of Nesterenko's solitary wave on a preloaded chain
/// with static overlap δ0 and peak overlap δ_m > δ0 \[Nesterenko1983\]:
///
/// > V² = (2 k / (m (n+1))) (δ_mⁿ⁺¹ − (n+1) δ_m δ0ⁿ + n δ0ⁿ⁺¹) / (δ_m − δ0)².
///
/// Tends to the sound speed √(n k δ0ⁿ⁻¹/m) for δ_m → δ0 (where the quotient
/// loses digits: below a relative excess of 1e-4 the limit is used to first order)
/// and to [`LongWave::speed_beads_s`] for δ0 → 0.
pub fn preloaded_speed_beads_s(
    exponent: f64,
    stiffness: f64,
    mass_kg: f64,
    static_overlap_m: f64,
    peak_overlap_m: f64,
) -> f64 {
    let n = exponent;
    let (rest, peak) = (static_overlap_m, peak_overlap_m);
    let excess = peak / rest - 1.0;
    let quotient = if excess.abs() < 1e-4 {
        // Taylor: n(n+1)/2 (1 + (n−1) excess/3 + …) in units of δ0ⁿ⁻¹.
        0.5 * n * (n + 1.0) * rest.powf(n - 1.0) * (1.0 + (n - 1.0) * excess / 3.0)
    } else {
        let work = peak.powf(n + 1.0) - (n + 1.0) * peak * rest.powf(n) + n * rest.powf(n + 1.0);
        work / (peak - rest).powi(2)
    };
    (2.0 * stiffness / (mass_kg * (n + 1.0)) * quotient).sqrt()
}
