//! Ticks of logarithmic axes, also over parts of a decade.

use super::label::{plain, power};
use super::{Room, Scale, Tick, Ticks, linear};

/// Which multiples of which powers of ten carry labels, richest first.
const CHOICES: [(&[u32], i32); 8] = [
    (&[1, 2, 3, 4, 5, 6, 7, 8, 9], 1),
    (&[1, 2, 5], 1),
    (&[1, 3], 1),
    (&[1], 1),
    (&[1], 2),
    (&[1], 3),
    (&[1], 5),
    (&[1], 10),
];

/// Beyond this many decades, multiples of a power of ten say nothing.
const MANY_DECADES: f64 = 3.0;

pub(super) fn ticks(scale: &Scale, room: &Room) -> Ticks {
    let found = CHOICES
        .iter()
        .filter(|(mantissas, _)| mantissas.len() == 1 || scale.decades() <= MANY_DECADES)
        .map(|(mantissas, every)| labelled(scale, mantissas, *every))
        .find(|major| major.len() <= room.most() && room.fits(scale, major))
        .unwrap_or_else(|| labelled(scale, &[1], sparse(scale)));
    if found.len() < 3 && scale.decades() < 1.0 {
        return even_steps(scale, room);
    }
    let minor = unlabelled(scale, &found);
    let sparse = found.len() < 2;
    let ticks = Ticks {
        major: found,
        minor,
        exponent: None,
    };
    if sparse {
        even_steps(scale, room)
    } else {
        ticks
    }
}

/// Decades between labels so that about five remain.
fn sparse(scale: &Scale) -> i32 {
    ((scale.decades() / 5.0).ceil() as i32).max(1)
}

/// Within a small part of a decade a logarithmic axis is nearly linear.
fn even_steps(scale: &Scale, room: &Room) -> Ticks {
    let mut found = linear::ticks(scale, room);
    if !room.fits(scale, &found.major) && found.major.len() > 3 {
        let mut n = 0;
        found.major.retain(|_| {
            n += 1;
            n % 2 == 1
        });
    }
    found
}

fn labelled(scale: &Scale, mantissas: &[u32], every: i32) -> Vec<Tick> {
    let written_out = scale.lo >= 9.9e-4 && scale.hi <= 1.01e5;
    let write = if written_out { plain } else { power };
    exponents(scale)
        .filter(|e| e.rem_euclid(every) == 0)
        .flat_map(|e| mantissas.iter().map(move |m| (*m, e)))
        .filter(|(m, e)| scale.holds(value(*m, *e)))
        .map(|(m, e)| Tick {
            value: value(m, e),
            label: write(m, e),
        })
        .collect()
}

/// Ticks between the labels. Where powers of ten go without a label only they
/// are marked, so that a short tick always means the same.
fn unlabelled(scale: &Scale, major: &[Tick]) -> Vec<f64> {
    let labels_missing = |p: &Tick| major.iter().all(|t| t.value != p.value);
    let crowded = labelled(scale, &[1], 1).iter().any(labels_missing);
    let mantissas: &[u32] = if crowded { &[1] } else { CHOICES[0].0 };
    let mut found: Vec<f64> = labelled(scale, mantissas, 1)
        .iter()
        .map(|t| t.value)
        .collect();
    found.retain(|v| major.iter().all(|t| t.value != *v));
    found
}

fn exponents(scale: &Scale) -> std::ops::RangeInclusive<i32> {
    (scale.lo.log10().floor() as i32)..=(scale.hi.log10().ceil() as i32)
}

/// `mantissa * 10^exponent`, exact for the decimals a label shows.
fn value(mantissa: u32, exponent: i32) -> f64 {
    if exponent < 0 {
        f64::from(mantissa) / 10f64.powi(-exponent)
    } else {
        f64::from(mantissa) * 10f64.powi(exponent)
    }
}
