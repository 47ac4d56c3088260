use super::*;

#[test]
fn cross_validation_needs_more_speeds_left_than_free_numbers() {
    // Of three speeds two are left, of seven in five parts five.
    assert!(enough(3, 1) && !enough(3, 2) && !enough(2, 1));
    assert!(enough(7, 4) && !enough(7, 5) && enough(25, 5));
}
