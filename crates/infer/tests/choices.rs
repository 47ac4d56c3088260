//! What the data cannot determine apart, which model they support, what to measure next.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::toys::{Curve, normals, spaced, straight};
use hertzchain_infer::{
    Aim, Candidate, Compared, Covariance, Criteria, Ending, Fit, Fitting, Folding, Identifiability,
    Loss, Parameter, Problem, compare, cross_validate, design, fit,
};

fn fit_result(problem: &dyn Problem) -> Fit {
    fit(problem, &Fitting::default()).unwrap()
}

#[test]
fn a_product_is_one_number_and_the_words_say_so() {
    // y = K A x with K = Y k: of three factors, one product is known.
    let free = [("Y", 200.0), ("nu", 0.3), ("eta", 3.0)];
    let data = Curve::drawn(
        free.map(|(name, start)| Parameter::new(name, "", start)).to_vec(),
        &spaced(1.0, 2.0, 9),
        0.02,
        &[210.0, 0.3, 3.0],
        1,
        |p: &[f64], x: f64| 0.01 * p[0] * p[1] * p[2] * x,
    );
    let found = fit_result(&data);
    let reported = Identifiability::new(&data.parameters, &found, |i| data.residual_label(i));
    assert_eq!((reported.determined(), reported.unidentifiable.len()), (1, 2));
    for confusion in &reported.unidentifiable {
        assert!(confusion.standard_error.is_infinite());
        // In a combination that leaves a product, relative changes sum to 0;
        // rounding and the error of differences.
        let sum: f64 = confusion.change.iter().zip(&found.point).map(|(c, p)| c / p).sum();
        assert!(sum.abs() < 1e-8, "{sum}");
        // The largest change is one percent.
        let shares = confusion.change.iter().zip(&found.point).map(|(c, p)| (c / p).abs());
        assert!((shares.fold(0.0, f64::max) - 0.01).abs() < 1e-12); // rounding
        assert!(confusion.effect.iter().all(|e| e.abs() < 1e-5));
        assert!(
            confusion.words.contains("zero within the error of the derivatives"),
            "{}",
            confusion.words
        );
    }
    // The one singular value: ‖∂r/∂ ln(product)‖ times √(Σ (size/value)²).
    let size = data.x.iter().map(|x| {
        let y: f64 = found.point.iter().product::<f64>() * 0.01 * x / 0.02;
        y * y
    });
    let ratio =
        found.point.iter().zip(&data.parameters).map(|(p, q)| (q.scale.max(p.abs()) / p).powi(2));
    let expected = (size.sum::<f64>() * ratio.sum::<f64>()).sqrt();
    // Differences' error.
    assert!((reported.singular_values[0] / expected - 1.0).abs() < 1e-6);
    let covariance = Covariance::new(&data.parameters, &found);
    assert!(covariance.sd.iter().all(|sd| sd.is_infinite()));
    // The product itself is known: relative derivatives along it.
    let along: Vec<f64> = found.point.iter().map(|p| p.recip()).collect();
    let rms = (data.x.iter().map(|x| x * x).sum::<f64>()).sqrt();
    let relative = 0.02 / (0.01 * found.point.iter().product::<f64>() * rms);
    // As above.
    assert!((covariance.sd_of(&along) / relative - 1.0).abs() < 1e-6);
}

#[test]
fn weakly_determined_combinations_have_a_standard_error_in_words() {
    let free = vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)];
    // Points so near each other that offset and slope hardly differ.
    let data = Curve::drawn(free, &spaced(0.99, 1.01, 9), 0.02, &[1.0, 1.0], 1, straight);
    let found = fit_result(&data);
    let reported = Identifiability::new(&data.parameters, &found, |i| format!("row {}", i + 1));
    assert_eq!(reported.unidentifiable.len(), 1);
    let confusion = &reported.unidentifiable[0];
    assert!((1.0..3.0).contains(&confusion.standard_error), "{}", confusion.standard_error);
    assert!(confusion.words.contains("row ") && confusion.words.contains("% only"));
    // Up with the other down.
    assert!(confusion.change[0] * confusion.change[1] < 0.0);
}

/// 0, 1, 2 or 3 powers of x fitted to a parabola.
fn polynomial(order: usize, seed: u64) -> impl Problem {
    let truth = [1.0, 2.0, 1.5];
    let power = |p: &[f64], x: f64| p.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let x = spaced(-1.0, 1.0, 15);
    let noise = normals(seed, 15);
    let names = ["c0", "c1", "c2", "c3"];
    Curve {
        parameters: names[..=order].iter().map(|n| Parameter::new(n, "", 1.0)).collect(),
        y: x.iter().zip(&noise).map(|(x, e)| power(&truth, *x) + 0.2 * e).collect(),
        sigma: vec![0.2; 15],
        x,
        model: power,
    }
}

#[test]
fn left_out_points_of_linear_models_are_foretold_as_the_hat_matrix_says() {
    for order in 1..3 {
        let data = polynomial(order, 2);
        let found = fit_result(&data);
        let reported = cross_validate(&data, &found, &Folding::default()).unwrap();
        let covariance = Covariance::new(data.parameters(), &found);
        for (row, square) in reported.rows.iter().enumerate() {
            // Leave-one-out residual r/(1 − h), h = jᵀ C j.
            let slopes: Vec<f64> = found.jacobian.columns.iter().map(|c| c[row]).collect();
            let hat = covariance.sd_of(&slopes).powi(2);
            let expected = (found.residuals[row] / (1.0 - hat)).powi(2);
            // 4e-5 standard errors of each optimum, times residuals up to 5.
            assert!((square - expected).abs() < 1e-3 * (1.0 + expected), "{row}");
        }
        assert_eq!((reported.folds, reported.unconverged), (15, 0));
    }
}

#[test]
fn the_right_model_is_supported_and_the_sentence_says_by_how_much() {
    let problems: Vec<_> = (0..4).map(|order| polynomial(order, 4)).collect();
    let fits: Vec<Fit> = problems.iter().map(|p| fit_result(p)).collect();
    let crosses: Vec<_> = problems
        .iter()
        .zip(&fits)
        .map(|(p, f)| cross_validate(p, f, &Folding::default()).unwrap())
        .collect();
    let names = ["constant", "line", "parabola", "cubic"];
    let models: Vec<Compared> = (0..4)
        .map(|i| Compared { name: names[i], fit: &fits[i], cross_validation: Some(&crosses[i]) })
        .collect();
    let found = compare(&models).unwrap();
    assert_eq!(found.order[0], 2);
    assert!(found.weights[2] > 0.5 && found.weights[0] < 1e-6);
    assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12); // rounding
    assert!(found.sentence.contains("parabola"), "{}", found.sentence);
    let two = compare(&models[1..3]).unwrap();
    assert!(two.sentence.starts_with("The data support parabola alone: line"), "{}", two.sentence);
    assert!(two.sentence.contains("cross-validated score r² + 2 ln σ +"), "{}", two.sentence);
    let Criteria { aic, aicc, bic, deviance, .. } = found.criteria[2];
    assert_eq!(aic, deviance + 6.0);
    // 2 · 3 · 4/11 and 3 ln 15; rounding.
    assert!((aicc - aic - 24.0 / 11.0).abs() < 1e-12);
    assert!((bic - deviance - 3.0 * 15_f64.ln()).abs() < 1e-12);
}

#[test]
fn models_that_cannot_be_compared_are_named() {
    let (line, parabola) = (polynomial(1, 4), polynomial(2, 4));
    let (first, mut second) = (fit_result(&line), fit_result(&parabola));
    let refused = |second: &Fit| {
        let of = |name, fit| Compared { name, fit, cross_validation: None };
        compare(&[of("line", &first), of("other", second)]).unwrap_err()
    };
    second.loss = Loss::Huber { scale: 1.0 };
    assert!(refused(&second).to_string().starts_with("other was fitted with a robust loss"));
    second.residuals.pop();
    assert!(refused(&second).to_string().starts_with("other was fitted to 14 numbers"));
    let alone = Compared { name: "line", fit: &first, cross_validation: None };
    assert!(compare(&[alone]).unwrap_err().to_string().contains("two models"));
}

#[test]
fn folds_keep_groups_together_and_follow_the_seed() {
    let data = polynomial(2, 4);
    let found = fit_result(&data);
    let pairs: Vec<usize> = (0..15).map(|row| row / 2).collect();
    let how = |parts, seed| Folding { groups: pairs.clone(), parts, seed };
    assert_eq!(cross_validate(&data, &found, &how(None, 0)).unwrap().folds, 8);
    let five = |seed| cross_validate(&data, &found, &how(Some(4), seed)).unwrap();
    assert_eq!(five(1), five(1));
    assert_ne!(five(1).rows, five(2).rows);
    for wrong in [how(Some(1), 0), how(Some(9), 0), Folding { groups: vec![0], ..how(None, 0) }] {
        let error = cross_validate(&data, &found, &wrong).unwrap_err();
        assert!(error.to_string().starts_with("number of "), "{error}");
    }
}

fn candidate(name: &str, x: f64, cost: f64) -> Candidate {
    // A line's residual falls by 1/σ and x/σ.
    Candidate {
        name: name.into(),
        rows: vec![vec![-1.0 / 0.2, -x / 0.2]],
        doubts: Vec::new(),
        cost,
    }
}

#[test]
fn designs_rank_by_what_linear_regression_would_gain() {
    let free = vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)];
    let x = spaced(0.0, 1.0, 5);
    let data = Curve::drawn(free, &x, 0.2, &[1.0, 1.0], 3, straight);
    let found = fit_result(&data);
    let candidates =
        [candidate("middle", 0.5, 1.0), candidate("far", 3.0, 1.0), candidate("dear", 4.0, 3.0)];
    let reported = design(&data.parameters, &found, &candidates, &[1], 3).unwrap();
    let slope_sd = |extra: &[f64]| {
        let all: Vec<f64> = x.iter().chain(extra).copied().collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        0.2 / all.iter().map(|x| (x - mean).powi(2)).sum::<f64>().sqrt()
    };
    // Assumed knowledge of 10⁴ scales, squared; differences' rounding.
    assert!((reported.before[0] / slope_sd(&[]) - 1.0).abs() < 1e-7);
    let order: Vec<usize> = reported.ranked.iter().map(|e| e.candidate).collect();
    assert_eq!(order, [1, 2, 0]);
    for expected in &reported.ranked {
        let x = [0.5, 3.0, 4.0][expected.candidate];
        assert!((expected.after[0] / slope_sd(&[x]) - 1.0).abs() < 1e-7);
        let gain = (slope_sd(&[]) / slope_sd(&[x])).ln();
        assert!((expected.gain - gain).abs() < 1e-7);
    }
    // The middle adds nothing to a slope.
    assert!(reported.ranked[2].gain.abs() < 1e-7);
    assert_eq!(reported.greedy[0].candidate, 1);
    assert!(reported.greedy.windows(2).all(|pair| pair[1].after[0] < pair[0].after[0]));
}

#[test]
fn a_candidate_whose_derivatives_jump_says_nothing_and_hides_nothing() {
    let free = vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)];
    let data = Curve::drawn(free, &spaced(0.0, 1.0, 5), 0.2, &[1.0, 1.0], 3, straight);
    let found = fit_result(&data);
    let useful = candidate("useful", 0.5, 1.0);
    let jumping = Candidate {
        name: "jumping".into(),
        rows: vec![vec![1e4, 2e4]],
        doubts: vec![2e4; 2],
        cost: 1.0,
    };
    let alone =
        design(&data.parameters, &found, std::slice::from_ref(&useful), &[0, 1], 1).unwrap();
    let both = design(&data.parameters, &found, &[useful, jumping], &[0, 1], 1).unwrap();
    assert_eq!((&both.ranked[0], &both.before), (&alone.ranked[0], &alone.before));
    // By half its derivative by b it may be wrong: the other half may be right.
    assert!(both.ranked[1].after[0] > 0.9 * both.before[0], "{both:?}");
}

#[test]
fn designs_say_what_would_determine_the_undetermined() {
    let data = Curve::drawn(
        vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)],
        &spaced(1.0, 2.0, 9),
        0.02,
        &[1.0, 1.0],
        1,
        |p: &[f64], x: f64| p[0] * p[1] * x,
    );
    let found = fit_result(&data);
    let alone = Candidate {
        name: "a alone".into(),
        rows: vec![vec![10.0, 0.0]],
        doubts: Vec::new(),
        cost: 1.0,
    };
    let more = Candidate {
        name: "more".into(),
        rows: vec![vec![50.0, 50.0]],
        doubts: Vec::new(),
        cost: 1.0,
    };
    let reported = design(&data.parameters, &found, &[more, alone.clone()], &[0, 1], 1).unwrap();
    assert!(reported.before.iter().all(|sd| sd.is_infinite()));
    assert_eq!(reported.ranked[0].candidate, 1);
    assert!(reported.ranked[1].after.iter().all(|sd| sd.is_infinite()));
    // a alone, to a tenth. Assumed knowledge, squared.
    assert!((reported.ranked[0].after[0] - 0.1).abs() < 1e-6);
    let refused = |candidates: &[Candidate], targets: &[usize]| {
        let error = design(&data.parameters, &found, candidates, targets, 0).unwrap_err();
        error.to_string()
    };
    assert!(refused(&[], &[0]).starts_with("name at least one parameter and one candidate"));
    assert_eq!(
        refused(std::slice::from_ref(&alone), &[2]),
        "there is no parameter 2: the fit has 2"
    );
    let free = Candidate { cost: 0.0, ..alone };
    assert!(refused(&[free], &[0]).contains("expected a positive cost"));
}

type Product = Curve<fn(&[f64], f64) -> f64>;

/// y = a b² x: nothing else than the product is ever measured.
fn product() -> (Product, Fit) {
    let free = vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)];
    let model: fn(&[f64], f64) -> f64 = |p: &[f64], x: f64| p[0] * p[1] * p[1] * x;
    let data = Curve::drawn(free, &spaced(1.0, 2.0, 9), 1e-3, &[1.0, 1.0], 1, model);
    let found = fit_result(&data);
    (data, found)
}

#[test]
fn a_design_ranks_for_what_can_be_determined_where_parameters_can_not() {
    let (data, found) = product();
    let (a, b) = (found.point[0], found.point[1]);
    // What is left of noise in derivatives says nothing, whatever its size.
    let noisy = |name: &str, size: f64| Candidate {
        name: name.into(),
        rows: vec![vec![size * b * b, 2.0 * size * a * b * (1.0 + 1e-6)]],
        doubts: vec![4e-6 * size; 2],
        cost: 1.0,
    };
    let candidates = [noisy("near", 1e5), noisy("far", 3e7)];
    let reported = design(&data.parameters, &found, &candidates, &[0, 1], 2).unwrap();
    assert_eq!(reported.not_identifiable, [0, 1]);
    assert_eq!(reported.open, ["a up 1.00 % with b down 0.50 %"]);
    let words = "b up 1.00 % with a up 0.50 %".to_owned();
    assert_eq!(reported.aims, [Aim::Combination(words)]);
    assert_eq!(reported.ranked[0].candidate, 1);
    // (a + 2b)/√5 to 1/(√5 · 3e7), the data's share of that and a, b off 1 left out.
    let exact = 1.0 / (5.0_f64.sqrt() * 3e7);
    assert!((reported.ranked[0].after[0] / exact - 1.0).abs() < 5e-3, "{reported:?}");
    assert!(reported.before[0].is_finite());
}

#[test]
fn a_design_around_no_minimum_is_refused() {
    let (data, found) = product();
    let stuck = Fit { ending: Ending::Stuck { expected_fall: 9.0 }, ..found };
    let alone = candidate("alone", 1.0, 1.0);
    let refused = design(&data.parameters, &stuck, &[alone], &[0], 1).unwrap_err();
    assert!(refused.to_string().contains("found no minimum"), "{refused}");
}
