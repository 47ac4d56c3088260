//! Beads, contacts and bodies are counted from somewhere and end somewhere.

use super::{DRY, after, check, line_of, only};

fn says(finding: &crate::Finding, words: &[&str]) {
    for word in words {
        let line = finding.one_line();
        assert!(line.contains(word), "{line} lacks {word}");
    }
}

#[test]
fn bead_0_is_told_to_be_the_striker_wherever_it_is_written() {
    let words = ["counted from 1", "0 is the striker", "from 1 to 40"];
    let line = line_of("bead = 7");
    check(&after("bead = 7", "bead = 0"), line, "0", &words);
    check(&after("bead = 7", "beads = [3, 0]"), line, "0", &words);
    let moved = "[[initial]]\nbead = 0\nvelocity = \"1 m/s\"";
    let finding = after("[striker]\nspeed = \"0.5 m/s\"", moved);
    check(&finding, line_of("[striker]") + 1, "0", &words);
}

#[test]
fn numbers_that_count_nothing_are_told_the_chain_s_own() {
    for value in ["-1", "7.5", "\"7\"", "true", "[7]", "2000001", "1e400"] {
        says(&after("bead = 7", &format!("bead = {value}")), &["from 1 to 40"]);
    }
    for value in ["-1", "7.5", "\"7\""] {
        let list = |key: &str| after("bead = 7", &format!("{key} = [{value}]"));
        says(&list("beads"), &["from 1 to 40", "counted from 1"]);
        says(&list("contacts"), &["from 0 to 40", "contact 0 lies before bead 1"]);
        says(&list("positions"), &["from 0 to 40", "body 0 is the striker"]);
        let gap = format!("{DRY}\n[[gaps]]\ncontact = {value}\ngap = \"1 um\"\n");
        says(&only(&gap), &["from 0 to 40", "contact 0 lies before bead 1"]);
        let from = after("[[contacts]]\n", &format!("[[contacts]]\nfrom = {value}\n"));
        says(&from, &["from 0 to 40"]);
    }
}

#[test]
fn beads_in_cells_and_several_groups_are_counted() {
    let material = "radius = \"6.35 mm\"\nmass = \"8.54 g\"\nmaterial = \"aisi316\"";
    let cell = "{ count = 2, radius = \"1 mm\", mass = \"1 g\", material = \"aisi316\" }";
    let groups = format!("repeat = 5\ncell = [{cell}, {cell}]\n[[beads]]\n{material}");
    let text = DRY.replace(&format!("count = 40\n{material}"), &groups);
    says(&only(&text.replace("bead = 7", "bead = 0")), &["from 1 to 21"]);
    // A count in error leaves the chain's length open, and is reported as well.
    let unknown = text.replace("repeat = 5", "repeat = \"5\"").replace("bead = 7", "bead = 0");
    let mistakes = crate::Experiment::from_text("test.toml", &unknown);
    let reported = mistakes.unwrap_err().to_string();
    assert!(reported.contains("`repeat` is text") && reported.contains("`bead` = 0"), "{reported}");
}
