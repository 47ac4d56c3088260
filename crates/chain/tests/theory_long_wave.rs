//! Long-wave theory against its textbook numbers and against the exact wave.

use hertzchain_chain::theory::long_wave::{LongWave, LongWaveForm, preloaded_speed_beads_s};
use hertzchain_chain::theory::solitary::SolitaryShape;

// Plain arithmetic: a few roundings.
const ROUNDING: f64 = 1e-14;

#[test]
fn nesterenko_speed_is_the_root_of_four_fifths_for_hertz() {
    let speed = LongWave::HERTZ.speed_beads_s(1.0, 1.0, 1.0);
    assert!((speed - 0.8f64.sqrt()).abs() < ROUNDING);
    // Six printed digits.
    assert!((speed - 0.894427).abs() < 5e-7);
}

#[test]
fn speed_scales_as_overlap_to_the_quarter_for_hertz() {
    let at = |overlap: f64| LongWave::HERTZ.speed_beads_s(2.0, 3.0, overlap);
    assert!((at(16.0) / at(1.0) - 2.0).abs() < ROUNDING);
}

#[test]
fn hertz_wave_is_five_beads_long_with_a_fourth_power_cosine() {
    let wave = LongWave::HERTZ;
    let x = 1.1;
    let cosine = (10f64.sqrt() / 5.0 * x).cos();
    assert!((wave.length_beads() - 5.0 * std::f64::consts::PI / 10f64.sqrt()).abs() < ROUNDING);
    assert!((wave.overlap(x) - cosine.powi(4)).abs() < ROUNDING);
    assert_eq!(wave.overlap(2.6), 0.0);
}

#[test]
fn speed_by_overlap_and_by_bead_speed_are_one_wave() {
    for exponent in [1.2, 1.5, 2.0, 3.0] {
        let form = LongWaveForm::Displacement;
        let wave = LongWave { form, exponent };
        let speed = wave.speed_beads_s(5.0, 2.0, 0.3);
        let again = wave.speed_from_bead_speed_beads_s(5.0, 2.0, speed * 0.3);
        assert!((again / speed - 1.0).abs() < ROUNDING);
    }
}

#[test]
fn strain_form_solves_its_own_equation() {
    for exponent in [1.3, 1.5, 2.0] {
        let form = LongWaveForm::Strain;
        let wave = LongWave { form, exponent };
        let (x, h) = (0.7, 1e-3);
        let second = (wave.force(x + h) - 2.0 * wave.force(x) + wave.force(x - h)) / (h * h);
        let gap = wave.speed_squared() * wave.overlap(x) - wave.force(x) - second / 12.0;
        // Truncation h²/12 of the difference and its rounding 1e-16/h².
        assert!(gap.abs() < 1e-6, "{gap:e}");
    }
}

#[test]
fn displacement_form_solves_its_first_integral() {
    for exponent in [1.3, 1.5, 2.0] {
        let form = LongWaveForm::Displacement;
        let wave = LongWave { form, exponent };
        let (x, h) = (0.7, 1e-4);
        let strain: f64 = wave.overlap(x);
        let slope = (wave.overlap(x + h) - wave.overlap(x - h)) / (2.0 * h);
        let gradient = exponent / 24.0 * strain.powf(exponent - 1.0) * slope * slope;
        let gap = 0.5 * wave.speed_squared() * strain * strain
            - strain.powf(exponent + 1.0) / (exponent + 1.0)
            - gradient;
        // Truncation of the central difference.
        assert!(gap.abs() < 1e-7, "{gap:e}");
    }
}

#[test]
fn exact_hertz_speed_lies_between_the_two_forms() {
    let exact = SolitaryShape::hertz().unwrap().speed_squared();
    let strain = LongWave { form: LongWaveForm::Strain, ..LongWave::HERTZ };
    assert!(LongWave::HERTZ.speed_squared() < exact && exact < strain.speed_squared());
}

#[test]
fn both_forms_become_exact_for_wide_waves() {
    // Wide waves are those of exponents near one; the error of the squared speed
    // relative to its distance from 1 must vanish with n - 1.
    let error = |form, exponent: f64| {
        let exact = SolitaryShape::new(exponent).unwrap();
        let wave = LongWave { form, exponent };
        (wave.speed_squared() - exact.speed_squared()).abs() / (exponent - 1.0)
    };
    for form in [LongWaveForm::Displacement, LongWaveForm::Strain] {
        // First order in n - 1: a fifth, with room for the next order.
        assert!(error(form, 1.02) < 0.25 * error(form, 1.1));
    }
}

#[test]
fn preloaded_speed_joins_sound_and_the_touching_chain() {
    let speed = |rest, peak| preloaded_speed_beads_s(1.5, 2.0, 3.0, rest, peak);
    let sound = |rest: f64| (1.5 * 2.0 / 3.0 * rest.sqrt()).sqrt();
    let touching = LongWave::HERTZ.speed_beads_s(2.0, 3.0, 0.4);
    // The formula's own next term: (excess/12 of the sound speed, ξ0/ξm of the touching one).
    assert!((speed(0.4, 0.4 * (1.0 + 1e-9)) / sound(0.4) - 1.0).abs() < 1e-9);
    assert!((speed(1e-14, 0.4) / touching - 1.0).abs() < 1e-12);
    // Both branches meet at the switch: the quotient's rounding, 1e-16/1e-8, and excess².
    let (below, above) = (speed(0.4, 0.4 * 1.000_099_99), speed(0.4, 0.4 * 1.000_100_01));
    assert!((above / below - 1.0).abs() < 5e-8);
}
