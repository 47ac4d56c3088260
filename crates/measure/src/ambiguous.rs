//! Pulses of one speed whose largest maximum noise leaves ambiguous.

use crate::signal::{Estimate, Flight, PulseKind};

/// Probability above which a maximum is not known to be the largest: three standard errors.
const OPEN: f64 = 1.35e-3;
/// Fewest shots whose scatter is compared with noise.
const FEWEST: usize = 3;
/// Maxima of two shots are the same two if they are as far apart but for this share of a width.
const SAME: f64 = 0.5;

/// Flights of one speed's shots as they enter its means: where one shot's noise leaves two maxima of
/// a pulse ambiguous, all shots that have the two decide which is the larger. Where they do not
/// either, a reflected pulse has no time, and a shot with such an incident or wall's pulse is `None`.
///
/// Shots may differ, as chains with gaps do: each is weighted by its own noise, all of them by what
/// scatters beyond noise.
pub fn resolve_ambiguous(flights: &[&Flight]) -> Vec<Option<Flight>> {
    let mut resolved: Vec<Flight> = flights.iter().map(|flight| **flight).collect();
    for kind in [PulseKind::Incident, PulseKind::Wall, PulseKind::Reflected] {
        let pairs: Vec<Option<MaximumPair>> =
            flights.iter().map(|f| MaximumPair::new(f, kind)).collect();
        let all: Vec<MaximumPair> = pairs.iter().flatten().copied().collect();
        for (flight, pair) in resolved.iter_mut().zip(&pairs) {
            if let Some(pair) = pair.filter(|_| is_open(flight, kind)) {
                let lower = turned(pair.combined(&all), pair.after_s);
                *flight = flight.with_height_difference(kind, lower);
            }
        }
    }
    resolved.into_iter().map(decided).collect()
}

fn decided(flight: Flight) -> Option<Flight> {
    if is_open(&flight, PulseKind::Incident) || is_open(&flight, PulseKind::Wall) {
        return None;
    }
    Some(match is_open(&flight, PulseKind::Reflected) {
        true => Flight { reflected_s: None, covariance_s2: 0.0, ..flight },
        false => flight,
    })
}

#[derive(Clone, Copy)]
struct MaximumPair {
    /// Time from the one that was picked to the other in s.
    after_s: f64,
    width_s: f64,
    /// Height of the later less that of the earlier in V.
    later_higher: Estimate,
}

impl MaximumPair {
    fn new(flight: &Flight, kind: PulseKind) -> Option<Self> {
        let pulse = flight.picks.pulse(kind)?;
        let other = flight.picks.competing[kind as usize]?;
        let after_s = other.picked.time_s - pulse.time_s;
        Some(Self { after_s, width_s: pulse.width_s, later_higher: turned(other.lower, after_s) })
    }

    /// How much higher the later maximum is, by this shot and by all of the same two.
    fn combined(&self, all: &[Self]) -> Estimate {
        let is_same =
            |other: &&Self| (self.after_s.abs() - other.after_s.abs()).abs() < SAME * self.width_s;
        let same = all.iter().filter(is_same).map(|pair| pair.later_higher);
        combined(self.later_higher, &same.collect::<Vec<_>>())
    }
}

/// How much lower the competing maximum is, from how much higher the later one is, or the reverse.
fn turned(of: Estimate, after_s: f64) -> Estimate {
    let value = if after_s > 0.0 { -of.value } else { of.value };
    Estimate { value, ..of }
}

fn is_open(flight: &Flight, kind: PulseKind) -> bool {
    let other = flight.picks.competing[kind as usize];
    other.is_some_and(|other| other.p_value() > OPEN)
}

/// A shot's difference, shrunk toward the mean of all shots, about which they scatter with the
/// variance that is beyond noise.
fn combined(own: Estimate, all: &[Estimate]) -> Estimate {
    if all.len() < FEWEST {
        return own;
    }
    let n = all.len() as f64;
    let mean = all.iter().map(|one| one.value).sum::<f64>() / n;
    let squares = all.iter().map(|one| (one.value - mean).powi(2));
    let scatter = squares.sum::<f64>() / (n - 1.0);
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
#[path = "tests/ambiguous.rs"]
mod tests;
