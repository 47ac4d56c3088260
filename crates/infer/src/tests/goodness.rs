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
