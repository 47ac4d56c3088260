//! Advice that helps with what people write in good faith.

use super::{DRY, after, check, line_of, only};

fn says(finding: &crate::Finding, words: &str) {
    let line = finding.one_line();
    assert!(line.contains(words), "{line} lacks {words}");
}

#[test]
fn a_decimal_comma_is_told_to_be_a_point() {
    let radius = |value: &str| after("\"6.35 mm\"\nmass", &format!("{value}\nmass"));
    let line = line_of("radius = \"6.35 mm\"");
    check(&radius("\"6,35 mm\""), line, "\"6,35 mm\"", &["write 6.35 mm"]);
    check(&radius("6,35 mm"), line, "6,35 mm", &["write \"6.35 mm\""]);
    says(&radius("\"6,350 mm\""), "write 6.350 mm, or 6350 mm");
    says(&after("poisson_ratio = 0.3", "poisson_ratio = 0,3"), "write 0.3");
}

#[test]
fn values_without_quotes_are_shown_with_them() {
    let radius = |value: &str| after("\"6.35 mm\"\nmass", &format!("{value}\nmass"));
    for (value, expected) in [
        ("6.35 mm", "expected quotes around a quantity: \"6.35 mm\""),
        ("6.35mm", "expected quotes around a quantity: \"6.35mm\""),
        ("“6.35 mm”", "expected straight quotes: \"6.35 mm\""),
    ] {
        check(&radius(value), line_of("radius = \"6.35 mm\""), value, &[expected]);
    }
    says(
        &after("kind = \"half-bead\"", "kind = half-bead"),
        "expected quotes around a text: \"half-bead\"",
    );
    says(&after("count = 40", "count ="), "expected a value after `=`");
    says(&after("count = 40", "count : 40"), "expected `key = value`");
}

#[test]
fn a_list_that_was_not_opened_is_one_report() {
    let finding = after("laws = [", "laws =");
    assert_eq!(finding.line(), line_of("laws = ["));
    says(&finding, "expected a value after `=`");
}

#[test]
fn keys_of_other_programs_are_told_ours() {
    let contacts = after("[[contacts]]\n", "[[contacts]]\ncontacts = [0, 6]\n");
    check(&contacts, line_of("[[contacts]]") + 1, "contacts", &["`from` and `to`"]);
    says(&after("radius =", "diameter ="), "half the diameter");
    says(&after("kind = \"half-bead\"", "type = \"plane\""), "needs `kind`");
    says(&after("bead = 7", "bead = 7\n[solver]\ntolerance = 1e-9"), "did you mean `accuracy`");
    says(&after("\"elastic_hertz\"", "\"hertz\""), "did you mean `elastic_hertz`");
    let named = after("{ law = \"damping_cubic\"", "{ name = \"damping_cubic\"");
    says(&named, "write `law` in place of `name`");
}

#[test]
fn a_table_without_its_deciding_key_is_told_which() {
    let near = |text: &str| only(&format!("{DRY}\n[near_end]\n{text}\nforce = \"1 N\"\n"));
    let line = DRY.lines().count() + 3;
    let words = ["needs `push`", "push = \"constant\" or \"spring\""];
    check(&near("kind = \"spring\""), line, "kind", &words);
    says(&near("kind = \"free\""), "leave [near_end] out");
    let moved = |motion: &str| {
        after(
            "[striker]\nspeed = \"0.5 m/s\"",
            &format!("[driven]\nmotion = \"{motion}\"\nfile = \"x.csv\""),
        )
    };
    says(&moved("file"), "write motion = \"table\" with file = ");
}

#[test]
fn a_table_in_the_wrong_place_is_sent_to_its_own() {
    let finding = after("bead = 7", "bead = 7\ntrack = \"1 deg\"");
    says(&finding, "`track` belongs into a table of its own, [track]");
}

#[test]
fn materials_without_a_name_are_one_report() {
    let finding = after("[materials.aisi316]", "[materials]");
    let line = line_of("young_modulus");
    check(&finding, line, "young_modulus", &["such as [materials.steel]"]);
}

#[test]
fn an_exponent_in_error_does_not_blame_the_unit_that_follows_it() {
    let power = |rest: &str| {
        let law = format!("{{ law = \"elastic_power\", stiffness = \"1e9 N/m^1.5\"{rest} }}");
        after("\"elastic_hertz\"", &law)
    };
    says(&power(""), "needs `exponent`");
    says(&power(", exponent = 0.5"), "`exponent` is 0.5, but must be from 1 to 100");
    says(&power(", exponent = 1000"), "from 1 to 100");
}

#[test]
fn signs_and_letters_that_only_look_right_are_named() {
    let radius = |value: &str| after("\"6.35 mm\"\nmass", &format!("\"{value}\"\nmass"));
    says(&radius("−6.35 mm"), "write the minus sign of the keyboard");
    says(&radius("nan m"), "is not a finite number");
    says(&radius("6.35 MM"), "did you mean `mm`");
    assert!(!radius("6.35 Q").one_line().contains("did you mean"));
}
