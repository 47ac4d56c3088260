//! From known parameters to data and back, at the paper's noise.

use crate::common::{Noise, Truth, model, problem, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::{
    Covariance, Criteria, CurveProblem, Data, Fitting, Goodness, Identifiability, Observable,
    Problem, Surrogate, fit,
};
use hertzchain_measure::signal::coverage;

const SPEEDS: usize = 12;

#[test]
fn the_dry_pair_comes_back_within_its_errors_from_a_start_far_off() {
    let dry = preset("dry").unwrap();
    let truth = Truth::of(&dry, &speeds_m_s(SPEEDS));
    let model = model(&dry, &["eta", "B"]);
    let data = truth.measured(1);
    let mut parameters = model.numbers.parameters(&data.speeds_m_s());
    (parameters[0].start, parameters[1].start) = (1e4, 10.0);
    let problem = hertzchain_infer::CurveProblem::new(model, data, parameters).unwrap();
    let best = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &best);
    for (at, exact) in [3.2e4, 77.0].into_iter().enumerate() {
        let pull = (best.point[at] - exact) / covariance.sd[at];
        // Of a thousand seeds three would fail.
        assert!(pull.abs() < 3.0, "{at}: {pull}");
        assert!(covariance.sd[at] / exact < 0.01, "{:?}", covariance.sd);
    }
    let goodness = Goodness::new(&problem, &best);
    assert!(goodness.chi_square.unwrap().probability > 1e-3);
    // Differences by two steps agree, so the derivatives are those of the model.
    assert!(best.jacobian.worst_disagreement() < 0.01);
}

/// How many of its standard errors each of η and B is off in repeated measurements.
fn pulls(sets: u64, measured: impl Fn(&Truth, u64) -> Data) -> [Vec<f64>; 2] {
    repeated(sets, measured).0
}

/// The same, and the probability of each chi-square. A surrogate stands for the model; its error is
/// a small part of σ.
fn repeated(sets: u64, measured: impl Fn(&Truth, u64) -> Data) -> ([Vec<f64>; 2], Vec<f64>) {
    let dry = preset("dry").unwrap();
    let truth = Truth::of(&dry, &speeds_m_s(12));
    let model = model(&dry, &["eta", "B"]);
    let first = problem(&model, truth.measured(0));
    let best = fit(&first, &Fitting::default()).unwrap();
    let around = Covariance::new(first.parameters(), &best);
    let surrogate = Surrogate::new(&first, &best, &around).unwrap();
    assert!(surrogate.error < 0.1, "{}", surrogate.error);
    let mut pulls: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    let mut probabilities = Vec::new();
    for seed in 0..sets {
        let repeated = surrogate.with_data([measured(&truth, 1000 + seed)]).unwrap();
        let best = fit(&repeated, &Fitting::default()).unwrap();
        let covariance = Covariance::new(repeated.parameters(), &best);
        for (at, exact) in [3.2e4, 77.0].into_iter().enumerate() {
            pulls[at].push((best.point[at] - exact) / covariance.sd[at]);
        }
        let goodness = Goodness::new(&repeated, &best);
        probabilities.push(goodness.chi_square.unwrap().probability);
    }
    (pulls, probabilities)
}

/// Largest distance of the share of numbers up to any one from that of uniform numbers, in
/// 1/√n: 1.36 in 5 % of repetitions, 1.63 in 1 %, 1.95 in 0.1 %.
fn kolmogorov(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let at = |(i, value): (usize, &f64)| {
        let (below, above) = (i as f64 / count, (i + 1) as f64 / count);
        (value - below).abs().max((above - value).abs())
    };
    values.iter().enumerate().map(at).fold(0.0, f64::max) * count.sqrt()
}

#[test]
fn probabilities_of_a_right_model_are_uniform_where_both_times_share_the_walls_pick() {
    // Three picks alike: half of either variance is the wall's.
    let noise = Noise { correlation: -0.5, ..Noise::of_the_paper() };
    let (stated, probabilities) = repeated(300, |truth, seed| truth.measured_with(noise, seed));
    let distance = kolmogorov(probabilities);
    assert!(distance < 1.95, "{distance}");
    for pulls in &stated {
        for (factor, share) in [(1.0, 0.6827), (1.96, 0.95)] {
            assert!(off(pulls, factor, share).abs() < 3.0, "{factor}");
        }
    }
    // Taken as independent, right models are refused far too often.
    let (_, probabilities) = repeated(300, |truth, seed| {
        let mut data = truth.measured_with(noise, seed);
        data.rows.iter_mut().for_each(|row| row.correlation = None);
        data
    });
    let refused = probabilities.iter().filter(|p| **p < 0.01).count();
    assert!(refused > 9, "{refused} of 300 at 1 %");
}

/// How far the share of pulls within so many standard errors is off a normal one's, in
/// binomial standard errors.
fn off(pulls: &[f64], factor: f64, share: f64) -> f64 {
    let error = (share * (1.0 - share) / pulls.len() as f64).sqrt();
    (coverage(pulls, factor).unwrap().share - share) / error
}

#[test]
fn intervals_by_covariance_hold_the_truth_as_often_as_they_say() {
    for pulls in &pulls(150, Truth::measured) {
        for (factor, share) in [(1.0, 0.6827), (1.96, 0.95)] {
            let off = off(pulls, factor, share);
            assert!(off.abs() < 3.0, "{factor}: {off}");
        }
    }
}

#[test]
fn so_do_those_of_errors_from_the_scatter_of_twenty_shots() {
    let reported = pulls(600, |truth, seed| truth.measured_by_shots(seed, true));
    let untold = pulls(600, |truth, seed| truth.measured_by_shots(seed, false));
    for (reported, untold) in reported.iter().zip(&untold) {
        for (factor, share) in [(1.0, 0.6827), (1.96, 0.95)] {
            let off = off(reported, factor, share);
            assert!(off.abs() < 3.0, "{factor}: {off}");
        }
        // The same data sets: taken as known, errors are too small in nearly all of them.
        let squares = |pulls: &[f64]| pulls.iter().map(|pull| pull * pull).sum::<f64>();
        let ratio = (squares(untold) / squares(reported)).sqrt();
        // Between one error a row, √(19/15), and two that are alike, √(38/34).
        assert!((1.05..1.13).contains(&ratio), "{ratio}");
    }
}

#[test]
fn leaving_out_the_cubic_term_is_rejected_at_the_papers_noise() {
    let dry = preset("dry").unwrap();
    let data = Truth::of(&dry, &speeds_m_s(SPEEDS)).measured(2);
    let full = problem(&model(&dry, &["eta", "B"]), data.clone());
    let full = fit(&full, &Fitting::default()).unwrap();
    let without = preset("hertz-viscoelastic").unwrap();
    // Even with the stiffness free too, which takes up what it can.
    let poorer = problem(&model(&without, &["eta", "Y"]), data);
    let best = fit(&poorer, &Fitting::default()).unwrap();
    let goodness = Goodness::new(&poorer, &best);
    assert!(goodness.chi_square.unwrap().probability < 1e-6);
    assert!(Criteria::new(&best).aicc - Criteria::new(&full).aicc > 100.0);
}

#[test]
fn three_numbers_of_a_material_are_two_of_its_contacts() {
    let viscoelastic = preset("hertz-viscoelastic").unwrap();
    let data = Truth::of(&viscoelastic, &[0.5]).measured(3);
    let three = model(&viscoelastic, &["Y", "nu", "eta"]);
    let parameters = three.numbers.parameters(&[0.5]);
    // One speed determines two numbers: three can't even be asked for.
    let few = hertzchain_infer::CurveProblem::new(three.clone(), data.clone(), parameters);
    let reported = few.unwrap_err().to_string();
    for words in ["2 measured values for 3 free", "enter only through K and A", "--free K,A"] {
        assert!(reported.contains(words), "{words}: {reported}");
    }
    // Nor do more speeds determine three.
    let data = Truth::of(&viscoelastic, &speeds_m_s(8)).measured(3);
    let three = problem(&three, data.clone());
    let best = fit(&three, &Fitting::default()).unwrap();
    let label = |at: usize| three.residual_label(at);
    let found = Identifiability::new(three.parameters(), &best, label);
    assert_eq!(found.determined(), 2, "{:?}", found.singular_values);
    let advice = three.suggested_measurements(&best);
    // Nor reflected times, peaks, other sensors, a push.
    assert_eq!(advice.prospects.len(), 7, "{advice:?}");
    assert!(advice.prospects.iter().all(|p| p.determined == 2), "{advice:?}");
    let words = advice.words();
    assert!(words[0].contains("enter only through K and A"), "{words:?}");
    assert!(words[1].starts_with("no further data"), "{words:?}");
    // K and A they do determine.
    let two = problem(&model(&viscoelastic, &["K", "A"]), data);
    let best = fit(&two, &Fitting::default()).unwrap();
    let found = Identifiability::new(two.parameters(), &best, |at| two.residual_label(at));
    assert!(found.unidentifiable.is_empty());
    let covariance = Covariance::new(two.parameters(), &best);
    for (at, exact) in [8.792_630_379_6e9, 3.385_289_514_9e-7].into_iter().enumerate() {
        let pull = (best.point[at] - exact) / covariance.sd[at];
        assert!(pull.abs() < 3.0, "{at}: {pull}");
    }
}

/// Errors of 5 µs, of times alone.
fn with_large_errors(mut data: Data) -> Data {
    for row in &mut data.rows {
        row.speed_m_s.sigma = 0.0;
        let values = row.values.iter_mut().flatten();
        values.for_each(|value| value.sigma = 5e-6);
    }
    data
}

#[test]
fn what_suggested_measurements_confused_numbers_is_foretold_with_their_errors() {
    let viscoelastic = preset("hertz-viscoelastic").unwrap();
    let truth = Truth::of(&viscoelastic, &[0.4, 0.5, 0.6]);
    let noise = Noise { speed_m_s: 1e-9, time_s: 1e-12, correlation: 0.0 };
    let both = with_large_errors(truth.measured_with(noise, 1));
    let two = model(&viscoelastic, &["K", "A"]);
    let incident = problem(&two, both.only(&[Observable::Incident]));
    let best = fit(&incident, &Fitting::default()).unwrap();
    let advice = incident.suggested_measurements(&best);
    assert_eq!((advice.now.determined, advice.combinations), (1, 2));
    let reflected =
        advice.prospects.iter().find(|p| p.measure.starts_with("incident, reflected at"));
    let reflected = reflected.unwrap();
    assert_eq!(reflected.determined, 2);
    // What a fit with them comes to.
    let speeds: Vec<f64> = (0..8).map(|at| 0.2 * 6.0_f64.powf(f64::from(at) / 7.0)).collect();
    let more = Truth::of(&viscoelastic, &speeds).measured_with(noise, 2);
    let more = with_large_errors(more.only(&[Observable::Incident, Observable::Reflected]));
    let joint = CurveProblem::of_curves(
        vec![(two.clone(), both.only(&[Observable::Incident])), (two, more)],
        &[],
    );
    let best = fit(&joint, &Fitting::default()).unwrap();
    let sd = Covariance::new(joint.parameters(), &best).sd;
    for (foretold, sd) in reflected.sd.iter().zip(&sd) {
        // The incident fit is off by its descent's tolerance, 5e-5 of errors that are
        // larger than A itself, and so are slopes there.
        assert!((foretold / sd - 1.0).abs() < 0.01, "{foretold} {sd}");
    }
    let words = advice.words().join("; ");
    assert!(words.contains("measure incident, reflected"), "{words}");
    assert!(!words.contains("no further data"), "{words}");
}

/// What counts is the value that was found, not the start's thousandth of it.
#[test]
fn a_start_far_too_low_leaves_nothing_open() {
    let dry = preset("dry").unwrap();
    let data = Truth::of(&dry, &speeds_m_s(6)).measured(7);
    let model = model(&dry, &["eta", "B"]);
    let mut parameters = model.numbers.parameters(&data.speeds_m_s());
    (parameters[0].start, parameters[0].scale) = (32.0, 32.0);
    let problem = hertzchain_infer::CurveProblem::new(model, data, parameters).unwrap();
    let best = fit(&problem, &Fitting::default()).unwrap();
    let label = |at: usize| problem.residual_label(at);
    let found = Identifiability::new(problem.parameters(), &best, label);
    let sd = Covariance::new(problem.parameters(), &best).sd;
    assert!(sd[0] > 32.0, "{sd:?}");
    assert_eq!(found.determined(), 2, "{:?}", found.singular_values);
    assert!(!found.leaves_open(0, sd[0]));
}

#[test]
fn one_speed_and_one_time_tell_one_number() {
    let viscoelastic = preset("hertz-viscoelastic").unwrap();
    let data = Truth::of(&viscoelastic, &[0.5]).measured(4);
    let data = data.only(&[Observable::Incident]);
    let one = model(&viscoelastic, &["K", "A"]);
    let parameters = one.numbers.parameters(&[0.5]);
    let error = hertzchain_infer::CurveProblem::new(one, data, parameters).unwrap_err();
    assert!(error.to_string().contains("1 measured values for 2 free parameters (K, A)"));
}

#[test]
fn data_of_another_integrator_give_the_same_pair() {
    let dry = preset("dry").unwrap();
    let mut truth = Truth::of(&dry, &speeds_m_s(6));
    truth.shot_by_rk4(&dry, 1e-7);
    let problem = problem(&model(&dry, &["eta", "B"]), truth.measured(5));
    let best = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &best);
    for (at, exact) in [3.2e4, 77.0].into_iter().enumerate() {
        let pull = (best.point[at] - exact) / covariance.sd[at];
        assert!(pull.abs() < 3.0, "{at}: {pull}");
    }
}
