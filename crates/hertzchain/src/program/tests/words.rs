use super::*;

#[test]
fn shares_below_what_means_anything_are_told_as_a_limit() {
    assert_eq!(percent(7e-310), "less than 1e-9 %");
    assert_eq!(percent(2e-11), "2e-9 %");
    assert_eq!(percent(0.43), "43 %");
    assert_eq!(percent(0.0), "0 %");
}

#[test]
fn rough_derivatives_are_told_with_the_parameter_and_what_to_do() {
    let free = ["wet.K at 0.31 m/s", "wet.A at 0.31 m/s"].map(|n| Parameter::new(n, "", 1.0));
    let with = |disagreement: Vec<f64>| Jacobian {
        columns: vec![vec![1.0]; 2],
        data_rows: 1,
        steps: vec![1e-3; 2],
        disagreement,
        failing: Vec::new(),
    };
    let reported = rough(&free, &with(vec![0.02, 0.43])).unwrap();
    for word in ["wet.A at 0.31 m/s differ by 43 %", "--method profile", "--accuracy"] {
        assert!(reported.contains(word), "{reported}");
    }
    assert_eq!(rough(&free, &with(vec![0.04, 1e-6])), None);
}

#[test]
fn a_value_that_its_error_dwarfs_is_shown_in_the_errors_size() {
    let angle = Parameter::new("incline", "rad", 1.0);
    assert_eq!(estimate(&angle, 1e-17, 1.1e-5), "(0.0 ± 1.1)·1e-5 rad");
    assert_eq!(estimate(&angle, 8.79e9, 3.4e6), "(8.7900 ± 0.0034)·1e9 rad");
    assert_eq!(estimate(&angle, 77.23, 0.26), "77.23 ± 0.26 rad");
}
