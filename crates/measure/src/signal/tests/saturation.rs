use super::*;

#[test]
fn runs_at_either_rail_are_found_also_at_the_end() {
    let rails = Rails {
        low: -5.0,
        high: 5.0,
    };
    let low = [0.0, -5.0, -5.0, -5.0, 1.0, 1.0, 1.0, 1.0];
    assert!(has_run(&low, rails, 3));
    assert!(!has_run(&low, rails, 4), "neither rail has four");
    assert!(has_run(&[1.0, 5.0, 6.0], rails, 2));
    assert!(!has_run(&[], rails, 1));
}

#[test]
fn rails_hold_what_conversion_to_volts_has_rounded() {
    let rails = |low, high| Rails { low, high };
    assert!(rails(-10.0, 10.0).hold(10.0 - 1e-12));
    assert!(!rails(-10.0, 10.0).hold(10.0 - 1e-4));
    assert!(!rails(f64::NEG_INFINITY, 1.0).hold(0.5));
    assert!(rails(f64::NEG_INFINITY, 1.0).hold(1.0));
}
