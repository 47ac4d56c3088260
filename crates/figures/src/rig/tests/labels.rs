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
        self.places.iter().map(|(left, _)| *left).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn texts_of_a_stack_neither_touch_nor_leave_the_page(
        labels in prop::collection::vec((0.0..PAGE, 5.0..122.0, 8.0..25.0), 0..7),
    ) {
        let found = stacked(&labels, PAGE);
        for (i, ((left, offset), size)) in found.places.iter().zip(&labels).enumerate() {
            prop_assert!(*left >= 0.0 && left + size.1 <= PAGE);
            prop_assert!(offset + size.2 <= found.height);
            for ((other_left, other_offset), other) in found.places.iter().zip(&labels).take(i) {
                let aside = *left >= other_left + other.1 || *other_left >= left + size.1;
                let beyond = *offset >= other_offset + other.2 || *other_offset >= offset + size.2;
                prop_assert!(aside || beyond, "{found:?}");
            }
        }
    }
}
