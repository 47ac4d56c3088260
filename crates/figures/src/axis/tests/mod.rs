use super::*;
use proptest::prelude::*;

const X_AXIS: Room = Room { length: 180.0, font: 7.0, side_by_side: true };
const Y_AXIS: Room = Room { length: 130.0, font: 7.0, side_by_side: false };

fn labels(lo: f64, hi: f64, log: bool, room: &Room) -> Vec<String> {
    let found = ticks(&Scale { lo, hi, log }, room);
    found.major.into_iter().map(|t| t.label).collect()
}

#[test]
fn log_axis_over_a_partial_decade_is_labelled_one_two_five() {
    assert_eq!(labels(0.07, 1.3, true, &X_AXIS), ["0.1", "0.2", "0.5", "1"]);
}

#[test]
fn log_axis_over_many_decades_is_labelled_with_powers() {
    let found = labels(1e-9, 1e3, true, &Y_AXIS);
    assert!(found.iter().all(|l| l.starts_with("$10^{")), "{found:?}");
    assert!(found.len() >= 3);
}

#[test]
fn log_axis_within_a_fraction_of_a_decade_falls_back_to_even_steps() {
    let found = labels(1.1, 1.45, true, &X_AXIS);
    assert_eq!(found[..3], ["1.10", "1.15", "1.20"]);
}

#[test]
fn ratio_axis_around_one_has_even_decimals() {
    let found = labels(0.96, 1.04, false, &Y_AXIS);
    assert!(found.iter().all(|l| l.len() == 4), "{found:?}");
    assert!(found.contains(&"1.00".to_owned()) && found.contains(&"0.96".to_owned()));
}

#[test]
fn large_numbers_share_a_power_of_ten() {
    let found = ticks(&Scale { lo: 0.0, hi: 3.2e8, log: false }, &X_AXIS);
    assert_eq!(found.exponent, Some(8));
    assert!(found.major.iter().all(|t| t.label.len() <= 3));
}

#[test]
fn negative_labels_have_a_true_minus_sign() {
    assert!(labels(-1.0, 1.0, false, &X_AXIS).contains(&"−1.0".to_owned()));
}

proptest! {
    #[test]
    fn linear_ticks_lie_inside_the_range_and_ascend(
        lo in -1e12_f64..1e12, span in 1e-6_f64..1e12,
    ) {
        let scale = Scale { lo, hi: lo + span.max(lo.abs() * 1e-8), log: false };
        check(&scale);
    }

    #[test]
    fn log_ticks_lie_inside_the_range_and_ascend(
        exponent in -200.0_f64..200.0, decades in 1e-3_f64..60.0,
    ) {
        let lo = 10f64.powf(exponent);
        check(&Scale { lo, hi: lo * 10f64.powf(decades), log: true });
    }
}

fn check(scale: &Scale) {
    for room in [X_AXIS, Y_AXIS] {
        let found = ticks(scale, &room);
        let values: Vec<f64> = found.major.iter().map(|t| t.value).collect();
        assert!(values.windows(2).all(|w| w[1] > w[0]), "{scale:?} {values:?}");
        assert!((2..=12).contains(&values.len()), "{scale:?} {found:?}");
        // Positions may leave the axis by the rounding of a multiple of the step.
        let on_axis = |v: &f64| scale.share(*v).is_some_and(|s| (-1e-6..=1.0 + 1e-6).contains(&s));
        assert!(values.iter().all(on_axis), "{scale:?} {values:?}");
        assert!(found.minor.iter().all(on_axis), "{scale:?}");
    }
}

fn scale_of(values: &[f64], log: bool) -> Scale {
    let mut extent = Extent::new(log);
    values.iter().for_each(|v| extent.add(*v));
    extent.scale(0.05)
}

#[test]
fn log_range_does_not_widen_to_whole_decades() {
    let scale = scale_of(&[0.075, 1.23], true);
    assert!(scale.lo > 0.06 && scale.hi < 1.5, "{scale:?}");
}

#[test]
fn data_an_axis_cannot_show_is_left_out_of_the_range() {
    let scale = scale_of(&[f64::NAN, f64::INFINITY, -3.0, 0.0, 2.0, 4.0], true);
    assert!(scale.lo > 1.0 && scale.hi < 6.0, "{scale:?}");
}

#[test]
fn constant_and_missing_data_still_make_an_axis() {
    for values in [&[][..], &[0.0], &[7.0, 7.0], &[f64::NAN]] {
        for log in [false, true] {
            let scale = scale_of(values, log);
            assert!(scale.hi > scale.lo, "{values:?} {scale:?}");
        }
    }
}

#[test]
fn value_inverts_share() {
    let scale = Scale { lo: 0.02, hi: 3.0, log: true };
    let back = scale.share(scale.value(0.3)).expect("inside the axis");
    // Logarithms and an exponential, a few ulp each.
    assert!((back - 0.3).abs() < 1e-13);
}

#[test]
fn zero_has_no_sign() {
    assert_eq!(fixed(-0.0001, 2), "0.00");
    assert_eq!(fixed(-0.5, 1), "−0.5");
}

#[test]
fn small_powers_are_written_out() {
    assert_eq!(plain(5, -2), "0.05");
    assert_eq!(plain(2, 3), "2000");
    assert_eq!(power(1, -5), "$10^{-5}$");
}
