//! No input makes the reader panic.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{Experiment, Reading, examples, film_presets, presets};
use proptest::prelude::*;

/// Reads a text and goes on as far as it can.
fn exercise(text: &str) -> Result<(), TestCaseError> {
    match Experiment::from_text("any.toml", text) {
        Ok(experiment) => {
            prop_assert!(experiment.chain(None).is_ok());
            let _ = experiment.system(None);
            let _ = experiment.system(Some(0.3));
            let _ = experiment.sensors();
            let within = Reading::default().with("striker", "within").unwrap();
            let _ = experiment.with_reading(&within);
            for number in experiment.numbers().iter().take(5) {
                let _ = experiment.set(&[(&number.path, 1e300)]);
            }
        }
        Err(mistakes) => {
            prop_assert!(!mistakes.findings().is_empty());
            for finding in mistakes.findings() {
                prop_assert!(!finding.one_line().is_empty());
                let lines = text.matches('\n').count() + 1;
                prop_assert!((1..=lines).contains(&finding.line()));
            }
        }
    }
    Ok(())
}

fn files() -> Vec<&'static str> {
    presets().iter().chain(film_presets()).chain(examples()).map(|file| file.text).collect()
}

/// Words that belong into experiment files, and some that do not.
fn word() -> impl Strategy<Value = String> {
    let words = [
        "count",
        "radius",
        "mass",
        "material",
        "laws",
        "law",
        "from",
        "to",
        "kind",
        "speed",
        "cell",
        "repeat",
        "radius_ratio",
        "motion",
        "times",
        "positions",
        "exponent",
        "prefactor",
        "stiffness",
        "elastic_power",
        "damping_cubic",
        "coefficient",
        "bead",
        "contact",
        "gap",
        "velocity",
        "units",
        "dimensionless",
        "force",
        "push",
        "spring",
        "é",
        "",
    ];
    prop::sample::select(words.to_vec()).prop_map(str::to_owned)
}

fn scalar() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<i64>().prop_map(|n| n.to_string()),
        any::<f64>().prop_map(|x| format!("{x:e}")),
        (0u32..50).prop_map(|n| n.to_string()),
        Just("nan".to_owned()),
        Just("true".to_owned()),
        Just("1979-05-27".to_owned()),
        word().prop_map(|w| format!("\"{w}\"")),
        (any::<f32>(), "m|kg|Pa s|N/m\\^1.5|g/cm\\^3|deg|s|m/s")
            .prop_map(|(x, u)| format!("\"{x:e} {u}\"")),
    ]
}

fn value() -> impl Strategy<Value = String> {
    scalar().prop_recursive(3, 12, 4, |inner| {
        let list = prop::collection::vec(inner.clone(), 0..4);
        let table = prop::collection::vec((word(), inner), 0..4);
        prop_oneof![
            list.prop_map(|members| format!("[{}]", members.join(", "))),
            table.prop_map(|entries| {
                let entries = entries.iter().map(|(key, value)| format!("\"{key}\" = {value}"));
                format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
            }),
        ]
    })
}

fn header() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "[striker]",
        "[driven]",
        "[[beads]]",
        "[[contacts]]",
        "[far_end]",
        "[near_end]",
        "[track]",
        "[suspension]",
        "[[gaps]]",
        "[[initial]]",
        "[sensors]",
        "[solver]",
        "[reading]",
        "[liquid]",
        "[rig]",
        "[rig.springs]",
        "[rig.recorder]",
        "[materials.a]",
        "[a.b]",
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn random_text_is_refused_politely(text in "\\PC{0,200}") {
        exercise(&text)?;
    }

    #[test]
    fn random_tables_of_known_words_are_read_or_refused(
        tables in prop::collection::vec(
            (header(), prop::collection::vec((word(), value()), 0..5)), 0..6),
    ) {
        let text: String = tables.iter().map(|(header, entries)| {
            let entries = entries.iter().map(|(key, value)| format!("\"{key}\" = {value}\n"));
            format!("{header}\n{}", entries.collect::<String>())
        }).collect();
        exercise(&text)?;
    }

    #[test]
    fn valid_files_with_a_piece_cut_out_or_doubled_are_read_or_refused(
        file in prop::sample::select(files()),
        start in any::<prop::sample::Index>(),
        length in 0usize..40,
        doubled in any::<bool>(),
    ) {
        let marks: Vec<usize> = file.char_indices().map(|(at, _)| at).collect();
        let first = start.index(marks.len());
        let last = (first + length).min(marks.len() - 1);
        let (from, to) = (marks[first], marks[last]);
        let end = if doubled { from } else { to };
        exercise(&format!("{}{}", &file[..to], &file[end..]))?;
    }

    #[test]
    fn valid_files_with_a_value_replaced_are_read_or_refused(
        file in prop::sample::select(files()),
        line in any::<prop::sample::Index>(),
        value in value(),
    ) {
        let lines: Vec<&str> = file.lines().collect();
        let settings: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ")).collect();
        let at = settings[line.index(settings.len())];
        let key = lines[at].split(" = ").next().unwrap();
        let changed = format!("{key} = {value}");
        let text: Vec<&str> = (0..lines.len()).map(|i| if i == at { &changed } else { lines[i] }).collect();
        exercise(&text.join("\n"))?;
    }
}

#[test]
fn deep_nesting_is_refused_without_a_deep_stack() {
    let depth = 100_000;
    let lists = format!("title = {}{}", "[".repeat(depth), "]".repeat(depth));
    assert!(Experiment::from_text("any.toml", &lists).is_err());
    let unit = format!("{}m{}", "(".repeat(depth), ")".repeat(depth));
    assert!(crate::units::parse_unit(&unit).is_err());
}
