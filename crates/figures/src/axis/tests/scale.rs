use super::*;

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
