//! The size of speeds, times and forces in a shot, known before it begins.

use super::statics::shorter_time;
use super::{Scales, System};
use crate::material::BeadPair;

/// The speed that moves the chain and the shortest time in which a pair of
/// its bodies turns round at that speed.
pub(super) fn scales(system: &System, kinds: &[(usize, BeadPair)]) -> Scales {
    let speed = characteristic_speed(system);
    let time = shortest_time(system, kinds, speed);
    let time_s = if time.is_finite() && time > 0.0 { time } else { 1.0 };
    let lightest = system.mass_kg.iter().copied().fold(f64::INFINITY, f64::min);
    let static_force = system.static_force_n.iter().copied().fold(0.0, f64::max);
    let silent_force_n = (1e-9 * lightest * speed / time_s).max(1e-13 * static_force);
    Scales {
        speed_m_s: speed,
        time_s,
        silent_force_n,
        momentum_n_s: lightest * speed,
        crossing_s: crossing_s(system, kinds, lightest * speed),
    }
}

/// Contacts with what they join, of equal neighbours the first.
pub(super) fn kinds(system: &System, pairs: &[Option<BeadPair>]) -> Vec<(usize, BeadPair)> {
    let kind = |c: usize| (pairs[c], system.section_of[c], system.offset_m[c]);
    (0..pairs.len())
        .filter(|&c| c == 0 || kind(c) != kind(c - 1))
        .filter_map(|c| Some((c, pairs[c]?)))
        .collect()
}

fn shortest_time(system: &System, kinds: &[(usize, BeadPair)], speed_m_s: f64) -> f64 {
    kinds.iter().fold(f64::INFINITY, |shortest, (c, pair)| {
        let mass_kg = match pair.mass_kg.is_finite() {
            true => pair.mass_kg,
            false => system.mass_kg[1],
        };
        shorter_time(system, *c, (mass_kg, speed_m_s), shortest)
    })
}

/// About how long the wave takes along the chain. Contacts keep momentum, whatever
/// they lose, so the wave is nowhere slower than the heaviest body so far with the
/// momentum of the start; a contact takes the time in which it stops such a body at
/// that speed, which goes as the speed to −1/5, and a gap is crossed at it.
fn crossing_s(system: &System, kinds: &[(usize, BeadPair)], least_n_s: f64) -> f64 {
    let momentum = match system.has_striker {
        true => system.mass_kg[0] * system.velocity_m_s[0].abs(),
        false => least_n_s,
    };
    let finite = |body: usize| Some(system.mass_kg[body]).filter(|mass| mass.is_finite());
    let mut heaviest = finite(0).unwrap_or(0.0);
    let (mut kinds, mut last, mut sum) = (kinds.iter().peekable(), (0.0, 0.0), 0.0);
    for contact in (0..system.contacts()).filter(|c| system.has_contact(*c)) {
        let new_kind = kinds.next_if(|(first, _)| *first <= contact).is_some();
        let mass = finite(contact + 1).into_iter().chain(finite(contact));
        heaviest = mass.fold(heaviest, f64::max);
        let speed = momentum / heaviest;
        if new_kind || last.0 != heaviest {
            let time = shorter_time(system, contact, (heaviest, speed), f64::INFINITY);
            last = (heaviest, if time.is_finite() { time } else { 0.0 });
        }
        sum += last.1 + (-system.offset_m[contact]).max(0.0) / speed;
    }
    if sum.is_finite() { sum } else { 0.0 }
}

fn characteristic_speed(system: &System) -> f64 {
    let driven = system.motion.as_ref().map_or(0.0, |motion| motion.largest_speed_m_s());
    let moving = system.velocity_m_s.iter().fold(driven, |most, v| most.max(v.abs()));
    if moving > 0.0 {
        return moving;
    }
    // Only displaced: the speed that the largest stored energy can give.
    let displaced = system.displacement_m.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let swinging = displaced * system.pendulum_per_s2.sqrt();
    let stored = (0..system.contacts())
        .map(|c| system.stored_energy(c, system.offset_m[c].max(0.0) + displaced))
        .fold(0.0_f64, f64::max);
    let lightest = system.mass_kg.iter().copied().fold(f64::INFINITY, f64::min);
    let released =
        if system.pendulum_per_s2 > 0.0 { 0.0 } else { (2.0 * stored / lightest).sqrt() };
    let speed = swinging.max(released);
    if speed.is_finite() && speed > 0.0 { speed } else { 1.0 }
}
