use super::*;

fn halvings(order: f64, first: f64, count: i32) -> Halvings {
    let mut halvings = Halvings::default();
    for i in 0..count {
        halvings.note(first * (-order * f64::from(i)).exp2());
    }
    halvings
}

#[test]
fn halvings_to_come_follow_from_the_observed_order() {
    for order in [1.0, 1.5, 2.0, 4.0] {
        let seen = halvings(order, 1e-2, 5);
        let forecast = seen.forecast(1e-9).unwrap();
        assert!((forecast.order - order).abs() < 1e-12, "{forecast:?}");
        let after = seen.last() * (-order * forecast.halvings).exp2();
        // Just enough: one halving less would not do.
        assert!(after <= 1e-9 && after * order.exp2() > 1e-9, "{forecast:?}");
    }
}

#[test]
fn few_or_missing_results_give_no_outlook() {
    assert_eq!(halvings(2.0, 1e-2, 3).forecast(1e-9), None);
    let mut lost = halvings(2.0, f64::INFINITY, 2);
    lost.note(1e-3);
    lost.note(1e-4);
    assert_eq!(lost.forecast(1e-9), None);
}
