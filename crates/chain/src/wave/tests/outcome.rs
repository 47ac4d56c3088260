use super::*;

#[test]
fn times_are_written_with_few_digits_and_a_unit() {
    let written = [
        (34.007_123_456, "34.007 s"),
        (1.5e-3, "1.5000 ms"),
        (6.308_415_91e-4, "630.84 µs"),
        (0.0, "0 s"),
        (3.2e-19, "3.20e-19 s"),
        (1.234e7, "1.23e7 s"),
    ];
    for (value, text) in written {
        assert_eq!(time(value), text);
    }
}

#[test]
fn a_motion_that_is_not_finite_says_when_where_why_and_what_to_do() {
    let error =
        SolveError::NotFinite { time_s: 1.234_567_89e-4, body: 8, contact: 8, step_s: Some(2e-6) };
    let text = error.to_string();
    for part in ["123.46 µs", "body 8", "contact 8", "too long", "200.00 ns"] {
        assert!(text.contains(part), "{part} is missing: {text}");
    }
}

#[test]
fn a_step_too_small_is_the_contacts_or_the_resolution_of_times() {
    let text = |time_s| SolveError::StepTooSmall { time_s, step_s: 1e-15, contact: 3 }.to_string();
    assert!(text(1e-3).contains("because of contact 3"), "{}", text(1e-3));
    assert!(text(40.0).contains("double precision"), "{}", text(40.0));
    assert!(!text(40.0).contains("contact"), "{}", text(40.0));
}
