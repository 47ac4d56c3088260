//! Where numbers come from.

use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Where the numbers of a reproduction come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Version of this program.
    pub version: &'static str,
    /// Commit of its source, when that still lies where it was built.
    pub commit: Option<String>,
    /// Name of the solver.
    pub solver: String,
    /// Tolerance per step of the solver.
    pub tolerance: f64,
    /// Relative accuracy asked of ToFs.
    pub accuracy_asked: f64,
    /// Largest relative accuracy reached of all ToFs.
    pub accuracy_reached: f64,
    /// Seed of all draws.
    pub seed: u64,
    /// Draws of the printed constants within their rounding.
    pub draws: usize,
    /// Instruction set, operating system, processor, number of threads.
    pub machine: String,
    /// Wall time in s.
    pub wall_time_s: f64,
}

impl Provenance {
    /// As JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        json!({
            "program": "hertzchain",
            "version": self.version,
            "commit": self.commit,
            "solver": self.solver,
            "tolerance": self.tolerance,
            "accuracy_asked": self.accuracy_asked,
            "accuracy_reached": self.accuracy_reached,
            "seed": self.seed,
            "draws_within_rounding": self.draws,
            "machine": self.machine,
            "finished_unix_s": now.as_ref().map_or(0, Duration::as_secs),
            "wall_time_s": self.wall_time_s,
        })
    }
}

/// The commit of the source that this was built from, if it still is there.
#[must_use]
pub fn commit() -> Option<String> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR"));
    let git = source
        .ancestors()
        .map(|folder| folder.join(".git"))
        .find(|git| git.is_dir())?;
    let head = fs::read_to_string(git.join("HEAD")).ok()?;
    let head = head.trim();
    let Some(branch) = head.strip_prefix("ref: ") else {
        return Some(head.to_owned());
    };
    if let Ok(commit) = fs::read_to_string(git.join(branch)) {
        return Some(commit.trim().to_owned());
    }
    let packed = fs::read_to_string(git.join("packed-refs")).ok()?;
    let line = packed.lines().find(|line| line.ends_with(branch))?;
    line.split(' ').next().map(str::to_owned)
}

/// Instruction set, operating system, processor, number of threads.
#[must_use]
pub fn machine() -> String {
    let threads = rayon::current_num_threads();
    let (arch, os) = (std::env::consts::ARCH, std::env::consts::OS);
    let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = about.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| line.split(": ").nth(1));
    let model = model.map_or(String::new(), |model| format!(", {model}"));
    format!("{arch}, {os}{model}, {threads} threads")
}
