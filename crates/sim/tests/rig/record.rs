//! What the recorder stores of forces that are known.

use crate::rig::recorder::Window;
use crate::rig::{Purpose, RandomStream, Record};
use hertzchain_experiment::{Amplifier, LowPass, LowPassKind, Recorder, Trigger, preset};

fn amplifier() -> Amplifier {
    Amplifier {
        sensitivity_c_n: 10e-12,
        wall_sensitivity_c_n: 10e-12,
        gain_v_c: 1e9,
        low_pass_hz: 450e3,
        order: LowPass::Second,
        kind: LowPassKind::Butterworth,
        high_pass_hz: 1e-3,
        noise_v: 0.0,
    }
}

fn recorder(trigger: Trigger) -> Recorder {
    Recorder {
        trigger,
        record_s: 10e-3,
        before_s: 1e-3,
        ..preset("dry").unwrap().campaign().recorder
    }
}

fn random() -> RandomStream {
    RandomStream::new(3, 0, Purpose::Noise(0))
}

/// A triangle of 100 N that begins 0.5 ms after the touch and lasts 0.2 ms.
fn record(trigger: Trigger, gate_s: f64, amplifier: &Amplifier) -> Record {
    let recorder = recorder(trigger);
    let window = Window::new(&recorder, gate_s, &mut random());
    let mut trace = window.trace();
    for (time_s, force_n) in [(0.5e-3, 0.0), (0.6e-3, 100.0), (0.7e-3, 0.0)] {
        trace.push(time_s, [force_n, 0.0]);
    }
    window.record(trace, amplifier, &recorder, &mut random())
}

/// Time in s of the largest sample after the touch.
fn peak_s(record: &Record) -> f64 {
    let (at, _) = (record.samples.iter().enumerate()).max_by_key(|(_, sample)| **sample).unwrap();
    at as f64 * 1e-6 - record.touch_s
}

#[test]
fn the_photogate_starts_a_record_before_the_touch() {
    let record = record(Trigger::Photogate, -2e-3, &amplifier());
    assert!(record.triggered);
    assert_eq!(record.samples.len(), 10_000);
    // 1 ms before the trigger, the trigger 2 ms before the touch; the sampling
    // clock has any phase.
    assert!((record.touch_s - 3e-3).abs() <= 1e-6, "{}", record.touch_s);
    // The low-pass delays by √2/ω = 0.5 µs; samples are 1 µs apart.
    assert!((peak_s(&record) - 0.6e-3).abs() < 1.6e-6, "{}", peak_s(&record));
}

#[test]
fn a_level_starts_a_record_where_the_signal_passes_it() {
    // 1 V of 10 mV/N × 100 N is half-way up at 0.55 ms.
    let record = record(Trigger::Level(0.5), -2e-3, &amplifier());
    assert_eq!(record.samples.len(), 10_000);
    assert!(record.triggered);
    let half = (0.5 / 10.0 * 32768.0) as i16;
    assert!(record.samples[999] < half && record.samples[1000] >= half);
    // To a sample and the delay of the low-pass.
    assert!((record.touch_s + 0.55e-3 - 1e-3).abs() < 2e-6, "{}", record.touch_s);
}

#[test]
fn a_level_that_is_never_passed_starts_a_record_at_the_touch_and_says_so() {
    let record = record(Trigger::Level(5.0), -2e-3, &amplifier());
    assert!(!record.triggered);
    assert_eq!(record.samples.len(), 10_000);
    assert!((record.touch_s - 1e-3).abs() <= 1e-6);
}

#[test]
fn both_discs_add_in_one_channel_by_their_sensitivities() {
    let recorder = recorder(Trigger::Photogate);
    let window = Window::new(&recorder, -2e-3, &mut random());
    let amplifier = Amplifier { wall_sensitivity_c_n: 5e-12, ..amplifier() };
    let mut trace = window.trace();
    trace.push(0.1e-3, [100.0, 40.0]);
    let record = window.record(trace, &amplifier, &recorder, &mut random());
    // 10 mV/N × 100 N + 5 mV/N × 40 N = 1.2 V, less the droop of 1 mHz.
    let last = f64::from(*record.samples.last().unwrap()) * 10.0 / 32768.0;
    assert!((last - 1.2).abs() < 1e-3, "{last}");
}

#[test]
fn noise_has_the_amplifier_s_deviation() {
    let noisy = Amplifier { noise_v: 0.02, ..amplifier() };
    let record = record(Trigger::Photogate, -2e-3, &noisy);
    let volts = record.samples[..2_500].iter().map(|s| f64::from(*s) * 10.0 / 32768.0);
    let square: f64 = volts.map(|v| v * v).sum();
    let deviation = (square / 2_500.0).sqrt();
    // Five standard errors of 2,500 samples.
    assert!((deviation / 0.02 - 1.0).abs() < 5.0 / 70.7, "{deviation}");
}
