//! Curves that stand for the model's in a posterior of many parameters.

use crate::common::{Truth, model, problem, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::{Covariance, CurveProblem, Fit, Fitting, Problem, Surrogate, fit};

/// Largest error of a surrogate in standard errors.
const ALLOWED: f64 = 0.1;

/// Residuals of a surrogate and of its model three standard errors from the best fit along
/// every parameter's own direction.
fn farthest(surrogate: &Surrogate, problem: &CurveProblem, best: &Fit, around: &Covariance) -> f64 {
    // Cᵏ/σₖ, a column of the covariance, is one standard error long whatever the others do.
    let aside = |k: usize, sign: f64| -> Vec<f64> {
        let columns = best.point.iter().zip(&around.matrix);
        let moved = |(value, row): (&f64, &Vec<f64>)| value + sign * 3.0 * row[k] / around.sd[k];
        columns.map(moved).collect()
    };
    let all = 0..best.point.len();
    let points: Vec<Vec<f64>> = all.flat_map(|k| [-1.0, 1.0].map(|sign| aside(k, sign))).collect();
    let (own, exact) = (surrogate.residuals(&points), problem.residuals(&points));
    let mut worst: f64 = 0.0;
    for (own, exact) in own.into_iter().zip(exact) {
        let (own, exact) = (own.unwrap().standardised, exact.unwrap().standardised);
        let pairs = own.iter().zip(&exact);
        worst = pairs.map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
    }
    worst
}

#[test]
fn five_parameters_of_an_oil_have_curves_right_to_a_tenth_of_a_standard_error() {
    let pump = preset("pump").unwrap();
    let truth = Truth::of(&pump, &speeds_m_s(10));
    let free = ["wet.Y", "wet.nu", "wet.eta"];
    let problem = problem(&model(&pump, &free), truth.measured(3));
    let best = fit(&problem, &Fitting::default()).unwrap();
    let around = Covariance::new(problem.parameters(), &best);
    assert_eq!(best.point.len(), 5);
    let surrogate = Surrogate::new(&problem, &best, &around).unwrap();
    assert!(surrogate.error <= ALLOWED, "{}", surrogate.error);
    let finer = problem.clone().with_accuracy(0.1 * problem.model().accuracy);
    let worst = farthest(&surrogate, &finer, &best, &around);
    // Not nought, or it would have been computed.
    assert!(worst > 0.0 && worst <= ALLOWED, "{worst}");
}

#[test]
fn two_parameters_need_no_computed_speed() {
    let dry = preset("dry").unwrap();
    let truth = Truth::of(&dry, &speeds_m_s(8));
    let problem = problem(&model(&dry, &["eta", "B"]), truth.measured(4));
    let best = fit(&problem, &Fitting::default()).unwrap();
    let around = Covariance::new(problem.parameters(), &best);
    let surrogate = Surrogate::new(&problem, &best, &around).unwrap();
    assert_eq!(surrogate.computed_speeds_m_s(), Vec::<f64>::new());
    let worst = farthest(&surrogate, &problem, &best, &around);
    // Beside the surrogate's own error that of the problem's curves, some hundredths.
    assert!(worst > 0.0 && worst <= 2.0 * ALLOWED, "{worst}");
}
