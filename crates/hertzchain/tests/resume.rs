//! Fits that were broken off and go on.

use crate::common::{ERRORS, curve, folder, json, with_errors};
use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

/// The walkers are written as they stand, whole, under their name: a run that is
/// killed goes on from there to the bits of one that was not.
#[test]
fn a_posterior_that_is_killed_goes_on_to_the_walkers_of_one_that_was_not() {
    let folder = folder("killed");
    let data = curve(&folder, "dry");
    let posterior = |out: &str, steps: &str, more: &[&str]| {
        let out = folder.join(out);
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        program
            .args(["fit", &data, "-p", "dry", "--free", "eta,B"])
            .args(["--method", "posterior", "--seed", "5", "--steps", steps])
            .args(ERRORS)
            .arg("--out")
            .arg(out)
            .args(more)
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        program
    };
    let chain = |out: &str| fs::read(folder.join(out).join("chain.json")).unwrap();
    assert!(posterior("whole", "60", &[]).status().is_ok());
    assert!(folder.join("whole/fit.json").exists(), "walkers saved on the way are the run's own");
    assert!(posterior("broken", "20", &[]).status().is_ok());
    let begun = chain("broken");
    for delay_ms in [50, 400] {
        let mut child = posterior("broken", "60", &["--resume"]).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(delay_ms));
        child.kill().unwrap();
        child.wait().unwrap();
        // Whole at any moment, whichever step it is of: JSON, then a hash of 64 digits.
        let bytes = chain("broken");
        assert!(serde_json::from_slice::<serde_json::Value>(&bytes[..bytes.len() - 64]).is_ok());
    }
    assert!(posterior("broken", "60", &["--resume"]).status().is_ok());
    assert!(chain("broken") == chain("whole"));
    assert!(begun != chain("whole"));
}

#[test]
fn walkers_with_any_flipped_bit_are_refused() {
    let folder = folder("flipped-walkers");
    let data = curve(&folder, "dry");
    let out = folder.join("out");
    let posterior = |steps: &str, more: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        program
            .args(["fit", &data, "-p", "dry", "--free", "eta,B"])
            .args(["--method", "posterior", "--seed", "5", "--steps", steps])
            .args(ERRORS)
            .arg("--out")
            .arg(&out)
            .args(more);
        program.output().unwrap()
    };
    posterior("2", &[]);
    let path = out.join("chain.json");
    let whole = fs::read(&path).unwrap();
    // A number, a name, the line's end before the hash, the hash.
    for at in [whole.len() / 3, 5, whole.len() - 66, whole.len() - 20] {
        let mut flipped = whole.clone();
        flipped[at] ^= 1;
        fs::write(&path, &flipped).unwrap();
        let refused = posterior("4", &["--resume"]);
        let reported = String::from_utf8_lossy(&refused.stderr);
        assert!(!refused.status.success(), "byte {at}");
        assert!(reported.contains("damaged"), "byte {at}: {reported}");
        assert!(fs::read(&path).unwrap() == flipped, "byte {at}");
    }
}

#[test]
fn a_posterior_is_the_same_in_one_run_and_in_two() {
    let folder = folder("posterior");
    let data = curve(&folder, "dry");
    let out = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (whole, parts) = (out("whole"), out("parts"));
    let run_into = |out: &str, more: &[&str]| {
        let fit = [
            "fit",
            &data,
            "-p",
            "dry",
            "--free",
            "eta,B",
            "--method",
            "posterior",
            "--json",
            "-o",
            out,
        ];
        json(&with_errors(&[&fit[..], more].concat()))
    };
    let at_once = run_into(&whole, &["--steps", "400"]);
    let first = run_into(&parts, &["--steps", "300"]);
    assert!(first["posterior"]["unconverged"].as_str().unwrap().contains("has not converged"));
    let then = run_into(&parts, &["--steps", "400", "--resume"]);
    assert_eq!(at_once["posterior"], then["posterior"]);
}
