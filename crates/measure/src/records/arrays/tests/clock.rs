use super::*;

#[test]
fn times_rise_evenly_in_either_precision_and_signals_do_not() {
    let times: Vec<f64> = (0..400).map(|i| f64::from(i) * 1e-6 - 1e-4).collect();
    let single: Vec<f64> = times.iter().map(|t| f64::from(*t as f32)).collect();
    for times in [&times, &single] {
        // Single precision's rounding of the ends.
        assert!((rises(times).unwrap() - 1e-6).abs() < 1e-12);
    }
    let signal: Vec<f64> = times.iter().map(|t| (t * 1e4).tanh()).collect();
    assert_eq!(rises(&signal), None);
    assert_eq!(rises(&[0.0; 400]), None);
    assert_eq!(rises(&times[..8]), None);
}
