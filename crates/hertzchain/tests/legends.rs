//! Pictures of all presets and examples: legends that hide nothing, labels that
//! fit the chain.

#[path = "../../figures/tests/covered/mod.rs"]
mod covered;

use covered::covered;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const BODY: &str = r#"
[[contacts]]
laws = ["elastic_hertz"]
"#;

const RING: &str = r#"
[materials.steel]
young_modulus = "213 GPa"
poisson_ratio = 0.3
density = "7800 kg/m^3"
[[beads]]
count = 20
radius = "5 mm"
material = "steel"
[far_end]
kind = "periodic"
force = "2 N"
[[initial]]
bead = 3
velocity = "0.1 m/s"
[sensors]
bead = 7
velocities = [3, 10]
[solver]
duration = "1 ms"
"#;

const PLAIN: &str = r#"
title = "Beads without units"
units = "dimensionless"
[materials.unit]
young_modulus = 1.0
poisson_ratio = 0.3
[striker]
speed = 1.0
[[beads]]
count = 2
radius = 1.0
mass = 1.0
material = "unit"
[far_end]
kind = "half-bead"
[sensors]
bead = 1
velocities = [0, 1]
positions = [1]
"#;

fn hertzchain(arguments: &[&str], out: &Path) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    let run = program.args(arguments).arg("--out").arg(out).output();
    let run = run.unwrap();
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{arguments:?}: {said}");
}

fn scratch(name: &str) -> PathBuf {
    let folder = format!("hertzchain-{name}-{}", std::process::id());
    std::env::temp_dir().join(folder)
}

/// Every SVG that a command writes, with its name.
fn pictures(name: &str, arguments: &[&str]) -> Vec<(String, String)> {
    let out = scratch(name);
    hertzchain(arguments, &out);
    let files = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
    let drawn = files.filter(|path| path.extension().is_some_and(|e| e == "svg"));
    let read = drawn.map(|path| (path.display().to_string(), fs::read_to_string(path).unwrap()));
    let all = read.collect();
    fs::remove_dir_all(&out).unwrap();
    all
}

fn check(name: &str, arguments: &[&str]) -> Vec<(String, String)> {
    let drawn = pictures(name, arguments);
    assert!(!drawn.is_empty(), "{name} drew nothing");
    for (picture, svg) in &drawn {
        let (legends, pixels) = covered(svg);
        assert!(legends > 0, "{picture} has no legend");
        assert_eq!(pixels, 0, "{picture}: a legend hides data");
    }
    drawn
}

fn check_text(name: &str, text: &str) -> Vec<(String, String)> {
    let file = scratch(name).with_extension("toml");
    fs::write(&file, format!("{text}{BODY}")).unwrap();
    let drawn = check(name, &["shot", file.to_str().unwrap()]);
    fs::remove_file(&file).unwrap();
    drawn
}

#[test]
fn legends_of_every_preset_and_example_hide_nothing() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments");
    let mut count = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        check(name, &["shot", path.to_str().unwrap()]);
        count += 1;
    }
    assert!(count > 13, "{count} experiments");
}

#[test]
fn legends_of_a_ring_and_of_a_sweep_hide_nothing() {
    check_text("ring", RING);
    let speeds = ["--speeds", "0.1,0.3,1.0"];
    check("sweep", &["sweep", "--preset", "dry", speeds[0], speeds[1]]);
}

#[test]
fn tables_of_a_dimensionless_chain_name_no_units() {
    let (file, out) = (scratch("table").with_extension("toml"), scratch("tables"));
    fs::write(&file, format!("{PLAIN}{BODY}")).unwrap();
    hertzchain(&["shot", file.to_str().unwrap()], &out);
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    let (traces, energy) = (read("traces.csv"), read("energy.csv"));
    fs::remove_file(&file).unwrap();
    fs::remove_dir_all(&out).unwrap();
    let names = "time,sensor_bead_1,wall,position_1,velocity_0,velocity_1\n";
    assert!(traces.starts_with(names), "{}", &traces[..90]);
    assert!(energy.starts_with("time,start,driven,kinetic,elastic,"));
}

#[test]
fn figures_of_a_dimensionless_chain_show_no_units() {
    for (picture, svg) in check_text("plain", PLAIN) {
        let labels = svg.split("aria-label=\"").skip(1);
        let labels = labels.filter_map(|rest| rest.split('"').next());
        for label in labels {
            assert!(!label.contains(" ("), "{picture}: {label}");
        }
        assert!(svg.contains("aria-label=\"Time\""), "{picture}");
    }
}
