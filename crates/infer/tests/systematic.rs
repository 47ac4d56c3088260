//! Systematic errors as nuisance parameters.

use crate::common::{Truth, chains, model, problem, speeds_m_s};
use hertzchain_experiment::{Experiment, preset};
use hertzchain_infer::gauge::{Chains, Gauge, known_oils};
use hertzchain_infer::{
    Covariance, Data, Fit, Fitting, FreeNumber, FreeNumbers, Model, Predicted, Prior, Problem,
    Speeds, fit,
};

/// A model with free numbers and systematic errors of these standard deviations.
fn uncertain(experiment: &Experiment, free: &[&str], known: &[(&str, f64)]) -> Model {
    let free = free.iter().map(|name| FreeNumber::find(experiment, name, None).unwrap());
    let known = known.iter();
    let known = known.map(|(name, sd)| FreeNumber::systematic(experiment, name, *sd).unwrap());
    Model::new(experiment, FreeNumbers::new(free.chain(known).collect()).unwrap()).unwrap()
}

/// A curve without noise, with the paper's errors.
fn exact(truth: &Truth) -> Data {
    let mut data = truth.measured(1);
    for (row, exact) in data.rows.iter_mut().zip(&truth.curve) {
        for (value, exact) in row.values.iter_mut().zip(exact) {
            if let (Some(value), Some(exact)) = (value, exact) {
                value.value = *exact;
            }
        }
    }
    data
}

/// Incident times later by so much.
fn later(mut data: Data, delay_s: f64) -> Data {
    for row in &mut data.rows {
        row.values[0].as_mut().unwrap().value += delay_s;
    }
    data
}

fn fitted(model: &Model, data: Data) -> (Fit, Covariance) {
    let problem = problem(model, data);
    let best = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &best);
    (best, covariance)
}

#[test]
fn a_delay_of_incident_times_moves_viscosity_and_damping_unless_it_is_a_nuisance_parameter() {
    let dry = preset("dry").unwrap();
    let data = later(exact(&Truth::of(&dry, &speeds_m_s(25))), 0.2e-6);
    let pulls = |known: &[(&str, f64)]| {
        let (best, covariance) = fitted(&uncertain(&dry, &["eta", "B"], known), data.clone());
        [(0, 3.2e4), (1, 77.0)].map(|(at, exact)| (best.point[at] - exact) / covariance.sd[at])
    };
    let silent = pulls(&[]);
    assert!(silent.iter().all(|pull| pull.abs() > 3.0), "{silent:?}");
    // The delay lies one standard deviation of its prior off, so that no other can be off by more.
    let allowed = pulls(&[("delay", 0.2e-6)]);
    assert!(allowed.iter().all(|pull| pull.abs() < 1.0), "{allowed:?}");
}

#[test]
fn a_scale_of_speeds_is_silent_where_the_young_modulus_is_free_and_then_widens_its_error() {
    let dry = preset("dry").unwrap();
    let mut data = exact(&Truth::of(&dry, &speeds_m_s(12)));
    for row in &mut data.rows {
        row.speed_m_s.value /= 1.01;
    }
    let young = |known: &[(&str, f64)]| {
        let (best, covariance) = fitted(&uncertain(&dry, &["Y", "eta", "B"], known), data.clone());
        ((best.point[0] - 213e9) / covariance.sd[0], best.chi_square())
    };
    let (pull, chi_square) = young(&[]);
    // 24 numbers, 3 parameters: nothing is seen.
    assert!(pull.abs() > 3.0 && chi_square < 21.0, "{pull} {chi_square}");
    let (pull, _) = young(&[("speed_scale", 0.01)]);
    assert!(pull.abs() < 1.1, "{pull}");
}

#[test]
fn times_and_speeds_and_radii_are_moved_as_the_names_say() {
    let dry = preset("dry").unwrap();
    let speeds = [0.2, 0.9];
    let curve = |model: &Model, point: &[f64], speeds: &[f64]| -> Vec<Predicted> {
        model.curves(&[point.to_vec()], &Speeds::of_rows(speeds)).remove(0).unwrap()
    };
    let plain = curve(&model(&dry, &[]), &[], &speeds);
    let names = ["delay", "reflected_delay", "skew"];
    let delayed = curve(&model(&dry, &names), &[1e-6, 2e-6, 4e-6], &speeds);
    for (delayed, plain) in delayed.iter().zip(&plain) {
        let by = [0, 1].map(|of| delayed[of].unwrap() - plain[of].unwrap());
        // Digits that a time of a millisecond leaves.
        assert!((by[0] - 5e-6).abs() < 1e-15 && (by[1] + 2e-6).abs() < 1e-15, "{by:?}");
    }
    let scaled = curve(&model(&dry, &["speed_scale"]), &[1.25], &speeds);
    let faster = speeds.map(|speed| 1.25 * speed);
    assert_eq!(scaled, curve(&model(&dry, &[]), &[], &faster));
    let radius = dry.get("beads[0].radius").unwrap() + 2e-6;
    let larger = dry.set(&[("beads[0].radius", radius)]).unwrap();
    let moved = curve(&model(&dry, &["radius_error"]), &[2e-6], &speeds);
    assert_eq!(moved, curve(&model(&larger, &[]), &[], &speeds));
}

#[test]
fn a_systematic_error_that_the_data_know_nothing_of_keeps_its_prior() {
    let dry = preset("dry").unwrap();
    let model = uncertain(&dry, &["eta"], &[("radius_error", 5e-6)]);
    let parameters = model.numbers.parameters(&[0.5]);
    assert_eq!(parameters[1].prior, Prior::Normal { mean: 0.0, sd: 5e-6 });
    // One number for two parameters, one of which has a prior.
    let data = exact(&Truth::of(&dry, &[0.5]));
    let data = data.only(&[hertzchain_infer::Observable::Incident]);
    let (_, covariance) = fitted(&model, data);
    assert!((covariance.sd[1] / 5e-6 - 1.0).abs() < 1e-6, "{:?}", covariance.sd);
    let law = FreeNumber::systematic(&preset("pump").unwrap(), "wet.eta", 1.0);
    assert!(law.unwrap_err().to_string().contains("depends on speed"));
}

#[test]
fn the_gauge_names_the_oil_through_a_delay_that_it_is_told_of() {
    let (dry, wet) = (preset("dry").unwrap(), preset("motor").unwrap());
    let measured = |row: &Experiment, delay| later(exact(&Truth::of(row, &speeds_m_s(8))), delay);
    // The trigger was moved between both curves.
    let verdict = |systematic: &[(String, f64)], delay| {
        let chains = Chains { systematic, ..chains(&dry, &wet) };
        let gauge = Gauge::new(&chains, measured(&dry, delay), measured(&wet, delay));
        gauge.unwrap().verdict(&known_oils().unwrap()).unwrap().sentence()
    };
    assert!(verdict(&[], 3e-6).starts_with("None of these"));
    let known = [("delay".to_owned(), 3e-6)];
    for delay in [3e-6, -1e-6] {
        let sentence = verdict(&known, delay);
        assert!(sentence.starts_with("Of the known oils only motor oil"), "{delay}: {sentence}");
    }
}
