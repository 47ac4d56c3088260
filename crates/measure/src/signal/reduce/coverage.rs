//! Whether stated errors are as large as errors are.

/// How many of many intervals held the true value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Intervals that did.
    pub inside: usize,
    /// All intervals.
    pub count: usize,
    /// Their quotient.
    pub share: f64,
    /// What normal errors of the stated size give: erf(factor/√2).
    pub expected: f64,
    /// Standard deviation of the share by chance, √(expected (1 − expected)/count).
    pub chance: f64,
    /// Root mean square of error over stated σ: 1 if the σ are right.
    pub scale: f64,
}

/// Coverage of intervals ± `factor` σ, from pulls (measured − true)/σ.
///
/// A pull that is not a number is an interval that held nothing. `None`
/// without pulls.
#[must_use]
pub fn coverage(pulls: &[f64], factor: f64) -> Option<Coverage> {
    let count = pulls.len();
    let inside = pulls.iter().filter(|pull| pull.abs() <= factor).count();
    let expected = libm::erf(factor / std::f64::consts::SQRT_2);
    let n = count as f64;
    let squares: f64 = pulls.iter().map(|pull| pull * pull).sum();
    (count > 0).then(|| Coverage {
        inside,
        count,
        share: inside as f64 / n,
        expected,
        chance: (expected * (1.0 - expected) / n).sqrt(),
        scale: (squares / n).sqrt(),
    })
}
