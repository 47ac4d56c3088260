//! How well the wave of a shot is followed.

use super::small::shots;
use crate::rig::{MeasuredShot, Plan};
use crate::{Batch, BatchOptions, Shard};
use hertzchain_experiment::Experiment;

/// The paper's rig, its chains laid compact and not pushed: at rest they are in equilibrium.
const COMPACT: [(&str, &str); 8] = [
    ("force = \"0.24 N\"", "force = \"0 N\""),
    ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
    ("incline = \"0.5 deg\"", "incline = \"0 deg\""),
    ("gap_scatter = \"5 um\"", "gap_scatter = \"0 um\""),
    ("speed_count = 60", "speed_count = 3"),
    ("shots = 20", "shots = 1"),
    ("taps = 40", "taps = 0"),
    ("record = \"0.1 s\"", "record = \"5 ms\""),
];

/// Incident and reflected time of flight in s at the shot's own speed, much closer than the rig's.
fn fine_s(experiment: &Experiment, fired: &MeasuredShot, accuracy: f64) -> [f64; 2] {
    let options = BatchOptions { accuracy, ..BatchOptions::of(experiment) };
    let batch = Batch::new(experiment, vec![fired.speed_m_s], options).unwrap();
    let flight = batch.run(Shard::WHOLE, &|| {}).rows.flights()[0];
    [flight.1, flight.2.unwrap()]
}

#[test]
fn incident_times_of_compact_chains_are_the_models_to_10_ps_and_reflected_ones_to_half_a_ns() {
    let paper = include_str!("../../../../experiments/paper.toml");
    let text = COMPACT.iter().fold(paper.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let plan = Plan::new(&Experiment::from_text("paper.toml", &text).unwrap(), None).unwrap();
    for (number, series) in plan.series.iter().enumerate() {
        let fired = shots(&plan, number).remove(0);
        let fine_s = fine_s(&plan.cases[series.case].experiment, &fired, 1e-10);
        let off = [fired.shot.incident_s, fired.shot.reflected_s];
        let off = [off[0] - fine_s[0], off[1] - fine_s[1]];
        // The wave's steps; split returns of wet chains at the lowest speed are the worst.
        assert!(off[0].abs() < 10e-12, "{number}: {off:?}");
        assert!(off[1].abs() < 0.5e-9, "{number}: {off:?}");
    }
}

#[test]
fn rows_with_films_come_to_rest_between_shots_and_have_the_models_times() {
    // Nothing presses them, so that friction changes nothing.
    let preset = include_str!("../../../../experiments/pump-film.toml");
    let preset = preset.replace("0.24 N", "0 N");
    let campaign = "[campaign]\nspeeds = [\"0.5 m/s\"]\nshots = 1\ntaps = 0\nseed = 1\n\
                    [campaign.laying]\ngap_scatter = \"0 um\"\n\
                    [campaign.recorder]\nrecord = \"5 ms\"\n";
    let text = format!("{preset}\n{campaign}");
    let plan = Plan::new(&Experiment::from_text("film.toml", &text).unwrap(), None).unwrap();
    let fired = shots(&plan, 0).remove(0);
    let fine_s = fine_s(&plan.cases[0].experiment, &fired, 1e-7);
    // Reflected times of films converge to some 1e-6.
    let found_s = [(fired.shot.incident_s, 1e-6), (fired.shot.reflected_s, 5e-6)];
    for ((found_s, relative), fine_s) in found_s.into_iter().zip(fine_s) {
        assert!((found_s / fine_s - 1.0).abs() < relative, "{found_s} {fine_s}");
    }
}
