use super::*;

#[test]
fn runs_at_either_end_are_found_also_at_the_end() {
    let range = DigitiserRange { low: -5.0, high: 5.0 };
    let low = [0.0, -5.0, -5.0, -5.0, 1.0, 1.0, 1.0, 1.0];
    assert!(range.clips_run(&low, 3));
    assert!(!range.clips_run(&low, 4), "neither end has four");
    assert!(range.clips_run(&[1.0, 5.0, 6.0], 2));
    assert!(!range.clips_run(&[], 1));
}

#[test]
fn range_clips_what_conversion_to_volts_has_rounded() {
    let range = |low, high| DigitiserRange { low, high };
    assert!(range(-10.0, 10.0).clips(10.0 - 1e-12));
    assert!(!range(-10.0, 10.0).clips(10.0 - 1e-4));
    assert!(!range(f64::NEG_INFINITY, 1.0).clips(0.5));
    assert!(range(f64::NEG_INFINITY, 1.0).clips(1.0));
}
