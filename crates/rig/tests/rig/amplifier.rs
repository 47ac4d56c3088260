//! The charge amplifier against closed forms.

use hertzchain_experiment::{Amplifier as Numbers, LowPass};
use hertzchain_rig::Amplifier;
use std::f64::consts::{SQRT_2, TAU};

const INTERVAL_S: f64 = 1e-6;

fn numbers(order: LowPass) -> Numbers {
    Numbers {
        sensitivity_c_n: 20e-12,
        wall_sensitivity_c_n: 5e-12,
        gain_v_c: 1e9,
        low_pass_hz: 30e3,
        order,
        high_pass_hz: 200.0,
        noise_v: 0.0,
    }
}

/// Voltages after a step of 3 N in the sensor bead and 4 N at the wall.
fn step_response(order: LowPass, samples: usize) -> Vec<f64> {
    let mut amplifier = Amplifier::new(&numbers(order), INTERVAL_S);
    amplifier.begin(3.0, 4.0);
    (0..samples).map(|_| amplifier.next(3.0, 4.0)).collect()
}

/// G (S₇ F₇ + S_w F_w) of that step in V.
const STEP_V: f64 = 1e9 * (20e-12 * 3.0 + 5e-12 * 4.0);

fn matches(order: LowPass, expected: impl Fn(f64) -> f64) {
    for (at, found) in step_response(order, 20_000).into_iter().enumerate() {
        let time_s = (at + 1) as f64 * INTERVAL_S;
        let expected = STEP_V * expected(time_s);
        // Rounding of 20,000 steps.
        assert!(
            (found - expected).abs() < 1e-12 * STEP_V,
            "{time_s}: {found} {expected}"
        );
    }
}

#[test]
fn a_step_through_a_first_order_low_pass_and_the_high_pass_is_two_exponentials() {
    let (low, high) = (TAU * 30e3, TAU * 200.0);
    matches(LowPass::First, |t| {
        low / (low - high) * ((-high * t).exp() - (-low * t).exp())
    });
}

#[test]
fn a_step_through_a_butterworth_low_pass_overshoots_as_its_closed_form() {
    let (low, high) = (TAU * 30e3, TAU * 200.0);
    let sigma = low / SQRT_2;
    // Partial fractions of ω²/((s + ω_h)(s² + √2 ω s + ω²)).
    let share = low * low / (high * high - SQRT_2 * low * high + low * low);
    matches(LowPass::Second, |t| {
        let (sin, cos) = (sigma * t).sin_cos();
        let ringing = (-sigma * t).exp() * (cos + (1.0 - high / sigma) * sin);
        share * ((-high * t).exp() - ringing)
    });
    let most = step_response(LowPass::Second, 100)
        .into_iter()
        .fold(0.0, f64::max);
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
