use super::*;

#[test]
fn slopes_of_parabolas_in_the_logarithms_are_exact_everywhere() {
    let speeds: [f64; 6] = [0.075, 0.0751, 0.1, 0.24, 0.6, 1.23];
    let y = |at: usize| -> Option<f64> {
        let x: f64 = speeds[at].ln();
        Some((2.0 - 0.2 * x + 0.03 * x * x).exp())
    };
    for row in 0..speeds.len() {
        let slope = Stencil::new(&speeds, row).unwrap().slope(y).unwrap();
        let exact = -0.2 + 0.06 * speeds[row].ln();
        // Rounding: logarithms of order 1 over steps of 0.25 and more.
        assert!((slope - exact).abs() < 1e-13, "{row}: {slope} {exact}");
    }
}

#[test]
fn two_speeds_make_no_parabola() {
    assert_eq!(Stencil::new(&[0.5, 1.0], 0), None);
    assert_eq!(Stencil::new(&[0.5, 0.501, 1.0], 0), None);
}
