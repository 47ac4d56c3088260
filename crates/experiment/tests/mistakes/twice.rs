//! What stands in a file twice: one report that shows both places.

use super::{DRY, after, check, line_of, only};
use crate::Experiment;
use miette::Diagnostic;

/// How many places a report underlines.
fn places(finding: &crate::Finding) -> usize {
    finding.labels().map_or(0, Iterator::count)
}

#[test]
fn a_second_table_is_one_report_that_shows_the_first() {
    let track = "\n[track]\nincline = \"1 deg\"\n\n# again\n[track]\nincline = \"2 deg\"\n\ngravity = \"9 m/s^2\"\n";
    let lines = DRY.lines().count();
    let finding = only(&format!("{DRY}{track}"));
    let words = ["`[track]` stands here a second time", "put all its keys"];
    check(&finding, lines + 6, "track", &words);
    assert_eq!(finding.other_line(), Some(lines + 2));
    assert_eq!(places(&finding), 2);
}

#[test]
fn a_second_material_of_the_same_name_is_one_report() {
    let again = "\n[materials.aisi316]\nyoung_modulus = \"1 GPa\"\npoisson_ratio = 0.2\n";
    let finding = only(&format!("{DRY}{again}"));
    assert_eq!(finding.text(), "aisi316");
    assert_eq!(finding.other_line(), Some(line_of("[materials.aisi316]")));
}

#[test]
fn a_table_after_a_list_of_tables_is_told_the_double_brackets() {
    let finding = only(&format!("{DRY}\n[beads]\ncount = 3\n"));
    let line = DRY.lines().count() + 2;
    check(&finding, line, "beads", &["write [[beads]] to add one more"]);
    assert_eq!(finding.other_line(), Some(line_of("[[beads]]")));
}

#[test]
fn a_second_key_is_one_report_that_shows_the_first() {
    let finding = after("count = 40", "count = 40\ncount = 41");
    let line = line_of("count = 40");
    let words = ["`count` stands here a second time", "keep one of the two"];
    check(&finding, line + 1, "count", &words);
    assert_eq!(finding.other_line(), Some(line));
    let finding = after("\"77 kg s/m^2\" }", "\"77 kg s/m^2\", coefficient = \"7 kg s/m^2\" }");
    assert_eq!(finding.other_line(), Some(finding.line()));
    assert_eq!(places(&finding), 2);
}

#[test]
fn overlapping_sections_are_one_report_with_both_places_and_what_to_write() {
    let two = |first: &str, second: &str| {
        let sections = format!(
            "[[contacts]]\n{first}\nlaws = [\"elastic_hertz\"]\n[[contacts]]\n{second}\nlaws = ["
        );
        only(&DRY.replacen("[[contacts]]\nlaws = [", &sections, 1))
    };
    let line = line_of("[[contacts]]");
    let finding = two("to = 9", "from = 5");
    let words = ["contacts 5 to 9 belong to two sections", "`to = 4`", "`from = 10`"];
    check(&finding, line + 4, "5", &words);
    assert_eq!(finding.other_line(), Some(line + 1));
    assert_eq!(places(&finding), 2);
    let all = two("", "from = 5");
    assert!(all.one_line().contains("no `to` means"), "{}", all.one_line());
    assert_eq!(all.other_line(), Some(line));
    let both = two("", "").one_line();
    assert!(both.contains("several laws on the same contacts"), "{both}");
    let turned = two("from = 2\nto = 8", "to = 5").one_line();
    assert!(turned.contains("`to = 1`"), "{turned}");
}

#[test]
fn the_same_law_twice_in_a_section_is_refused_and_a_sum_of_two_is_not() {
    let finding = after("\"elastic_hertz\",", "\"elastic_hertz\",\n  \"elastic_hertz\",");
    let line = line_of("\"elastic_hertz\"");
    let words = ["law `elastic_hertz` stands twice", "would double"];
    check(&finding, line + 1, "\"elastic_hertz\"", &words);
    assert_eq!(finding.other_line(), Some(line));
    let damping = "{ law = \"damping_cubic\", coefficient = \"7 kg s/m^2\" },";
    let sum = DRY.replacen("\"elastic_hertz\",", &format!("\"elastic_hertz\", {damping}"), 1);
    assert!(Experiment::from_text("test.toml", &sum).is_ok());
}

#[test]
fn gaps_and_initial_states_given_twice_show_both_places() {
    let gaps = "\n[[gaps]]\ncontact = 3\ngap = \"1 um\"\n[[gaps]]\ncontact = 3\ngap = \"2 um\"\n";
    let finding = only(&format!("{DRY}{gaps}"));
    let lines = DRY.lines().count();
    assert_eq!((finding.line(), finding.other_line()), (lines + 6, Some(lines + 3)));
}

#[test]
fn a_misspelt_needed_key_is_not_missed_as_well() {
    for (from, to) in [
        ("speed =", "sped ="),
        ("speed =", "velocity ="),
        ("[[beads]]", "[[bead]]"),
        ("young_modulus =", "E ="),
        ("\"213 GPa\"\npoisson", "{ prefacter = \"213 GPa\", exponent = 0.1 }\npoisson"),
    ] {
        let line = after(from, to).one_line();
        assert!(line.contains("did you mean"), "{line}");
    }
}

#[test]
fn many_tables_given_twice_are_told_without_starting_over_for_each() {
    // Each report looks at the text before it; looking for reports there too
    // would double the work with every table, and 60 never end.
    let text = format!("{DRY}{}", "\n[track]\nincline = \"1 deg\"\n".repeat(60));
    let mistakes = Experiment::from_text("test.toml", &text).unwrap_err();
    assert_eq!(mistakes.findings().len(), 20, "the first 20 are reported");
}

#[test]
fn a_slip_that_all_members_of_a_list_share_is_one_mistake() {
    let table = "[driven]\nmotion = \"table\"\ntimes = [0, 1, 2]\npositions = [\"0 m\", \"1 um\", \"2 um\"]";
    let finding = only(&DRY.replace("[striker]\nspeed = \"0.5 m/s\"", table));
    assert_eq!((finding.text(), finding.line()), ("0", line_of("[striker]") + 2));
}

#[test]
fn braces_left_open_are_one_report() {
    let finding = after("coefficient = \"77 kg s/m^2\" },", "coefficient = \"77 kg s/m^2\"");
    assert!(finding.one_line().contains("not valid TOML"));
}
