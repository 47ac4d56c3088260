//! Filters of a record: inverse high-pass, zero-phase low-pass, running means, amplifier's low-pass.

use crate::error::{MeasureError, Result, all_finite};
use std::f64::consts::{PI, SQRT_2, TAU};
use std::fmt::{self, Display, Formatter};

/// Corrects a record for AC coupling: the exact inverse of a first-order high-pass
/// τ y' + y = τ x' from rest by the trapezoidal rule,
/// x_n = y_n + (1/τ) · (trapezoidal integral of y up to n).
///
/// A high-pass moves the maximum of a pulse of height h and second derivative x'' < 0 by h/(τ x''),
/// earlier. Take the offset away first: the inverse makes a ramp of it, offset/τ a second. White
/// noise of deviation σ gains a random walk of deviation σ √n · interval/τ after n samples.
///
/// # Errors
/// Interval or time constant not positive; samples not finite.
pub(crate) fn invert_high_pass(
    samples: &mut [f64],
    interval_s: f64,
    time_constant_s: f64,
) -> Result<()> {
    MeasureError::positive("sampling interval in s", interval_s)?;
    MeasureError::positive("time constant of the high-pass in s", time_constant_s)?;
    all_finite(samples)?;
    let k = 0.5 * interval_s / time_constant_s;
    let (mut integral, mut before) = (0.0, 0.0);
    for sample in samples {
        let y = *sample;
        integral += k * (y + before);
        *sample = y + integral;
        before = y;
    }
    Ok(())
}

/// A Butterworth low-pass run forward and backward, without delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass {
    /// Frequency at which one run has lost 3 dB; both together lose 6 dB there.
    pub cutoff_hz: f64,
    /// Order of one run: 2 or 4.
    pub order: usize,
}

/// A second-order section with gain 1 at rest, transposed direct form II.
struct Biquad {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Returns the filtered samples, as many as were given.
    ///
    /// Sections by the bilinear transform with prewarped frequency run forward, then backward, over
    /// samples that are continued beyond either end by 3 (order + 1) samples turned about the end
    /// one. Noise is correlated afterwards.
    ///
    /// # Errors
    /// Order not 2 or 4; cutoff not between 0 and half the sampling rate; too few or not finite
    /// samples.
    pub(crate) fn apply(&self, samples: &[f64], interval_s: f64) -> Result<Vec<f64>> {
        let sections = self.sections(interval_s)?;
        let edge = 3 * (self.order + 1);
        MeasureError::enough(samples.len(), edge + 1)?;
        all_finite(samples)?;
        let n = samples.len();
        let turned = |end: f64, at: usize| 2.0 * end - samples[at];
        let before = (0..edge).map(|i| turned(samples[0], edge - i));
        let after = (0..edge).map(|i| turned(samples[n - 1], n - 2 - i));
        let all = before.chain(samples.iter().copied()).chain(after);
        let mut all: Vec<f64> = all.collect();
        for _direction in 0..2 {
            for section in &sections {
                section.run(&mut all);
            }
            all.reverse();
        }
        all.truncate(edge + n);
        all.drain(..edge);
        Ok(all)
    }

    fn sections(&self, interval_s: f64) -> Result<Vec<Biquad>> {
        MeasureError::positive("sampling interval in s", interval_s)?;
        let turns = self.cutoff_hz * interval_s;
        let expected = "a number between 0 and half the sampling rate";
        let accepted = turns > 0.0 && turns < 0.5;
        MeasureError::require(accepted, "cutoff of the low-pass in Hz", self.cutoff_hz, expected)?;
        let order = self.order as f64;
        let accepted = self.order == 2 || self.order == 4;
        MeasureError::require(accepted, "order of the low-pass", order, "2 or 4")?;
        let angle = |i: usize| PI * (2 * i + 1) as f64 / (2.0 * order);
        let pairs = 0..self.order / 2;
        Ok(pairs.map(|i| Biquad::new(turns, angle(i).sin())).collect())
    }
}

impl Biquad {
    /// Poles at `damping` = −cos of their angle on the unit circle of the analogue filter.
    fn new(turns: f64, damping: f64) -> Self {
        let k = (PI * turns).tan();
        let norm = (1.0 + 2.0 * damping * k + k * k).recip();
        let b0 = k * k * norm;
        let a2 = (1.0 - 2.0 * damping * k + k * k) * norm;
        Self { b: [b0, 2.0 * b0, b0], a: [2.0 * (k * k - 1.0) * norm, a2] }
    }

    /// Filters in place, as if the first sample had lasted for ever before.
    fn run(&self, samples: &mut [f64]) {
        let first = samples.first().copied().unwrap_or(0.0);
        let mut z1 = first * (1.0 - self.b[0]);
        let mut z2 = first * (self.b[2] - self.a[1]);
        for sample in samples {
            let x = *sample;
            let y = self.b[0] * x + z1;
            z1 = self.b[1] * x - self.a[0] * y + z2;
            z2 = self.b[2] * x - self.a[1] * y;
            *sample = y;
        }
    }
}

/// Centred running means over an odd number of samples; over fewer near the ends.
fn running_mean(values: &[f64], length: usize) -> Vec<f64> {
    if length < 2 {
        return values.to_vec();
    }
    let half = length / 2;
    let (mut sums, mut sum) = (Vec::with_capacity(values.len() + 1), 0.0);
    sums.push(sum);
    for value in values {
        sum += value;
        sums.push(sum);
    }
    let mean = |i: usize| {
        let (from, to) = (i.saturating_sub(half), (i + half + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Two running means, one after the other: triangular weights.
pub(crate) fn triangular_mean(values: &[f64], length: usize) -> Vec<f64> {
    running_mean(&running_mean(values, length), length)
}

/// An amplifier's low-pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandwidth {
    /// Its corner in Hz, where 3 dB are missing.
    pub corner_hz: f64,
    /// Number of poles, 1 to 4; 0 for that and the kind which a recording states, else one pole.
    pub order: usize,
    /// Whether it is Bessel's rather than Butterworth's.
    pub bessel: bool,
}

impl Display for Bandwidth {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let kind = match (self.order, self.bessel) {
            (..2, _) => "",
            (_, true) => " (Bessel)",
            (_, false) => " (Butterworth)",
        };
        write!(f, "low-pass of {} Hz, order {}{kind}", self.corner_hz, self.order)
    }
}

/// Longest [`Bandwidth::inverse`].
pub(crate) const MOST_POLES: usize = 4;

/// Widths at half maximum of the shortest pulses that low-passes leave, times the corner: of one
/// pole's response to an impulse, and of the narrowest with more poles, near a Gaussian.
const SHORTEST: [f64; 2] = [0.11, 0.3];

impl Bandwidth {
    /// Coefficients of the inverse x = y + a₁ y′ + a₂ y″ + …, in samples, for a record whose widest
    /// pulse is so many samples wide.
    pub(crate) fn inverse(&self, interval_s: f64, widest: f64) -> Result<[f64; MOST_POLES]> {
        MeasureError::positive("corner of the amplifier's low-pass in Hz", self.corner_hz)?;
        let name = "order of the amplifier's low-pass";
        let accepted = self.order <= MOST_POLES;
        MeasureError::require(accepted, name, self.order as f64, "1 to 4")?;
        let least_hz = SHORTEST[usize::from(self.order > 1)] / (widest * interval_s);
        if self.corner_hz < least_hz {
            return Err(MeasureError::LowCorner(self.corner_hz, least_hz));
        }
        let samples = (TAU * self.corner_hz * interval_s).recip();
        let coefficients = self.denominator();
        Ok(std::array::from_fn(|k| coefficients[k] * samples.powi(k as i32 + 1)))
    }

    /// Coefficients of s, s² and so on of 1/H, s over 2π times the corner: of Butterworth's and of the
    /// reverse Bessel polynomials, these over the frequency of half power.
    fn denominator(&self) -> [f64; MOST_POLES] {
        // 1/sin(π/8), and 2 + √2.
        const SUM: f64 = 2.613_125_929_752_753;
        const MIDDLE: f64 = 2.0 + SQRT_2;
        match (self.order, self.bessel) {
            (..2, _) => [1.0, 0.0, 0.0, 0.0],
            (2, false) => [SQRT_2, 1.0, 0.0, 0.0],
            (3, false) => [2.0, 2.0, 1.0, 0.0],
            (_, false) => [SUM, MIDDLE, SUM, 1.0],
            (2, true) => [1.361_654_128_716_130_3, 0.618_033_988_749_894_7, 0.0, 0.0],
            (3, true) => [1.755_672_368_681_21, 1.232_954_186_460_276, 0.360_777_266_169_688, 0.0],
            (_, true) => [
                2.113_917_674_904_215,
                1.915_134_829_831_048,
                0.899_652_748_134_340,
                0.190_179_184_555_734,
            ],
        }
    }
}

#[cfg(test)]
#[path = "tests/running.rs"]
mod tests;
