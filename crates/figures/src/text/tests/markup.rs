use super::*;

fn run(text: &str, style: Style, script: Script) -> Run {
    Run {
        text: text.into(),
        style,
        script,
    }
}

#[test]
fn subscripts_are_italic_unless_marked_upright() {
    let runs = parse(r"$K_{\mathrm{eff}}$ of $v_0$");
    let expected = vec![
        run("K", Style::Italic, Script::Base),
        run("eff", Style::Regular, Script::Sub),
        run(" of ", Style::Regular, Script::Base),
        run("v", Style::Italic, Script::Base),
        run("0", Style::Regular, Script::Sub),
    ];
    assert_eq!(runs, expected);
}

#[test]
fn powers_of_ten_have_a_true_minus_sign() {
    let runs = parse("$10^{-5}$");
    assert_eq!(runs[1], run("−5", Style::Regular, Script::Super));
}

#[test]
fn file_names_outside_dollars_are_literal() {
    assert_eq!(
        parse("hertz_x^2-{a}"),
        vec![run("hertz_x^2-{a}", Style::Regular, Script::Base)]
    );
}

#[test]
fn greek_commands_become_letters() {
    assert_eq!(
        parse(r"$\alpha$"),
        vec![run("α", Style::Italic, Script::Base)]
    );
    assert_eq!(
        parse(r"$\Delta$"),
        vec![run("Δ", Style::Regular, Script::Base)]
    );
}

#[test]
fn malformed_markup_ends_quietly() {
    for source in ["$x_", "$x^{", r"$\mathrm", r"\", "$", r"$\nosuch$", "$_^$"] {
        parse(source);
    }
}
