//! Residuals of one row, made independent.

/// Lower triangle of a row's covariance.
type Triangle = [[f64; 4]; 4];

/// Standardises what one speed's measurements miss: with their own standard
/// errors σᵢ and `sᵢ`, what an error of the speed of one σ moves each by, their
/// covariance is C = diag(σᵢ²) + s sᵀ. Given C = L Lᵀ the result is L⁻¹ r with
/// ln Lᵢᵢ; the sum of its squares is rᵀ C⁻¹ r.
///
/// The first is standardised by itself, each further one by what it tells beside
/// those before it.
pub(super) fn whiten(residuals: &[f64], sigmas: &[f64], moved: &[f64]) -> Vec<(f64, f64)> {
    let mut triangle: Triangle = [[0.0; 4]; 4];
    let mut white: Vec<(f64, f64)> = Vec::with_capacity(residuals.len());
    for i in 0..residuals.len().min(4) {
        for j in 0..=i {
            let own = if i == j { sigmas[i] * sigmas[i] } else { 0.0 };
            let sum: f64 = (0..j).map(|k| triangle[i][k] * triangle[j][k]).sum();
            let rest = own + moved[i] * moved[j] - sum;
            triangle[i][j] = match i == j {
                true => rest.sqrt(),
                false => rest / triangle[j][j],
            };
        }
        let known: f64 = (0..i).map(|k| triangle[i][k] * white[k].0).sum();
        white.push(((residuals[i] - known) / triangle[i][i], triangle[i][i].ln()));
    }
    white
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_an_error_of_the_speed_each_has_its_own_sigma() {
        let white = whiten(&[1.0, -6.0], &[0.5, 3.0], &[0.0, 0.0]);
        assert_eq!(white, [(2.0, 0.5_f64.ln()), (-2.0, 3.0_f64.ln())]);
    }

    #[test]
    fn squares_sum_to_those_with_the_inverse_covariance() {
        let (r, sigma, moved) = ([0.7, -0.4], [0.5, 0.3], [0.8, -0.6]);
        let [a, b, c]: [f64; 3] = [0.25 + 0.64, -0.48, 0.09 + 0.36];
        let determinant = a * c - b * b;
        let exact = (r[0] * r[0] * c - 2.0 * r[0] * r[1] * b + r[1] * r[1] * a) / determinant;
        let white = whiten(&r, &sigma, &moved);
        let squares: f64 = white.iter().map(|(w, _)| w * w).sum();
        let ln_sigmas: f64 = white.iter().map(|(_, l)| l).sum();
        // Rounding of some ten operations.
        assert!((squares - exact).abs() < 1e-14, "{squares} {exact}");
        assert!((2.0 * ln_sigmas - determinant.ln()).abs() < 1e-14);
    }
}
