use super::*;

#[test]
fn a_rate_that_contradicts_the_file_is_refused_unless_insisted_on() {
    let mut options = ReadOptions { rate_hz: Some(5e5), ..ReadOptions::default() };
    let refused = interval_s(Path::new("x"), Some(1e-6), &options).unwrap_err();
    assert!(matches!(refused, MeasureError::Rate(..)));
    options.trust_rate = true;
    assert_eq!(interval_s(Path::new("x"), Some(1e-6), &options).unwrap(), 2e-6);
}

#[test]
fn the_roundest_rate_that_times_allow_is_taken_and_told() {
    let taken = |least_s, most_s| {
        let reported = FromTimes { least_s, most_s, even_to_s: 1e-5 };
        from_times(Path::new("x"), &reported, None, &ReadOptions::default()).unwrap()
    };
    let round = taken(0.9997e-6, 1.0002e-6);
    // Rounding of 1/1e6.
    assert!((round.s - 1e-6).abs() < 1e-20);
    // A uniform share of what is left on the longer side.
    assert!((round.error_s - 0.3e-9 / 3.0_f64.sqrt()).abs() < 1e-15);
    let note = round.note.unwrap();
    assert!(note.contains("10 µs") && note.contains("0.03 %"), "{note}");
    assert!(note.contains("1000 kHz") && note.contains("--rate"), "{note}");
    let odd = taken(0.9872e-6, 0.9876e-6);
    assert!((odd.s - 0.9874e-6).abs() < 1e-15, "{odd:?}");
    assert!(odd.note.unwrap().contains("middle"));
    let fine = taken(0.98739999e-6, 0.98740001e-6);
    assert_eq!(fine.note, None);
}

#[test]
fn a_rate_that_is_given_or_stated_counts_where_times_allow_it() {
    let reported = FromTimes { least_s: 0.95e-6, most_s: 1.05e-6, even_to_s: 1e-4 };
    let of = |rate_hz, stated_s| {
        let options = ReadOptions { rate_hz, ..ReadOptions::default() };
        from_times(Path::new("x"), &reported, stated_s, &options)
    };
    let given = of(Some(1.03e6), None).unwrap();
    assert_eq!((given.s, given.error_s, given.note), (1.03e6_f64.recip(), 0.0, None));
    assert_eq!(of(None, Some(0.97e-6)).unwrap().s, 0.97e-6);
    assert!(matches!(of(Some(5e5), None), Err(MeasureError::Rate(..))));
}

#[test]
fn impossible_intervals_are_refused() {
    let open = ReadOptions::default();
    for interval in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
        assert!(interval_s(Path::new("x"), Some(interval), &open).is_err());
    }
    assert!(interval_s(Path::new("x"), None, &open).is_err());
}
