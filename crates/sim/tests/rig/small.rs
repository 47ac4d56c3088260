//! A campaign small enough for tests: 12 beads, two cases, three speeds.

use super::rig::{MeasuredShot, Plan, run_series};
use hertzchain_experiment::Experiment;

pub const TEXT: &str = include_str!("../small.toml");

/// The campaign with parts of its text replaced.
pub fn experiment(changes: &[(&str, &str)]) -> Experiment {
    let mut text = TEXT.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Experiment::from_text("small.toml", &text).unwrap()
}

pub fn plan(changes: &[(&str, &str)]) -> Plan {
    Plan::new(&experiment(changes), None).unwrap()
}

/// All shots of one series.
pub fn shots(plan: &Plan, series: usize) -> Vec<MeasuredShot> {
    let mut shots = Vec::new();
    run_series(plan, &plan.series[series], &mut |fired| {
        shots.push(fired);
        Ok(())
    })
    .unwrap();
    shots
}

/// What is needed for the spread of shots that differ in nothing but the chain.
pub const SAME_SPEED: (&str, &str) =
    ("[campaign.laying]", "[campaign.actuator]\nspread = \"0 m/s\"\n\n[campaign.laying]");
