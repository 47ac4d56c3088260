//! Two channels, each of which shows some of the other's.

use crate::signal::{Channels, FindOptions, Measured, QualityFlag, SignalOptions, measure};
use crate::tests::common::normal;
use crate::tests::dry::Dry;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A computed dry shot at 1 MHz in two channels with these shares of the wall's in the bead's and the
/// other way round, the return this much of itself.
fn shot(into_bead: f64, into_wall: f64, back: f64, noise: f64, seed: u64) -> Measured {
    let dry = Dry::load();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut sensor, mut wall) = (Vec::new(), Vec::new());
    for i in 0..2300 {
        let time_s = f64::from(i) * 1e-6 - 0.5e-3;
        let [mut bead, at_wall] = dry.separate(time_s);
        if time_s > 0.5 * (Dry::MAXIMA_S[1] + Dry::MAXIMA_S[2]) {
            bead *= back;
        }
        sensor.push(bead + into_bead * at_wall + noise * normal(&mut rng));
        wall.push(at_wall + into_wall * bead + noise * normal(&mut rng));
    }
    let channels = Channels::Separate { sensor: &sensor, wall: &wall };
    let measuring = SignalOptions {
        find: FindOptions {
            beads: seed.is_multiple_of(2).then_some((40, 7)),
            ..FindOptions::default()
        },
        ..SignalOptions::default()
    };
    measure(channels, 1e-6, &measuring).unwrap()
}

fn is_grave(measured: &Measured) -> bool {
    measured.found.flags.iter().any(QualityFlag::is_grave)
}

#[test]
fn crosstalk_of_the_wall_is_no_return() {
    let [passing, wall, back] = Dry::MAXIMA_S;
    for into_bead in [0.0, 0.1, 0.3, 0.35, 0.5, 0.7, 1.0, 1.5, -0.2, -0.5] {
        for seed in 0..10 {
            let measured = shot(into_bead, 0.0, 1.0, 3e-3, seed);
            let flight = measured.flight.as_ref().unwrap();
            let reflected = flight.reflected_s.unwrap();
            let off = [
                (flight.incident_s.value - (wall - passing)) / flight.incident_s.sigma,
                (reflected.value - (back - wall)) / reflected.sigma,
            ];
            // Of 200 pulls: five deviations.
            assert!(off.iter().all(|off| off.abs() < 5.0), "{into_bead}, {seed}: {off:?}");
            assert!(!is_grave(&measured), "{into_bead}, {seed}: {:?}", measured.found.flags);
        }
    }
}

#[test]
fn without_a_return_crosstalk_gives_no_reflected_time_that_counts() {
    for into_bead in [0.1, 0.35, 0.7, 1.2, -0.5] {
        for seed in 0..10 {
            let measured = shot(into_bead, 0.0, 0.0, 1e-2, seed);
            let flight = measured.flight.as_ref().unwrap();
            let counts = flight.reflected_s.filter(|_| !is_grave(&measured));
            let soon = counts.is_some_and(|reflected| reflected.value < 0.6e-3);
            assert!(!soon, "{into_bead}, {seed}: {counts:?}");
        }
    }
}

#[test]
fn a_wall_channel_that_shows_the_bead_more_than_the_wall_is_of_doubtful_order() {
    for seed in 0..10 {
        let measured = shot(0.0, 2.5, 1.0, 3e-3, seed);
        assert!(measured.flight.is_err() || is_grave(&measured), "{measured:?}");
    }
}
