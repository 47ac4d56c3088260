//! Shots of the ensemble loop, for its tests.

use super::*;
use hertzchain_chain::ensemble::{End, LaneResult, Precision, Settings, Shot, fire};
use hertzchain_chain::wave::SolveError;

/// What the paper's rig watches: a bead (the seventh, or the last of a shorter
/// row) and the wall.
pub fn watched(beads: usize) -> Vec<Sensor> {
    vec![Sensor::Bead(7.min(beads)), Sensor::Contact(beads)]
}

/// Until the reflected pulse has passed the sensor bead.
pub fn settings(beads: usize) -> Settings {
    Settings {
        sensors: watched(beads),
        end: End::Passed,
        set: InstructionSet::default(),
        shapes: true,
        whole_chain: false,
        openings: false,
    }
}

/// Both lengths of numbers.
pub const PRECISIONS: [Precision; 2] = [Precision::Double, Precision::Single];

/// Fires systems with one step and one duration, in double precision.
pub fn fire_all(
    systems: &[System],
    step: (f64, f64),
    settings: &Settings,
) -> Vec<Result<LaneResult, SolveError>> {
    fire_all_in(Precision::Double, systems, step, settings)
}

/// Fires systems with one step and one duration.
pub fn fire_all_in(
    precision: Precision,
    systems: &[System],
    (step, duration_s): (f64, f64),
    settings: &Settings,
) -> Vec<Result<LaneResult, SolveError>> {
    let shot = |system| Shot { system, step, duration_s, precision };
    let shots: Vec<Shot<'_>> = systems.iter().map(shot).collect();
    fire(&shots, settings)
}

/// Fires one system alone, in double precision.
pub fn fire_one(system: &System, step: (f64, f64), settings: &Settings) -> LaneResult {
    fire_one_in(Precision::Double, system, step, settings)
}

/// Fires one system alone.
pub fn fire_one_in(
    precision: Precision,
    system: &System,
    step: (f64, f64),
    settings: &Settings,
) -> LaneResult {
    let mut flown = fire_all_in(precision, std::slice::from_ref(system), step, settings);
    flown.remove(0).unwrap()
}

/// Pulses of a shot that watched a bead and the wall.
pub fn passage(flown: &LaneResult) -> Option<Passage> {
    let [sensor, wall] = flown.signals.as_slice() else {
        return None;
    };
    Passages::from_signals(sensor.clone(), wall.clone(), flown.time_s).passage().ok()
}

/// Incident and reflected time of flight in s.
pub fn tofs(passage: &Passage) -> [f64; 2] {
    [passage.tof_incident_s(), passage.tof_reflected_s().unwrap_or(f64::NAN)]
}

/// The first number in which two flights differ, if any; the cost in bodies is
/// the block's and may.
pub fn difference(one: &LaneResult, two: &LaneResult) -> Option<String> {
    let (one, two) = (numbers(one), numbers(two));
    if one.len() != two.len() {
        return Some(format!("{} and {} numbers", one.len(), two.len()));
    }
    let other = one.iter().zip(&two).find(|(a, b)| a.1.to_bits() != b.1.to_bits());
    other.map(|(a, b)| format!("{}: {:e} and {:e}", a.0, a.1, b.1))
}

/// Everything that a shot gives, with names.
fn numbers(flown: &LaneResult) -> Vec<(&'static str, f64)> {
    let named = |name| move |value| (name, value);
    let maxima = flown.signals.iter().flat_map(|signal| signal.maxima());
    let stretches = flown.signals.iter().flat_map(|signal| signal.stretches());
    let mut numbers = vec![
        ("time", flown.time_s),
        ("step", flown.step_s),
        ("steps", flown.work.steps as f64),
        ("force passes", flown.work.force_passes as f64),
        ("finished", f64::from(u8::from(flown.finished))),
    ];
    numbers.extend(flown.velocity_m_s.iter().copied().map(named("velocity")));
    numbers.extend(maxima.flat_map(|m| [m.time_s, m.value]).map(named("maximum")));
    numbers.extend(
        stretches.flat_map(|s| [s.start_s].into_iter().chain(s.values)).map(named("stretch")),
    );
    numbers
}

/// Step in contact times, and whether openings are followed, for an accuracy
/// of both times of flight: log-linear between the rows.
pub fn step_for(accuracy: f64) -> (f64, bool) {
    const TABLE: [(f64, f64, bool); 4] =
        [(1e-4, 0.2, false), (1e-5, 0.135, false), (1e-6, 0.05, true), (1e-7, 0.03, true)];
    let after = TABLE.iter().position(|row| row.0 <= accuracy);
    match after {
        Some(0) => (TABLE[0].1, TABLE[0].2),
        None => (TABLE[3].1, TABLE[3].2),
        Some(i) => {
            let (loose, tight) = (TABLE[i - 1], TABLE[i]);
            let part = (loose.0 / accuracy).ln() / (loose.0 / tight.0).ln();
            (loose.1 * (tight.1 / loose.1).powf(part), tight.2)
        }
    }
}
