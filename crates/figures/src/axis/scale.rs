//! Data range and its mapping to the unit interval.

/// The finite values seen along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    lo: f64,
    hi: f64,
    log: bool,
}

/// Values beyond are treated as out of any picture; differences stay finite.
const LARGEST: f64 = 1e300;
/// Values below are zero: they have no power of ten that is itself a number.
const SMALLEST: f64 = 1e-290;

impl Extent {
    pub(crate) fn new(log: bool) -> Self {
        Self { lo: f64::INFINITY, hi: f64::NEG_INFINITY, log }
    }

    /// Takes in a value unless the axis cannot show it.
    fn add(&mut self, value: f64) {
        let value = if value.abs() < SMALLEST { 0.0 } else { value };
        let shown = value.is_finite() && value.abs() <= LARGEST && (!self.log || value >= SMALLEST);
        if shown {
            self.lo = self.lo.min(value);
            self.hi = self.hi.max(value);
        }
    }

    pub(crate) fn extend(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.add(value));
    }

    /// The lowest and highest value, if any.
    pub(crate) fn ends(&self) -> Option<(f64, f64)> {
        (self.lo <= self.hi).then_some((self.lo, self.hi))
    }

    /// A scale that holds all values with `pad` of the length free at both ends.
    pub(crate) fn scale(self, pad: f64) -> Scale {
        let Self { lo, hi, log } = self;
        if lo > hi {
            let (lo, hi) = if log { (0.1, 10.0) } else { (0.0, 1.0) };
            return Scale { lo, hi, log };
        }
        if log { padded_log(lo, hi, pad) } else { padded_linear(lo, hi, pad) }
    }
}

fn padded_linear(lo: f64, hi: f64, pad: f64) -> Scale {
    let magnitude = lo.abs().max(hi.abs());
    let span = hi - lo;
    // Spans below the resolution of a label are noise around a constant.
    let (lo, hi) = if magnitude == 0.0 {
        (-1.0, 1.0)
    } else if span <= 1e-8 * magnitude {
        (lo - 0.05 * magnitude, hi + 0.05 * magnitude)
    } else {
        (lo - pad * span, hi + pad * span)
    };
    Scale { lo, hi, log: false }
}

fn padded_log(lo: f64, hi: f64, pad: f64) -> Scale {
    let span = hi.ln() - lo.ln();
    let ratio = if span < 1e-6 { 1.1 } else { (pad * span).exp() };
    Scale { lo: (lo / ratio).max(0.1 * SMALLEST), hi: (hi * ratio).min(10.0 * LARGEST), log: true }
}

/// A linear or logarithmic map of `[lo, hi]` to the unit interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    pub(crate) log: bool,
}

impl Scale {
    /// A scale with the limits asked for, if they make one.
    pub(crate) fn fixed(lo: f64, hi: f64, log: bool) -> Option<Self> {
        let finite = lo.is_finite() && hi.is_finite() && lo.abs().max(hi.abs()) <= LARGEST;
        let wide_enough = (hi - lo).abs() > SMALLEST + 1e-8 * lo.abs().max(hi.abs());
        let sound = finite && wide_enough && (!log || lo.min(hi) >= SMALLEST);
        sound.then_some(Self { lo: lo.min(hi), hi: lo.max(hi), log })
    }

    /// Position of a value, 0 at `lo` and 1 at `hi`; nothing if it has none.
    pub(crate) fn share(&self, value: f64) -> Option<f64> {
        if !value.is_finite() || (self.log && value <= 0.0) {
            return None;
        }
        let share = if self.log {
            (value.ln() - self.lo.ln()) / (self.hi.ln() - self.lo.ln())
        } else {
            (value - self.lo) / (self.hi - self.lo)
        };
        // Far outside the frame the exact place no longer matters.
        (!share.is_nan()).then(|| share.clamp(-1e6, 1e6))
    }

    /// The value at a share of the axis, the inverse of [`Scale::share`].
    pub(crate) fn value(&self, share: f64) -> f64 {
        if self.log {
            (self.lo.ln() + share * (self.hi.ln() - self.lo.ln())).exp()
        } else {
            self.lo + share * (self.hi - self.lo)
        }
    }

    pub(crate) fn decades(&self) -> f64 {
        self.hi.log10() - self.lo.log10()
    }

    pub(crate) fn holds(&self, value: f64) -> bool {
        self.share(value).is_some_and(|s| (-1e-9..=1.0 + 1e-9).contains(&s))
    }
}

#[cfg(test)]
#[path = "tests/scale.rs"]
mod tests;
