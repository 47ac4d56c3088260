//! Series that can't be computed, and parts that are put together.

use super::small::plan;
use crate::Shard;
use crate::rig::{RigError, campaign, merge, plan_of_folder, run_series};
use std::fs;

#[test]
fn a_poisoned_series_is_told_and_stops_no_other() {
    let out = std::env::temp_dir().join(format!("hertzchain-poisoned-{}", std::process::id()));
    let _ = fs::remove_dir_all(&out);
    let sound = plan(&[]);
    let mut poisoned = sound.clone();
    // Where its speed was looked at, it was sound.
    poisoned.series[1].programmed_m_s = f64::NAN;
    let done = campaign(&poisoned, &out, Shard::WHOLE, &|_| {}).unwrap();
    assert_eq!((done.run, done.failed.len()), (sound.series.len() - 1, 1));
    assert!(done.failed[0].contains(&sound.series[1].name), "{:?}", done.failed);
    let there = |plan: &crate::rig::Plan| {
        let file = |name: &str| out.join(format!("{name}.h5")).is_file();
        plan.series.iter().map(|series| file(&series.name)).collect::<Vec<bool>>()
    };
    assert_eq!(there(&sound).iter().filter(|there| !**there).count(), 1);
    assert!(!there(&sound)[1]);
    // The same folder, without the poison, is made whole; the file determines the plan.
    let reported = plan_of_folder(&out).unwrap();
    assert_eq!(reported.series, sound.series);
    let missing = merge(&reported, &[&out], &out).unwrap_err();
    assert!(
        matches!(missing, RigError::Missing { ref missing, .. } if missing.len() == 1),
        "{missing}"
    );
    let done = campaign(&sound, &out, Shard::WHOLE, &|_| {}).unwrap();
    assert_eq!((done.run, done.kept), (1, sound.series.len() - 1));
    let merged = merge(&reported, &[&out], &out).unwrap();
    assert_eq!((merged.series, merged.copied), (sound.series.len(), 0));
    fs::remove_dir_all(&out).unwrap();
}

/// What a plan refuses is not replaced by something else if it comes by another way.
#[test]
fn taps_that_the_actuator_cannot_do_are_refused_and_not_left_out() {
    let mut poisoned = plan(&[]);
    let fast = [("campaign.tap_speed", 3.0)];
    poisoned.cases[0].experiment = poisoned.cases[0].experiment.set(&fast).unwrap();
    let refused = run_series(&poisoned, &poisoned.series[0], &mut |_| Ok(())).unwrap_err();
    assert!(
        matches!(refused, RigError::Speed(ref what) if what.starts_with("taps before shot 1")),
        "{refused}"
    );
}
