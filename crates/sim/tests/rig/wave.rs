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
fn fine_s(experiment: &Experiment, fired: &MeasuredShot) -> [f64; 2] {
    let options = BatchOptions { accuracy: 1e-10, ..BatchOptions::of(experiment) };
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
        let fine_s = fine_s(&plan.cases[series.case].experiment, &fired);
        let off = [fired.shot.incident_s, fired.shot.reflected_s];
        let off = [off[0] - fine_s[0], off[1] - fine_s[1]];
        // The wave's steps; split returns of wet chains at the lowest speed are the worst.
        assert!(off[0].abs() < 10e-12, "{number}: {off:?}");
        assert!(off[1].abs() < 0.5e-9, "{number}: {off:?}");
    }
}
