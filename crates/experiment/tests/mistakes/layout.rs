//! Parts that must fit together.

use super::{DRY, after, check, line_of, only, refused};
use crate::Experiment;

#[test]
fn a_sensor_outside_the_chain_is_told_the_chain() {
    let line = line_of("bead = 7");
    let words = ["sensor bead 41 is outside the chain of 40 beads", "from 1 to 40"];
    check(&after("bead = 7", "bead = 41"), line, "41", &words);
    let finding = after("bead = 7", "bead = 7\ncontacts = [3, 41]");
    check(&finding, line + 1, "41", &["contact 41", "from 0 to 40"]);
}

#[test]
fn what_does_not_exist_has_no_sensor() {
    let free = DRY.replace("kind = \"half-bead\"", "kind = \"free\"");
    let finding = only(&free.replace("bead = 7", "contacts = [40]"));
    assert!(finding.one_line().contains("from 0 to 39"), "{}", finding.one_line());
    let finding = only(&free.replace("bead = 7", "channel = true"));
    assert!(finding.one_line().contains("there is no wall"));
    let initial = DRY
        .replace("[striker]\nspeed = \"0.5 m/s\"", "[[initial]]\nbead = 1\nvelocity = \"1 m/s\"");
    let finding = only(&initial.replace("bead = 7", "velocities = [0]"));
    assert!(finding.one_line().contains("from 1 to 40"), "{}", finding.one_line());
}

#[test]
fn contact_sections_meet_without_overlap_or_hole() {
    let two = |first: &str, second: &str| {
        let section = format!(
            "[[contacts]]\n{first}\nlaws = [\"elastic_hertz\"]\n[[contacts]]\n{second}\nlaws = ["
        );
        only(&DRY.replacen("[[contacts]]\nlaws = [", &section, 1)).one_line()
    };
    assert!(two("to = 7", "from = 7").contains("contact 7 belongs to two sections"));
    assert!(two("to = 6", "from = 8").contains("contact 7 has no laws"));
    assert!(two("to = 6", "from = 7\nto = 30").contains("contacts 31 to 40 have no laws"));
    assert!(two("from = 9\nto = 3", "from = 10").contains("ends before it begins"));
    let file = DRY.replacen("[[contacts]]\n", "[[contacts]]\nto = 41\n", 1);
    let finding = only(&file);
    assert_eq!(finding.text(), "41");
    assert!(finding.one_line().contains("outside the chain of 40 beads"));
}

#[test]
fn keys_that_do_not_go_together_are_told_apart() {
    let finding = after("kind = \"half-bead\"", "kind = \"plane\"\nradius = \"1 mm\"");
    assert!(
        finding.one_line().contains("kind = \"plane\" has no key `radius`"),
        "{}",
        finding.one_line()
    );
    let finding = after(
        "[striker]",
        "[driven]\nmotion = \"pulse\"\namplitude = \"1 um\"\nduration = \"20 us\"\n[striker]",
    );
    assert!(finding.one_line().contains("a striker and a driven end"));
    let finding = after("[striker]\nspeed = \"0.5 m/s\"", "");
    assert!(finding.one_line().contains("nothing sets the chain in motion"));
    let finding = only(&format!("{DRY}\n[solver]\nstep = \"1 us\"\n"));
    assert!(finding.one_line().contains("chooses its own steps"));
    let finding = after("kind = \"half-bead\"", "kind = \"periodic\"");
    assert!(finding.one_line().contains("no near end"));
}

#[test]
fn what_the_physics_refuses_is_found_in_the_file() {
    let free = DRY.replace("kind = \"half-bead\"", "kind = \"free\"");
    let push = "[near_end]\npush = \"constant\"\nforce = \"1 N\"\n";
    let finding = refused(&format!("{free}\n{push}"));
    assert_eq!(finding.text(), "[far_end]");
    assert!(finding.one_line().contains("no rest position"));
    let bare = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n[[contacts]]\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\"]\n";
    let words = ["can't be used on contact 0", "`relaxation_time`"];
    check(&refused(bare), 6, "\"damping_viscoelastic\"", &words);
}

#[test]
fn a_missing_elastic_law_is_found_where_the_laws_are() {
    let without = DRY.replacen("  \"elastic_hertz\",", "", 1);
    let finding = refused(&format!("{without}\n[track]\nincline = \"1 deg\"\n"));
    assert_eq!(finding.line(), line_of("laws = ["));
    let line = finding.one_line();
    assert!(line.contains("no law of these contacts carries a load"), "{line}");
    assert!(line.contains("add \"elastic_hertz\""), "{line}");
    let (_, warnings) = Experiment::from_text("test.toml", &without).unwrap().chain(None).unwrap();
    assert_eq!(warnings[0].line(), line_of("laws = ["));
}

#[test]
fn threads_that_cannot_hold_a_pushed_chain_are_found_at_the_threads() {
    let threads = "[suspension]\nlength = \"10 cm\"\n[track]\nincline = \"1 deg\"\n";
    assert_eq!(refused(&format!("{DRY}\n{threads}")).text(), "[suspension]");
}

#[test]
fn what_moves_nothing_is_refused() {
    let instead = |text: &str| only(&DRY.replace("[striker]\nspeed = \"0.5 m/s\"", text));
    let finding = instead("[[initial]]\nbead = 3");
    assert!(finding.one_line().contains("neither displaced nor moving"));
    let finding = instead("[[initial]]\nbead = 3\nvelocity = \"0 m/s\"");
    assert!(finding.one_line().contains("nothing sets the chain in motion"));
    let finding =
        instead("[driven]\nmotion = \"sine\"\namplitude = \"0 m\"\nfrequency = \"1 kHz\"");
    assert_eq!(finding.text(), "\"0 m\"");
}

#[test]
fn a_speed_asked_of_a_chain_without_a_striker_points_at_what_moves_it() {
    let free = DRY
        .replace("[striker]\nspeed = \"0.5 m/s\"", "[[initial]]\nbead = 3\nvelocity = \"1 m/s\"");
    let experiment = Experiment::from_text("test.toml", &free).unwrap();
    for mistakes in [
        experiment.chain(Some(1.0)).unwrap_err(),
        experiment.needs_striker("a sweep needs one").unwrap_err(),
    ] {
        assert_eq!(mistakes.findings()[0].text(), "[[initial]]", "{mistakes}");
        assert!(mistakes.to_string().contains("put a [striker]"), "{mistakes}");
    }
}

#[test]
fn a_gap_that_a_load_closes_is_a_warning() {
    let text = format!(
        "{DRY}\n[[gaps]]\ncontact = 3\ngap = \"1 um\"\n[near_end]\npush = \"constant\"\nforce = \"1 N\"\n"
    );
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    let (_, warnings) = experiment.chain(None).unwrap();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].one_line().contains("this gap closes"));
}

#[test]
fn beads_pressed_into_each_other_beyond_their_radius_are_refused() {
    let push = "[near_end]\npush = \"constant\"\nforce = \"1e30 N\"\n";
    let finding = refused(&format!("{DRY}\n{push}"));
    assert_eq!(finding.text(), "[near_end]");
    assert!(finding.one_line().contains("more than a bead's radius"));
    let text = format!("{DRY}\n[[initial]]\nbead = 3\ndisplacement = \"1 km\"\n");
    assert_eq!(refused(&text).line(), DRY.lines().count() + 3);
    // Away from its neighbour a ball may be lifted as far as one likes.
    let lifted = DRY.replace(
        "[striker]\nspeed = \"0.5 m/s\"",
        "[[initial]]\nbead = 1\ndisplacement = \"-5 cm\"",
    );
    let experiment = Experiment::from_text("test.toml", &lifted).unwrap();
    assert!(experiment.system(None).is_ok());
}

#[test]
fn a_table_of_one_position_moves_nothing() {
    let table =
        "[driven]\nmotion = \"table\"\ntimes = [\"0 s\", \"1 ms\"]\npositions = [\"1 m\", \"1 m\"]";
    let finding = only(&DRY.replace("[striker]\nspeed = \"0.5 m/s\"", table));
    assert!(finding.one_line().contains("sets nothing in motion"));
}
