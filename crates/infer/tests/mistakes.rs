//! Every mistake has a message that names what to change.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::toys::{Curve, spaced, straight};
use hertzchain_infer::{
    Covariance, Fit, Fitting, InferError, ModelError, Parameter, Prior, Problem, Residuals, fit,
};

type Line = Curve<fn(&[f64], f64) -> f64>;

fn line(parameters: Vec<Parameter>, points: usize) -> Line {
    let x = spaced(0.0, 1.0, points.max(2))[..points].to_vec();
    Curve::drawn(parameters, &x, 0.1, &[1.0, 2.0], 5, straight)
}

fn two() -> Vec<Parameter> {
    vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)]
}

fn refused(problem: &dyn Problem) -> InferError {
    fit(problem, &Fitting::default()).map(|found: Fit| found.point).unwrap_err()
}

#[test]
fn fewer_points_than_parameters_are_refused() {
    let error = refused(&line(two(), 1));
    let text = "1 measured numbers and 0 priors cannot determine 2 parameters";
    assert!(error.to_string().starts_with(text), "{error}");
    assert!(error.to_string().contains("measure more, or free fewer"));
    // As many are enough; a prior counts.
    assert!(fit(&line(two(), 2), &Fitting::default()).is_ok());
    let mut known = two();
    known[1].prior = Prior::Normal { mean: 1.0, sd: 0.5 };
    assert!(fit(&line(known, 1), &Fitting::default()).is_err_and(|e| {
        // One point at x = 0 says nothing of the slope.
        matches!(e, InferError::ChangesNothing { name, .. } if name == "b")
    }));
}

#[test]
fn parameters_that_change_nothing_are_named() {
    let mut free = two();
    free.push(Parameter::new("nu", "", 0.3));
    let error = refused(&line(free, 5));
    assert!(error.to_string().starts_with("nu changes no residual"), "{error}");
    let error = refused(&line(Vec::new(), 5)).to_string();
    assert!(error.starts_with("no parameter is free"), "{error}");
    let twice = vec![Parameter::new("a", "", 1.0), Parameter::new("a", "", 1.0)];
    let error = refused(&line(twice, 5)).to_string();
    assert!(error.starts_with("a is free twice"), "{error}");
}

/// Of a parameter that no residual knows, differences leave rounding alone, along which
/// a descent would go as far as numbers reach.
#[test]
fn a_parameter_that_nothing_measures_is_refused_where_it_starts() {
    let mut free = two();
    free.push(Parameter::new("gain", "", 0.7));
    let found = refused(&line(free, 9));
    let value = 0.7;
    let name = "gain".to_owned();
    assert_eq!(found, InferError::ChangesNothing { name, value });
}

#[test]
fn a_parameter_without_effect_where_it_starts_alone_is_fitted() {
    let cubic: fn(&[f64], f64) -> f64 = |p, x| p[0] + p[1].powi(3) * x;
    let free = vec![Parameter::new("a", "", 1.0), Parameter::new("c", "", 0.01)];
    let x = spaced(0.0, 1.0, 9);
    let data: Line = Curve::drawn(free, &x, 0.01, &[1.0, 1.0], 6, cubic);
    // Twice as much of c moves the farthest point by 7e-6/0.01 standard errors.
    let found = fit(&data, &Fitting::default()).unwrap();
    let sd = Covariance::new(&data.parameters, &found).sd[1];
    assert!((found.point[1] - 1.0).abs() < 3.0 * sd, "{:?}", found.point);
}

#[test]
fn starts_bounds_scales_and_priors_must_agree() {
    type Change = fn(&mut Parameter);
    let cases: [(Change, &str); 7] = [
        (|p| p.lower = 2.0, "outside its bounds 2 to"),
        (|p| p.start = f64::NAN, "starts at NaN, outside its bounds"),
        (|p| p.upper = f64::NAN, "leave nothing between them"),
        (|p| (p.lower, p.upper) = (3.0, 1.0), "leave nothing between them"),
        (|p| p.scale = 0.0, "has the scale 0: expected a positive number"),
        (|p| p.prior = Prior::Normal { mean: 0.0, sd: -1.0 }, "is no distribution"),
        (
            |p| p.prior = Prior::LogNormal { median: 100.0, ln_sd: 0.1 },
            "46.1 standard deviations from the middle of its prior",
        ),
    ];
    for (change, expected) in cases.into_iter() {
        let mut free = two();
        change(&mut free[0]);
        let error = refused(&line(free, 5)).to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
}

#[test]
fn residuals_that_are_no_numbers_name_their_row() {
    let mut data = line(two(), 5);
    data.sigma[3] = 0.0;
    let error = refused(&data).to_string();
    assert!(error.contains("residual 4") && error.contains("uncertainty"), "{error}");
    data.sigma[3] = 0.1;
    data.y[2] = f64::NAN;
    assert!(refused(&data).to_string().contains("residual 3"));
}

#[test]
fn options_out_of_range_are_refused() {
    let data = line(two(), 5);
    let wrong = [
        Fitting { starts: 0, ..Fitting::default() },
        Fitting { tolerance: 0.0, ..Fitting::default() },
        Fitting { loss: hertzchain_infer::Loss::Huber { scale: f64::NAN }, ..Fitting::default() },
    ];
    for how in wrong {
        let error = fit(&data, &how).unwrap_err().to_string();
        assert!(error.contains("expected"), "{error}");
    }
    let hasty = Fitting { iterations: 0, ..Fitting::default() };
    let found = fit(&data, &hasty).unwrap();
    assert!(!found.ending.converged());
    assert!(found.ending.to_string().contains("iterations"), "{}", found.ending);
}

/// A line whose model fails for some points, or returns too little.
struct Failing<F>(Line, F);

impl<F: Fn(&[f64]) -> Option<Result<Residuals, ModelError>> + Sync> Problem for Failing<F> {
    fn parameters(&self) -> &[Parameter] {
        self.0.parameters()
    }
    fn residual_count(&self) -> usize {
        self.0.residual_count()
    }
    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let sound = self.0.residuals(points);
        let all = points.iter().zip(sound);
        all.map(|(point, found)| (self.1)(point).unwrap_or(found)).collect()
    }
}

#[test]
fn a_model_that_fails_somewhere_is_walked_around_and_one_that_fails_at_the_start_is_told() {
    let crushed = || Err(ModelError("the bead is crushed".into()));
    // Fails above b = 2.2; the optimum is near 2.
    let edge = Failing(line(two(), 9), |p: &[f64]| (p[1] > 2.2).then(crushed));
    let found = fit(&edge, &Fitting::default()).unwrap();
    assert!(found.ending.converged(), "{}", found.ending);
    let nowhere = Failing(line(two(), 9), |_: &[f64]| Some(crushed()));
    assert!(refused(&nowhere).to_string().contains("the bead is crushed"));
    let short = Failing(line(two(), 9), |_: &[f64]| Some(Ok(Residuals::new(vec![1.0]))));
    assert!(refused(&short).to_string().contains("returned 1 residuals"));
}

#[test]
fn a_start_where_the_model_fails_is_told_with_its_values() {
    struct Fails(Vec<Parameter>);
    impl hertzchain_infer::Problem for Fails {
        fn parameters(&self) -> &[Parameter] {
            &self.0
        }
        fn residual_count(&self) -> usize {
            4
        }
        fn residuals(
            &self,
            points: &[Vec<f64>],
        ) -> Vec<Result<hertzchain_infer::Residuals, hertzchain_infer::ModelError>> {
            let none = || Err(hertzchain_infer::ModelError("beads overlap".to_owned()));
            points.iter().map(|_| none()).collect()
        }
    }
    let free = vec![Parameter::new("Y", "Pa", 213.0)];
    let reported = fit(&Fails(free), &Fitting::default()).unwrap_err().to_string();
    let expected = "no residuals at the start: with Y = 2.1300e2 Pa: beads overlap";
    assert!(reported.starts_with(expected), "{reported}");
    assert!(reported.contains("--start"), "{reported}");
}
