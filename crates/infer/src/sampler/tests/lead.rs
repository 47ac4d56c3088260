use super::*;
use crate::random::{Purpose, RandomStream};
use hertzchain_sim::Stop;
use std::thread::scope;

#[test]
fn looks_are_fixed_numbers_of_steps() {
    assert_eq!(test_times(0), (false, 500));
    assert_eq!(test_times(499), (false, 500));
    assert_eq!(test_times(500), (true, 750));
    assert_eq!(test_times(760), (false, 1125));
}

fn normals(seed: u64, count: usize) -> Vec<f64> {
    let mut random = RandomStream::new(seed, Purpose::Folds);
    (0..count).map(|_| random.normal()).collect()
}

#[test]
fn autocorrelation_time_of_a_markov_chain_is_the_closed_form() {
    // x ← φ x + noise forgets with ρ(t) = φᵗ: τ = (1 + φ)/(1 − φ).
    for (seed, phi) in [(1_u64, 0.5_f64), (2, 0.9), (3, 0.0)] {
        let chains: Vec<Vec<f64>> = (0..20)
            .map(|chain| {
                let noise = normals(100 * seed + chain, 5000);
                let width = (1.0 - phi * phi).sqrt();
                let mut x = noise[0];
                let step = |e: &f64| {
                    x = phi * x + width * e;
                    x
                };
                noise[1..].iter().map(step).collect()
            })
            .collect();
        let found = autocorrelation_time(&chains);
        let expected = (1.0 + phi) / (1.0 - phi);
        // Sokal: relative error √(2 (2 window + 1)/n) with a window of 5 τ;
        // the window cuts off e⁻¹⁰ of the sum.
        let error = (2.0 * (10.0 * expected + 1.0) / 1e5).sqrt();
        assert!(found.resolved);
        assert!((found.time / expected - 1.0).abs() < 4.0 * error, "{phi} {}", found.time);
        // Independent of where walkers are: chains agree.
        assert!(split_r_hat(&chains) < (1.0 + 2.0 * expected / 2500.0).sqrt());
    }
}

#[test]
fn chains_at_different_places_are_found_out() {
    let apart: Vec<Vec<f64>> = (0..4)
        .map(|chain| normals(chain, 1000).iter().map(|x| x + chain as f64).collect())
        .collect();
    // Means 0 to 3: B/W = 10/7 of eight halves; chance a few percent.
    let expected = (1.0 + 10.0 / 7.0_f64).sqrt();
    assert!((split_r_hat(&apart) / expected - 1.0).abs() < 0.1);
    // Not forgotten within the chains.
    assert!(!autocorrelation_time(&apart).resolved);
    assert!(split_r_hat(&[vec![1.0, 2.0]]).is_nan());
}

#[test]
fn whoever_is_asked_to_stop_waits_for_no_autocorrelation_time() {
    let chains = [normals(1, 2000), normals(2, 2000)];
    assert!(autocorrelation_time(&chains).resolved);
    let stop = Stop::default();
    stop.ask();
    let stopped = || {
        stop.clone().adopt();
        autocorrelation_time(&chains)
    };
    let found = scope(|scope| scope.spawn(stopped).join()).unwrap();
    // Not one lag was added to the first.
    assert!(!found.resolved && found.time == 1.0);
}
