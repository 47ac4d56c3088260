use super::*;

#[test]
fn bound_of_a_sech_squared_is_its_closed_form() {
    // s = sech²(z/a): ∫ s'² dz = 16/(15 a), and the width is 2 a arcosh √2.
    let (noise, width, interval) = (0.01, 60e-6, 1e-6);
    let a = width / (2.0 * 2.0_f64.sqrt().acosh());
    let by_hand = noise / (16.0 / (15.0 * a) / interval).sqrt();
    let found = cramer_rao_s(&Shape::sech_power(2.0), 1.0, width, interval, noise);
    // The sum over z in steps of a thousandth.
    assert!((found / by_hand - 1.0).abs() < 1e-6, "{found} {by_hand}");
}

#[test]
fn both_forms_of_the_bound_agree() {
    let shape = Shape::cos_power(6.0);
    let pulse: Vec<f64> = (0..300)
        .map(|i| 7.0 * shape.value((f64::from(i) - 150.2) / 60.0))
        .collect();
    let sampled = cramer_rao_of_samples_s(&pulse, 1e-6, 0.07);
    let known = cramer_rao_s(&shape, 7.0, 60e-6, 1e-6, 0.07);
    // Central differences at 60 samples a width.
    assert!((sampled / known - 1.0).abs() < 2e-3, "{sampled} {known}");
}
