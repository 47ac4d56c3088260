//! Keys, options and TOML itself.

use super::{DRY, after, check, line_of, only};
use crate::Experiment;

#[test]
fn an_unknown_key_names_the_nearest_and_all() {
    let finding = after("bead = 7", "baed = 7");
    let words = ["[sensors] has no key `baed`", "did you mean `bead`", "velocities, channel"];
    check(&finding, line_of("bead = 7"), "baed", &words);
    let finding = after("title =", "titel = \"\"\ntitle =");
    check(&finding, 1, "titel", &["did you mean `title`"]);
}

#[test]
fn a_key_in_the_wrong_table_is_sent_home() {
    let finding = after("bead = 7", "bead = 7\ntension = \"clipped\"");
    let words = ["`tension` belongs at the top of the file"];
    check(&finding, line_of("bead = 7") + 1, "tension", &words);
    let finding = after("title =", "incline = \"1 deg\"\ntitle =");
    check(&finding, 1, "incline", &["`incline` belongs into [track]"]);
}

#[test]
fn options_and_materials_name_the_nearest() {
    let finding = after("kind = \"half-bead\"", "kind = \"halfbead\"");
    check(&finding, line_of("kind ="), "\"halfbead\"", &["did you mean `half-bead`", "plane-stop"]);
    let finding = after("material = \"aisi316\"", "material = \"aisi361\"");
    check(&finding, line_of("material = "), "\"aisi361\"", &["did you mean `aisi316`"]);
    let finding = only(&format!("{DRY}\n[reading]\ncontact_6 = \"damp\"\n"));
    assert!(finding.one_line().contains("expected one of: \"dry\", \"wet\""));
}

#[test]
fn all_mistakes_of_form_come_at_once() {
    let text = DRY
        .replacen("radius =", "raduis =", 1)
        .replacen("young_modulus = \"213 GPa\"", "young_modulus = 213", 1)
        .replacen("bead = 7", "bead = \"seven\"", 1);
    let mistakes = Experiment::from_text("test.toml", &text).unwrap_err();
    let text = mistakes.to_string();
    for words in
        ["`raduis`", "did you mean `radius`", "`young_modulus` has no unit", "`bead` is text"]
    {
        assert!(text.contains(words), "{text} lacks {words}");
    }
}

#[test]
fn syntax_errors_point_at_their_line() {
    let finding = after("count = 40", "count = = 40");
    assert_eq!(finding.line(), line_of("count = 40"));
    assert!(finding.one_line().contains("not valid TOML"));
}
