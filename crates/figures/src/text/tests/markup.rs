use super::*;

fn run(text: &str, style: Face, script: Script) -> TextRun {
    TextRun { text: text.into(), style, script }
}

#[test]
fn subscripts_are_italic_unless_marked_upright() {
    let runs = parse(r"$K_{\mathrm{eff}}$ of $v_0$");
    let expected = vec![
        run("K", Face::Italic, Script::Base),
        run("eff", Face::Regular, Script::Sub),
        run(" of ", Face::Regular, Script::Base),
        run("v", Face::Italic, Script::Base),
        run("0", Face::Regular, Script::Sub),
    ];
    assert_eq!(runs, expected);
}

#[test]
fn powers_of_ten_have_a_true_minus_sign() {
    let runs = parse("$10^{-5}$");
    assert_eq!(runs[1], run("−5", Face::Regular, Script::Super));
}

#[test]
fn file_names_outside_dollars_are_literal() {
    assert_eq!(parse("hertz_x^2-{a}"), vec![run("hertz_x^2-{a}", Face::Regular, Script::Base)]);
}

#[test]
fn greek_commands_become_letters() {
    assert_eq!(parse(r"$\alpha$"), vec![run("α", Face::Italic, Script::Base)]);
    assert_eq!(parse(r"$\Delta$"), vec![run("Δ", Face::Regular, Script::Base)]);
}

#[test]
fn malformed_markup_ends_quietly() {
    for source in ["$x_", "$x^{", r"$\mathrm", r"\", "$", r"$\nosuch$", "$_^$"] {
        parse(source);
    }
}
