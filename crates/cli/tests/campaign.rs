//! `hertzchain campaign`: killed, resumed, dealt out, read by others.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

#[path = "../../records/tests/common/mod.rs"]
mod records;

use records::python;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// Twelve beads, eight speeds, few samples.
const SMALL: &str = r#"
title = "A small campaign"

[materials.steel]
young_modulus = "213 GPa"
poisson_ratio = 0.3
shear_viscosity = "3.2e4 Pa s"

[striker]
speed = "0.5 m/s"

[[beads]]
count = 12
radius = "6.35 mm"
mass = "8.54 g"
material = "steel"

[[contacts]]
laws = ["elastic_hertz", "damping_viscoelastic"]

[near_end]
push = "spring"
force = "0.24 N"
stiffness = "100 N/m"

[sensors]
bead = 4

[campaign]
seed = 7
slowest = "0.1 m/s"
fastest = "1 m/s"
speed_count = 8
shots = 4
taps = 2

[campaign.recorder]
sampling = "500 kHz"
record = "20 ms"
before = "1 ms"
"#;

/// A folder with the small campaign in it, gone at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("hertzchain-campaign-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("small.toml"), SMALL).unwrap();
        Self(path)
    }

    fn command(&self, out: &str, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        command
            .current_dir(&self.0)
            .args(["campaign", "small.toml", "--out", out]);
        command.args(more);
        command
    }

    fn run(&self, out: &str, more: &[&str]) -> Output {
        self.command(out, more).output().unwrap()
    }

    fn done(&self, out: &str, more: &[&str]) -> String {
        let output = self.run(out, more);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).unwrap()
    }

    /// Every file of a folder by name.
    fn files(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.0.join(out)).unwrap();
        let file = |path: &Path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, fs::read(path).unwrap())
        };
        entries.map(|entry| file(&entry.unwrap().path())).collect()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Delays in ms that differ from each other in no regular way.
fn delay_ms(attempt: u64) -> u64 {
    5 + (attempt * 2_654_435_761) % 120
}

/// `Child::kill` is SIGKILL, which nothing can catch.
#[test]
fn a_campaign_killed_many_times_ends_with_the_bytes_of_one_that_was_not() {
    let scratch = Scratch::new("killed");
    scratch.done("whole", &[]);
    let whole = scratch.files("whole");
    assert_eq!(whole.keys().filter(|name| name.ends_with(".h5")).count(), 8);
    let mut killed = 0;
    for attempt in 0..12 {
        let mut command = scratch.command("broken", &["--threads", "2"]);
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(delay_ms(attempt)));
        child.kill().unwrap();
        killed += usize::from(!child.wait().unwrap().success());
        // What has its name is whole, at any moment.
        for (name, bytes) in scratch.files_if_any("broken") {
            if name.ends_with(".h5") {
                assert!(whole[&name] == bytes, "{name} after {attempt} kills");
            }
        }
    }
    assert!(
        killed >= 3,
        "only {killed} runs were killed before their end"
    );
    scratch.done("broken", &[]);
    let mut broken = scratch.files("broken");
    broken.retain(|name, _| whole.contains_key(name));
    assert!(broken == whole);
    assert!(scratch.done("broken", &[]).contains("8 more series"));
}

impl Scratch {
    fn files_if_any(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        match self.0.join(out).is_dir() {
            true => self.files(out),
            false => BTreeMap::new(),
        }
    }
}

#[test]
fn parts_on_other_threads_make_the_same_files_as_the_whole() {
    let scratch = Scratch::new("dealt");
    scratch.done("whole", &["--threads", "1"]);
    for part in ["1/3", "2/3", "3/3"] {
        scratch.done("dealt", &["--shard", part, "--threads", "3"]);
    }
    assert!(scratch.files("whole") == scratch.files("dealt"));
}

#[test]
fn another_seed_needs_another_folder() {
    let scratch = Scratch::new("seed");
    scratch.done("out", &["--shard", "1/8"]);
    let refused = scratch.run("out", &["--shard", "1/8", "--seed", "8"]);
    assert_eq!(refused.status.code(), Some(2));
    let text = String::from_utf8_lossy(&refused.stderr);
    assert!(text.contains("another campaign"), "{text}");
    scratch.done("other", &["--shard", "1/8", "--seed", "8"]);
    let (one, other) = (scratch.files("out"), scratch.files("other"));
    for (name, bytes) in one.iter().filter(|(name, _)| name.ends_with(".h5")) {
        assert!(other[name] != *bytes, "{name}");
    }
}

#[test]
fn mistakes_of_the_command_line_are_told_with_exit_code_2() {
    let scratch = Scratch::new("mistakes");
    for (more, expected) in [
        (&["--shard", "4/3"][..], "expected i/n"),
        (&["--shard", "half"], "expected i/n"),
        (&["--seed", "-1"], "--seed"),
        (&["--threads", "0"], "from 1 to"),
    ] {
        let refused = scratch.run("out", more);
        assert_eq!(refused.status.code(), Some(2), "{more:?}");
        let text = String::from_utf8_lossy(&refused.stderr);
        assert!(text.contains(expected), "{more:?}: {text}");
    }
    let fast = SMALL.replace("fastest = \"1 m/s\"", "fastest = \"3 m/s\"");
    fs::write(scratch.0.join("small.toml"), fast).unwrap();
    let refused = scratch.run("out", &[]);
    let text = String::from_utf8_lossy(&refused.stderr);
    assert!(text.contains("from 0.05 to 2.5 m/s"), "{text}");
    let none = Command::new(env!("CARGO_BIN_EXE_hertzchain"))
        .arg("campaign")
        .output()
        .unwrap();
    assert!(String::from_utf8_lossy(&none.stderr).contains("--preset paper"));
}

/// What h5py finds in a recording.
const READ: &str = r#"
import h5py
with h5py.File("FILE") as file:
    samples = file['samples']
    assert samples.shape == (4, 10000) and samples.dtype == 'int16', samples
    volts = samples[0] * samples.attrs['scale_factor'] + samples.attrs['add_offset']
    assert 0.01 < volts.max() < 10, volts.max()
    assert list(file['shot'][:]) == [0, 1, 2, 3]
    assert abs(file['programmed_speed'][0] - 0.1) < 1e-4
    assert abs(file['measured_speed'][0] - 0.1) < 0.03
    assert file['truth/incident_tof_s'].shape == (4,)
    assert 'slowest' in file.attrs['experiment']
    assert samples.attrs['units'] == 'V'
print('read')
"#;

#[test]
fn h5py_reads_a_recording() {
    let scratch = Scratch::new("h5py");
    scratch.done("out", &["--shard", "1/8"]);
    let files = scratch.files("out");
    let name = files.keys().find(|name| name.ends_with(".h5")).unwrap();
    let program = READ.replace("FILE", name);
    let Some(printed) = python(&scratch.0.join("out"), &program) else {
        return;
    };
    assert_eq!(printed.trim(), "read");
}
