use super::*;
use hertzchain_chain::Sensor;
use hertzchain_infer::{Fitting, FreeNumber, FreeNumbers, fit};
use hertzchain_sim::{Plan, shoot};

/// Time between samples in s, and how many times as densely signals are filtered.
const INTERVAL_S: f64 = 1e-6;
const DENSER: usize = 50;

/// A shot through an experiment's amplifier, with noise of some 1e-5 of its height: a
/// hundredth of what the errors looked for would be.
fn recorded(experiment: &Experiment, speed_m_s: f64) -> Pulses {
    let (plan, _) = Plan::from_experiment(experiment, Some(speed_m_s)).unwrap();
    let sensors = [Sensor::Bead(plan.sensor_bead), Sensor::Contact(plan.chain.beads.len())];
    let fine_s = INTERVAL_S / DENSER as f64;
    let mut plan = plan.with_accuracy(1e-8).watching(sensors.to_vec(), Some(fine_s));
    plan.duration_s = Some(2.5e-3);
    let trace = shoot(&plan).unwrap().trace.unwrap();
    let numbers = experiment.campaign().amplifier;
    let mut amplifier = Amplifier::new(&numbers, fine_s);
    let [bead, wall] = &trace.columns[..] else { unreachable!("two sensors") };
    let signal: Vec<f64> = bead.iter().zip(wall).map(|(b, w)| amplifier.next(*b, *w)).collect();
    let quiet = [0.0; 400];
    let samples = quiet.iter().chain(signal.iter().step_by(DENSER)).enumerate();
    // A fixed sequence without correlation stands for noise.
    let noise = |at: usize| 2e-5 * ((at * at * 7919 % 1009) as f64 / 504.0 - 1.0);
    let volts: Vec<f64> = samples.map(|(at, volts)| volts + noise(at)).collect();
    let speed = Estimate { value: speed_m_s, sigma: 0.0 };
    Pulses::of("shot", (Some(speed), None), INTERVAL_S, &[volts]).unwrap()
}

fn best_fit(rig: &Experiment, model: &Experiment, free: &[&str]) -> Vec<f64> {
    let records = vec![recorded(rig, 0.4), recorded(rig, 1.1)];
    let find = |name: &&str| FreeNumber::find(model, name, None).unwrap();
    let numbers = FreeNumbers::new(free.iter().map(find).collect()).unwrap();
    // So that the solver's own errors are below what is looked for.
    let model = Model::new(model, numbers).unwrap().with_accuracy(1e-7);
    let problem = PulseProblem::new(model, records, filtered).unwrap();
    fit(&problem, &Fitting::default()).unwrap().point
}

#[test]
fn the_model_s_signals_pass_the_filter_as_recorded_ones_do() {
    let rig = hertzchain_experiment::preset("dry").unwrap();
    let amplifier = rig.campaign().amplifier;
    let gain_v_n = amplifier.gain_v_c * amplifier.sensitivity_c_n;
    let gain = best_fit(&rig, &rig, &["sensor_gain"])[0] / gain_v_n;
    // Noise makes 3e-6 of it; sampled at 2 µs before the filter it was 2.5e-4, at 0.25 µs by straight
    // lines alone 1e-5.
    assert!((gain - 1.0).abs() < 1e-5, "{gain}");
}

#[test]
fn another_order_kind_and_corner_of_the_low_pass_are_options_or_free() {
    let plain = hertzchain_experiment::preset("dry").unwrap();
    let rig = plain.with_low_pass(Some(60e3), Some("third"), Some("bessel")).unwrap();
    let model = plain.with_low_pass(None, Some("third"), Some("bessel")).unwrap();
    let found = best_fit(&rig, &model, &["low_pass", "sensor_gain"]);
    // The noise leaves the corner open by some 1e-4.
    assert!((found[0] / 60e3 - 1.0).abs() < 1e-3, "{found:?}");
    let words = rig.campaign().amplifier.filters();
    assert_eq!(
        words,
        "Bessel low-pass of third order at 60 kHz, high-pass of first order at 0.5 Hz"
    );
}
