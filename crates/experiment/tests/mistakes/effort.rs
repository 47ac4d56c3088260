//! Steps and durations with which no shot comes to a sensible end.

use super::{DRY, check, line_of, only, refused};
use crate::Experiment;
use hertzchain_chain::wave::{Limits, Method, run};

const STRIKER: &str = "[striker]\nspeed = \"0.5 m/s\"";

fn solver(keys: &str) -> String {
    format!("{DRY}\n[solver]\n{keys}\n")
}

fn line_in(text: &str, part: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    1 + lines.iter().rposition(|line| line.contains(part)).unwrap()
}

#[test]
fn a_step_longer_than_a_contact_is_told_with_a_sensible_one() {
    for method in ["rk4", "verlet"] {
        for step in ["1 s", "1e9 s", "20 us"] {
            let text = solver(&format!("method = \"{method}\"\nstep = \"{step}\""));
            let words = ["longer than a contact lasts, 1.5e-5 s", "3e-7 s, a fiftieth"];
            let line = line_in(&text, "step = ");
            check(&refused(&text), line, &format!("\"{step}\""), &words);
        }
    }
    let text = solver("method = \"rk4\"\nstep = \"3e-7 s\"");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    assert!(experiment.system(None).is_ok());
}

#[test]
fn a_contact_that_lasts_shorter_at_another_speed_asks_for_another_step() {
    let text = solver("method = \"rk4\"\nstep = \"14 us\"");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    assert!(experiment.system(None).is_ok());
    let mistakes = experiment.system(Some(5.0)).unwrap_err();
    assert!(mistakes.to_string().contains("longer than a contact"));
}

#[test]
fn a_step_without_end_is_told_with_the_least() {
    for method in ["rk4", "verlet"] {
        for step in ["1e-15 s", "1e-18 s", "1 ps"] {
            let text = solver(&format!("method = \"{method}\"\nstep = \"{step}\""));
            let words = ["a shot of about 0.0075 s takes", "expected at least", "rounding"];
            let line = line_in(&text, "step = ");
            check(&refused(&text), line, &format!("\"{step}\""), &words);
        }
    }
}

#[test]
fn a_step_too_short_for_the_duration_points_at_both() {
    let text = solver("method = \"rk4\"\nstep = \"1 us\"\nduration = \"100 s\"");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    assert!(experiment.system(None).is_ok());
    let text = solver("method = \"rk4\"\nstep = \"1 ns\"\nduration = \"100 s\"");
    let finding = refused(&text);
    check(&finding, line_in(&text, "step = "), "\"1 ns\"", &["1e11 steps", "at least"]);
    assert_eq!(finding.other_line(), Some(line_in(&text, "duration = ")));
}

#[test]
fn the_least_step_is_one_that_the_wave_loop_finishes() {
    let accepted = |step: f64| {
        let text = format!(
            "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n[solver]\n\
             method = \"rk4\"\nstep = {step:e}\nduration = 2\n"
        );
        Experiment::from_text("test.toml", &text).unwrap().system(None).ok()
    };
    let (mut refused, mut least) = (1e-12, 1e-2);
    while least / refused > 1.0001 {
        let middle = f64::sqrt(least * refused);
        match accepted(middle) {
            Some(_) => least = middle,
            None => refused = middle,
        }
    }
    let (system, _) = accepted(least).unwrap();
    let outcome = run(&system, &Method::rk4(least), Limits::until(2.0), &mut []).unwrap();
    assert!(outcome.work.steps > 2_000_000, "{:?}", outcome.work);
}

#[test]
fn a_duration_without_end_is_told_with_the_longest() {
    for method in ["adaptive", "rk4", "verlet"] {
        for duration in ["1e9 s", "1 h"] {
            let text = solver(&format!("method = \"{method}\"\nduration = \"{duration}\""));
            let words = ["steps", "expected a duration of at most 1500 s", "contacts here last"];
            let line = line_in(&text, "duration = ");
            check(&refused(&text), line, &format!("\"{duration}\""), &words);
        }
    }
}

#[test]
fn swings_and_gaps_without_end_are_told_where_they_stand() {
    let cradle = DRY.replace("kind = \"half-bead\"", "kind = \"free\"");
    let text = format!("{cradle}\n[suspension]\nlength = \"1000 km\"\n");
    let finding = refused(&text);
    assert_eq!(finding.line(), line_in(&text, "[suspension]"));
    assert!(finding.one_line().contains("one swing takes 2000 s"), "{}", finding.one_line());
    let text = format!("{DRY}\n[[gaps]]\ncontact = 3\ngap = \"1000 km\"\n");
    let finding = refused(&text);
    let words = ["a shot across this gap takes 2e7 s", "expected a smaller gap"];
    check(&finding, line_in(&text, "contact = 3"), "3", &words);
}

fn driven(keys: &str) -> String {
    DRY.replace(STRIKER, &format!("[driven]\n{keys}"))
}

#[test]
fn a_motion_faster_than_any_striker_is_told_at_what_makes_it_so() {
    for (keys, place) in [
        ("motion = \"sine\"\namplitude = \"1 nm\"\nfrequency = \"1e18 Hz\"", "\"1e18 Hz\""),
        ("motion = \"pulse\"\namplitude = \"1 m\"\nduration = \"1 ns\"", "\"1 ns\""),
        (
            "motion = \"table\"\npositions = [\"0 m\", \"1 m\"]\ntimes = [\"0 s\", \"1 ns\"]",
            "[\"0 s\", \"1 ns\"]",
        ),
    ] {
        let text = driven(keys);
        let words = ["this motion reaches a speed of", "from 1e-12 m/s to 1e6 m/s"];
        check(&only(&text), line_in(&text, place), place, &words);
    }
}

#[test]
fn a_drive_that_swings_too_often_is_told_how_often() {
    let finding =
        refused(&driven("motion = \"sine\"\namplitude = \"1e-11 m\"\nfrequency = \"1e11 Hz\""));
    assert_eq!(finding.line(), line_of("[striker]"));
    assert!(
        finding.one_line().contains("9e9 steps: expected a slower motion"),
        "{}",
        finding.one_line()
    );
}

#[test]
fn a_spring_that_is_no_spring_is_told_the_stiffest() {
    let text = format!(
        "{DRY}\n[near_end]\npush = \"spring\"\nforce = \"1 N\"\nstiffness = \"1e30 N/m\"\n"
    );
    let finding = refused(&text);
    assert_eq!(finding.line(), line_in(&text, "[near_end]"));
    assert!(
        finding.one_line().contains("expected a stiffness of at most"),
        "{}",
        finding.one_line()
    );
}
