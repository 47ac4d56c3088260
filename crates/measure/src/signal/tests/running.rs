use super::*;

#[test]
fn a_mean_of_a_ramp_is_the_ramp_inside() {
    let ramp: Vec<f64> = (0..20).map(f64::from).collect();
    let smooth = triangular_mean(&ramp, 5);
    assert_eq!(smooth[4..16], ramp[4..16]);
    assert_eq!(running_mean(&ramp, 1), ramp);
    assert!(running_mean(&[], 3).is_empty());
}
