use super::*;

#[test]
fn times_rise_evenly_in_either_precision_and_signals_do_not() {
    let times: Vec<f64> = (0..400).map(|i| f64::from(i) * 1e-6 - 1e-4).collect();
    let single: Vec<f64> = times.iter().map(|t| f64::from(*t as f32)).collect();
    for times in [&times, &single] {
        // Single precision's rounding of the ends.
        assert!((even_step(times).unwrap() - 1e-6).abs() < 1e-12);
    }
    let signal: Vec<f64> = times.iter().map(|t| (t * 1e4).tanh()).collect();
    assert_eq!(even_step(&signal), None);
    assert_eq!(even_step(&[0.0; 400]), None);
    assert_eq!(even_step(&times[..8]), None);
}

#[test]
fn the_longer_axis_is_time_unless_told() {
    let axes = |shape: &[usize], rows| Axes::new(shape, rows).unwrap();
    assert_eq!(axes(&[20, 1000], Rows::Auto).shots, Some(0));
    assert_eq!(axes(&[1000, 2], Rows::Auto).channels, Some(1));
    assert_eq!(axes(&[2, 1000], Rows::Channels).channels, Some(0));
    assert_eq!(axes(&[2, 1000], Rows::Times).time, 0);
    let columns = axes(&[1000, 20], Rows::Moments);
    assert_eq!((columns.shots, columns.time), (Some(1), 0));
    assert_eq!(Axes::new(&[1, 1, 1, 1], Rows::Auto), None);
}
