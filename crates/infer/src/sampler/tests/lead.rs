use super::*;

#[test]
fn looks_are_fixed_numbers_of_steps() {
    assert_eq!(looks(0), (false, 500));
    assert_eq!(looks(499), (false, 500));
    assert_eq!(looks(500), (true, 750));
    assert_eq!(looks(760), (false, 1125));
}
