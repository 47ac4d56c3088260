//! Shots measured as they come: in a folder, through a pipe, and after a kill.

use crate::common::{file, folder, run};
use crate::measure::{volts, write};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const SPEEDS: [f64; 4] = [0.2, 0.4, 0.7, 1.0];

/// Time without news after which the program ends: many looks into the folder, which come every 0.1 s.
const STOP: &str = "2s";

struct Live {
    program: Child,
    lines: BufReader<ChildStdout>,
}

impl Live {
    fn start(arguments: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"))
            .args(["live", "--json"])
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(program.stdout.take().unwrap());
        Self { program, lines }
    }

    fn line(&mut self) -> Value {
        let mut line = String::new();
        self.lines.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap()
    }

    /// The lines that are left, and whether it ended well.
    fn rest(mut self) -> (usize, bool) {
        let mut rest = String::new();
        self.lines.read_to_string(&mut rest).unwrap();
        (rest.lines().count(), self.program.wait().unwrap().success())
    }
}

/// A recorder: a line of the table, then the file, which gets its name when it is whole.
fn record(shots: &Path, list: &Path, number: usize) {
    let name = format!("shot-{number}.csv");
    let mut lines = fs::OpenOptions::new().append(true).open(list).unwrap();
    writeln!(lines, "{name},dry,{},0.001", SPEEDS[number]).unwrap();
    write(&shots.join("growing"), &volts(SPEEDS[number], 1.0));
    fs::rename(shots.join("growing"), shots.join(name)).unwrap();
}

fn setup(test: &str) -> (PathBuf, PathBuf, String) {
    let all = folder(test);
    let shots = all.join("shots");
    fs::create_dir_all(&shots).unwrap();
    let list = file(&all, "list.txt", "file,case,speed,speed error\n");
    (all, shots, list)
}

fn assert_same_tables(live: &Path, measured: &Path) {
    for table in ["shots.csv", "speeds.csv", "power-laws.csv", "measured.json"] {
        let [live, measured] = [live, measured].map(|folder| folder.join(table));
        assert_eq!(fs::read(live).unwrap(), fs::read(measured).unwrap(), "{table}");
    }
}

#[test]
fn a_folder_that_fills_gives_the_tables_of_measure_also_after_a_kill() {
    let (all, shots, list) = setup("live-folder");
    // What is no recording, and a line about a file that never comes, are in the tables too.
    fs::write(shots.join("sketch.pdf"), "").unwrap();
    let mut lines = fs::OpenOptions::new().append(true).open(&list).unwrap();
    writeln!(lines, "absent.csv,dry,0.3,0.001").unwrap();
    let (into, out, measured) = (shots.to_str().unwrap(), all.join("live"), all.join("measured"));
    let arguments = [into, "--shots", &list, "--out", out.to_str().unwrap(), "--stop-after", STOP];
    let mut live = Live::start(&arguments);
    for (number, speed) in SPEEDS.into_iter().enumerate().take(2) {
        record(&shots, Path::new(&list), number);
        let line = live.line();
        assert_eq!(line["shot"]["speed_m_s"]["value"], speed, "{line}");
        assert_eq!(line["mean"]["shots"], 1, "{line}");
    }
    live.program.kill().unwrap();
    live.program.wait().unwrap();
    record(&shots, Path::new(&list), 2);
    let mut live = Live::start(&arguments);
    let lines: Vec<Value> = (0..3).map(|_| live.line()).collect();
    record(&shots, Path::new(&list), 3);
    let last = live.line();
    // Bells of one shape at 630 µs v^-0.2, one sample wide at most off.
    let exponent = last["power_law_incident"]["exponent"].as_f64().unwrap();
    assert!((exponent + 0.2).abs() < 1e-3, "{exponent} {lines:?}");
    assert_eq!(live.rest(), (0, true));
    let whole = run(&["measure", into, "--shots", &list, "--out", measured.to_str().unwrap()]);
    assert!(whole.status.success());
    assert_same_tables(&out, &measured);
    let found = fs::read_to_string(out.join("measured.json")).unwrap();
    assert!(found.contains("absent.csv is none of the files given"), "{found}");
    assert!(found.contains("sketch.pdf"), "{found}");
}

/// Both sensors' sum in counts, with quiet before and after each shot.
fn counts(speeds: &[f64]) -> Vec<u8> {
    let shot = |speed: &f64| [vec![0.0; 12_000], volts(*speed, 1.0), vec![0.0; 12_000]].concat();
    let volts = speeds.iter().flat_map(shot);
    volts.flat_map(|volt| ((1e4 * volt).round() as i16).to_le_bytes()).collect()
}

#[test]
fn a_stream_is_stored_shot_by_shot_and_measured_as_its_stored_shots_are() {
    let (all, _, list) = setup("live-stream");
    let out = all.join("live");
    let mut lines = fs::OpenOptions::new().append(true).open(&list).unwrap();
    for (number, speed) in SPEEDS.iter().enumerate() {
        writeln!(lines, "shot-{:06}.npy,dry,{speed},0.001", number + 1).unwrap();
    }
    let stream = ["--rate", "1MHz", "--level", "3000", "--shots", &list, "--out"];
    let stream = [&stream[..], &[out.to_str().unwrap()]].concat();
    let mut live = Live::start(&[&["-"], &stream[..]].concat());
    let mut input = live.program.stdin.take().unwrap();
    input.write_all(&counts(&SPEEDS[..2])).unwrap();
    drop(input);
    assert_eq!(live.rest(), (2, true));
    // A second run, of a recorder that is a server, goes on behind the first.
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("tcp://{}", server.local_addr().unwrap());
    let live = Live::start(&[&[address.as_str()], &stream[..]].concat());
    server.accept().unwrap().0.write_all(&counts(&SPEEDS[2..])).unwrap();
    assert_eq!(live.rest(), (4, true));
    let (records, measured) = (out.join("records"), all.join("measured"));
    let whole = ["--rate", "1MHz", "--whole", "--shots", &list, "--out"];
    let whole = [&["measure", records.to_str().unwrap()], &whole[..]].concat();
    assert!(run(&[&whole[..], &[measured.to_str().unwrap()]].concat()).status.success());
    assert_same_tables(&out, &measured);
    let laws = fs::read_to_string(out.join("power-laws.csv")).unwrap();
    assert!(laws.lines().count() > 1, "{laws}");
}

#[test]
fn a_stream_of_another_rate_does_not_go_on_behind_the_first() {
    let (all, ..) = setup("live-rates");
    let out = all.join("live");
    let stream = |rate: &str| {
        let stream = ["-", "--rate", rate, "--level", "3000", "--out", out.to_str().unwrap()];
        let mut live = Live::start(&stream);
        live.program.stdin.take().unwrap().write_all(&counts(&SPEEDS[..1])).unwrap_or_default();
        let mut reported = String::new();
        live.program.stderr.take().unwrap().read_to_string(&mut reported).unwrap();
        (live.rest(), reported)
    };
    assert_eq!(stream("1MHz").0, (1, true));
    let (ended, reported) = stream("500kHz");
    assert_eq!(ended, (0, false));
    assert!(reported.contains("--channels 1 --samples i16, not --rate 500000"), "{reported}");
    assert_eq!(stream("1MHz").0, (2, true));
}

#[test]
fn a_recording_that_is_deleted_leaves_the_tables() {
    let (all, shots, list) = setup("live-deleted");
    let (into, out) = (shots.to_str().unwrap(), all.join("live"));
    let arguments = [into, "--shots", &list, "--out", out.to_str().unwrap(), "--stop-after", STOP];
    let mut live = Live::start(&arguments);
    (0..2).for_each(|number| record(&shots, Path::new(&list), number));
    let _ = [live.line(), live.line()];
    fs::remove_file(shots.join("shot-0.csv")).unwrap();
    assert_eq!(live.rest(), (0, true));
    let table = fs::read_to_string(out.join("shots.csv")).unwrap();
    assert!(!table.contains("shot-0.csv") && table.contains("shot-1.csv"), "{table}");
}

#[test]
fn what_to_measure_next_follows_each_shot() {
    let (_, shots, list) = setup("live-next");
    let model = ["--model", "dry", "--free", "eta", "--stop-after", STOP];
    let mut live =
        Live::start(&[&[shots.to_str().unwrap(), "--shots", &list], &model[..]].concat());
    for number in 0..3 {
        record(&shots, Path::new(&list), number);
        let line = live.line();
        assert_eq!(line["mean"]["shots"], 1, "the shot is there before: {line}");
        assert_eq!(line["next"], Value::Null);
        let proposed = live.line();
        assert_eq!(proposed["shot"]["file"], line["shot"]["file"]);
        let next = proposed["next"].as_str();
        assert!(next.is_some_and(|next| next.contains("m/s")), "{proposed}");
    }
    assert_eq!(live.rest(), (0, true));
}

#[test]
fn why_nothing_can_be_proposed_yet_is_reported() {
    let (_, shots, list) = setup("live-next-missing");
    let model = ["--model", "dry", "--free", "eta", "--stop-after", STOP];
    let mut live =
        Live::start(&[&[shots.to_str().unwrap(), "--shots", &list], &model[..]].concat());
    // Its speed is nowhere stated.
    write(&shots.join("unlisted.csv"), &volts(0.3, 1.0));
    let line = live.line();
    assert_eq!((&line["next"], &line["next_missing"]), (&Value::Null, &Value::Null));
    let proposed = live.line();
    assert_eq!(proposed["shot"]["file"], line["shot"]["file"]);
    assert_eq!(proposed["next"], Value::Null);
    let why = proposed["next_missing"].as_str().unwrap();
    assert!(why.contains("measured"), "{why}");
    record(&shots, Path::new(&list), 0);
    assert_eq!(live.line()["mean"]["shots"], 1);
    let proposed = live.line();
    assert!(proposed["next"].is_string() && proposed["next_missing"].is_null(), "{proposed}");
    assert_eq!(live.rest(), (0, true));
}

#[test]
fn live_ends_after_the_time_without_shots_that_it_is_given() {
    let (_, shots, list) = setup("live-stop-after");
    let begun = Instant::now();
    let arguments = [shots.to_str().unwrap(), "--shots", &list, "--stop-after", "700ms"];
    let mut live = Live::start(&arguments);
    sleep(Duration::from_millis(400));
    record(&shots, Path::new(&list), 0);
    assert_eq!(live.line()["mean"]["shots"], 1);
    let seen = begun.elapsed();
    assert_eq!(live.rest(), (0, true));
    // From the last shot on, not from the start.
    assert!(begun.elapsed() - seen > Duration::from_millis(600), "{:?}", begun.elapsed());
    let output = run(&["live", shots.to_str().unwrap(), "--stop-after", "soon"]);
    let reported = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{reported}");
    assert!(reported.contains("--stop-after"), "{reported}");
}

#[test]
fn live_replaces_tables_of_its_own_recordings_only() {
    let (all, shots, list) = setup("live-replaced");
    record(&shots, Path::new(&list), 0);
    let (into, out) = (shots.to_str().unwrap(), all.join("out"));
    let arguments =
        [into, "--shots", &list, "--out", out.to_str().unwrap(), "--stop-after", "600ms"];
    for _ in 0..2 {
        let mut live = Live::start(&arguments);
        assert_eq!(live.line()["mean"]["shots"], 1);
        assert_eq!(live.rest(), (0, true));
    }
    let kept = fs::read(out.join("measured.json")).unwrap();
    let empty = all.join("empty");
    fs::create_dir_all(&empty).unwrap();
    let other = [&["live", empty.to_str().unwrap()], &arguments[3..]].concat();
    let refused = run(&other);
    let reported = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{reported}");
    assert!(reported.contains("measured.json is there already"), "{reported}");
    assert!(fs::read(out.join("measured.json")).unwrap() == kept);
    assert!(run(&[&other[..], &["--force"]].concat()).stderr.starts_with(b"measuring"));
}

#[test]
fn a_table_of_shots_that_breaks_is_reported_and_its_last_state_holds_until_it_is_mended() {
    let (_, shots, list) = setup("live-list");
    let into = shots.to_str().unwrap();
    let mut live = Live::start(&[into, "--shots", &list, "--stop-after", STOP]);
    record(&shots, Path::new(&list), 0);
    assert_eq!(live.line()["mean"]["shots"], 1);
    let good = fs::read_to_string(&list).unwrap();
    fs::write(&list, good.replace("0.2", "fast")).unwrap();
    write(&shots.join("later.csv"), &volts(0.3, 1.0));
    assert_eq!(live.line()["mean"], Value::Null);
    fs::write(&list, good + "later.csv,dry,0.3,0.001\n").unwrap();
    assert_eq!(live.line()["shot"]["speed_m_s"]["value"], 0.3);
    let mut program = live.program;
    let mut reported = String::new();
    program.stderr.take().unwrap().read_to_string(&mut reported).unwrap();
    assert!(program.wait().unwrap().success(), "{reported}");
    assert!(reported.contains("fast") && reported.contains("warning"), "{reported}");
}

#[test]
fn a_source_that_cannot_be_followed_is_named_with_the_options_that_it_needs() {
    for (arguments, words) in [
        (&["live", "no-folder"][..], "no-folder is no folder"),
        (&["live", "-"], "--rate, --level"),
        (&["live", "tcp://127.0.0.1:1", "--rate", "1MHz"], "tcp://127.0.0.1:1"),
        (&["live", ".", "--report", "page.html"], "--report"),
        (&["live", ".", "--free", "eta"], "--model"),
    ] {
        let output = run(arguments);
        let reported = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{reported}");
        assert!(reported.contains(words), "{reported}");
    }
}
