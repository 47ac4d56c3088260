use super::*;

fn errors(sigmas: &[f64], moved: &[f64], freedom: f64) -> Errors {
    let mut errors = Errors::new(freedom, 0.0);
    for (sigma, moved) in sigmas.iter().zip(moved) {
        errors.push(*sigma, freedom, *moved);
    }
    errors
}

#[test]
fn without_an_error_of_the_speed_each_has_its_own_sigma() {
    let white = whiten(&[1.0, -6.0], &errors(&[0.5, 3.0], &[0.0, 0.0], f64::INFINITY));
    assert_eq!(white, [(2.0, 0.5_f64.ln()), (-2.0, 3.0_f64.ln())]);
}

#[test]
fn squares_sum_to_those_with_the_inverse_covariance() {
    let (r, sigma, moved) = ([0.7, -0.4], [0.5, 0.3], [0.8, -0.6]);
    let [a, b, c]: [f64; 3] = [0.25 + 0.64, -0.48, 0.09 + 0.36];
    let determinant = a * c - b * b;
    let exact = (r[0] * r[0] * c - 2.0 * r[0] * r[1] * b + r[1] * r[1] * a) / determinant;
    let white = whiten(&r, &errors(&sigma, &moved, f64::INFINITY));
    let squares: f64 = white.iter().map(|(w, _)| w * w).sum();
    let ln_sigmas: f64 = white.iter().map(|(_, l)| l).sum();
    // Rounding of some ten operations.
    assert!((squares - exact).abs() < 1e-14, "{squares} {exact}");
    assert!((2.0 * ln_sigmas - determinant.ln()).abs() < 1e-14);
}

#[test]
fn errors_that_are_correlated_among_themselves_enter_the_inverse_covariance() {
    let (sigma, moved, correlation) = ([0.5, 0.3], [0.8, -0.6], -0.6);
    let mut errors = errors(&sigma, &moved, 19.0);
    errors.correlation = correlation;
    let r = [0.7, -0.4];
    let [a, b, c]: [f64; 3] = [0.25 + 0.64, -0.48 - 0.6 * 0.15, 0.09 + 0.36];
    let determinant = a * c - b * b;
    let exact = (r[0] * r[0] * c - 2.0 * r[0] * r[1] * b + r[1] * r[1] * a) / determinant;
    let white = whiten(&r, &errors);
    let squares: f64 = white.iter().map(|(w, _)| w * w).sum();
    // Rounding of some ten operations.
    assert!((squares - exact).abs() < 1e-14, "{squares} {exact}");
    // s C⁻¹ s of the speed, the rest of two is the numbers' own.
    let of_speed = (0.64 * c - 2.0 * 0.8 * -0.6 * b + 0.36 * a) / determinant;
    let shares = errors.weighed();
    let q: f64 = shares.iter().zip(&moved).map(|(w, s)| w * s).sum();
    assert!((q / (1.0 + q) - of_speed).abs() < 1e-14, "{q} {of_speed}");
}

#[test]
fn errors_are_widened_by_their_shares_of_a_sum() {
    // One error alone: √(19/15). Two alike in one number: Welch's 38 degrees, √(38/34).
    let alone = errors(&[0.5], &[0.0], 19.0).widened();
    assert!((alone.sigmas[0] / 0.5 - (19.0_f64 / 15.0).sqrt()).abs() < 1e-15);
    let both = errors(&[0.5], &[0.5], 19.0).widened();
    for widened in [both.sigmas[0], both.moved[0]] {
        // Rounding.
        assert!((widened / 0.5 - (38.0_f64 / 34.0).sqrt()).abs() < 1e-15);
    }
    // Known ones, and ones of which nothing is known, stay.
    for freedom in [f64::INFINITY, 4.0] {
        let known = errors(&[0.5, 0.3], &[0.8, -0.6], freedom);
        assert_eq!(known.clone().widened(), known);
    }
}
