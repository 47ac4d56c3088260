use super::{Expected, progress, rough};

#[test]
fn durations_are_rounded_to_the_largest_unit_that_fits() {
    let times = [0.2, 40.0, 100.0, 6000.0, 200_000.0];
    let words = ["1 s", "40 s", "2 min", "2 h", "2 d"];
    assert_eq!(times.map(rough), words);
}

#[test]
fn progress_beyond_the_estimate_is_no_share_of_it() {
    let expected = Expected { steps: 1000.0, time_s: 40.0 };
    let quarter = "250 steps, t = 1.000e-3 s: about 25 % of this run, 30 s left";
    assert_eq!(progress((250, 1.0), 1e-3, expected), quarter);
    let slow = "250 steps, t = 1.000e-3 s: about 25 % of this run, 60 s left";
    assert_eq!(progress((250, 20.0), 1e-3, expected), slow);
    let beyond = "2000 steps, t = 1.000e-3 s: more than the 1.0e3 steps that were expected";
    assert_eq!(progress((2000, 90.0), 1e-3, expected), beyond);
}
