//! Pulses of one speed, of which a shot's noise leaves open which maximum is the largest.

use crate::signal::{Estimate, Flight, Place};

/// Chance above which a maximum is not known to be the largest: three standard errors.
const OPEN: f64 = 1.35e-3;
/// Fewest shots whose spread tells whether they are alike.
const FEWEST: usize = 3;
/// Maxima of two shots are the same two if they are as far apart but for this share of a width.
const SAME: f64 = 0.5;

/// Flights of one speed's shots as they enter its means: of a pulse whose two largest maxima one
/// shot's noise leaves alike, all shots that show the two tell which is the larger. Where they do
/// not tell it either, a return has no time, and a shot with such a passing or wall's pulse
/// is `None`.
///
/// Shots may differ, as chains with gaps do: each is believed by its own noise, all of them by
/// what scatters beyond noise.
#[must_use]
pub fn settled(flights: &[&Flight]) -> Vec<Option<Flight>> {
    let mut settled: Vec<Flight> = flights.iter().map(|flight| **flight).collect();
    for place in [Place::Passing, Place::Wall, Place::Returning] {
        let pairs: Vec<Option<Pair>> = flights.iter().map(|f| Pair::of(f, place)).collect();
        let all: Vec<Pair> = pairs.iter().flatten().copied().collect();
        for (flight, pair) in settled.iter_mut().zip(&pairs) {
            if let Some(pair) = pair.filter(|_| is_open(flight, place)) {
                let lower = turned(pair.believed(&all), pair.after_s);
                *flight = flight.with_rival_lower(place, lower);
            }
        }
    }
    settled.into_iter().map(decided).collect()
}

/// What is known of a flight, as far as its rivals are told apart.
fn decided(flight: Flight) -> Option<Flight> {
    if is_open(&flight, Place::Passing) || is_open(&flight, Place::Wall) {
        return None;
    }
    Some(match is_open(&flight, Place::Returning) {
        true => Flight {
            reflected_s: None,
            covariance_s2: 0.0,
            ..flight
        },
        false => flight,
    })
}

/// The two largest maxima of a pulse.
#[derive(Clone, Copy)]
struct Pair {
    /// Time from the one that was picked to the other in s.
    after_s: f64,
    width_s: f64,
    /// Height of the later less that of the earlier in V.
    later_higher: Estimate,
}

impl Pair {
    fn of(flight: &Flight, place: Place) -> Option<Self> {
        let (pulse, rival) = (flight.picks.pulse(place)?, flight.picks.rival(place)?);
        let after_s = rival.picked.time_s - pulse.time_s;
        Some(Self {
            after_s,
            width_s: pulse.width_s,
            later_higher: turned(rival.lower, after_s),
        })
    }

    fn is_same(&self, other: &Self) -> bool {
        (self.after_s.abs() - other.after_s.abs()).abs() < SAME * self.width_s
    }

    /// How much higher the later maximum is, by this shot and by all of the same two.
    fn believed(&self, all: &[Self]) -> Estimate {
        let same = all.iter().filter(|pair| self.is_same(pair));
        let same: Vec<Estimate> = same.map(|pair| pair.later_higher).collect();
        believed(self.later_higher, &same)
    }
}

/// How much lower the rival is, from how much higher the later maximum is, or the other way round.
fn turned(of: Estimate, after_s: f64) -> Estimate {
    let value = if after_s > 0.0 { -of.value } else { of.value };
    Estimate { value, ..of }
}

fn is_open(flight: &Flight, place: Place) -> bool {
    let rival = flight.picks.rival(place);
    rival.is_some_and(|rival| rival.chance() > OPEN)
}

/// A shot's difference by itself and by all shots, each as far as it is worth: all of them scatter
/// about their mean with the variance that is beyond noise.
fn believed(own: Estimate, all: &[Estimate]) -> Estimate {
    if all.len() < FEWEST {
        return own;
    }
    let n = all.len() as f64;
    let mean = all.iter().map(|one| one.value).sum::<f64>() / n;
    let scatter = all
        .iter()
        .map(|one| (one.value - mean).powi(2))
        .sum::<f64>()
        / (n - 1.0);
    let noise = all.iter().map(|one| one.sigma.powi(2)).sum::<f64>() / n;
    let between = (scatter - noise).max(0.0);
    let (variance, of_mean) = (own.sigma.powi(2), scatter.max(noise) / n);
    let weight = match between > 0.0 {
        true => between / (between + variance),
        false => 0.0,
    };
    let rest = 1.0 - weight;
    Estimate {
        value: weight * own.value + rest * mean,
        sigma: (weight * variance + rest * rest * of_mean).sqrt(),
    }
}

#[cfg(test)]
#[path = "tests/alike.rs"]
mod tests;
