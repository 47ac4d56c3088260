//! Which of a pulse's maxima is the largest, where noise leaves that open.

use super::smooth::{Maximum, Smooth};
use super::{Channels, Doubt, Found, Place, Pulse};
use crate::signal::picks::{Sight, fitted};
use crate::signal::{Estimate, Rival};

/// Maxima whose smoothed heights are so many standard errors below the largest are looked at
/// closely: of both the error is 1.4 times the noise left.
const CLOSE: f64 = 7.0;
/// So many of them: a return has two or three fragments of like height.
const MOST: usize = 2;
/// Share of the width within which two maxima are those of one top: noise, or a digitiser's steps, on it.
const APART: f64 = 0.5;
/// Standard errors of a difference in height beyond which it is no chance: 0.13 %.
const TELLS: f64 = 3.0;

/// The highest others of a pulse's maxima, of those that noise could have made the lower.
pub(super) fn others(
    maxima: &[Maximum],
    (from, to): (f64, f64),
    chosen: &Maximum,
    smooth: &Smooth,
) -> Vec<Maximum> {
    let least = chosen.height - CLOSE * smooth.noise;
    let (rise, fall) = smooth.sides(chosen);
    let apart = (APART * (rise + fall)) as usize;
    let near = |m: &&Maximum| {
        let at = m.at as f64;
        at > from && at < to && m.height > least
    };
    let mut near: Vec<Maximum> = maxima.iter().filter(near).copied().collect();
    near.sort_by(|a, b| b.height.total_cmp(&a.height));
    let mut tops = vec![*chosen];
    for maximum in near {
        let is_other = |top: &Maximum| top.at.abs_diff(maximum.at) > apart;
        if tops.len() <= MOST && tops.iter().all(is_other) {
            tops.push(maximum);
        }
    }
    tops.split_off(1)
}

/// Compares the heights of pulses found with those of others of their place, as fits to all
/// samples about each tell them: the highest is the pulse, the next its rival. Says which pairs
/// noise leaves alike.
pub(super) fn tell(found: &mut Found, others: &[Pulse], channels: Channels<'_>) {
    for place in [Place::Passing, Place::Wall, Place::Returning] {
        let of_place = others.iter().filter(|other| other.place == place);
        let whole = found.slot(place).filter(|own| own.clipped.is_none());
        let pulses: Vec<Pulse> = whole.into_iter().chain(of_place.copied()).collect();
        if whole.is_none() || pulses.len() < 2 {
            continue;
        }
        let mut tops: Vec<(Pulse, f64, Estimate)> = Vec::new();
        for pulse in pulses {
            let (time, height) = top(found, &pulse, channels);
            let is_same = |other: &(Pulse, f64, Estimate)| {
                (other.1 - time).abs() < APART * pulse.width_samples
            };
            if !tops.iter().any(is_same) {
                tops.push((pulse, time, height));
            }
        }
        tops.sort_by(|a, b| b.2.value.total_cmp(&a.2.value));
        let [(first, _, most), (second, _, next), ..] = tops[..] else {
            continue;
        };
        *found.slot(place) = Some(first);
        let lower = Estimate {
            value: most.value - next.value,
            sigma: most.sigma.hypot(next.sigma),
        };
        found.rivals.push(Rival {
            pulse: second,
            lower,
        });
        if lower.value < TELLS * lower.sigma || lower.value <= 0.0 {
            found.doubt(vec![Doubt::Alike(place)]);
        }
    }
}

/// Sample and height of a maximum by fits to the samples about it; those of the smoothed signal where
/// they fit nothing.
fn top(found: &Found, pulse: &Pulse, channels: Channels<'_>) -> (f64, Estimate) {
    let upright = *found.upright(pulse.place);
    let sight = Sight {
        samples: match pulse.place {
            Place::Wall => channels.wall(),
            Place::Passing | Place::Returning => channels.sensor(),
        },
        upright,
        rails: None,
        summed: matches!(channels, Channels::Summed(_)),
        wall: None,
        inverse: [0.0; 2],
    };
    let (at, height, error) = fitted(&sight, pulse).map_or(
        (pulse.at as f64, pulse.height, upright.level.noise),
        |picked| (picked.time_s, picked.height, picked.height_sigma),
    );
    let height = Estimate {
        value: height,
        sigma: error,
    };
    (at, height)
}
