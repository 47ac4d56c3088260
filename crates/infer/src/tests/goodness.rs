use super::*;

#[test]
fn runs_of_all_orders_are_counted_rightly() {
    // Three above, two below, ten orders by hand:
    // 2 runs: AAABB BBAAA; 5: ABABA; 3: ABBAA AABBA BAAAB; 4: the other four.
    let shares = [2, 3, 4, 5].map(|runs| run_probability(runs, 3, 2));
    let by_hand = [0.2, 0.3, 0.4, 0.1];
    // Rounding.
    assert!(shares.iter().zip(by_hand).all(|(a, b)| (a - b).abs() < 1e-15));
    let found = runs(&[1.0, 2.0, 0.0, 1.0, -1.0, -3.0]).unwrap();
    assert_eq!(found.count, 2);
    assert!((found.probability_fewer - 0.2).abs() < 1e-15);
    assert!((found.expected - 3.4).abs() < 1e-15);
    assert_eq!(runs(&[1.0, 2.0]), None);
}

#[test]
fn squares_of_few_shots_are_one_on_average_and_their_probabilities_even() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    // Means of ten shots over their standard errors, widened as fits widen them.
    let freedom = 9.0_f64;
    let mut residual = || {
        let shots: Vec<f64> = (0..10).map(|_| StandardNormal.sample(&mut rng)).collect();
        let mean = shots.iter().sum::<f64>() / 10.0;
        let squares: f64 = shots.iter().map(|x| (x - mean).powi(2)).sum();
        mean / (squares / freedom / 10.0).sqrt() / (freedom / (freedom - 4.0)).sqrt()
    };
    let mut all = Vec::new();
    for _ in 0..2000 {
        let rows: Vec<(f64, f64)> = (0..20).map(|_| (residual(), freedom)).collect();
        all.push(chi_square_of(rows.into_iter(), 0).unwrap());
    }
    let mean = all.iter().map(|found| found.value).sum::<f64>() / 2000.0;
    // Three standard errors of the mean: √(2 × 20 × 1.6/2000).
    assert!((mean - 20.0).abs() < 3.0 * 0.18, "{mean}");
    let below = |p: f64| all.iter().filter(|found| found.probability < p).count();
    // Three standard errors of a count, and a fifth for the distribution, which is not quite a multiple
    // of a chi-square variable's.
    for (p, expected) in [(0.5, 1000.0), (0.1, 200.0), (0.05, 100.0)] {
        let found = below(p) as f64;
        assert!((found - expected).abs() < 0.2 * expected + 3.0 * expected.sqrt(), "{p}: {found}");
    }
}
