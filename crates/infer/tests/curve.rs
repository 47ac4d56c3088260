//! Predicted curves and their residuals.

use hertzchain_experiment::{Experiment, preset};
use hertzchain_infer::{
    Choices, Covariance, CurveProblem, Data, ExpectedErrors, Fit, Fitting, FreeNumber, FreeNumbers,
    Model, Observable, Problem, Selection, Speeds, design, fit, ways,
};
use hertzchain_sim::{Plan, shoot};

const SPEEDS_M_S: [f64; 4] = [0.1, 0.25, 0.6, 1.2];

fn model(experiment: &Experiment, names: &[&str]) -> Model {
    let numbers = names.iter().map(|name| FreeNumber::find(experiment, name, None).unwrap());
    Model::new(experiment, FreeNumbers::new(numbers.collect()).unwrap()).unwrap()
}

/// Data that lie on the model's own curve, moved by standard errors.
fn table(model: &Model, point: &[f64], moved: f64, speed_error: f64) -> Data {
    let speeds = Speeds::of_rows(&SPEEDS_M_S);
    let curves = model.curves(&[point.to_vec()], &speeds);
    let curve = curves[0].clone().unwrap();
    let mut text = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,\
                    tof_reflected_s_error\n"
        .to_owned();
    for (speed, row) in SPEEDS_M_S.iter().zip(&curve) {
        let (incident, reflected) = (row[0].unwrap(), row[1].unwrap());
        text +=
            &format!("{speed},{speed_error},{},1e-7,{reflected},2e-7\n", incident + moved * 1e-7);
    }
    Data::parse("made", &text, &Selection::default()).unwrap()
}

fn problem(model: &Model, data: Data) -> CurveProblem {
    let parameters = model.numbers.parameters(&data.speeds_m_s());
    CurveProblem::new(model.clone(), data, parameters).unwrap()
}

#[test]
fn a_curve_is_that_of_shots_one_by_one() {
    let dry = preset("dry").unwrap();
    let model = model(&dry, &["eta", "B"]);
    let points = [vec![3.2e4, 77.0], vec![2e4, 40.0], vec![5e4, 120.0]];
    let curves = model.curves(&points, &Speeds::of_rows(&SPEEDS_M_S));
    for (point, curve) in points.iter().zip(curves) {
        let numbers = [("shear_viscosity", point[0]), ("coefficient", point[1])];
        let changed = dry.set(&numbers).unwrap();
        for (speed, row) in SPEEDS_M_S.iter().zip(curve.unwrap()) {
            let (plan, _) = Plan::from_experiment(&changed, Some(*speed)).unwrap();
            let flight = shoot(&plan.with_accuracy(1e-9)).unwrap().flight.unwrap();
            // The accuracy that fits promise of dry chains; docs/explanation/numerics.md.
            let close = |one: f64, two: f64| (one / two - 1.0).abs() < 2e-6;
            assert!(close(row[0].unwrap(), flight.incident_s), "{point:?} {speed}");
            assert!(close(row[1].unwrap(), flight.reflected_s.unwrap()), "{point:?} {speed}");
        }
    }
}

#[test]
fn bits_of_a_point_depend_on_no_neighbour() {
    let model = model(&preset("dry").unwrap(), &["eta", "B"]);
    let speeds = Speeds::of_rows(&SPEEDS_M_S);
    let points: Vec<Vec<f64>> = (0..7).map(|i| vec![3e4 + 1e3 * f64::from(i), 70.0]).collect();
    let together = model.curves(&points, &speeds);
    for (point, curve) in points.iter().zip(together) {
        assert_eq!(model.curves(std::slice::from_ref(point), &speeds)[0], curve);
    }
}

#[test]
fn a_point_that_physics_refuses_is_an_error_of_its_own() {
    let model = model(&preset("dry").unwrap(), &["nu"]);
    let curves = model.curves(&[vec![0.3], vec![1.5], vec![0.2]], &Speeds::of_rows(&[0.5]));
    assert!(curves[0].is_ok() && curves[2].is_ok());
    let error = curves[1].clone().unwrap_err().to_string();
    assert!(error.contains("0.5 m/s") && error.contains("1.5"), "{error}");
}

#[test]
fn residuals_count_standard_errors() {
    let model = model(&preset("dry").unwrap(), &["eta", "B"]);
    let point = vec![3.2e4, 77.0];
    let problem = problem(&model, table(&model, &point, 3.0, 0.0));
    let residuals = problem.residuals(&[point])[0].clone().unwrap();
    assert_eq!(problem.residual_count(), 8);
    for (at, residual) in residuals.standardised.iter().enumerate() {
        let expected = if at % 2 == 0 { 3.0 } else { 0.0 };
        // Ten significant digits of a time of 1e-3 s against an error of 1e-7 s.
        assert!((residual - expected).abs() < 1e-5, "{at}: {residual}");
    }
    assert_eq!(problem.residual_label(1), "line 2, 0.1 m/s, reflected ToF");
}

#[test]
fn an_error_of_the_speed_widens_by_the_slope_of_the_curve() {
    // Without losses the time of flight goes exactly as v^(−1/5): an error of 1 %
    // of the speed is one of 0.2 % of the time.
    let model = model(&preset("hertz").unwrap(), &["Y"]);
    let problem = problem(
        &model,
        table(&model, &[213e9], 0.0, 0.001).only(&[hertzchain_infer::Observable::Incident]),
    );
    let residuals = problem.residuals(&[vec![213e9]])[0].clone().unwrap();
    for ((speed, row), ln_sigma) in
        SPEEDS_M_S.iter().zip(&problem.data().rows).zip(&residuals.ln_sigmas)
    {
        let time = row.values[0].unwrap().value;
        let sigma = (0.2 * time * 0.001 / speed).hypot(1e-7);
        // The solver's 1e-6 over steps of 1 in ln v and more.
        assert!((ln_sigma - sigma.ln()).abs() < 1e-4, "{speed}");
    }
}

#[test]
fn two_speeds_get_their_slopes_from_shots_around_them() {
    let model = model(&preset("hertz").unwrap(), &["Y"]);
    let mut data = table(&model, &[213e9], 0.0, 0.001);
    data.rows.truncate(1);
    let problem = crate::common::problem(&model, data);
    let residuals = problem.residuals(&[vec![213e9]])[0].clone().unwrap();
    let time = problem.data().rows[0].values[0].unwrap().value;
    let sigma = (0.2 * time * 0.001 / SPEEDS_M_S[0]).hypot(1e-7);
    // The solver's 1e-6 over a step of 0.04 in ln v, times the slope of 1/5.
    assert!((residuals.ln_sigmas[0] - sigma.ln()).abs() < 5e-4);
}

#[test]
fn fewer_values_than_parameters_are_refused_by_name() {
    let model = model(&preset("dry").unwrap(), &["eta", "B", "Y"]);
    let mut data = table(&model, &[3.2e4, 77.0, 213e9], 0.0, 0.0);
    data.rows.truncate(1);
    let parameters = model.numbers.parameters(&data.speeds_m_s());
    let error = CurveProblem::new(model, data, parameters).unwrap_err();
    let text = error.to_string();
    assert!(text.contains('2') && text.contains('3'), "{error}");
    assert!(error.to_string().contains("eta, B, Y"), "{error}");
}

/// Speeds in smaller units: waves are slower than such speeds make them.
#[test]
fn times_of_flight_tell_speeds_in_another_unit() {
    let dry = preset("dry").unwrap();
    let model = model(&dry, &["eta"]);
    let measured = crate::common::Truth::of(&dry, &[0.0759, 0.125, 0.25, 0.4]).measured(3);
    for (factor, unit) in [(1.0, None), (100.0, Some("cm/s"))] {
        let mut data = measured.clone();
        for row in &mut data.rows {
            row.speed_m_s.value *= factor;
            row.speed_m_s.sigma *= factor;
        }
        let problem = crate::common::problem(&model, data);
        assert_eq!(problem.curves[0].other_unit_of_speed(&[3.2e4]), unit);
    }
}

/// Exact times of the dry chain, incident to 0.1 µs and reflected to 3 µs, both of six shots; with
/// an incident time more at one speed.
fn rough_returns(model: &Model, more: Option<f64>) -> Data {
    let speeds: Vec<f64> = SPEEDS_M_S.into_iter().chain(more).collect();
    let curve = model.curves(&[vec![3.2e4, 77.0]], &Speeds::of_rows(&speeds)).remove(0).unwrap();
    let mut text = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,\
                    tof_reflected_s_error,tof_correlation,shots\n"
        .to_owned();
    for (at, (speed, row)) in speeds.iter().zip(&curve).enumerate() {
        let reflected = row[1].filter(|_| at < SPEEDS_M_S.len()).map(|time| time.to_string());
        let reflected = reflected.unwrap_or_default();
        text += &format!("{speed},1e-4,{},1e-7,{reflected},3e-6,0,6\n", row[0].unwrap());
    }
    Data::parse("made", &text, &Selection::default()).unwrap()
}

#[test]
fn a_design_promises_what_a_fit_with_the_measurement_has() {
    let dry = preset("dry").unwrap();
    let model = model(&dry, &["eta", "B"]);
    let fitted = |data: Data| -> (CurveProblem, Fit) {
        let problem = problem(&model, data);
        let best = fit(&problem, &Fitting::default()).unwrap();
        (problem, best)
    };
    let (problem, best) = fitted(rough_returns(&model, None));
    let errors = ExpectedErrors::like(problem.data());
    assert_eq!(errors.values, [1e-7, 3e-6, 0.005, 0.005]);
    assert_eq!((errors.freedom.speed, errors.freedom.values[0]), (5.0, 5.0));
    // What has not been measured has the errors of the other time.
    let alone = ExpectedErrors::like(&problem.data().only(&[Observable::Incident]));
    assert_eq!(alone.values[..2], [1e-7, 1e-7]);
    let incident = &ways(&dry, &Choices::default()).unwrap()[..1];
    let candidates = problem.candidates(&best, incident, &[1.0], &errors).unwrap();
    let promised = design(problem.parameters(), &best, &candidates, &[0, 1], 1).unwrap();
    let (with, best) = fitted(rough_returns(&model, Some(1.0)));
    let measured = Covariance::new(with.parameters(), &best);
    for (promised, sd) in promised.ranked[0].after.iter().zip(&measured.sd) {
        // Slopes by the speed come from other neighbours, and noise of the model.
        assert!((promised / sd - 1.0).abs() < 0.02, "{promised} {sd}");
    }
    assert!(promised.ranked[0].gain > 0.1, "{promised:?}");
}

#[test]
fn candidates_at_close_speeds_have_names_of_their_own() {
    let dry = preset("dry").unwrap();
    let problem = problem(&model(&dry, &["eta"]), rough_returns(&model(&dry, &["eta", "B"]), None));
    let best = fit(&problem, &Fitting::default()).unwrap();
    let errors = ExpectedErrors::like(problem.data());
    let incident = &ways(&dry, &Choices::default()).unwrap()[..1];
    let close = [0.1001, 0.1004, 0.100_42];
    let found = problem.candidates(&best, incident, &close, &errors).unwrap();
    let names: Vec<&str> = found.iter().map(|one| one.name.as_str()).collect();
    let expected = ["0.1001 m/s: incident", "0.1004 m/s: incident", "0.10042 m/s: incident"];
    assert_eq!(names, expected);
}
