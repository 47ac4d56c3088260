//! `--shard` and `merge`: what several runs have made is what one makes.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// A folder with experiments in it, gone at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("hertzchain-merge-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        let small = include_str!("../../sim/tests/small.toml");
        fs::write(path.join("small.toml"), small).unwrap();
        Self(path)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        program.current_dir(&self.0).args(arguments).output().unwrap()
    }

    fn done(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let reported = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {reported}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn refused(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap()
    }

    /// Every file of a folder by name.
    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.0.join(folder)).unwrap();
        let file = |path: PathBuf| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, fs::read(path).unwrap())
        };
        entries.map(|entry| file(entry.unwrap().path())).collect()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The last speed breaks the table of oils: it has no shot.
const SPEEDS: &str = "log:0.3:1.2:9,1e-9";

#[test]
fn merged_shards_of_a_sweep_are_the_files_and_the_words_of_the_sweep() {
    let scratch = Scratch::new("sweep");
    let sweep = ["sweep", "-p", "pump", "--speeds", SPEEDS, "--accuracy", "1e-5"];
    let with = |more: &[&'static str]| [&sweep[..], more].concat();
    let whole = scratch.done(&with(&["--out", "whole"]));
    scratch.done(&with(&["--shard", "2/3", "--out", "a"]));
    scratch.done(&with(&["--shard", "1/3", "--out", "b", "--threads", "1"]));
    let reported = scratch.refused(&["merge", "a", "b", "--out", "merged"]);
    assert!(reported.contains("1 of 3 shards") && reported.contains("--shard 3/3"), "{reported}");
    assert!(!scratch.0.join("merged").exists());
    scratch.done(&with(&["--shard", "3/3", "--out", "b"]));
    let again = scratch.done(&with(&["--shard", "3/3", "--out", "b"]));
    assert!(again.contains("there already"), "{again}");
    let merged = scratch.done(&["merge", "a", "b", "--out", "merged"]);
    assert_eq!(merged, whole);
    let files = scratch.files("whole");
    assert_eq!(files.len(), 3);
    assert!(scratch.files("merged") == files);
    let reported = scratch.refused(&["merge", "a", "b", "--out", "merged"]);
    assert!(reported.contains("sweep.csv is there already"), "{reported}");
    let output = scratch.run(&["merge", "a", "b", "--out", "merged", "--force"]);
    let reported = String::from_utf8(output.stderr).unwrap();
    assert!(reported.contains("no shot at"), "{reported}");
}

#[test]
fn shards_need_a_folder_and_belong_to_one_run() {
    let scratch = Scratch::new("refused");
    let reported = scratch.refused(&["sweep", "-p", "hertz", "--shard", "1/2"]);
    assert!(reported.contains("--out"), "{reported}");
    for speeds in ["0.5,1", "0.5,0.9"] {
        let shard = ["--shard", "1/2", "--out", "mixed"];
        scratch.done(&[&["sweep", "-p", "hertz", "--speeds", speeds][..], &shard].concat());
    }
    let reported = scratch.refused(&["merge", "mixed", "--out", "merged"]);
    assert!(reported.contains("2 different runs"), "{reported}");
    let reported = scratch.refused(&["merge", "nowhere", "--out", "merged"]);
    assert!(reported.contains("nowhere"), "{reported}");
}

#[test]
fn merged_parts_of_a_campaign_are_the_files_of_the_campaign() {
    let scratch = Scratch::new("campaign");
    scratch.done(&["campaign", "small.toml", "--out", "whole"]);
    let part = |shard, out| {
        let out = ["--shard", shard, "--out", out, "--seed", "8"];
        [&["campaign", "small.toml"][..], &out].concat()
    };
    scratch.done(&part("1/2", "one"));
    let reported = scratch.refused(&["merge", "one", "--out", "merged"]);
    assert!(reported.contains("3 of 6 series are missing"), "{reported}");
    scratch.done(&part("2/2", "two"));
    scratch.done(&["merge", "one", "two", "--out", "merged"]);
    scratch.done(&["campaign", "small.toml", "--out", "eight", "--seed", "8"]);
    assert!(scratch.files("merged") == scratch.files("eight"));
    let reported = scratch.refused(&["merge", "one", "whole", "--out", "mixed"]);
    assert!(reported.contains("another campaign"), "{reported}");
}
