//! The shell blocks of `docs/tutorials` run in order, each page in an empty folder.

use std::path::Path;
use std::process::Command;

/// Fenced blocks of a page as (language, text).
fn blocks(page: &str) -> Vec<(&str, &str)> {
    let mut parts = page.split("```").skip(1).step_by(2);
    std::iter::from_fn(|| parts.next()?.split_once('\n')).collect()
}

/// A TOML block that begins with `# name.toml` becomes that file; a shell block must succeed.
fn run(page: &str) {
    let pages = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/tutorials");
    let text = std::fs::read_to_string(pages.join(page)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_hertzchain"))
        .parent()
        .unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    for (language, block) in blocks(&text) {
        let name = block
            .lines()
            .next()
            .and_then(|line| line.strip_prefix("# "));
        match (language, name) {
            ("toml", Some(name)) if name.ends_with(".toml") => {
                std::fs::write(folder.path().join(name), block).unwrap();
            }
            ("sh", _) => {
                let mut shell = Command::new("bash");
                let shell = shell.args(["-euo", "pipefail", "-c", block]);
                let done = shell
                    .current_dir(&folder)
                    .env("PATH", &path)
                    .output()
                    .unwrap();
                let printed = String::from_utf8_lossy(&done.stderr);
                assert!(done.status.success(), "{page}\n{block}\n{printed}");
            }
            _ => {}
        }
    }
}

#[test]
fn my_first_chain_runs() {
    run("my-first-chain.md");
}

#[test]
fn from_a_recording_runs() {
    run("from-a-recording.md");
}

#[test]
fn fit_and_find_the_oil_runs() {
    run("fit-and-find-the-oil.md");
}

#[test]
fn a_virtual_rig_runs() {
    run("a-virtual-rig.md");
}

#[test]
fn dimers_and_long_chains_run() {
    run("dimers-and-long-chains.md");
}

#[test]
fn a_lesson_runs() {
    run("a-lesson.md");
}
