//! Ticks at multiples of 1, 2 or 5 times a power of ten.

use super::label::fixed;
use super::{Room, Scale, Tick, Ticks};

/// A tick distance of `mantissa * 10^exponent`.
#[derive(Debug, Clone, Copy)]
struct Step {
    mantissa: u8,
    exponent: i32,
}

impl Step {
    /// The first step that cuts the span into no more than `parts`.
    fn at_least(span: f64, parts: f64) -> Self {
        let raw = span / parts;
        let mut step = Self {
            mantissa: 1,
            exponent: raw.log10().floor() as i32,
        };
        // One, two or three changes lead from a power of ten to the next.
        for _ in 0..4 {
            if step.size() < raw * (1.0 - 1e-9) {
                step = step.next();
            }
        }
        step
    }

    fn next(self) -> Self {
        let Self { mantissa, exponent } = self;
        match mantissa {
            1 => Self {
                mantissa: 2,
                exponent,
            },
            2 => Self {
                mantissa: 5,
                exponent,
            },
            _ => Self {
                mantissa: 1,
                exponent: exponent + 1,
            },
        }
    }

    fn before(self) -> Self {
        let Self { mantissa, exponent } = self;
        match mantissa {
            5 => Self {
                mantissa: 2,
                exponent,
            },
            2 => Self {
                mantissa: 1,
                exponent,
            },
            _ => Self {
                mantissa: 5,
                exponent: exponent - 1,
            },
        }
    }

    fn size(self) -> f64 {
        self.multiple(1.0)
    }

    /// `n` steps; dividing by an exact power of ten keeps 0.3 from becoming 0.30000000000000004.
    fn multiple(self, n: f64) -> f64 {
        let whole = n * f64::from(self.mantissa);
        if self.exponent < 0 {
            whole / 10f64.powi(-self.exponent)
        } else {
            whole * 10f64.powi(self.exponent)
        }
    }

    /// Small steps per labelled step.
    fn subdivisions(self) -> f64 {
        if self.mantissa == 2 { 4.0 } else { 5.0 }
    }
}

/// More changes of step than any sound range needs.
const TRIES: usize = 12;

pub(super) fn ticks(scale: &Scale, room: &Room) -> Ticks {
    let exponent = shared_exponent(scale);
    let mut step = Step::at_least(scale.hi - scale.lo, room.most() as f64);
    let mut major = labelled(scale, step, exponent);
    for _ in 0..TRIES {
        if major.len() <= 3 || room.fits(scale, &major) {
            break;
        }
        step = step.next();
        major = labelled(scale, step, exponent);
    }
    for _ in 0..TRIES {
        if major.len() >= 2 {
            break;
        }
        step = step.before();
        major = labelled(scale, step, exponent);
    }
    Ticks {
        minor: minor(scale, step),
        major,
        exponent,
    }
}

/// Power of ten to take out of the labels of very large or small numbers.
fn shared_exponent(scale: &Scale) -> Option<i32> {
    let largest = scale.lo.abs().max(scale.hi.abs());
    let exponent = largest.log10().floor() as i32;
    (!(-2..5).contains(&exponent)).then_some(exponent)
}

fn labelled(scale: &Scale, step: Step, exponent: Option<i32>) -> Vec<Tick> {
    let shift = exponent.unwrap_or(0);
    let decimals = usize::try_from(shift - step.exponent).unwrap_or(0);
    multiples(scale, step.size())
        .map(|n| {
            let value = step.multiple(n);
            let label = fixed(scaled_down(value, shift), decimals);
            Tick { value, label }
        })
        .collect()
}

/// `value / 10^exponent` where 10^exponent alone may not be a number.
fn scaled_down(value: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    value / 10f64.powi(half) / 10f64.powi(exponent - half)
}

/// Whole numbers `n` with `n * step` on the axis.
fn multiples(scale: &Scale, step: f64) -> impl Iterator<Item = f64> {
    let slack = 1e-9 * (scale.hi - scale.lo) / step;
    let first = (scale.lo / step - slack).ceil();
    let last = (scale.hi / step + slack).floor();
    let count = (last - first).clamp(-1.0, 1000.0) as i32;
    (0..=count).map(move |i| first + f64::from(i))
}

fn minor(scale: &Scale, step: Step) -> Vec<f64> {
    let parts = step.subdivisions();
    multiples(scale, step.size() / parts)
        .filter(|n| n.rem_euclid(parts) != 0.0)
        .map(|n| step.multiple(n / parts))
        .collect()
}
