//! Slopes of a curve from its own points.
//!
//! A speed's error moves what is predicted by the curve's slope. Curves are
//! close to power laws, so a parabola in the logarithms through neighbouring
//! speeds determines their slope well enough for a standard error, and costs no shot.

/// Speeds that differ by less determine the solver's noise rather than a slope.
const LEAST_STEP: f64 = 0.01;

/// Speeds whose logarithms make a parabola, and weights of its slope at the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stencil {
    at: [usize; 3],
    weights: [f64; 3],
}

impl Stencil {
    /// For the `row`th of some rising speeds; `None` without two others apart from it.
    pub(super) fn new(speeds: &[f64], row: usize) -> Option<Self> {
        let x: Vec<f64> = speeds.iter().map(|speed| speed.ln()).collect();
        let apart = |one: usize, two: usize| (x[one] - x[two]).abs() >= LEAST_STEP;
        let below = (0..row).rev().find(|&other| apart(row, other));
        let above = (row + 1..x.len()).find(|&other| apart(row, other));
        let (one, two) = match (below, above) {
            (Some(below), Some(above)) => (below, above),
            (Some(below), None) => (below, (0..below).rev().find(|&other| apart(below, other))?),
            (None, Some(above)) => (above, (above + 1..x.len()).find(|&o| apart(above, o))?),
            (None, None) => return None,
        };
        Some(Self::through([row, one, two], [one, two].map(|other| x[other] - x[row])))
    }

    /// For a speed between two others, a relative `aside` off; `first` is the lower one's place.
    pub(super) fn around(aside: f64, first: usize) -> Self {
        let steps = [(1.0 - aside).ln(), (1.0 + aside).ln()];
        Self::through([first + 1, first, first + 2], steps)
    }

    /// Slope at the first place of Lagrange's parabola through it and two others.
    fn through(at: [usize; 3], [h1, h2]: [f64; 2]) -> Self {
        Self {
            at,
            weights: [-(h1 + h2) / (h1 * h2), -h2 / (h1 * (h1 - h2)), h1 / (h2 * (h1 - h2))],
        }
    }

    /// The place of its own speed.
    pub(super) fn own(&self) -> usize {
        self.at[0]
    }

    /// d ln y/d ln v of positive values at all speeds.
    pub(super) fn slope(&self, value: impl Fn(usize) -> Option<f64>) -> Option<f64> {
        let terms = self.at.iter().zip(self.weights);
        terms.map(|(&at, weight)| Some(weight * value(at)?.ln())).sum()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/stencil.rs"]
mod tests;
