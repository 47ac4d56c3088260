//! What a recorder will not see is reported before a campaign.

use super::small::{experiment, plan, shots};
use crate::rig::{Plan, RigError, forecast};

#[test]
fn a_recorder_that_sees_all_is_told_nothing() {
    assert_eq!(forecast(&plan(&[])).unwrap(), Vec::<String>::new());
}

#[test]
fn a_record_that_ends_before_the_wave_is_back_is_told_with_one_that_does_not() {
    // The striker needs 11 ms from the gate at 0.1 m/s less three deviations of 3 mm/s.
    let short = [("record = \"20 ms\"", "record = \"6.5 ms\"")];
    let reported = forecast(&plan(&short)).unwrap();
    let named = |what: &str| reported.iter().filter(|line| line.contains(what)).count();
    assert!(named("`dry`") > 0 && named("`wet`") > 0, "{reported:?}");
    assert!(reported[0].contains("at 0.0910 m/s"), "{reported:?}");
    let enough = reported[0].split("record = \"").nth(1).unwrap();
    let enough_ms: f64 = enough.split(" ms").next().unwrap().parse().unwrap();
    let longer = format!("record = \"{enough_ms} ms\"");
    let plan = plan(&[("record = \"20 ms\"", &longer), ("taps = 2", "taps = 0")]);
    let left = forecast(&plan).unwrap();
    assert!(!left.iter().any(|line| line.contains("`dry` at 0.0910")), "{left:?}");
    // The shot of a real series is over within that record.
    let fired = shots(&plan, 0).remove(0);
    let back_s = fired.record.touch_s + fired.shot.peaks_s[2];
    assert!(back_s < 1e-3 * enough_ms, "{back_s} {enough_ms}");
    // A striker that is late by three deviations of its speed comes a tenth later.
    assert!(back_s > 0.8e-3 * enough_ms, "{back_s} {enough_ms}");
}

#[test]
fn a_rate_of_few_samples_a_pulse_is_told_and_one_of_none_refused() {
    let at = |rate: &str| forecast(&plan(&[("sampling = \"500 kHz\"", rate)]));
    let reported = at("sampling = \"100 kHz\"").unwrap();
    assert!(reported[0].contains("sampled at 100 kHz"), "{reported:?}");
    let refused = at("sampling = \"1 kHz\"").unwrap_err();
    assert!(matches!(refused, RigError::Unsuited(_)));
    assert!(refused.to_string().contains("has 0.1 samples"), "{refused}");
}

/// Each of these would record nothing that anybody could use.
#[test]
fn a_converter_or_a_trigger_that_sees_no_shot_is_told() {
    let reported = |from: &str, to: &str| forecast(&plan(&[(from, to)])).unwrap().join("\n");
    let record = "record = \"20 ms\"";
    let clipped = reported(record, "record = \"20 ms\"\nrange = \"20 mV\"");
    assert!(clipped.contains("is clipped at the converter's range of ± 0.02 V"), "{clipped}");
    let ranges = clipped.split("range = \"").skip(1);
    let volts = ranges.map(|text| text.split(" V").next().unwrap().parse().unwrap());
    let enough = volts.fold(0.0, f64::max);
    let wider = reported(record, &format!("record = \"20 ms\"\nrange = \"{enough} V\""));
    assert_eq!(wider, "");
    let coarse = reported(record, "record = \"20 ms\"\nbits = 4");
    assert!(coarse.contains("steps of the converter"), "{coarse}");
    let level = |level: &str| {
        let with = format!("record = \"20 ms\"\ntrigger = \"level\"\nlevel = \"{level}\"");
        reported(record, &with)
    };
    let high = level("5 V");
    assert!(high.contains("never passes the trigger's level of 5 V"), "{high}");
    let low = level("1 mV");
    assert!(low.contains("within the noise"), "{low}");
    assert_eq!(level("20 mV"), "");
}

#[test]
fn gaps_wider_than_beads_are_refused_by_name() {
    let wide = experiment(&[("gap_scatter = \"5 um\"", "gap_scatter = \"50 mm\"")]);
    let refused = Plan::new(&wide, None).unwrap_err().to_string();
    assert!(refused.contains("`gap_scatter`") && refused.contains("50 mm"), "{refused}");
}
