//! The charge amplifier against closed forms.

use crate::rig::Amplifier;
use hertzchain_experiment::{Amplifier as Numbers, LowPass, LowPassKind};
use std::f64::consts::{SQRT_2, TAU};

const INTERVAL_S: f64 = 1e-6;

fn numbers(order: LowPass) -> Numbers {
    Numbers {
        sensitivity_c_n: 20e-12,
        wall_sensitivity_c_n: 5e-12,
        gain_v_c: 1e9,
        low_pass_hz: 30e3,
        order,
        kind: LowPassKind::Butterworth,
        high_pass_hz: 200.0,
        noise_v: 0.0,
    }
}

/// Voltages after a rise to 3 N in the sensor bead and 4 N at the wall within one
/// interval: forces are straight lines between samples.
fn response(order: LowPass, samples: usize) -> Vec<f64> {
    let mut amplifier = Amplifier::new(&numbers(order), INTERVAL_S);
    (0..samples).map(|_| amplifier.next(3.0, 4.0)).collect()
}

/// G (S₇ F₇ + S_w F_w) after that rise in V.
const STEP_V: f64 = 1e9 * (20e-12 * 3.0 + 5e-12 * 4.0);

/// The response to the rise is the mean of the one to a step over the interval: `risen` is
/// that one's integral from 0.
fn matches(order: LowPass, risen: impl Fn(f64) -> f64) {
    for (at, found) in response(order, 20_000).into_iter().enumerate() {
        let (from_s, time_s) = (at as f64 * INTERVAL_S, (at + 1) as f64 * INTERVAL_S);
        let expected = STEP_V * (risen(time_s) - risen(from_s)) / INTERVAL_S;
        // Rounding of 20,000 steps, and of two integrals of up to 800 intervals.
        assert!((found - expected).abs() < 2e-12 * STEP_V, "{time_s}: {found} {expected}");
    }
}

#[test]
fn a_rise_through_a_first_order_low_pass_and_the_high_pass_is_two_exponentials() {
    let (low, high) = (TAU * 30e3, TAU * 200.0);
    // Of low/(low − high) (exp(−high t) − exp(−low t)).
    let one = |rate: f64, t: f64| -(-rate * t).exp_m1() / rate;
    matches(LowPass::First, |t| low / (low - high) * (one(high, t) - one(low, t)));
}

#[test]
fn a_rise_through_a_butterworth_low_pass_overshoots_as_its_closed_form() {
    let (low, high) = (TAU * 30e3, TAU * 200.0);
    let sigma = low / SQRT_2;
    // Partial fractions of ω²/((s + ω_h)(s² + √2 ω s + ω²)).
    let share = low * low / (high * high - SQRT_2 * low * high + low * low);
    // The step's ringing is exp(−σt) (cos σt + b sin σt); its integral from 0:
    let b = 1.0 - high / sigma;
    let rung = |t: f64| {
        let (sin, cos) = (sigma * t).sin_cos();
        let end = (-sigma * t).exp() * ((1.0 - b) * sin - (1.0 + b) * cos);
        (end + 1.0 + b) / (2.0 * sigma)
    };
    matches(LowPass::Second, |t| share * (-(-high * t).exp_m1() / high - rung(t)));
    let most = response(LowPass::Second, 100).into_iter().fold(0.0, f64::max);
    // Butterworth's overshoot is e^{-π} = 4.3 %, less what the high-pass takes.
    assert!(most > 1.02 * STEP_V && most < 1.0433 * STEP_V, "{most}");
}

/// A ramp is a straight line between samples: exact whatever the interval.
#[test]
fn a_ramp_gives_the_same_voltages_on_a_grid_five_times_as_coarse() {
    let voltages = |interval_s: f64, every: usize| -> Vec<f64> {
        let mut amplifier = Amplifier::new(&numbers(LowPass::Second), interval_s);
        let ramp = |at: usize| 1e5 * at as f64 * interval_s;
        let all = (1..=500 * every).map(|at| amplifier.next(ramp(at), 0.0));
        all.skip(every - 1).step_by(every).collect()
    };
    let (fine, coarse) = (voltages(1e-6, 5), voltages(5e-6, 1));
    for (one, two) in fine.iter().zip(&coarse) {
        // Rounding of 2,500 steps, relative to the largest voltage.
        assert!((one - two).abs() < 1e-12 * fine.last().unwrap().abs().max(1.0));
    }
}

#[test]
fn no_force_gives_no_voltage() {
    let mut amplifier = Amplifier::new(&numbers(LowPass::Second), INTERVAL_S);
    assert!((0..100).all(|_| amplifier.next(0.0, 0.0) == 0.0));
}

/// The amplitude of a sine after all else has died away, over that of the input.
fn gain(numbers: &Numbers, frequency_hz: f64) -> f64 {
    let interval_s = 0.005 / numbers.low_pass_hz;
    let mut amplifier = Amplifier::new(numbers, interval_s);
    let mut sums = [0.0; 3];
    for at in 0..40_000 {
        let (sin, cos) = (TAU * frequency_hz * at as f64 * interval_s).sin_cos();
        let out = amplifier.next(sin, 0.0);
        if at >= 20_000 {
            for (sum, term) in sums.iter_mut().zip([out * sin, out * cos, sin * sin]) {
                *sum += term;
            }
        }
    }
    sums[0].hypot(sums[1]) / sums[2] / (numbers.gain_v_c * numbers.sensitivity_c_n)
}

#[test]
fn low_passes_of_all_orders_and_kinds_have_half_the_power_at_the_corner() {
    let orders = [LowPass::First, LowPass::Second, LowPass::Third, LowPass::Fourth];
    for (order, poles) in orders.into_iter().zip(1..) {
        for kind in [LowPassKind::Butterworth, LowPassKind::Bessel] {
            let numbers = Numbers { kind, high_pass_hz: 1e-3, ..numbers(order) };
            let at_corner = gain(&numbers, numbers.low_pass_hz);
            // Straight lines between samples, and a high-pass far below.
            assert!((at_corner * SQRT_2 - 1.0).abs() < 1e-4, "{order:?} {kind:?}: {at_corner}");
            if kind == LowPassKind::Butterworth {
                let expected = (1.0 + 2_f64.powi(2 * poles)).sqrt().recip();
                let octave = gain(&numbers, 2.0 * numbers.low_pass_hz);
                assert!((octave / expected - 1.0).abs() < 1e-3, "{order:?}: {octave}");
            }
        }
    }
}

/// A bell of 45 µs at half of its height, as pulses of the paper's chain are wide.
fn bell(time_s: f64) -> [f64; 2] {
    [100.0 * ((time_s - 200e-6) / 37e-6).cosh().powi(-4), 0.0]
}

#[test]
fn smooth_forces_half_a_microsecond_apart_are_followed_to_a_millionth() {
    let numbers = Numbers { low_pass_hz: 180e3, ..numbers(LowPass::Second) };
    let every = |interval_s: f64, count: usize| {
        let force = |at: usize| bell(at as f64 * interval_s);
        Amplifier::new(&numbers, interval_s).follow(count, force)
    };
    let (coarse, fine) = (every(0.5e-6, 1000), every(0.5e-6 / 32.0, 32_000));
    let most = fine.iter().copied().fold(0.0, f64::max);
    let off = (coarse.iter().zip(fine.iter().step_by(32))).map(|(a, b)| (a - b).abs() / most);
    let off = off.fold(0.0, f64::max);
    // Straight lines make 4e-5, of whose order h² nothing is left; what is left is of order h⁴.
    assert!(off < 1e-6, "{off}");
}
