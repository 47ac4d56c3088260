use super::*;

#[test]
fn contour_of_a_bell_is_a_circle() {
    let middle = |i: usize| -3.0 + 6.0 * (i as f64 + 0.5) / 60.0;
    let bell = |x: f64, y: f64| (-0.5 * (x * x + y * y)).exp();
    let field = Field {
        rows: (0..60).map(|j| (0..60).map(|i| bell(middle(i), middle(j))).collect()).collect(),
        x: (-3.0, 3.0),
        y: (-3.0, 3.0),
    };
    // The circle that holds half of a bell has radius √(2 ln 2); what lies
    // outside of the field and its cells are worth a percent or two.
    let level = field.level(0.5);
    let radius = (2.0 * 2.0_f64.ln()).sqrt();
    assert!((level - 0.5).abs() < 0.02, "{level}");
    let (x, y) = field.contour(0.5);
    let sizes: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).collect();
    let (last, round) = sizes.split_last().unwrap();
    // One closed line; straight pieces over a tenth.
    assert!(last.is_nan() && round.iter().all(|r| (r - radius).abs() < 2e-3));
    assert_eq!((x[0], y[0]), (x[x.len() - 2], y[y.len() - 2]));
}
