use super::*;

#[test]
fn quantised_values_keep_the_range_to_half_a_step() {
    let rows = vec![vec![-2.0, 0.1], vec![0.7, 5.0]];
    let (levels, (lo, hi)) = quantised(&rows);
    let step = (hi - lo) / 65535.0;
    for (level, value) in levels.iter().zip(rows.iter().flatten()) {
        // Half a quantum, and a little for rounding.
        assert!((lo + f64::from(*level) * step - value).abs() <= 0.500001 * step);
    }
}

#[test]
fn resampling_passes_over_what_is_not_finite() {
    let found = resampled(&[0.0, 1.0, 2.0], &[0.0, f64::NAN, 4.0], &[0.0, 1.0, 2.0, 9.0]);
    assert_eq!(found, [0.0, 2.0, 4.0, 4.0]);
}
