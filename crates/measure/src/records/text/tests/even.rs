use super::*;

/// Times of a sampling with this interval and beginning, printed to `unit`.
fn printed(interval_s: f64, begun_s: f64, unit: f64, count: usize) -> Vec<Printed> {
    let time = |i: usize| begun_s + i as f64 * interval_s;
    let times = (0..count).map(|i| Printed { s: (time(i) / unit).round() * unit, unit_s: unit });
    times.collect()
}

#[test]
fn the_true_interval_is_among_those_that_digits_allow() {
    // No interval but the first is a whole number of units.
    for interval_s in [1e-6, 0.983e-6, 1.0007e-6, 2e-6 / 3.0] {
        for begun_s in [0.0, -3.21e-4, 17.3e-6] {
            for unit in [1e-5, 1e-6, 1e-7, 1e-8, 1e-9] {
                let times = printed(interval_s, begun_s, unit, 4000);
                let reported = even_interval(&times).unwrap();
                let slack = 1e-9 * interval_s;
                let inside = reported.least_s - slack..=reported.most_s + slack;
                assert!(inside.contains(&interval_s), "{interval_s} {unit}: {reported:?}");
                // The ends alone would leave two halves of a unit over all steps.
                assert!(reported.most_s - reported.least_s <= 2.0 * unit / 3999.0 + slack);
            }
        }
    }
}

#[test]
fn digits_that_show_every_step_are_taken_as_they_stand() {
    let reported = even_interval(&printed(2e-6, -1e-3, 1e-6, 1000)).unwrap();
    assert_eq!(reported.least_s, reported.most_s);
    // Rounding.
    assert!((reported.least_s - 2e-6).abs() < 1e-18);
}

#[test]
fn a_lost_sample_is_told_where_digits_show_it() {
    for lost in [1, 500, 998] {
        for unit in [1e-6, 1e-7] {
            let mut times = printed(1e-6, 0.0, unit, 1000);
            times.remove(lost);
            assert!(even_interval(&times).is_none(), "{lost} {unit}");
        }
    }
}

#[test]
fn jitter_beyond_the_digits_is_borne_to_two_fifths_of_a_step() {
    let jittered = |by: f64| {
        let mut times = printed(1e-6, 0.0, 1e-12, 1000);
        times.iter_mut().step_by(7).for_each(|time| time.s += by);
        even_interval(&times)
    };
    let reported = jittered(0.2e-6).unwrap();
    assert!(reported.least_s < 1e-6 && reported.most_s > 1e-6, "{reported:?}");
    assert!(jittered(0.6e-6).is_none());
}

#[test]
fn a_constant_does_not_rise() {
    let constant = printed(0.0, 1e-3, 1e-6, 100);
    assert!(!rises(&constant));
    assert!(rises(&printed(1e-6, -2e-5, 1e-5, 100)));
    let mut step = constant;
    step.iter_mut().skip(60).for_each(|time| time.s += 1e-6);
    assert!(!rises(&step));
}
