//! Whole pulses: from known parameters to records and back.

use crate::common::model;
use hertzchain_chain::Sensor;
use hertzchain_experiment::preset;
use hertzchain_infer::{Covariance, Fitting, Goodness, Problem, PulseProblem, Pulses, fit};
use hertzchain_measure::signal::Estimate;
use hertzchain_sim::{Plan, shoot};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Sensitivity of the simulated sensors in V/N, and noise of a sample in V.
const GAIN_V_N: f64 = 0.017;
const NOISE_V: f64 = 2e-3;

/// Error of a measured speed in m/s, as the photogate's.
const SPEED_ERROR_M_S: f64 = 5e-4;

/// A shot of the dry chain at a speed, sampled at 1 MHz from 0.6 ms before the
/// impact, upside down and with an offset, as real ones are. A sample's noise keeps a share of
/// that of the one before.
fn record(speed_m_s: f64, seed: u64, separate: bool, memory: f64) -> Vec<Vec<f64>> {
    let dry = preset("dry").unwrap();
    let (plan, _) = Plan::from_experiment(&dry, Some(speed_m_s)).unwrap();
    let sensors = vec![Sensor::Bead(plan.sensor_bead), Sensor::Contact(plan.chain.beads.len())];
    let mut plan = plan.with_accuracy(1e-7).watching(sensors, Some(1e-6));
    plan.duration_s = Some(4e-3);
    let trace = shoot(&plan).unwrap().trace.unwrap();
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = 0.0;
    let mut sample = |force_n: f64| -> f64 {
        let own: f64 = StandardNormal.sample(&mut generator);
        noise = memory * noise + (1.0 - memory * memory).sqrt() * own;
        0.1 - GAIN_V_N * force_n + NOISE_V * noise
    };
    let quiet = [0.0; 600];
    let [bead, wall] = &trace.columns[..] else { unreachable!() };
    let summed: Vec<f64> = bead.iter().zip(wall).map(|(b, w)| b + w).collect();
    let channels = match separate {
        true => vec![bead.clone(), wall.clone()],
        false => vec![summed],
    };
    let channel = |forces: &Vec<f64>| quiet.iter().chain(forces).map(|f| sample(*f)).collect();
    channels.iter().map(channel).collect()
}

fn pulses(speed_m_s: f64, seed: u64, separate: bool) -> Pulses {
    remembering(speed_m_s, seed, (separate, 0.0))
}

fn remembering(speed_m_s: f64, seed: u64, (separate, memory): (bool, f64)) -> Pulses {
    // The photogate errs by one standard error.
    let measured = Estimate {
        value: speed_m_s + if seed.is_multiple_of(2) { SPEED_ERROR_M_S } else { -SPEED_ERROR_M_S },
        sigma: SPEED_ERROR_M_S,
    };
    let volts = record(speed_m_s, seed, separate, memory);
    Pulses::of(&format!("shot {seed}"), (Some(measured), Some(speed_m_s)), 1e-6, &volts).unwrap()
}

fn pulls(records: Vec<Pulses>, free: &[&str], exact: &[f64]) {
    let dry = preset("dry").unwrap();
    let problem =
        PulseProblem::new(model(&dry, free), records, |_, signal, _| signal.to_vec()).unwrap();
    let mut parameters = problem.parameters().to_vec();
    parameters[0].start = 2e4;
    let problem = problem.with_parameters(parameters).unwrap();
    let best = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &best);
    for (at, exact) in exact.iter().enumerate() {
        let pull = (best.point[at] - exact) / covariance.sd[at];
        // Of a thousand seeds three would fail.
        assert!(pull.abs() < 3.0, "{}: {pull}", free[at]);
        assert!(covariance.sd[at] < 0.05 * exact, "{:?}", covariance.sd);
    }
    let goodness = Goodness::with_nuisances(problem.nuisance_count(), &problem, &best);
    let chi_square = goodness.chi_square.unwrap();
    // Noise is white and normal, or made so, so that only chance moves chi-square.
    assert!((1e-3..0.999).contains(&chi_square.probability), "{chi_square:?}");
}

#[test]
fn eta_b_and_the_sensors_gain_come_back_from_whole_pulses() {
    let records = vec![pulses(0.2, 1, false), pulses(0.4, 2, false), pulses(0.8, 3, false)];
    pulls(records, &["eta", "B", "sensor_gain"], &[3.2e4, 77.0, GAIN_V_N]);
}

#[test]
fn so_they_do_from_channels_of_their_own_with_both_gains_free() {
    let records = vec![pulses(0.3, 4, true), pulses(0.7, 5, true)];
    pulls(records, &["eta", "B", "sensor_gain", "wall_gain"], &[3.2e4, 77.0, GAIN_V_N, 1.0]);
}

#[test]
fn noise_that_is_correlated_over_many_samples_is_made_white() {
    let of = |speed_m_s, seed| remembering(speed_m_s, seed, (false, 0.9));
    let records = vec![of(0.2, 1), of(0.4, 2), of(0.8, 3)];
    pulls(records, &["eta", "B", "sensor_gain"], &[3.2e4, 77.0, GAIN_V_N]);
}

#[test]
fn records_that_cannot_be_fitted_say_why() {
    let volts = record(0.5, 6, false, 0.0);
    let speed = Estimate { value: 0.5, sigma: 0.0 };
    let of = |speed, volts: &[Vec<f64>]| Pulses::of("shot", (speed, None), 1e-6, volts);
    let error = of(None, &volts).unwrap_err().to_string();
    assert!(error.starts_with("shot: no speed of the striker"), "{error}");
    let flat = vec![vec![0.0; 3000]];
    let error = of(Some(speed), &flat).unwrap_err().to_string();
    assert!(error.starts_with("shot: "), "{error}");
    // Without anything before the passing pulse, nothing determines the noise.
    let cut = vec![volts[0][760..].to_vec()];
    assert!(of(Some(speed), &cut).is_err());
}

#[test]
fn a_record_whose_shot_the_model_does_not_show_is_left_out_by_name() {
    let dry = preset("dry").unwrap();
    let of = |records| {
        PulseProblem::new(model(&dry, &["eta:each"]), records, |_, signal, _| signal.to_vec())
    };
    let mut broken = pulses(0.7, 8, false);
    (broken.speed_m_s.value, broken.programmed_m_s) = (-0.7, 0.7);
    let problem = of(vec![broken.clone(), pulses(0.4, 7, false)]).unwrap();
    let named = |source: &&str| *source == "shot 7";
    assert!(problem.records.iter().map(|r| r.source.as_str()).all(|s| named(&s)));
    assert_eq!(problem.parameters().len(), 1);
    assert!(problem.left_out[0].contains("-0.7 m/s"), "{:?}", problem.left_out);
    assert!(of(vec![broken]).is_err());
}
