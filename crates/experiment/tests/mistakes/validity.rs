//! Laws that are used beyond what they are for.

use super::{DRY, check, line_of, refused};
use crate::{Experiment, Warning, examples, film_presets, presets};
use hertzchain_chain::laws::{LAWS, Nature, Row, Source};
use hertzchain_chain::theory::two_body::ElasticCollision;
use miette::Diagnostic;

const CUBIC: &str = "coefficient = \"77 kg s/m^2\"";

fn warnings(text: &str) -> Vec<Warning> {
    let experiment = Experiment::from_text("test.toml", text).unwrap();
    experiment.chain(None).unwrap().1
}

fn warning(text: &str) -> Warning {
    let found = warnings(text);
    let lines: Vec<String> = found.iter().map(Warning::one_line).collect();
    assert_eq!(found.len(), 1, "{lines:?}");
    found[0].clone()
}

fn dissipative() -> impl Iterator<Item = &'static Row> {
    LAWS.iter().filter(|row| row.info.nature == Nature::Dissipative)
}

/// A dimensionless chain with one dissipative law at a value of its first
/// parameter.
fn damped(row: &Row, value: f64) -> String {
    let mut parameters = row.info.parameters.iter();
    let first = parameters.next().unwrap().name;
    let others = parameters.filter(|p| p.source != Source::Default(0.0));
    let others: String = others.map(|p| format!(", {} = 1", p.name)).collect();
    format!(
        "units = \"dimensionless\"\n[materials.a]\nyoung_modulus = 1\npoisson_ratio = 0.3\n\
         [striker]\nspeed = 1\n[[beads]]\ncount = 9\nmaterial = \"a\"\n[[contacts]]\nlaws = [\"elastic_hertz\", {{ law = \"{}\", {first} = {value:e}{others} }}]\n",
        row.info.name
    )
}

/// The value that the help of a finding calls equal to the elastic force.
fn balance(finding: &Warning) -> f64 {
    let help = finding.help().unwrap().to_string();
    help.rsplit(' ').next().unwrap().parse().unwrap()
}

#[test]
fn a_loss_without_a_viscosity_is_named() {
    let text = |more: &str| {
        format!(
            "materials.a = {{ young_modulus = \"213 GPa\", poisson_ratio = 0.3, density = \"7960 kg/m^3\"{more} }}\n\
             striker = {{ speed = \"0.5 m/s\" }}\nbeads = [{{ count = 9, radius = \"6 mm\", material = \"a\" }}]\n\
             contacts = [{{ laws = [\"elastic_hertz\", \"damping_viscoelastic\"] }}]\n"
        )
    };
    let line = warning(&text("")).one_line();
    assert!(line.contains("shear_viscosity"), "{line}");
    assert!(warnings(&text(", shear_viscosity = \"32 kPa s\"")).is_empty());
}

#[test]
fn every_law_that_stops_all_motion_is_refused_with_its_balance() {
    for row in dissipative() {
        let finding = refused(&damped(row, 1e60));
        let line = finding.one_line();
        assert_eq!(finding.line(), 11, "{line}");
        assert!(finding.text().contains(row.info.name), "{line}");
        for words in ["times as strong as the elastic force", "at most 1e6 times"] {
            assert!(line.contains(words), "{line} lacks {words}");
        }
        // Every law is proportional to its first parameter: half of what
        // balances the elastic force is within the range, twice is not.
        let balance = balance(&finding);
        assert!(warnings(&damped(row, 0.5 * balance)).is_empty(), "{line}");
        let strong = warning(&damped(row, 2.0 * balance));
        assert!(
            strong.one_line().contains("part with less than half of their speed"),
            "{}",
            strong.one_line()
        );
        let validity = strong.help().unwrap().to_string();
        assert!(validity.contains(row.info.validity), "{validity}");
    }
}

#[test]
fn every_law_too_weak_to_be_seen_is_warned_of() {
    for row in dissipative() {
        let weak = warning(&damped(row, 1e-40));
        assert!(weak.one_line().contains("too weak to change any result"), "{}", weak.one_line());
        assert!(warnings(&damped(row, 0.0)).is_empty(), "0 is a way to say no");
    }
}

#[test]
fn a_damping_of_the_wrong_size_is_underlined_in_its_section() {
    let text = DRY.replace(CUBIC, "coefficient = \"1e20 kg s/m^2\"");
    let law = "{ law = \"damping_cubic\", coefficient = \"1e20 kg s/m^2\" }";
    let words = ["contact 0 at 0.5 m/s", "coefficient = 1400 kg s/m^2"];
    check(&refused(&text), line_of("damping_cubic"), law, &words);
    let wet = format!(
        "{}\n[[contacts]]\nfrom = 21\nlaws = [\"elastic_hertz\", {law}]\n",
        DRY.replace("[[contacts]]\n", "[[contacts]]\nto = 20\n")
    );
    let finding = refused(&wet);
    assert_eq!(finding.line(), 1 + wet.lines().position(|l| l.contains("1e20")).unwrap());
    assert!(finding.one_line().contains("contact 21"), "{}", finding.one_line());
}

#[test]
fn a_viscosity_of_the_wrong_size_is_underlined_in_its_material() {
    let text = DRY.replace("\"3.2e4 Pa s\"", "\"1e20 Pa s\"");
    let words = ["damping_viscoelastic", "viscosities"];
    check(&refused(&text), line_of("shear_viscosity = "), "\"1e20 Pa s\"", &words);
    let bulk = "\"3.2e4 Pa s\"\nbulk_viscosity = \"1e20 Pa s\"";
    let text = DRY.replace("\"3.2e4 Pa s\"", bulk);
    check(&refused(&text), line_of("shear_viscosity = ") + 1, "\"1e20 Pa s\"", &words);
    let text = DRY.replace("\"3.2e4 Pa s\"", "\"3.2e6 Pa s\"");
    let finding = warning(&text);
    check(
        &finding,
        line_of("shear_viscosity = "),
        "\"3.2e6 Pa s\"",
        &["less than half of their speed", "A δ̇/δ small"],
    );
}

#[test]
fn overlaps_that_are_not_small_are_warned_of_at_their_probable_cause() {
    let hertz = "{ law = \"elastic_hertz\", stiffness = \"1e4 N/m^1.5\" }";
    let laws = "laws = [\n  \"elastic_hertz\", ";
    let start = DRY.find("laws = [").unwrap();
    let end = start + DRY[start..].find("\n]").unwrap();
    let bare = DRY.replace(&DRY[start..end], laws);
    for (from, to, text) in [
        ("\"0.5 m/s\"", "\"100 m/s\"", "\"100 m/s\""),
        ("= \"213 GPa\"", "= \"1 MPa\"", "\"1 MPa\""),
        ("\"elastic_hertz\"", hertz, hertz),
    ] {
        let found = warnings(&bare.replacen(from, to, 1));
        let finding = found.iter().find(|one| one.one_line().contains("overlap by")).unwrap();
        let line = 1 + bare.lines().position(|l| l.contains(from)).unwrap();
        let words = ["of their reduced radius", "out of its range", "smooth spheres"];
        check(finding, line, text, &words);
    }
}

#[test]
fn bodies_that_would_pass_into_each_other_are_refused() {
    let speed = DRY.replace("\"0.5 m/s\"", "\"1e5 m/s\"");
    let words = ["more than a bead's radius", "expected bodies that stop within 0.0063 m"];
    check(&refused(&speed), line_of("speed = "), "\"1e5 m/s\"", &words);
    let soft = DRY.replace("= \"213 GPa\"", "= \"1 Pa\"");
    check(&refused(&soft), line_of("young_modulus = "), "\"1 Pa\"", &words);
    let yielding = "{ law = \"elastic_plastic_thornton\", yield_pressure = \"1 Pa\" }";
    let plastic = DRY.replacen("\"elastic_hertz\"", yielding, 1);
    check(&refused(&plastic), line_of("\"elastic_hertz\""), yielding, &words);
    let moved = DRY.replace(
        "[striker]\nspeed = \"0.5 m/s\"",
        "[[initial]]\nbead = 40\ndisplacement = \"1 m\"",
    );
    let finding = refused(&moved);
    check(&finding, line_of("0.5 m/s"), "40", &["contact 40 is overlapped by 1 m"]);
}

#[test]
fn overlaps_are_those_of_a_hertz_collision() {
    let speed_m_s = 200.0;
    let text = DRY.replace("\"0.5 m/s\"", "\"200 m/s\"");
    let found = warnings(&text);
    let line = found[0].one_line();
    let reported = line.split("overlap by ").nth(1).unwrap().split(' ').next().unwrap();
    let collision = ElasticCollision {
        exponent: 1.5,
        stiffness: 8.7926303796e9,
        reduced_mass_kg: 0.00427,
        speed_m_s,
    };
    let ratio = reported.parse::<f64>().unwrap() / collision.largest_overlap_m();
    // Reported to two digits, 5 %, after an inversion to a hundredth.
    assert!((ratio - 1.0).abs() < 0.06, "{line}: {ratio}");
}

#[test]
fn lengths_without_unit_are_compared_with_no_radius() {
    let text = "units = \"dimensionless\"\n[striker]\nspeed = 1e9\n[[beads]]\ncount = 5\n";
    let experiment = Experiment::from_text("test.toml", text).unwrap();
    let (_, warnings) = experiment.system(None).unwrap();
    assert!(warnings.is_empty());
}

#[test]
fn files_that_come_along_use_their_laws_within_range() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let experiment = Experiment::from_text(file.name, file.text).unwrap();
        let struck = experiment.speed_m_s().is_some();
        let speeds: &[Option<f64>] = match struck {
            true => &[None, Some(0.075), Some(1.23)],
            false => &[None],
        };
        for speed in speeds {
            let (_, found) = experiment.system(*speed).unwrap();
            for warning in found {
                let line = warning.one_line();
                assert!(line.contains("Poisson ratio"), "{}: {line}", file.name);
            }
        }
    }
}

#[test]
fn beads_that_no_laboratory_has_are_warned_of() {
    let with = |from: &str, to: &str| {
        assert!(DRY.contains(from), "{from}");
        DRY.replacen(from, to, 1)
    };
    let two_groups = with("= \"213 GPa\"", "= \"210 MPa\"");
    let group = &two_groups[two_groups.find("[[beads]]").unwrap()..];
    let group = &group[..group.find("\n[").unwrap() + 1];
    let soft = warnings(&two_groups.replacen(group, &format!("{group}{group}"), 1));
    let soft: Vec<_> = soft.iter().filter(|found| found.one_line().contains("210 MPa")).collect();
    let [soft] = soft[..] else { unreachable!("not said once: {soft:?}") };
    check(soft, line_of("young_modulus"), "\"210 MPa\"", &["7.96 g/cm^3", "is the unit right?"]);
    let says = |text: &str, words: &str| {
        let found = warnings(text);
        assert!(found.iter().any(|warning| warning.one_line().contains(words)), "{found:?}");
    };
    says(&with("= \"6.35 mm\"", "= \"6 m\""), "radius of 6 m");
    says(&with("= \"8.54 g\"", "= \"8.54 kg\""), "no solid has it");
    assert!(warnings(DRY).is_empty());
}
