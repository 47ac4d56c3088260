//! Where numbers come from.

use serde_json::{Value, json};
use std::fs;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Name of the file.
pub const PROVENANCE: &str = "provenance.json";

/// What the file says wrote it.
pub(super) const PROGRAM: &str = "hertzchain";

/// Where the numbers of a reproduction come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Version of this program.
    pub version: &'static str,
    /// Commit that was built, when known.
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
    /// As JSON, with the names of the run's files.
    #[must_use]
    pub fn json(&self, files: &[&str]) -> Value {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        json!({
            "program": PROGRAM,
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
            "files": files,
        })
    }
}

/// Instruction set, operating system, processor, number of threads.
#[must_use]
pub(super) fn machine() -> String {
    let threads = rayon::current_num_threads();
    let (arch, os) = (std::env::consts::ARCH, std::env::consts::OS);
    let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = about.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| line.split(": ").nth(1));
    let model = model.map_or(String::new(), |model| format!(", {model}"));
    format!("{arch}, {os}{model}, {threads} threads")
}
