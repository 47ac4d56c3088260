use super::*;

#[test]
fn streamed_json_escapes_the_controls_that_json_leaves_raw() {
    let mut out = Plain { out: Vec::new(), held: Vec::new() };
    serde_json::to_writer(&mut out, "µ\u{9b}31m\u{7f}\u{1b}").unwrap();
    out.flush().unwrap();
    let written = String::from_utf8(out.out).unwrap();
    assert_eq!(written, "\"µ\\u009b31m\\u007f\\u001b\"");
}

#[test]
fn headings_are_bold_and_nothing_else_steers_the_terminal() {
    let text = format!("{}a\u{1b}[2J{}b", BOLD[0], BOLD[1]);
    assert_eq!(shown(&text, true), format!("{}a\\u001b[2J{}b", BOLD[0], BOLD[1]));
    assert!(!shown(&text, false).contains('\u{1b}'));
}
