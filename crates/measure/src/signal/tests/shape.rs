use super::*;

fn all() -> Vec<Shape> {
    let bell = Shape::cos_power(6.0);
    let samples: Vec<f64> = (0..200)
        .map(|i| 3.0 * bell.value((f64::from(i) - 99.3) / 40.0))
        .collect();
    vec![
        bell,
        Shape::sech_power(2.0),
        Shape::sech_power(6.0),
        Shape::sampled(&samples).unwrap(),
    ]
}

#[test]
fn every_shape_is_one_high_and_one_wide() {
    for shape in all() {
        // The sampled one: linear interpolation of its half height, 40 samples wide.
        assert!((shape.value(0.0) - 1.0).abs() < 1e-4, "{shape:?}");
        assert!((shape.value(0.5) - 0.5).abs() < 1e-3);
        assert!((shape.value(-0.5) - 0.5).abs() < 1e-3);
        assert!(shape.slope(0.0).abs() < 1e-2);
    }
}

#[test]
fn slopes_are_the_differences_of_values() {
    for shape in all() {
        for z in [-1.1, -0.6, -0.2, 0.0, 0.3, 0.9, 1.5] {
            let step = 1e-5;
            let by_values = (shape.value(z + step) - shape.value(z - step)) / (2.0 * step);
            // Central differences, and the kink of a cubic's bend at samples.
            assert!((shape.slope(z) - by_values).abs() < 1e-4, "{z}");
        }
    }
}

#[test]
fn what_is_no_pulse_is_no_template() {
    let ramp: Vec<f64> = (0..50).map(f64::from).collect();
    assert!(Shape::sampled(&ramp).is_err());
    assert!(Shape::sampled(&[1.0; 50]).is_err());
    assert!(Shape::sampled(&[0.0, 1.0, 0.0]).is_err());
    assert!(Shape::sampled(&[f64::NAN; 50]).is_err());
}
