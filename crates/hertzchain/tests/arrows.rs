//! ARCHITECTURE.md's arrows and what it says is absent, read from the crates.

use std::fs::{read_dir, read_to_string};
use std::path::{Path, PathBuf};

/// Which crates of ours each crate may depend on.
const ARROWS: &[(&str, &[&str])] = &[
    ("chain", &[]),
    ("measure", &[]),
    ("experiment", &["chain"]),
    ("sim", &["chain", "experiment", "measure"]),
    ("infer", &["chain", "experiment", "measure", "sim"]),
    ("explore", &["chain", "experiment", "measure", "sim"]),
    ("figures", &[]),
    ("paper", &["chain", "experiment", "figures", "measure", "sim"]),
    (
        "hertzchain",
        &["chain", "experiment", "explore", "figures", "infer", "measure", "paper", "sim"],
    ),
    ("py", &["chain", "experiment", "infer", "measure", "sim"]),
];

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn crates_depend_on_each_other_only_along_the_arrows() {
    let arrows = |name: &str| ARROWS.iter().find(|arrow| arrow.0 == name);
    for folder in read_dir(crates()).unwrap() {
        let folder = folder.unwrap();
        let name = folder.file_name().into_string().unwrap();
        let (_, allowed) = arrows(&name).unwrap();
        let manifest = read_to_string(folder.path().join("Cargo.toml")).unwrap();
        let ours = manifest.lines().filter_map(|line| line.strip_prefix("hertzchain-"));
        for dependency in ours.map(|rest| rest.split(['.', ' ']).next().unwrap()) {
            assert!(allowed.contains(&dependency), "{name} -> {dependency}");
        }
    }
}

#[test]
fn physics_and_signals_know_no_files_clocks_threads_or_chance() {
    for source in sources(&crates().join("chain/src"))
        .iter()
        .chain(&sources(&crates().join("measure/src/signal")))
    {
        let text = read_to_string(source).unwrap();
        for absent in ["std::fs", "std::time", "std::thread", "std::env", "rand::"] {
            assert!(!text.contains(absent), "{}: {absent}", source.display());
        }
    }
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let deeper = folders.iter().flat_map(|folder| sources(folder));
    files.into_iter().chain(deeper).collect()
}

#[test]
fn every_file_of_tests_is_part_of_its_crate_s_test_program() {
    for folder in read_dir(crates()).unwrap() {
        let tests = folder.unwrap().path().join("tests");
        let Ok(all) = read_to_string(tests.join("all.rs")) else {
            continue;
        };
        let files = read_dir(&tests).unwrap().map(|entry| entry.unwrap().path());
        for file in files.filter(|path| path.extension().is_some_and(|end| end == "rs")) {
            let name = file.file_stem().unwrap().to_str().unwrap();
            let named = name == "all" || all.contains(&format!("mod {name};"));
            assert!(named, "{} is never run: name it in all.rs", file.display());
        }
    }
}
