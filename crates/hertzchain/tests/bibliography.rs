//! Every source that is cited has an entry, and every entry is cited.

use std::collections::BTreeSet;
use std::fs::{read_dir, read_to_string};
use std::path::{Path, PathBuf};

/// Where sources are cited.
const CITING: [&str; 8] = [
    "crates",
    "docs",
    "experiments",
    "bench",
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Text files below a path.
fn texts(path: &Path) -> Vec<String> {
    if path.is_dir() {
        let entries = read_dir(path).unwrap();
        return entries.flat_map(|entry| texts(&entry.unwrap().path())).collect();
    }
    let kinds = ["rs", "md", "toml", "py"];
    let kind = path.extension().and_then(|kind| kind.to_str());
    let read = kind.is_some_and(|kind| kinds.contains(&kind)) && !path.ends_with("bibliography.rs");
    read.then(|| read_to_string(path).unwrap()).into_iter().collect()
}

/// Names and a year: `Nesterenko1983`.
fn is_key(word: &str) -> bool {
    let year = word.find(|letter: char| letter.is_ascii_digit());
    let Some((names, year)) = year.and_then(|at| word.split_at_checked(at)) else {
        return false;
    };
    names.len() >= 2
        && names.starts_with(|letter: char| letter.is_ascii_uppercase())
        && names.chars().all(|letter| letter.is_ascii_alphabetic())
        && year.len() == 4
        && ["18", "19", "20"].iter().any(|century| year.starts_with(century))
}

/// Keys that are cited: in brackets, several separated by commas, or as text
/// of their own in quotes.
fn cited() -> BTreeSet<String> {
    let texts: Vec<String> = CITING.iter().flat_map(|path| texts(&root().join(path))).collect();
    let pieces = texts.iter().flat_map(|text| text.split(['[', ']', '"']));
    let words = pieces.flat_map(|piece| piece.split([',', ';']));
    words
        .map(|word| word.trim().trim_end_matches('\\'))
        .filter(|word| is_key(word))
        .map(str::to_owned)
        .collect()
}

/// Keys of the bibliography.
fn entries() -> BTreeSet<String> {
    let text = read_to_string(root().join("references.bib")).unwrap();
    let heads = text.lines().filter(|line| line.starts_with('@'));
    let key = |line: &str| line.split(['{', ',']).nth(1).unwrap().to_owned();
    heads.map(key).collect()
}

#[test]
fn every_source_that_is_cited_has_an_entry() {
    let missing: Vec<String> = cited().difference(&entries()).cloned().collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn every_entry_of_the_bibliography_is_cited() {
    let unused: Vec<String> = entries().difference(&cited()).cloned().collect();
    assert!(unused.is_empty(), "{unused:?}");
}

#[test]
fn every_key_has_one_entry() {
    let text = read_to_string(root().join("references.bib")).unwrap();
    let heads = text.lines().filter(|line| line.starts_with('@')).count();
    assert_eq!(heads, entries().len());
    assert!(entries().iter().all(|key| is_key(key)), "{:?}", entries());
}
