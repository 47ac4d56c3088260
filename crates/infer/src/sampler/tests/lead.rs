use super::*;

#[test]
fn looks_are_fixed_numbers_of_steps() {
    assert_eq!(test_times(0), (false, 500));
    assert_eq!(test_times(499), (false, 500));
    assert_eq!(test_times(500), (true, 750));
    assert_eq!(test_times(760), (false, 1125));
}
