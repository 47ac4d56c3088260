use super::*;

fn bump(count: usize, at: f64, width: f64) -> Vec<f64> {
    (0..count).map(|i| ((i as f64 - at) / width).cosh().powi(-4)).collect()
}

#[test]
fn delay_of_a_shifted_pulse_is_its_shift() {
    for shift in [-7.3, -0.5, 0.0, 0.25, 12.0, 31.77] {
        let delay =
            delay_by_cross_correlation(&bump(200, 90.0, 9.0), &bump(220, 90.0 + shift, 9.0), 2e-6);
        // The remainder of the quartic at 9 samples a width is 4e-5 of a sample.
        assert!((delay.unwrap() - 2e-6 * shift).abs() < 1e-4 * 2e-6, "{shift}: {delay:?}");
    }
}

#[test]
fn delay_ignores_the_height_of_the_pulses() {
    let first = bump(100, 40.0, 6.0);
    let second: Vec<f64> = bump(100, 51.5, 6.0).iter().map(|x| 1e4 * x).collect();
    let delay = delay_by_cross_correlation(&first, &second, 1.0).unwrap();
    // As above, at 6 samples a width.
    assert!((delay - 11.5).abs() < 1e-3, "{delay}");
}

#[test]
fn silence_and_nonsense_have_no_delay() {
    let pulse = bump(20, 10.0, 2.0);
    assert_eq!(delay_by_cross_correlation(&[], &pulse, 1.0), None);
    assert_eq!(delay_by_cross_correlation(&pulse, &[0.0; 20], 1.0), None);
    assert_eq!(delay_by_cross_correlation(&pulse, &[f64::NAN; 20], 1.0), None);
}
