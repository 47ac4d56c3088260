use super::*;

const ALL: [Loss; 4] = [
    Loss::Squares,
    Loss::SoftL1 { scale: 1.5 },
    Loss::Huber { scale: 1.5 },
    Loss::Cauchy { scale: 1.5 },
];

#[test]
fn influence_is_the_slope_of_the_cost_and_small_residuals_cost_squares() {
    for loss in ALL {
        for residual in [-4.0, -0.7, 0.3, 1.4, 9.0] {
            let h = 1e-5;
            let differences =
                (loss.cost(residual + h).value - loss.cost(residual - h).value) / (2.0 * h);
            let (influence, _) = loss.influence(residual);
            // Rounding over the step: 1e-15/1e-5, times values near 10.
            assert!((influence - differences).abs() < 1e-8, "{loss:?}");
        }
        // Next order is r⁴.
        let small = loss.cost(1e-3).value;
        assert!((small / 0.5e-6 - 1.0).abs() < 1e-6, "{loss:?}");
    }
}

#[test]
fn both_factors_multiply_to_the_gradient() {
    for loss in ALL {
        for residual in [0.5, 1.2] {
            let cost = loss.cost(residual);
            let product = cost.slope_factor * cost.residual_factor * residual;
            assert!((product - loss.influence(residual).0).abs() < 1e-15); // rounding
        }
    }
}
