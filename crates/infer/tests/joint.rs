//! Several tables, one fit.

use crate::common::{Truth, model, problem, speeds_between, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::{
    Covariance, CurveProblem, Data, Fitting, Identifiability, Model, Observable, Problem,
    Surrogate, fit,
};

fn joint(curves: Vec<(Model, Data)>, own: &[&str]) -> CurveProblem {
    let own: Vec<String> = own.iter().map(|name| (*name).to_owned()).collect();
    let problem = CurveProblem::of_curves(curves, &own);
    let parameters = problem.parameters().to_vec();
    problem.with_parameters(parameters).unwrap()
}

#[test]
fn a_table_that_is_given_twice_has_the_same_fit_and_errors_less_by_root_two() {
    let dry = preset("dry").unwrap();
    let (model, data) = (model(&dry, &["eta", "B"]), Truth::of(&dry, &speeds_m_s(8)).measured(1));
    let one = problem(&model, data.clone());
    let two = joint(vec![(model.clone(), data.clone()), (model, data)], &[]);
    let [first, second] = [&one, &two].map(|problem| {
        let best = fit(problem, &Fitting::default()).unwrap();
        (Covariance::new(problem.parameters(), &best).sd, best)
    });
    for at in [0, 1] {
        // The descent's tolerance and that of derivatives.
        assert!((first.1.point[at] - second.1.point[at]).abs() < 1e-3 * first.0[at]);
        assert!((first.0[at] / second.0[at] - 2_f64.sqrt()).abs() < 0.01);
    }
    assert!((2.0 * first.1.chi_square() - second.1.chi_square()).abs() < 1e-6);
    assert_ne!(one.fingerprint(), two.fingerprint());
    let labels: Vec<String> = [0, 16].map(|at| two.residual_label(at)).into();
    assert_eq!(labels[0], labels[1]);
    assert!(labels[0].starts_with("simulated, line 2"), "{labels:?}");
}

#[test]
fn a_sensor_in_another_bead_separates_a_delay_from_the_stiffness() {
    let near = preset("hertz-viscoelastic").unwrap();
    let far = near.set(&[("sensors.bead", 20.0)]).unwrap();
    let names = ["K", "A", "delay"];
    let curve = |row, seed| {
        let mut data = Truth::of(row, &speeds_between(0.3, 0.6, 6)).measured(seed);
        for row in &mut data.rows {
            row.values[0].as_mut().unwrap().value += 1e-6;
        }
        (model(row, &names), data.only(&[Observable::Incident]))
    };
    let determined = |problem: &CurveProblem| {
        let best = fit(problem, &Fitting::default()).unwrap();
        let label = |at: usize| problem.residual_label(at);
        let found = Identifiability::new(problem.parameters(), &best, label).determined();
        let sd = Covariance::new(problem.parameters(), &best).sd;
        (found, sd, best)
    };
    let (one, sd, _) = determined(&joint(vec![curve(&near, 1)], &[]));
    let (both, joint_sd, best) = determined(&joint(vec![curve(&near, 1), curve(&far, 2)], &[]));
    assert!(one < 3 && both == 3, "{one} {both}");
    assert!(joint_sd[2] < 0.1 * sd[2], "{sd:?} {joint_sd:?}");
    for (at, exact) in [8.792_630_379_6e9, 3.385_289_514_9e-7, 1e-6].into_iter().enumerate() {
        let pull = (best.point[at] - exact) / joint_sd[at];
        assert!(pull.abs() < 3.0, "{at}: {pull}");
    }
}

#[test]
fn numbers_of_their_own_have_one_value_a_table_and_all_others_one() {
    let dry = preset("dry").unwrap();
    let rows = [0.3, 0.9].map(|force_n| dry.with_push(force_n).unwrap());
    let names = ["eta", "B", "near_end.force"];
    let curves = rows
        .iter()
        .zip([1, 2])
        .map(|(row, seed)| (model(row, &names), Truth::of(row, &speeds_m_s(6)).measured(seed)));
    let problem = joint(curves.collect(), &["near_end.force"]);
    let free: Vec<&str> = problem.parameters().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(free, ["eta", "B", "near_end.force#1", "near_end.force#2"]);
    let best = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &best);
    for (at, exact) in [3.2e4, 77.0, 0.3, 0.9].into_iter().enumerate() {
        let pull = (best.point[at] - exact) / covariance.sd[at];
        assert!(pull.abs() < 3.5, "{at}: {pull}");
    }
    // A posterior's curves are interpolated as those of one table.
    let surrogate = Surrogate::new(&problem, &best, &covariance).unwrap();
    assert!(surrogate.is_right(), "{}", surrogate.error);
}

#[test]
fn two_rows_of_one_speed_count_as_one_with_errors_less_by_root_two() {
    let dry = preset("dry").unwrap();
    let model = model(&dry, &["eta", "B"]);
    let mut data = Truth::of(&dry, &speeds_m_s(6)).measured(3);
    data.rows.iter_mut().for_each(|row| row.speed_m_s.sigma = 0.0);
    let twice = data.rows.iter().flat_map(|row| [row.clone(), row.clone()]);
    let twice = Data { rows: twice.collect(), ..data.clone() };
    let [one, two] = [data, twice.clone()].map(|data| {
        let problem = problem(&model, data);
        let best = fit(&problem, &Fitting::default()).unwrap();
        (Covariance::new(problem.parameters(), &best).sd, best.point)
    });
    for at in [0, 1] {
        assert!((one.1[at] - two.1[at]).abs() < 1e-3 * one.0[at]);
        assert!((one.0[at] / two.0[at] - 2_f64.sqrt()).abs() < 0.01);
    }
    let each = crate::common::model(&dry, &["B:each"]).numbers.parameters(&[0.5, 0.5, 0.7]);
    let names: Vec<&str> = each.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["B@0.5", "B@0.5(2)", "B@0.7"]);
}
