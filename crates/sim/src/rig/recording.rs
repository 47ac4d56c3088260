//! A series as a file.

use crate::rig::converter::Converter;
use crate::rig::error::RigError;
use crate::rig::plan::{Plan, Series};
use crate::rig::series::{Fired, run};
use hertzchain_experiment as experiment;
use hertzchain_measure::records::{Channels, SeriesInfo, SeriesWriter, ShotRow};
use std::path::Path;

/// True values of a shot, by name; the endings are the units.
pub type Truth = Vec<(&'static str, f64)>;

/// What true values are, for people.
const LONG_NAMES: [(&str, &str); 19] = [
    ("speed_m_s", "true speed of the striker at the touch"),
    (
        "touch_s",
        "time from the first sample to the striker's touch",
    ),
    (
        "incident_peak_s",
        "time from the touch to the passing pulse's maximum at the sensor bead",
    ),
    (
        "wall_peak_s",
        "time from the touch to the pulse's maximum at the wall",
    ),
    (
        "reflected_peak_s",
        "time from the touch to the returning pulse's maximum at the sensor bead",
    ),
    ("incident_tof_s", "true incident time of flight"),
    ("reflected_tof_s", "true reflected time of flight"),
    (
        "incident_peak_n",
        "largest force of the passing pulse at the sensor bead",
    ),
    ("wall_peak_n", "largest force at the wall"),
    (
        "reflected_peak_n",
        "largest force of the returning pulse at the sensor bead",
    ),
    (
        "rebound_m_s",
        "final velocity of the striker, negative away from the chain",
    ),
    ("rest_s", "time from the touch until all beads rest"),
    ("open_before", "number of open contacts before the shot"),
    ("gaps_before_m", "sum of all gaps before the shot"),
    ("largest_gap_before_m", "largest gap before the shot"),
    (
        "open_after",
        "number of open contacts after the shot, at rest",
    ),
    ("gaps_after_m", "sum of all gaps after the shot, at rest"),
    ("largest_gap_after_m", "largest gap after the shot, at rest"),
    (
        "overlap_before_m",
        "overlap of every contact before the shot, negative across a gap",
    ),
];

/// Runs a series into a file, which has its name once it is whole.
///
/// # Errors
/// A shot that can't be computed, a file that can't be written.
pub(crate) fn write(
    plan: &Plan,
    series: &Series,
    path: &Path,
    inputs: &str,
    seen: &dyn Fn(),
) -> Result<(), RigError> {
    let mut writer = SeriesWriter::create(path, &info(plan, series, inputs))?;
    run(plan, series, &mut |fired| {
        writer.push(&ShotRow {
            shot: u64::from(fired.number),
            programmed_speed_m_s: fired.programmed_m_s,
            measured_speed_m_s: fired.measured_m_s,
            triggered: fired.record.triggered,
            samples: &fired.record.samples,
            truth: &truth(&fired),
            contacts: &[("overlap_before_m", &fired.shot.overlaps_before_m)],
        })?;
        seen();
        Ok(())
    })?;
    writer.finish()?;
    Ok(())
}

/// Whether a finished file is the recording of a series.
///
/// # Errors
/// What it is or has instead.
pub(crate) fn verify(
    plan: &Plan,
    series: &Series,
    path: &Path,
    inputs: &str,
) -> Result<(), RigError> {
    let shots = plan.experiment.campaign().shots;
    let info = info(plan, series, inputs);
    hertzchain_measure::records::verify(path, &info, shots, series.programmed_m_s)
        .map_err(RigError::NotOurs)
}

fn info(plan: &Plan, series: &Series, inputs: &str) -> SeriesInfo {
    let campaign = plan.experiment.campaign();
    let (recorder, amplifier) = (&campaign.recorder, &campaign.amplifier);
    let text = |name: &str, value: f64| (name.to_owned(), value.to_string());
    SeriesInfo {
        channels: match recorder.channels {
            experiment::Channels::Summed => Channels::Summed,
            experiment::Channels::Separate => Channels::Separate,
        },
        interval_s: recorder.sampling_hz.recip(),
        volts_per_count: Converter::new(recorder).volts_per_count(),
        offset_v: 0.0,
        pretrigger: (recorder.before_s * recorder.sampling_hz).round() as usize,
        samples_per_shot: recorder.samples(),
        series: u64::from(series.number),
        case: plan.case(series).name.clone(),
        seed: plan.seed,
        experiment: plan.experiment.text().to_owned(),
        long_names: &LONG_NAMES,
        more: vec![
            ("title".to_owned(), plan.experiment.title().to_owned()),
            ("inputs".to_owned(), inputs.to_owned()),
            text("measured_speed_error_m_s", campaign.photogate.error_m_s),
            text("beads", plan.experiment.beads() as f64),
            text("sensor_bead", plan.experiment.sensor_bead() as f64),
            text("taps", campaign.taps as f64),
            text("tap_speed_m_s", campaign.tap_speed_m_s),
            text("high_pass_hz", amplifier.high_pass_hz),
            text("low_pass_hz", amplifier.low_pass_hz),
            (
                "low_pass_order".to_owned(),
                experiment::ORDERS[amplifier.order as usize].to_owned(),
            ),
            (
                "low_pass_kind".to_owned(),
                experiment::KINDS[amplifier.kind as usize].to_owned(),
            ),
        ],
    }
}

/// What only a simulation knows of a shot.
#[must_use]
pub fn truth(fired: &Fired) -> Truth {
    let shot = &fired.shot;
    let open = |gaps_m: &[f64]| gaps_m.iter().filter(|gap| **gap > 0.0).count() as f64;
    let largest = |gaps_m: &[f64]| gaps_m.iter().copied().fold(0.0, f64::max);
    let (before_m, after_m) = (&shot.gaps_before_m[..], &shot.gaps_after_m[..]);
    vec![
        ("speed_m_s", fired.speed_m_s),
        ("touch_s", fired.record.touch_s),
        ("incident_peak_s", shot.peaks_s[0]),
        ("wall_peak_s", shot.peaks_s[1]),
        ("reflected_peak_s", shot.peaks_s[2]),
        ("incident_tof_s", shot.incident_s),
        ("reflected_tof_s", shot.reflected_s),
        ("incident_peak_n", shot.peaks_n[0]),
        ("wall_peak_n", shot.peaks_n[1]),
        ("reflected_peak_n", shot.peaks_n[2]),
        ("rebound_m_s", shot.rebound_m_s),
        ("rest_s", shot.rest_s),
        ("open_before", open(before_m)),
        ("gaps_before_m", before_m.iter().sum()),
        ("largest_gap_before_m", largest(before_m)),
        ("open_after", open(after_m)),
        ("gaps_after_m", after_m.iter().sum()),
        ("largest_gap_after_m", largest(after_m)),
    ]
}
