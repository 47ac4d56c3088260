//! Which of a pulse's maxima is the largest, where noise leaves that open.

use super::smooth::{Maximum, Smooth};
use super::{Channels, Doubt, Found, Place, Pulse};
use crate::picks::{Sight, fitted_height};
use crate::{Estimate, Rival};

/// Maxima whose smoothed heights are so many standard errors below the largest are looked at
/// closely: of both the error is 1.4 times the noise left.
const CLOSE: f64 = 7.0;
/// So many of them: a return has two or three fragments of like height.
const MOST: usize = 2;
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
    let near = |m: &&Maximum| {
        let at = m.at as f64;
        m.at != chosen.at && at > from && at < to && m.height > least
    };
    let mut others: Vec<Maximum> = maxima.iter().filter(near).copied().collect();
    others.sort_by(|a, b| b.height.total_cmp(&a.height));
    others.truncate(MOST);
    others
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
        let with_height = |pulse: &Pulse| (*pulse, height(found, pulse, channels));
        let mut all: Vec<(Pulse, Estimate)> = pulses.iter().map(with_height).collect();
        all.sort_by(|a, b| b.1.value.total_cmp(&a.1.value));
        let [(first, most), (second, next), ..] = all[..] else {
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

/// Height of a maximum by the samples about it; that of the smoothed signal where they fit nothing.
fn height(found: &Found, pulse: &Pulse, channels: Channels<'_>) -> Estimate {
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
    };
    fitted_height(&sight, pulse).unwrap_or(Estimate {
        value: pulse.height,
        sigma: upright.level.noise,
    })
}
