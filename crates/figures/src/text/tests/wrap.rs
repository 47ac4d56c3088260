use super::*;

#[test]
fn wrapped_lines_stay_within_the_width() {
    let lines = wrap("time of flight falls strictly with the speed", 7.0, 50.0, 9);
    assert!(lines.len() > 1);
    // What is not cut may be wider by a part in a thousand.
    assert!(lines.iter().all(|l| l.width() <= 50.0 * (1.0 + 1e-3)));
}

#[test]
fn too_many_lines_end_in_an_ellipsis() {
    assert_eq!(wrap("one two three four five", 7.0, 12.0, 2).len(), 2);
}
