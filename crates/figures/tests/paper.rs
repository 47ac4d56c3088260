//! The paper's figures from a whole, coarse reproduction.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod covered;

use covered::covered;
use hertzchain_figures::paper;
use hertzchain_study::reproduce::{Options, Silent, reproduce};
use std::collections::BTreeSet;
use std::fs;

const TABLES: [&str; 8] = [
    "claims.json",
    "claims.md",
    "oils.csv",
    "power_law_residuals.csv",
    "power_laws.csv",
    "provenance.json",
    "ratios.csv",
    "tof.csv",
];

const FIGURES: [&str; 6] = [
    "energy",
    "figure1",
    "figure2",
    "figure3",
    "figure4",
    "space_time",
];

#[test]
fn a_reproduction_writes_all_its_tables_and_figures_and_its_legends_hide_nothing() {
    let coarse = Options {
        accuracy: 1e-4,
        draws: 0,
        ..Options::default()
    };
    let computed = reproduce(&coarse, &Silent).unwrap();
    for (name, figure) in paper::figures(&computed).unwrap() {
        assert_eq!(covered(&figure.svg()).1, 0, "{name}: a legend hides data");
        assert!(figure.caption_text().len() > 40, "{name} has no caption");
    }
    let folder = std::env::temp_dir().join(format!("hertzchain-paper-{}", std::process::id()));
    computed.write_tables(&folder).unwrap();
    paper::write(&computed, &folder).unwrap();
    let entries = fs::read_dir(&folder).unwrap();
    let written: BTreeSet<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let png = fs::read(folder.join("figure1.png")).unwrap();
    fs::remove_dir_all(&folder).unwrap();
    let figures = FIGURES
        .iter()
        .flat_map(|name| ["svg", "png"].map(|ending| format!("{name}.{ending}")));
    let expected: BTreeSet<String> = TABLES
        .iter()
        .map(|name| (*name).to_owned())
        .chain(figures)
        .chain(["captions.md".to_owned()])
        .collect();
    assert_eq!(written, expected);
    assert!(png.starts_with(b"\x89PNG"));
}
