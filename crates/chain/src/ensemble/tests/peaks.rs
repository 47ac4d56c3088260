use super::*;

#[test]
fn equidistant_samples_need_no_differences() {
    let nodes = std::array::from_fn(|i| i as f64 - 3.0);
    let values = std::array::from_fn(|i| (0.7 * i as f64).sin() + 0.1 * (i * i) as f64);
    let [quick, slow] = [through_equidistant(values), through(nodes, values)];
    for (quick, slow) in quick.into_iter().zip(slow) {
        // Rounding alone.
        assert!((quick - slow).abs() < 1e-13, "{quick} {slow}");
    }
}
