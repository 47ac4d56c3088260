use super::*;

#[test]
fn polynomials_of_lower_degree_than_nodes_are_given_back() {
    let f = |x: f64| 1.0 - 2.0 * x + 0.5 * x.powi(4);
    for x in [-1.0, -0.3, 0.0, 0.77, chebyshev(2, 5)] {
        let weights = barycentric(x, 5);
        let sum: f64 = (0..5).map(|n| weights[n] * f(chebyshev(n, 5))).sum();
        // Rounding of ten operations.
        assert!((sum - f(x)).abs() < 1e-14, "{x}: {sum}");
    }
}
