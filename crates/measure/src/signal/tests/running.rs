use super::*;

#[test]
fn a_mean_of_a_ramp_is_the_ramp_inside() {
    let ramp: Vec<f64> = (0..20).map(f64::from).collect();
    let smooth = triangle(&ramp, 5);
    assert_eq!(smooth[4..16], ramp[4..16]);
    assert_eq!(mean(&ramp, 1), ramp);
    assert!(mean(&[], 3).is_empty());
}
