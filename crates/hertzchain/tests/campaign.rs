//! `hertzchain campaign`: killed, resumed, dealt out, read by others.

#[path = "../../measure/tests/records/common/mod.rs"]
mod records;

use records::python;
use std::collections::BTreeMap;
use std::fs;
use std::hash::{BuildHasher, DefaultHasher, Hash, Hasher, RandomState};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Twelve beads, two cases, few samples.
const SMALL: &str = include_str!("../../sim/tests/small.toml");

/// The same with eight series of four shots.
fn small() -> String {
    let more = SMALL.replace("speed_count = 3", "speed_count = 4");
    more.replace("shots = 3", "shots = 4")
}

/// A folder with the small campaign in it, gone at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("hertzchain-campaign-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("small.toml"), small()).unwrap();
        Self(path)
    }

    fn command(&self, out: &str, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        command.current_dir(&self.0).args(["campaign", "small.toml", "--out", out]);
        command.args(more);
        command
    }

    fn run(&self, out: &str, more: &[&str]) -> Output {
        self.command(out, more).output().unwrap()
    }

    fn done(&self, out: &str, more: &[&str]) -> String {
        let output = self.run(out, more);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
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

/// A moment between nothing and `longest`, drawn from a seed.
fn moment(seed: u64, attempt: u64, longest: Duration) -> Duration {
    let mut hasher = DefaultHasher::new();
    (seed, attempt).hash(&mut hasher);
    longest.mul_f64(hasher.finish() as f64 / u64::MAX as f64)
}

/// `Child::kill` is SIGKILL, which nothing can catch. Moments are others in every run of this
/// test; `HERTZCHAIN_KILL_SEED` repeats those of the seed that a failure prints.
#[test]
fn a_campaign_killed_many_times_ends_with_the_bytes_of_one_that_was_not() {
    let scratch = Scratch::new("killed");
    let reported = std::env::var("HERTZCHAIN_KILL_SEED").ok();
    let seed = reported
        .map_or_else(|| RandomState::new().hash_one("moments"), |seed| seed.parse().unwrap());
    println!("seed of the moments: HERTZCHAIN_KILL_SEED={seed}");
    let begun = Instant::now();
    scratch.done("whole", &["--threads", "2"]);
    // Three runs so short together cannot finish what the whole one took.
    let longest = begun.elapsed() / 4;
    let whole = scratch.files("whole");
    assert_eq!(whole.keys().filter(|name| name.ends_with(".h5")).count(), 8);
    let mut killed = 0;
    for attempt in 0..12 {
        let mut command = scratch.command("broken", &["--threads", "2"]);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(moment(seed, attempt, longest));
        child.kill().unwrap();
        killed += usize::from(!child.wait().unwrap().success());
        // What has its name is whole, at any moment.
        for (name, bytes) in scratch.files_if_any("broken") {
            if name.ends_with(".h5") {
                assert!(whole[&name] == bytes, "{name} after {attempt} kills");
            }
        }
    }
    assert!(killed >= 3, "only {killed} runs were killed before their end");
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

/// The shell lets no file grow beyond 16 blocks of 512 or 1024 bytes. Without
/// the trap the system would kill the program that tries; with it the write fails,
/// as on a full disk.
#[cfg(unix)]
#[test]
fn a_full_disk_is_a_clear_error_and_leaves_what_was_finished() {
    let scratch = Scratch::new("full");
    scratch.done("whole", &[]);
    scratch.done("out", &["--shard", "1/8"]);
    let before = scratch.files("out");
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" campaign small.toml --out out";
    let refused = Command::new("sh")
        .current_dir(&scratch.0)
        .args(["-c", limited, env!("CARGO_BIN_EXE_hertzchain")])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{text}");
    assert!(text.contains("cannot be written"), "{text}");
    assert!(text.contains("files finished before are intact"), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    assert!(scratch.files("out") == before, "no part is left");
    scratch.done("out", &[]);
    assert!(scratch.files("out") == scratch.files("whole"));
}

/// Incident times of flight with their errors, in s, as `measure` finds them.
fn measured(scratch: &Scratch, out: &str) -> Vec<(f64, f64)> {
    let output = Command::new(env!("CARGO_BIN_EXE_hertzchain"))
        .current_dir(&scratch.0)
        .args(["measure", out, "--json"])
        .output()
        .unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let shots = found["shots"].as_array().unwrap().iter();
    let tof = |shot: &serde_json::Value| {
        let tof = &shot["tof_incident_s"];
        (tof["value"].as_f64().unwrap(), tof["sigma"].as_f64().unwrap())
    };
    shots.map(tof).collect()
}

#[test]
fn measure_reads_separate_channels_as_it_reads_the_summed_one() {
    let scratch = Scratch::new("separate");
    scratch.done("summed", &["--shard", "1/4"]);
    let separate =
        small().replace("[campaign.recorder]", "[campaign.recorder]\nchannels = \"separate\"");
    fs::write(scratch.0.join("small.toml"), separate).unwrap();
    scratch.done("separate", &["--shard", "1/4"]);
    let (one, two) = (measured(&scratch, "summed"), measured(&scratch, "separate"));
    // Two series of four shots.
    assert_eq!((one.len(), two.len()), (8, 8));
    for ((one_s, one_error_s), (two_s, two_error_s)) in one.into_iter().zip(two) {
        // Five standard errors of the difference: the noise is another.
        let sure_s = 5.0 * one_error_s.hypot(two_error_s);
        assert!((one_s - two_s).abs() < sure_s, "{one_s} {two_s} ± {sure_s}");
    }
}

/// Reported by the campaign, also of files that are there already, and by `measure` of each shot.
#[test]
fn shots_that_never_pass_the_level_are_told() {
    let scratch = Scratch::new("level");
    let level = "[campaign.recorder]\ntrigger = \"level\"\nlevel = \"9 V\"";
    let high = small().replace("[campaign.recorder]", level);
    fs::write(scratch.0.join("small.toml"), high).unwrap();
    for _ in 0..2 {
        let output = scratch.run("high", &[]);
        assert!(output.status.success());
        let reported = String::from_utf8_lossy(&output.stderr);
        assert!(reported.contains("32 shots never passed"), "{reported}");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_hertzchain"))
        .current_dir(&scratch.0)
        .args(["measure", "high", "--json"])
        .output()
        .unwrap();
    let reported = String::from_utf8_lossy(&output.stdout);
    assert_eq!(reported.matches("no trigger").count(), 32, "{reported}");
}

#[test]
fn a_record_too_short_is_warned_of_and_a_rate_without_pulses_refused() {
    let scratch = Scratch::new("outlook");
    let with = |from: &str, to: &str| {
        assert!(small().contains(from), "{from}");
        fs::write(scratch.0.join("small.toml"), small().replace(from, to)).unwrap();
    };
    with("record = \"20 ms\"", "record = \"6 ms\"");
    let short = scratch.run("short", &[]);
    assert!(short.status.success());
    let reported = String::from_utf8_lossy(&short.stderr);
    assert!(reported.contains("warning: case `dry` at 0.0910 m/s: the record ends"), "{reported}");
    with("sampling = \"500 kHz\"", "sampling = \"1 kHz\"");
    let slow = scratch.run("slow", &[]);
    assert_eq!(slow.status.code(), Some(2));
    let reported = String::from_utf8_lossy(&slow.stderr);
    assert!(reported.contains("sampled at 1 kHz"), "{reported}");
    assert!(!scratch.0.join("slow").exists());
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
    let fast = SMALL.replace("fastest = \"0.9 m/s\"", "fastest = \"3 m/s\"");
    fs::write(scratch.0.join("small.toml"), fast).unwrap();
    let refused = scratch.run("out", &[]);
    let text = String::from_utf8_lossy(&refused.stderr);
    assert!(text.contains("from 0.05 to 2.5 m/s"), "{text}");
    let none = Command::new(env!("CARGO_BIN_EXE_hertzchain")).arg("campaign").output().unwrap();
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
    truth = file['truth']
    names = {truth[name].attrs['long_name'] for name in truth}
    assert len(names) == len(truth) and 'true value' not in names, names
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
