//! The program as a user meets it: what it prints, what it writes, how it ends.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_hertzchain"))
}

fn run(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Standard output of a run that must succeed.
fn good(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(code(&output), 0, "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// Standard error of a run that must be the user's mistake.
fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = text(&output.stderr);
    assert_eq!(code(&output), 2, "{arguments:?}: {message}");
    assert!(!message.contains("panicked"), "{message}");
    message
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&good(arguments)).unwrap()
}

/// An empty folder of this test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_shot_prints_its_times_of_flight() {
    let text = good(&["shot", "--preset", "hertz", "--speed", "1 m/s"]);
    // The reference's digits, rounded to the accuracy reached.
    assert!(text.contains("630.8416 µs") && text.contains("632.2657 µs"), "{text}");
    for word in ["rebound", "striker", "residual", "wide at half maximum", "beads/s"] {
        assert!(word == "rebound" || text.contains(word), "{word} in {text}");
    }
}

#[test]
fn a_shot_as_json_has_the_reference_times() {
    let shot = json(&["shot", "-p", "dry", "-s", "1.23", "-a", "1e-9", "--json", "--check"]);
    let close = |key: &str, expected: f64| {
        let found = shot[key].as_f64().unwrap();
        // Half a unit of the reference's last digit is 1e-9 of it.
        assert!((found / expected - 1.0).abs() < 2e-9, "{key}: {found}");
    };
    close("tof_incident_s", 660.261248e-6);
    close("tof_reflected_s", 699.493431e-6);
    assert!(shot["accuracy_reached"].as_f64().unwrap() < 1e-9);
    assert!(shot["energy"]["relative_residual"].as_f64().unwrap().abs() < 1e-9);
    assert_eq!(shot["speed_m_s"], 1.23);
}

#[test]
fn every_preset_and_example_can_be_shot_and_checked() {
    let list = good(&["presets"]);
    let names: Vec<&str> = (list.lines())
        .filter(|line| line.starts_with("  "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(names.len() >= 17, "{names:?}");
    for name in names {
        assert!(good(&["check", "--preset", name]).contains("number of beads"), "{name}");
        let _ = good(&["theory", "--preset", name]);
        // Twenty seconds each to this accuracy.
        if name.ends_with("-film") {
            continue;
        }
        let shot = json(&["shot", "--preset", name, "--json"]);
        assert!(shot["duration_s"].as_f64().unwrap() > 0.0, "{name}");
        // The accuracy asked by default, 1e-6, holds for the energy too.
        let residual = shot["energy"]["relative_residual"].as_f64().unwrap();
        assert!(residual.abs() < 1e-6, "{name}: {residual:e}");
    }
}

#[test]
fn a_preset_printed_and_opened_again_is_the_same_experiment() {
    let folder = folder("preset");
    let file = folder.join("mine.toml");
    fs::write(&file, good(&["presets", "motor"])).unwrap();
    let path = file.to_str().unwrap();
    let of = |arguments: &[&str]| json(arguments)["tof_incident_s"].clone();
    assert_eq!(of(&["shot", path, "--json"]), of(&["shot", "-p", "motor", "--json"]));
}

#[test]
fn a_shot_writes_traces_figures_arrays_and_a_moving_picture() {
    let folder = folder("shot");
    let out = folder.join("deep/out");
    let path = out.to_str().unwrap();
    good(&["shot", "-p", "pump", "--out", path, "--npy", "--animate"]);
    let expected = [
        "animation.html",
        "energy.csv",
        "energy.png",
        "energy.svg",
        "experiment.toml",
        "force_n.npy",
        "position_m.npy",
        "shot.json",
        "signals.png",
        "signals.svg",
        "time_s.npy",
        "traces.csv",
        "velocity_m_s.npy",
    ];
    assert_eq!(names(&out), expected);
    let traces = fs::read_to_string(out.join("traces.csv")).unwrap();
    assert!(traces.starts_with("time_s,sensor_bead_7_n,wall_n"), "{}", &traces[..80]);
    assert!(traces.lines().count() > 1000);
    assert!(fs::read(out.join("position_m.npy")).unwrap().starts_with(b"\x93NUMPY"));
    let page = fs::read_to_string(out.join("animation.html")).unwrap();
    assert!(page.contains("</html>") && !page.contains("src=\"http"));
}

#[test]
fn a_shot_keeps_what_was_shot_and_replaces_another_only_if_asked() {
    let folder = folder("kept");
    let path = folder.to_str().unwrap();
    let again = ["shot", "-p", "hertz", "--speed", "0.25", "-a", "1e-5", "--out", path, "--force"];
    good(&again[..again.len() - 1]);
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let kept: Value = serde_json::from_str(&read("shot.json")).unwrap();
    assert_eq!(kept["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!((&kept["experiment"], &kept["speed_m_s"]), (&"hertz.toml".into(), &0.25.into()));
    assert_eq!(kept["options"]["accuracy"], 1e-5);
    assert_eq!(read("experiment.toml"), good(&["presets", "hertz"]));
    assert!(read("signals.svg").contains("0.25 m/s"));
    let message = refused(&["shot", "-p", "dry", "--out", path]);
    assert!(
        message.contains("shot.json is there already") && message.contains("--force"),
        "{message}"
    );
    assert!(read("shot.json").contains("hertz.toml"));
    good(&again);
}

#[test]
fn no_verb_replaces_files_of_an_earlier_run_unless_asked() {
    let folder = folder("replaced");
    let at = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (dry, page) = (at("dry"), at("page.html"));
    let sweep = ["sweep", "-p", "dry", "--speeds", "log:0.1:1.2:6", "-a", "1e-4", "--out", &dry];
    good(&sweep);
    let data = at("dry/sweep.csv");
    let fit = ["--preset", "dry", "--free", "eta", "--tof-error", "1us"];
    let verbs: [(&str, &[&str], &str); 8] = [
        ("sweep", &["-p", "dry", "--speeds", "1,2"], "sweep.csv"),
        ("measure", &[&data], "measured.json"),
        ("fit", &[&[&data[..]], &fit[..]].concat(), "fit.json"),
        ("fit", &[&[&data[..]], &fit[..]].concat(), "chain.json"),
        ("design", &[&[&data[..]], &fit[..]].concat(), "design.json"),
        ("gauge", &[&data, "--dry", &data, "--tof-error", "1us"], "gauge.json"),
        ("live", &[folder.to_str().unwrap(), "--stop-after", "1ms"], "measured.json"),
        ("reproduce", &[], "claims.md"),
    ];
    for (verb, arguments, file) in verbs {
        let out = at(&format!("{verb}-{file}"));
        fs::create_dir(&out).unwrap();
        fs::write(folder.join(&out).join(file), "earlier").unwrap();
        let message = refused(&[&[verb], arguments, &["--out", &out]].concat());
        assert!(message.contains(&format!("{file} is there already")), "{verb}: {message}");
        assert_eq!(fs::read_to_string(folder.join(&out).join(file)).unwrap(), "earlier");
    }
    fs::write(&page, "earlier").unwrap();
    let message = refused(&["measure", &data, "--report", &page]);
    assert!(message.contains("page.html is there already") && message.contains("--report"));
    good(&[&sweep[..], &["--force"]].concat());
}

#[test]
fn a_sweep_prints_the_power_law_of_hertz() {
    let swept = json(&["sweep", "-p", "hertz", "--speeds", "log:0.1:1:5", "-a", "1e-10", "--json"]);
    let exponent = swept["power_law_incident"]["exponent"].as_f64().unwrap();
    // Ten times the accuracy asked of each time, over a decade in speed.
    assert!((exponent + 0.2).abs() < 1e-9, "{exponent}");
    assert_eq!(swept["points"].as_array().unwrap().len(), 5);
    let text = good(&["sweep", "-p", "hertz", "--speeds", "0.1, 500 mm/s"]);
    assert!(text.contains("^(-0.2"), "{text}");
}

#[test]
fn a_sweep_gives_the_same_bytes_on_one_and_on_two_threads() {
    let with = |threads: &str| {
        let speeds = ["sweep", "-p", "gear", "--speeds", "0.1:1:6", "--json", "--threads", threads];
        good(&speeds)
    };
    assert_eq!(with("1"), with("2"));
}

#[test]
fn a_sweep_writes_its_table_and_figure() {
    let folder = folder("sweep");
    let path = folder.to_str().unwrap();
    good(&["sweep", "-p", "dry", "--speeds", "0.2,0.5,1", "--out", path]);
    assert_eq!(names(&folder), ["sweep.csv", "sweep.png", "sweep.svg"]);
    let table = fs::read_to_string(folder.join("sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 4);
}

#[test]
fn check_prints_what_follows_from_the_paper_s_numbers() {
    let text = good(&["check", "--preset", "dry"]);
    // K and A of the paper's balls, to six digits.
    assert!(text.contains("8.79263e9 N/m^(3/2)") && text.contains("338.529 ns"), "{text}");
    let loaded = good(&["check", "--preset", "precompressed"]);
    for word in ["static overlap", "sound speed", "cutoff frequency", "recommended step"] {
        assert!(loaded.contains(word), "{word} in {loaded}");
    }
}

#[test]
fn laws_lists_the_whole_registry() {
    let listed = json(&["laws", "--json"]);
    let registry = hertzchain_chain::laws::LAWS;
    assert_eq!(listed.as_array().unwrap().len(), registry.len());
    let text = good(&["laws"]);
    for row in registry {
        assert!(text.contains(row.info.name) && text.contains(row.info.equation));
    }
    assert!(good(&["laws", "damping_cubic"]).contains("kg s/m^2"));
}

#[test]
fn laws_print_the_work_that_each_is_from() {
    let text = good(&["laws", "damping_tsuji"]);
    for words in [
        "Tsuji, Y.; Tanaka, T.; Ishida, T.",
        "Lagrangian numerical simulation of plug flow",
        "Powder Technology 71, 239–250 (1992) [Tsuji1992]",
        "default: the section's elastic_hertz, else the materials",
    ] {
        assert!(text.contains(words), "{words} in {text}");
    }
    for law in json(&["laws", "--json"]).as_array().unwrap() {
        let source = &law["source"];
        assert!(law["reference"].is_string(), "{law}");
        assert!(source["authors"][0].is_string(), "{law}");
        assert!(source["title"].is_string() && source["year"].is_i64(), "{law}");
    }
    let hertz = json(&["laws", "elastic_hertz", "--json"]);
    assert!(hertz[0]["source"]["journal"].as_str().unwrap().contains("für"));
}

#[test]
fn schema_completions_and_manual_pages_come_from_the_program() {
    let schema = json(&["schema"]);
    for files in ["then", "else"] {
        assert!(schema[files]["properties"]["beads"].is_object(), "{files}");
    }
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(good(&["completions", shell]).contains("reproduce"), "{shell}");
    }
    assert!(good(&["man"]).contains(".TH"));
    let folder = folder("man");
    good(&["man", "--out", folder.to_str().unwrap()]);
    assert!(names(&folder).contains(&"hertzchain-shot.1".to_owned()));
    assert!(good(&["--version"]).contains(env!("CARGO_PKG_VERSION")));
}

#[test]
fn the_user_s_mistakes_end_with_code_2_and_say_what_was_expected() {
    let cases: &[(&[&str], &str)] = &[
        (&["shot", "--preset", "drry"], "did you mean `dry`"),
        (&["shot", "no-such-file.toml"], "no-such-file.toml"),
        (&["shot", "dry"], "--preset dry"),
        (&["shot", "--speed", "0"], "not positive"),
        (&["shot", "--speed", "-1"], "not positive"),
        (&["shot", "--speed", "3 kg"], "speed"),
        (&["shot", "--speed", "nan"], "nan"),
        (&["shot", "--speed", "1e400"], "too large"),
        (&["shot", "--accuracy", "0"], "1e-13"),
        (&["shot", "--accuracy", "tight"], "number"),
        (&["shot", "--step", "1 us"], "--solver"),
        (&["shot", "--step", "1 kg", "--solver", "rk4"], "time"),
        (&["shot", "--npy"], "--out"),
        (&["shot", "--solver", "euler"], "adaptive"),
        (&["shot", "-p", "newtons-cradle", "--duration", "-1 s"], "not positive"),
        (&["sweep", "--speeds", ""], "m/s"),
        (&["sweep", "--speeds", "1:2:1000000000000"], "speeds"),
        (&["sweep", "--speeds", "-1"], "not positive"),
        (&["check"], "FILE"),
        (&["laws", "hertz"], "elastic_hertz"),
        (&["completions", "dos"], "bash"),
        (&["fire"], "fire"),
    ];
    for (arguments, expected) in cases {
        let message = refused(arguments);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
}

fn mistaken(name: &str, from: &str, to: &str) -> String {
    let folder = folder(name);
    let file = folder.join("mine.toml");
    let dry = good(&["presets", "dry"]);
    assert!(dry.contains(from));
    fs::write(&file, dry.replacen(from, to, 1)).unwrap();
    refused(&["check", file.to_str().unwrap()])
}

#[test]
fn a_mistake_in_a_file_is_shown_at_its_line_underlined() {
    let message = mistaken("weight", "radius = \"6.35 mm\"", "radius = \"6.35 kg\"");
    assert!(message.contains("mine.toml:"), "{message}");
    assert!(message.contains("radius = \"6.35 kg\"") && message.contains('─'), "{message}");
    assert!(message.contains("a length in m"), "{message}");
    let unknown = mistaken("unknown", "radius = \"6", "raduis = \"6");
    assert!(unknown.contains("did you mean `radius`?"), "{unknown}");
    assert!(mistaken("many", "count = 40", "count = 1000000000000").contains("count"));
}

#[test]
fn an_unwritable_folder_is_refused_before_anything_is_computed() {
    let folder = folder("unwritable");
    let file = folder.join("file");
    fs::write(&file, "in the way").unwrap();
    let path = file.join("out");
    for verb in ["shot", "sweep", "reproduce"] {
        let message = refused(&[verb, "--out", path.to_str().unwrap()]);
        assert!(message.contains("cannot write into"), "{message}");
    }
    assert_eq!(names(&folder), ["file"]);
}

#[test]
fn a_failed_shot_leaves_no_files() {
    let folder = folder("failed");
    let out = folder.to_str().unwrap();
    refused(&[
        "shot",
        "-p",
        "dry",
        "--solver",
        "verlet",
        "-a",
        "1e-13",
        "--duration",
        "0.1 ms",
        "--out",
        out,
    ]);
    assert!(names(&folder).is_empty(), "{:?}", names(&folder));
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let mut child =
        program().args(["laws"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 0);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn piped_output_has_no_colour_and_no_progress_bar() {
    let output = run(&["sweep", "-p", "hertz", "--speeds", "0.5,1"]);
    assert!(!text(&output.stdout).contains('\u{1b}'));
    assert_eq!(text(&output.stderr), "");
}
