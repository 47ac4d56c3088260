use super::*;
use crate::observe::Shape;

fn passages(sensor: &[(f64, f64)], wall: &[(f64, f64)], until_s: f64) -> Passages {
    let [sensor, wall] =
        [(Sensor::Bead(1), sensor), (Sensor::Contact(1), wall)].map(|(which, maxima)| {
            let seen = maxima.iter().filter(|(time_s, _)| *time_s < until_s);
            let maximum =
                |&(time_s, value): &(f64, f64)| (Maximum { time_s, value }, Shape::UNKNOWN);
            Signal::assembled(which, (Vec::new(), seen.map(maximum).collect()), 1e-3)
        });
    Passages::from_signals(sensor, wall, until_s)
}

#[test]
fn a_larger_maximum_of_the_wall_after_the_search_competes() {
    let later = [(10.0, 8.0), (25.0, 7.0), (45.0, 12.0), (50.0, 9.0)];
    let passage = passages(&[(2.0, 10.0)], &later, 60.0).passage().unwrap();
    assert_eq!(passage.wall.time_s, 10.0);
    let competing: Vec<f64> =
        (passage.competing.iter()).map(|other| other.maximum.time_s).collect();
    // That at 25 is later than 2 tw and smaller: an echo.
    assert_eq!(competing, [45.0, 50.0]);
    assert_eq!(passage.wall_maxima.len(), 2, "until the end of the search");
}

fn wall_s(sensor: &[(f64, f64)], wall: &[(f64, f64)], until_s: f64) -> f64 {
    passages(sensor, wall, until_s).wall_peak_s().unwrap()
}

#[test]
fn small_maxima_neither_start_nor_end_the_search() {
    let sensor = [(0.4, 1e-9), (3.0, 1.0), (15.0, 0.9)];
    let wall = [(1.0, 1e-8), (10.0, 2.0)];
    assert_eq!(wall_s(&sensor, &wall, 40.0), 10.0);
    let none = passages(&sensor[..1], &wall[..1], 40.0).passage();
    assert_eq!(none, Err(PassageError::NoWallPulse { duration_s: 40.0 }));
    let only = passages(&sensor[..1], &wall, 40.0).passage();
    assert_eq!(
        only,
        Err(PassageError::NoIncidentPulse { wall: Maximum { time_s: 10.0, value: 2.0 } })
    );
}

#[test]
fn every_duration_that_covers_the_search_has_one_peak() {
    // A train that grows, with sensor maxima just before each of its pulses: no
    // window counted from them would reach the next. What comes at 60, after
    // three times 18, is none of it.
    let wall = [(4.0, 1.0), (9.0, 1.2), (14.0, 1.1), (18.0, 1.5), (60.0, 7.0)];
    let sensor = [(3.9, 1.0), (8.9, 1.0), (13.9, 1.0), (17.9, 1.1), (20.0, 1.0)];
    for until_s in [54.1, 59.0, 61.0, 1e3] {
        let passage = passages(&sensor, &wall, until_s).passage().unwrap();
        assert_eq!(passage.wall.time_s, 18.0, "{until_s}");
        assert_eq!(passage.search_ends_s, 54.0);
        let highest = passage.wall_maxima.iter().map(|peak| peak.value);
        assert_eq!(highest.reduce(f64::max), Some(1.5));
    }
}

#[test]
fn maxima_that_could_be_the_peak_are_reported() {
    let wall = [(4.0, 0.15), (9.0, 0.05), (10.0, 1.0), (12.0, 0.6), (13.0, 0.4), (25.0, 0.9)];
    let passage = passages(&[(3.0, 1.0)], &wall, 40.0).passage().unwrap();
    let competing: Vec<f64> =
        (passage.competing.iter()).map(|other| other.maximum.time_s).collect();
    assert_eq!(competing, [4.0, 12.0]);
    assert_eq!(passage.competing[1].pulse, Pulse::Wall);
    assert_eq!(passage.competing[1].share, 0.6);
}
