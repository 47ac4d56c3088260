use super::*;
use proptest::prelude::*;

const PAGE: f64 = 235.0;

#[test]
fn labels_with_room_lie_centred_side_by_side() {
    let found = stacked(&[(40.0, 50.0, 8.0), (150.0, 60.0, 8.0)], PAGE);
    assert_eq!(found.height, 8.0);
    assert_eq!(found.lefts(), [15.0, 120.0]);
}

impl Stack {
    fn lefts(&self) -> Vec<f64> {
        self.places.iter().map(|place| place.left).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn texts_of_a_stack_neither_touch_nor_leave_the_page(
        labels in prop::collection::vec((0.0..PAGE, 5.0..122.0, 8.0..25.0), 0..7),
    ) {
        let found = stacked(&labels, PAGE);
        for (i, (a, size)) in found.places.iter().zip(&labels).enumerate() {
            prop_assert!(a.left >= 0.0 && a.left + size.1 <= PAGE);
            prop_assert!(a.offset + size.2 <= found.height);
            for (b, other) in found.places.iter().zip(&labels).take(i) {
                let beside = a.left >= b.left + other.1 || b.left >= a.left + size.1;
                let beyond = a.offset >= b.offset + other.2 || b.offset >= a.offset + size.2;
                prop_assert!(beside || beyond, "{found:?}");
            }
        }
    }
}
