use super::*;

#[test]
fn a_shape_is_one_high_and_one_wide() {
    for shape in [2.0, 4.0, 6.0].map(Shape::cos_power) {
        // Rounding.
        assert!((shape.value(0.0) - 1.0).abs() < 1e-12, "{shape:?}");
        assert!((shape.value(0.5) - 0.5).abs() < 1e-12);
        assert!((shape.value(-0.5) - 0.5).abs() < 1e-12);
        assert!(shape.value_slope(0.0).1.abs() < 1e-12);
    }
}

#[test]
fn slopes_are_the_differences_of_values() {
    let shape = Shape::cos_power(6.0);
    for z in [-1.1, -0.6, -0.2, 0.0, 0.3, 0.9, 1.5] {
        let step = 1e-5;
        let by_values = (shape.value(z + step) - shape.value(z - step)) / (2.0 * step);
        // Central differences.
        assert!((shape.value_slope(z).1 - by_values).abs() < 1e-6, "{z}");
    }
}
