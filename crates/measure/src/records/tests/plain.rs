use super::*;

#[test]
fn control_characters_are_written_out_and_all_else_stays() {
    let plain = "a title, 1.5 µs\n\tand a line";
    assert_eq!(without_controls(plain), plain);
    let steering = "\u{1b}[2J\r\u{7}\u{9b}31m\u{7f}";
    let written = "\\u001b[2J\\u000d\\u0007\\u009b31m\\u007f";
    assert_eq!(without_controls(steering), written);
}

#[test]
fn words_that_begin_as_formulas_are_words_and_numbers_stay_numbers() {
    for formula in ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1"] {
        assert_eq!(no_formula(formula), format!("'{formula}"));
    }
    assert_eq!(no_formula("=\u{1b}[2J"), "'=\\u001b[2J");
    for other in ["-1.5e-7", "+3", "dry", "a-b", "", "-inf"] {
        assert_eq!(no_formula(other), other);
    }
}
