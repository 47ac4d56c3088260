//! Every mistake is one report with line, text, expectation and advice.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on should fail"
)]

use hertzchain_experiment::{Experiment, Finding, preset};
use miette::Diagnostic;

const DRY: &str = include_str!("../../../experiments/dry.toml");

/// The only mistake of the dry preset after a replacement.
fn after(from: &str, to: &str) -> Finding {
    assert!(DRY.contains(from), "{from}");
    only(&DRY.replacen(from, to, 1))
}

fn only(text: &str) -> Finding {
    let mistakes = Experiment::from_text("test.toml", text).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    mistakes.findings()[0].clone()
}

fn line_of(text: &str) -> usize {
    1 + DRY.lines().position(|line| line.contains(text)).unwrap()
}

/// Line, underlined text and words of a finding.
fn check(finding: &Finding, line: usize, text: &str, words: &[&str]) {
    assert_eq!(finding.line(), line, "{}", finding.one_line());
    assert_eq!(finding.text(), text, "{}", finding.one_line());
    assert_eq!(finding.file(), "test.toml");
    for word in words {
        assert!(
            finding.one_line().contains(word),
            "{} lacks {word}",
            finding.one_line()
        );
    }
}

#[test]
fn an_unknown_key_names_the_nearest_and_all() {
    let finding = after("bead = 7", "baed = 7");
    let words = [
        "[sensors] has no key `baed`",
        "did you mean `bead`",
        "velocities, channel",
    ];
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
fn a_wrong_dimension_names_the_expected_unit() {
    let finding = after("\"6.35 mm\"\nmass", "\"6.35 kg\"\nmass");
    let words = ["`radius` is a mass", "a length in m", "\"6.35 mm\""];
    check(
        &finding,
        line_of("radius = \"6.35 mm\""),
        "\"6.35 kg\"",
        &words,
    );
}

#[test]
fn a_missing_unit_is_asked_for() {
    let line = line_of("mass = \"8.54 g\"");
    let words = ["`mass` has no unit", "a mass in kg", "\"8.54 g\""];
    check(
        &after("\"8.54 g\"\nmaterial", "8.54\nmaterial"),
        line,
        "8.54",
        &words,
    );
    check(
        &after("\"8.54 g\"\nmaterial", "\"8.54\"\nmaterial"),
        line,
        "\"8.54\"",
        &words,
    );
}

#[test]
fn a_negative_mass_must_be_positive() {
    let finding = after("\"8.54 g\"\nmaterial", "\"-8.54 g\"\nmaterial");
    let words = ["`mass` is -0.00854 kg", "must be positive"];
    check(
        &finding,
        line_of("mass = \"8.54 g\""),
        "\"-8.54 g\"",
        &words,
    );
}

#[test]
fn poisson_ratios_end_at_one() {
    for value in ["1.0", "1.2", "-1.0", "-3"] {
        let finding = after("poisson_ratio = 0.3", &format!("poisson_ratio = {value}"));
        let words = ["`poisson_ratio` is", "between -1 and 1"];
        check(&finding, line_of("poisson_ratio"), value, &words);
    }
    let text = DRY.replace("poisson_ratio = 0.3", "poisson_ratio = 0.6");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    let (_, warnings) = experiment.chain(None).unwrap();
    check(
        &warnings[0],
        line_of("poisson_ratio"),
        "0.6",
        &["above 1/2", "below 1"],
    );
    assert_eq!(warnings[0].severity(), Some(miette::Severity::Warning));
}

#[test]
fn a_power_law_beyond_its_limits_is_found_at_the_speed_of_the_shot() {
    let pump = preset("pump").unwrap();
    let mistakes = pump.chain(Some(0.01)).unwrap_err();
    let line = mistakes.findings()[0].one_line();
    assert!(
        line.contains("Poisson ratio is 1.1") && line.contains("at 0.01 m/s"),
        "{line}"
    );
    assert!(line.contains("between -1 and 1"), "{line}");
}

#[test]
fn chains_have_between_one_and_many_beads() {
    let line = line_of("count = 40");
    let words = ["`count` = 0 is out of range", "from 1 to 2000000"];
    check(&after("count = 40", "count = 0"), line, "0", &words);
    check(
        &after("count = 40", "count = 1000000000000"),
        line,
        "1000000000000",
        &["out of range"],
    );
    check(
        &after("count = 40", "count = 40.5"),
        line,
        "40.5",
        &["not a whole number"],
    );
    let two = format!(
        "{DRY}\n[[beads]]\ncount = 1999961\nradius = \"1 mm\"\nmass = \"1 g\"\nmaterial = \"aisi316\"\n"
    );
    assert!(only(&two).one_line().contains("more than 2000000 beads"));
    assert!(
        only("beads = []\ncontacts = [{laws = [\"elastic_hertz\"]}]")
            .one_line()
            .contains("empty")
    );
    let cells = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\nrepeat = 2000000\ncell = [{count = 2000000}]";
    assert!(only(cells).one_line().contains("more than"));
}

#[test]
fn a_sensor_outside_the_chain_is_told_the_chain() {
    let line = line_of("bead = 7");
    let words = [
        "sensor bead 41 is outside the chain of 40 beads",
        "from 1 to 40",
    ];
    check(&after("bead = 7", "bead = 41"), line, "41", &words);
    let finding = after("bead = 7", "bead = 7\ncontacts = [3, 41]");
    check(&finding, line + 1, "41", &["contact 41", "from 0 to 40"]);
}

#[test]
fn what_does_not_exist_has_no_sensor() {
    let free = DRY.replace("kind = \"half-bead\"", "kind = \"free\"");
    let finding = only(&free.replace("bead = 7", "contacts = [40]"));
    assert!(
        finding.one_line().contains("from 0 to 39"),
        "{}",
        finding.one_line()
    );
    let finding = only(&free.replace("bead = 7", "channel = true"));
    assert!(finding.one_line().contains("there is no wall"));
    let initial = DRY.replace(
        "[striker]\nspeed = \"0.5 m/s\"",
        "[[initial]]\nbead = 1\nvelocity = \"1 m/s\"",
    );
    let finding = only(&initial.replace("bead = 7", "velocities = [0]"));
    assert!(
        finding.one_line().contains("from 1 to 40"),
        "{}",
        finding.one_line()
    );
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
fn a_law_s_missing_parameter_is_shown_with_its_unit() {
    let finding = after(
        "{ law = \"damping_cubic\", coefficient = \"77 kg s/m^2\" }",
        "\"damping_cubic\"",
    );
    let words = [
        "law `damping_cubic` needs `coefficient`",
        "kg s/m^2",
        "coefficient B",
    ];
    check(
        &finding,
        line_of("law = \"damping_cubic\""),
        "\"damping_cubic\"",
        &words,
    );
}

#[test]
fn laws_and_their_parameters_are_looked_up_in_the_registry() {
    let finding = after("\"elastic_hertz\"", "\"elastic_herz\"");
    let words = [
        "no law `elastic_herz`",
        "did you mean `elastic_hertz`",
        "damping_tsuji",
    ];
    check(
        &finding,
        line_of("\"elastic_hertz\""),
        "\"elastic_herz\"",
        &words,
    );
    let finding = after(
        "coefficient = \"77 kg s/m^2\"",
        "coefficient = \"77 kg s/m\"",
    );
    let words = [
        "`coefficient` is a quantity in kg m^-1 s",
        "a cubic damping in kg s/m^2",
    ];
    check(
        &finding,
        line_of("law = \"damping_cubic\""),
        "\"77 kg s/m\"",
        &words,
    );
    let finding = after(
        "coefficient = \"77 kg s/m^2\"",
        "coefficient = \"77 kg s/m^2\", coeff = 1",
    );
    assert!(
        finding.one_line().contains("no parameter `coeff`"),
        "{}",
        finding.one_line()
    );
}

#[test]
fn a_unit_follows_the_exponent_beside_it() {
    let law = |text: &str| DRY.replacen("\"elastic_hertz\"", text, 1);
    let power = |unit: &str, n: &str| {
        law(&format!(
            "{{ law = \"elastic_power\", stiffness = \"1e9 {unit}\", exponent = {n} }}"
        ))
    };
    for (unit, n) in [
        ("N/m^1.7", "1.7"),
        ("N/m^(4/3)", "1.3333333333"),
        ("N/m", "1"),
        ("N/mm^2", "2"),
    ] {
        let file = Experiment::from_text("test.toml", &power(unit, n));
        assert!(file.is_ok(), "{unit}: {}", file.unwrap_err());
    }
    let finding = only(&power("N/m^1.5", "2"));
    assert!(
        finding.one_line().contains("in N/m^2"),
        "{}",
        finding.one_line()
    );
}

#[test]
fn speeds_are_positive_and_finite() {
    let line = line_of("speed =");
    for (value, words) in [
        ("\"0 m/s\"", "must be positive"),
        ("\"-1 m/s\"", "must be positive"),
        ("\"nan\"", "not a finite number"),
        ("nan", "no unit"),
        ("inf", "no unit"),
        ("\"1e999 m/s\"", "too large"),
    ] {
        check(
            &after("\"0.5 m/s\"", value),
            line,
            value,
            &[words, "a speed in m/s"],
        );
    }
    let dry = preset("dry").unwrap();
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let line = dry.chain(Some(speed)).unwrap_err().to_string();
        assert!(line.contains("expected a positive, finite speed"), "{line}");
    }
}

#[test]
fn plain_numbers_are_finite() {
    for value in ["nan", "inf", "-inf", "1e999"] {
        let finding = after("poisson_ratio = 0.3", &format!("poisson_ratio = {value}"));
        check(
            &finding,
            line_of("poisson_ratio"),
            value,
            &["not a finite number"],
        );
    }
}

#[test]
fn options_and_materials_name_the_nearest() {
    let finding = after("kind = \"half-bead\"", "kind = \"halfbead\"");
    check(
        &finding,
        line_of("kind ="),
        "\"halfbead\"",
        &["did you mean `half-bead`", "plane-stop"],
    );
    let finding = after("material = \"aisi316\"", "material = \"aisi361\"");
    check(
        &finding,
        line_of("material = "),
        "\"aisi361\"",
        &["did you mean `aisi316`"],
    );
    let finding = only(&format!("{DRY}\n[reading]\ncontact_6 = \"damp\"\n"));
    assert!(
        finding
            .one_line()
            .contains("expected one of: \"dry\", \"wet\"")
    );
}

#[test]
fn keys_that_do_not_go_together_are_told_apart() {
    let finding = after(
        "kind = \"half-bead\"",
        "kind = \"plane\"\nradius = \"1 mm\"",
    );
    assert!(
        finding
            .one_line()
            .contains("kind = \"plane\" has no key `radius`"),
        "{}",
        finding.one_line()
    );
    let finding = after(
        "[striker]",
        "[driven]\nmotion = \"pulse\"\namplitude = \"1 um\"\nduration = \"20 us\"\n[striker]",
    );
    assert!(finding.one_line().contains("a striker and a driven end"));
    let finding = after("[striker]\nspeed = \"0.5 m/s\"", "");
    assert!(
        finding
            .one_line()
            .contains("nothing sets the chain in motion")
    );
    let finding = only(&format!("{DRY}\n[solver]\nstep = \"1 us\"\n"));
    assert!(finding.one_line().contains("chooses its own steps"));
    let finding = after("kind = \"half-bead\"", "kind = \"periodic\"");
    assert!(finding.one_line().contains("no near end"));
}

#[test]
fn all_mistakes_of_form_come_at_once() {
    let text = DRY
        .replacen("radius =", "raduis =", 1)
        .replacen("young_modulus = \"213 GPa\"", "young_modulus = 213", 1)
        .replacen("bead = 7", "bead = \"seven\"", 1);
    let mistakes = Experiment::from_text("test.toml", &text).unwrap_err();
    let text = mistakes.to_string();
    for words in [
        "`raduis`",
        "did you mean `radius`",
        "`young_modulus` has no unit",
        "`bead` is text",
    ] {
        assert!(text.contains(words), "{text} lacks {words}");
    }
}

#[test]
fn syntax_errors_point_at_their_line() {
    let finding = after("count = 40", "count = = 40");
    assert_eq!(finding.line(), line_of("count = 40"));
    assert!(finding.one_line().contains("not valid TOML"));
    let finding = after("count = 40", "count = 40\ncount = 41");
    assert!(
        finding.one_line().contains("duplicate"),
        "{}",
        finding.one_line()
    );
}

#[test]
fn dimensionless_files_have_plain_numbers() {
    let file = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\ncount = 5\n";
    let experiment = Experiment::from_text("test.toml", file).unwrap();
    let (chain, _) = experiment.chain(None).unwrap();
    assert_eq!(
        (chain.beads[4].mass_kg, chain.beads[4].radius_m),
        (1.0, 1.0)
    );
    assert_eq!(chain.gravity_m_s2, 0.0);
    let finding = only(&file.replace("speed = 1", "speed = \"1 m/s\""));
    check(
        &finding,
        3,
        "\"1 m/s\"",
        &["has a unit in a dimensionless file", "a plain number"],
    );
}

#[test]
fn materials_without_use_are_a_warning() {
    let text =
        format!("{DRY}\n[materials.brass]\nyoung_modulus = \"100 GPa\"\npoisson_ratio = 0.35\n");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    let (_, warnings) = experiment.chain(None).unwrap();
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].text(), "brass");
}

#[test]
fn beads_need_a_mass_or_a_density() {
    let finding = after("mass = \"8.54 g\"\n", "");
    assert!(
        finding.one_line().contains("`density` in the material"),
        "{}",
        finding.one_line()
    );
    let finding = after(
        "speed = \"0.5 m/s\"",
        "speed = \"0.5 m/s\"\nradius = \"1 cm\"",
    );
    assert!(finding.one_line().contains("the striker has no mass"));
}

/// The only mistake that shows when the chain is set up.
fn refused(text: &str) -> Finding {
    let experiment = Experiment::from_text("test.toml", text).unwrap();
    let mistakes = experiment.system(None).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    mistakes.findings()[0].clone()
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
fn either_all_beads_have_a_material_or_none() {
    let mixed = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n\
                 [materials.a]\nyoung_modulus = 1\npoisson_ratio = 0\n[[beads]]\nmaterial = \"a\"\n";
    assert!(
        only(mixed)
            .one_line()
            .contains("no material, but others do")
    );
}
