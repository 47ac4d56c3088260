//! Sensors of unlike sensitivity, and a wall's channel that is late.

use crate::MeasureError;
use crate::signal::{Channels, Measured, PulseKind, SensorCalibration, SignalOptions, measure};
use crate::tests::common::{Scene, channels};

/// Samples of 1 µs by which the wall's channel is late.
const LATE: usize = 7;

const CALIBRATION: SensorCalibration =
    SensorCalibration { sensitivities_v_n: Some([0.012, 0.03]), skew_s: 1e-6 * LATE as f64 };

fn calibrated(
    channels: Channels<'_>,
    calibration: SensorCalibration,
) -> Result<Measured, MeasureError> {
    measure(channels, 1e-6, &SignalOptions { calibration, ..SignalOptions::default() })
}

#[test]
fn a_late_and_more_sensitive_wall_channel_measures_as_one_that_is_not() {
    let pair = Scene::default().separate();
    let plain = calibrated(channels(&pair), SensorCalibration::default()).unwrap().flight.unwrap();
    let late = pair.1[..LATE].iter().chain(&pair.1[..pair.1.len() - LATE]);
    let other = (pair.0.clone(), late.map(|volts| 2.5 * volts).collect());
    let found = calibrated(channels(&other), CALIBRATION).unwrap().flight.unwrap();
    // Rounding of sample numbers and of the fit.
    let differs = |found: f64, plain: f64| (found - plain).abs() > 1e-9 * plain;
    let pairs = [
        (found.incident_s, plain.incident_s),
        (found.reflected_s.unwrap(), plain.reflected_s.unwrap()),
        (found.wall_over_incident, plain.wall_over_incident),
        (found.reflected_over_incident.unwrap(), plain.reflected_over_incident.unwrap()),
    ];
    for (found, plain) in pairs {
        assert!(!differs(found.value, plain.value), "{found:?} {plain:?}");
    }
    for kind in [PulseKind::Incident, PulseKind::Wall, PulseKind::Reflected] {
        let volts = [plain.picks.incident, plain.picks.wall, plain.picks.reflected.unwrap()];
        let force_n = volts[kind as usize].height / 0.012;
        assert!(!differs(found.picks.force_n(kind).unwrap(), force_n), "{kind:?}");
    }
    assert_eq!(plain.picks.force_n(PulseKind::Wall), None);
}

#[test]
fn one_channel_has_no_skew_and_no_sensor_is_insensitive() {
    let summed = Scene::default().summed();
    let skewed = calibrated(Channels::Summed(&summed), CALIBRATION).unwrap_err();
    assert!(skewed.to_string().contains("name the two channels"), "{skewed}");
    let dead =
        SensorCalibration { sensitivities_v_n: Some([0.012, 0.0]), ..SensorCalibration::default() };
    assert!(calibrated(Channels::Summed(&summed), dead).is_err());
}

#[test]
fn a_skew_that_turns_pulses_about_leaves_no_time_of_flight() {
    let pair = Scene::default().separate();
    for skew_s in [-1e-3, 1e-3] {
        let late = SensorCalibration { skew_s, ..SensorCalibration::default() };
        let flight = calibrated(channels(&pair), late).unwrap().flight;
        assert!(matches!(flight, Err(MeasureError::OutOfOrder(..))), "{flight:?}");
    }
}
