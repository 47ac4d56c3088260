//! The dimensionless shape of the exact lattice solitary wave.

use super::solver::{Solution, sinc, solve};
use crate::chain::ChainError;
use crate::theory::out_of_range;

/// Exponents for which the solver's window and spectrum stay small.
const EXPONENTS: std::ops::RangeInclusive<f64> = 1.02..=20.0;

/// Shape of the solitary wave of a touching chain with force law F = k δⁿ.
///
/// In units of the peak overlap δ_m, as a function of the distance x from the
/// wave's centre in beads, the overlap p(x) solves
///
/// > σ p(x) = ∫ Λ(x − y) p(y)ⁿ dy,  Λ(x) = max(1 − |x|, 0),  p(0) = 1,
///
/// which is the advance–delay equation m c² δ″ = F(x+1) − 2F(x) + F(x−1)
/// integrated twice, with σ = m c² / (k δ_mⁿ⁻¹) \[EnglishPego2005\].
/// Existence: \[FrieseckeWattis1994\]. The numbers are those of the lattice
/// itself, no long-wave expansion enters; computed to about 1e-14.
#[derive(Debug, Clone, PartialEq)]
pub struct SolitaryShape {
    exponent: f64,
    solved: Solution,
}

impl SolitaryShape {
    /// Solves for the shape at force exponent `exponent` (1.02 to 20; Hertz 3/2).
    ///
    /// # Errors
    /// [`ChainError::Value`] for other exponents,
    /// [`ChainError::NotConverged`] if rounding accuracy is not reached.
    pub fn new(exponent: f64) -> Result<Self, ChainError> {
        if !EXPONENTS.contains(&exponent) {
            let expected = "between 1.02 and 20";
            return Err(out_of_range("force exponent", exponent, expected));
        }
        let solved = solve(exponent)?;
        Ok(Self { exponent, solved })
    }

    /// The shape for Hertz contacts, n = 3/2.
    ///
    /// # Errors
    /// As [`SolitaryShape::new`]; none is known to happen.
    pub fn hertz() -> Result<Self, ChainError> {
        Self::new(1.5)
    }

    /// Force exponent n.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// σ = m c² / (k δ_mⁿ⁻¹): squared speed in units of the peak overlap.
    pub fn speed_squared(&self) -> f64 {
        self.solved.speed_squared
    }

    /// c / (k^{1/(2n)} m^{−1/2} F_m^{(n−1)/(2n)}) = √σ; Hertz: 0.9055 K^{1/3} m^{−1/2} F_m^{1/6}.
    pub fn speed_per_force_power(&self) -> f64 {
        self.solved.speed_squared.sqrt()
    }

    /// c / ((k/m)^{1/(n+1)} v_m^{(n−1)/(n+1)}); Hertz: 0.9075 (K/m)^{2/5} v_m^{1/5}.
    pub fn speed_per_velocity_power(&self) -> f64 {
        let n = self.exponent;
        let peak = self.velocity(0.0);
        (self.solved.speed_squared.powf(n) * peak.powf(1.0 - n)).powf(1.0 / (n + 1.0))
    }

    /// Mean share of the kinetic energy; the virial argument gives (n+1)/(n+3)
    /// exactly (see [`kinetic_share_by_virial`]), this is the quadrature of the profile.
    pub fn kinetic_share(&self) -> f64 {
        let kinetic = self.solved.velocity_square_area / (2.0 * self.solved.speed_squared);
        kinetic / (kinetic + self.solved.work_area / (self.exponent + 1.0))
    }

    /// Energy E / (k δ_mⁿ⁺¹), from the quadratures of both kinds of energy.
    pub fn energy(&self) -> f64 {
        self.solved.velocity_square_area / (2.0 * self.solved.speed_squared)
            + self.solved.work_area / (self.exponent + 1.0)
    }

    /// Momentum P / (m c δ_m) = ∫ p dx: also how far the passing wave shifts each bead, in units of δ_m.
    pub(crate) fn momentum(&self) -> f64 {
        self.solved.force_area / self.solved.speed_squared
    }

    /// Mass of the particle with the wave's energy and momentum,
    /// P² / (2 E m), in beads \[Job2007\].
    pub(crate) fn effective_mass(&self) -> f64 {
        self.solved.speed_squared * self.momentum().powi(2) / (2.0 * self.energy())
    }

    /// Overlap in units of δ_m at `x` beads from the centre.
    pub fn overlap(&self, x: f64) -> f64 {
        self.filtered_sum(x, 2) / self.solved.speed_squared
    }

    /// Contact force in units of F_m at `x` beads from the centre.
    pub fn force(&self, x: f64) -> f64 {
        self.filtered_sum(x, 0)
    }

    /// Bead velocity in units of F_m / (m c) at `x` beads from the centre:
    /// ∫_{x−1/2}^{x+1/2} pⁿ, from Newton's law for the bead between two contacts.
    pub fn velocity(&self, x: f64) -> f64 {
        self.filtered_sum(x, 1)
    }

    /// Mean of the two contact forces of a bead, in units of F_m, with the
    /// bead's centre at `x`: what a sensor inside a split bead feels. One hump
    /// for Hertz; from about n = 1.75 on the two contacts show as two humps.
    pub fn sensor(&self, x: f64) -> f64 {
        0.5 * (self.force(x - 0.5) + self.force(x + 0.5))
    }

    /// Largest value of [`Self::sensor`], by golden sections of the bead's own way: one hump is there.
    pub(crate) fn sensor_peak(&self) -> f64 {
        const SECTIONS: usize = 40;
        let share = 0.5 * (5f64.sqrt() - 1.0);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..SECTIONS {
            let reach = share * (high - low);
            match self.sensor(high - reach) < self.sensor(low + reach) {
                true => low = high - reach,
                false => high = low + reach,
            }
        }
        self.sensor(low).max(self.sensor(0.0))
    }

    /// Full width at half maximum of the contact force, beads.
    pub fn force_width_beads(&self) -> f64 {
        self.width(|x| self.force(x))
    }

    /// Full width at half maximum of the bead velocity, beads.
    pub fn velocity_width_beads(&self) -> f64 {
        self.width(|x| self.velocity(x))
    }

    /// Full width of a bead sensor's signal at half its central value, beads.
    pub fn sensor_width_beads(&self) -> f64 {
        self.width(|x| self.sensor(x))
    }

    /// Bisection for f(x) = f(0)/2: every profile falls from its centre outwards.
    fn width(&self, profile: impl Fn(f64) -> f64) -> f64 {
        let half = 0.5 * profile(0.0);
        let (mut inner, mut outer) = (0.0, self.solved.half_window);
        while outer - inner > 2.0 * f64::EPSILON * outer {
            let middle = 0.5 * (inner + outer);
            if profile(middle) > half {
                inner = middle;
            } else {
                outer = middle;
            }
        }
        inner + outer
    }

    /// The force's cosine series times sinc(k/2)^`times`: one factor averages
    /// over a bead, two make the double integral of the second difference.
    /// The series is good to 1e-16 of the peak; below that a tail may not turn negative.
    fn filtered_sum(&self, x: f64, times: i32) -> f64 {
        if x.abs() >= self.solved.half_window {
            return 0.0;
        }
        let step = std::f64::consts::PI / self.solved.half_window;
        let term = |(mode, a): (usize, &f64)| {
            let k = step * mode as f64;
            a * sinc(0.5 * k).powi(times) * (k * x).cos()
        };
        let sum: f64 = self.solved.force.iter().enumerate().map(term).sum();
        sum.max(0.0)
    }
}

/// Mean kinetic share (n+1)/(n+3) of the energy of any solitary wave of F = k δⁿ.
///
/// With V the bead velocity, m c V = ∫ F over one bead and m c² δ = Λ ∗ F, so
/// ∫ m V²/2 = ∫ F (Λ ∗ F) / (2 m c²) = ½ ∫ F δ, while the elastic part is
/// ∫ F δ / (n + 1). Hertz: 5/9.
pub fn kinetic_share_by_virial(exponent: f64) -> f64 {
    (exponent + 1.0) / (exponent + 3.0)
}
