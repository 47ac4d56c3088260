//! Striker, photogate and converter keep what their numbers promise.

use crate::rig::instruments::{Converter, GateReading, programmed, true_speed_m_s};
use crate::rig::{Plan, Purpose, RandomStream, RigError};
use hertzchain_experiment::{Actuator, Photogate, Recorder, preset};

use super::small;

fn actuator() -> Actuator {
    preset("dry").unwrap().campaign().actuator
}

fn recorder(bits: u32, range_v: f64, offset_v: f64) -> Recorder {
    Recorder { bits, range_v, offset_v, ..preset("dry").unwrap().campaign().recorder }
}

fn random() -> RandomStream {
    RandomStream::new(1, 0, Purpose::Assembly)
}

#[test]
fn speeds_are_programmed_in_steps_of_the_resolution() {
    let actuator = actuator();
    for asked in [0.05, 0.123_456, 0.75, 2.5] {
        let got = programmed(&actuator, asked).unwrap();
        assert!((got - asked).abs() <= 0.5 * 1.5e-4 * (1.0 + 1e-9));
        let steps = got / 1.5e-4;
        // Rounding of one product and one quotient.
        assert!((steps - steps.round()).abs() < 1e-9 * steps);
    }
}

#[test]
fn speeds_out_of_range_are_refused_and_told() {
    let actuator = actuator();
    for asked in [0.0499, 2.5001, 0.0, -1.0, f64::NAN] {
        let text = programmed(&actuator, asked).unwrap_err().to_string();
        assert!(text.contains("from 0.05 to 2.5 m/s"), "{text}");
    }
    let fast = small::experiment(&[("\"0.9 m/s\"", "\"2.6 m/s\"")]);
    let error = Plan::new(&fast, None).unwrap_err();
    assert!(matches!(error, RigError::Speed(_)), "{error}");
    assert!(error.to_string().contains("2.6 m/s"), "{error}");
}

/// Mean and standard deviation.
fn spread(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (mean, (square / (count - 1.0)).sqrt())
}

#[test]
fn shots_spread_by_the_actuator_s_number_and_the_gate_adds_its_own() {
    let (actuator, mut random) = (actuator(), random());
    let fired = |random: &mut RandomStream| true_speed_m_s(&actuator, 0.6, random);
    let speeds: Vec<f64> = (0..10_000).map(|_| fired(&mut random)).collect();
    let (mean, deviation) = spread(&speeds);
    // Five standard errors of 10,000 draws.
    assert!((mean - 0.6).abs() < 5.0 * 0.003 / 100.0, "{mean}");
    assert!((deviation / 0.003 - 1.0).abs() < 5.0 / 141.0, "{deviation}");
    let gate = Photogate { error_m_s: 0.001, way_m: 2e-3 };
    let measured = |random: &mut RandomStream| GateReading::new(&gate, 0.5, 0.0, random);
    let errors: Vec<f64> = (0..10_000).map(|_| measured(&mut random).speed_m_s - 0.5).collect();
    assert!((spread(&errors).1 / 0.001 - 1.0).abs() < 5.0 / 141.0);
    assert_eq!(measured(&mut random).time_s, -2e-3 / 0.5);
}

#[test]
fn a_converter_rounds_to_the_nearest_reading() {
    let converter = Converter::new(&recorder(16, 10.0, 0.0));
    let step = 10.0 / 32768.0;
    assert_eq!(converter.volts_per_count(), step);
    assert_eq!(converter.reading(0.0), 0);
    assert_eq!(converter.reading(0.49 * step), 0);
    assert_eq!(converter.reading(0.51 * step), 1);
    assert_eq!(converter.reading(-1.4 * step), -1);
    assert_eq!(converter.reading(1000.0 * step), 1000);
}

#[test]
fn a_converter_cuts_at_both_ends_of_its_range() {
    let converter = Converter::new(&recorder(16, 10.0, 0.0));
    assert_eq!(converter.reading(9.9999), i16::MAX);
    assert_eq!(converter.reading(1e300), i16::MAX);
    assert_eq!(converter.reading(-10.0), i16::MIN);
    assert_eq!(converter.reading(f64::NEG_INFINITY), i16::MIN);
    assert_eq!(converter.reading(f64::NAN), 0);
}

#[test]
fn an_offset_moves_all_readings() {
    let converter = Converter::new(&recorder(16, 10.0, 2.5));
    assert_eq!(converter.reading(0.0), 8192);
    assert_eq!(converter.reading(8.0), i16::MAX);
}

#[test]
fn fewer_bits_are_coarser_steps_of_the_same_volts() {
    let converter = Converter::new(&recorder(8, 1.0, 0.0));
    let step = 1.0 / 128.0;
    assert_eq!(f64::from(converter.reading(3.3 * step)) * converter.volts_per_count(), 3.0 * step);
    assert_eq!(f64::from(converter.reading(5.0)) * converter.volts_per_count(), 127.0 * step);
    assert_eq!(converter.reading(-5.0), i16::MIN);
}

#[test]
fn chance_has_streams_that_do_not_repeat_each_other() {
    let first = |series, purpose| RandomStream::new(7, series, purpose).bits();
    let mut all = vec![first(0, Purpose::Assembly), first(1, Purpose::Assembly)];
    for shot in 0..100 {
        all.push(first(0, Purpose::Shot(shot)));
        all.push(first(0, Purpose::Noise(shot)));
        all.push(first(1, Purpose::Shot(shot)));
    }
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count);
}
