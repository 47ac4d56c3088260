//! Campaigns: every series a file, several at once, in one folder or in parts to be merged.
//!
//! A recording is there whole or not at all. A file beside the recordings holds the experiment
//! and a fingerprint of all that they follow from.

use crate::rig::instruments::Converter;
use crate::rig::{MeasuredShot, Plan, RigError, Series, run_series};
use crate::{Fingerprint, Shard, commit};
use hertzchain_experiment::{self as experiment, Experiment};
use hertzchain_measure::records::{
    SeriesChannels, SeriesInfo, SeriesWriter, ShotRow, remove_left_behind, untriggered, write_whole,
};
use rayon::prelude::*;
use std::collections::HashSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// How far a campaign is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Shots fired in this run.
    pub fired: u64,
    /// Shots to be fired in this run.
    pub shots: u64,
}

/// What a run has done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Done {
    /// Series that were finished before.
    pub kept: usize,
    /// Series run now.
    pub run: usize,
    /// Shots fired now.
    pub shots: u64,
    /// Bytes of all files of this part.
    pub bytes: u64,
    /// Series that can't be computed, each with the reason; they have no file.
    pub failed: Vec<String>,
    /// Series of this part with shots whose trigger never fired, and how many of them.
    pub untriggered: Vec<(String, usize)>,
}

/// Runs the series of a part that a folder does not have yet, and calls
/// `watch` after every shot. Those that it has are opened and compared with what
/// this campaign would write. What a killed run has left under way is removed.
///
/// Files depend on neither the number of threads nor the order of series; a
/// run that is interrupted and begun again ends with the same bytes. A series that
/// can't be computed is listed in [`Done::failed`] and stops no other.
///
/// # Errors
/// A folder that can't be used, a file in it that is not this campaign's, a recording
/// that can't be written: finished files stay as they are.
pub fn campaign(
    plan: &Plan,
    out: &Path,
    shard: Shard,
    watch: &(dyn Fn(Progress) + Sync),
) -> Result<Done, RigError> {
    let folder = CampaignFolder::open(out, plan)?;
    folder.clear(plan);
    let dealt = plan.series.iter().enumerate();
    let part: Vec<&Series> =
        dealt.filter(|(at, _)| shard.holds(*at)).map(|(_, series)| series).collect();
    let (done, due): (Vec<&Series>, Vec<&Series>) =
        part.iter().copied().partition(|series| folder.has(series));
    let fired = AtomicU64::new(0);
    let shots = plan.shots(due.len());
    let inputs = fingerprint(plan).short();
    for series in &done {
        verify(plan, series, &folder.file(series), &inputs)?;
    }
    watch(Progress { fired: 0, shots });
    let series = due.par_iter().with_max_len(1).map(|series| {
        let seen = || {
            let fired = fired.fetch_add(1, Ordering::Relaxed) + 1;
            watch(Progress { fired, shots });
        };
        match write(plan, series, &folder.file(series), &inputs, &seen) {
            // The others may be sound; a full disk would be full for them too.
            Err(error @ RigError::Shot { .. }) => Ok(Some(error.to_string())),
            written => written.map(|()| None),
        }
    });
    let failed: Vec<Option<String>> = series.collect::<Result<_, RigError>>()?;
    let failed: Vec<String> = failed.into_iter().flatten().collect();
    let size = |series: &&Series| folder.file(series).metadata().map_or(0, |data| data.len());
    let finished = part.iter().copied().filter(|series| folder.has(series));
    let untriggered: Result<Vec<(String, usize)>, RigError> = finished
        .map(|series| {
            let missed = untriggered(&folder.file(series)).map_err(RigError::NotOurs)?;
            Ok((series.name.clone(), missed))
        })
        .filter(|missed| !matches!(missed, Ok((_, 0))))
        .collect();
    Ok(Done {
        kept: done.len(),
        run: due.len() - failed.len(),
        shots: fired.load(Ordering::Relaxed),
        bytes: part.iter().map(size).sum(),
        failed,
        untriggered: untriggered?,
    })
}

/// What a merged campaign is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Its series.
    pub series: usize,
    /// Files copied now; the others were there.
    pub copied: usize,
    /// Bytes of all recordings.
    pub bytes: u64,
}

/// Copies the series of a campaign from folders into one, which then has the files of a
/// campaign that was never cut. Nothing is copied before all series are found and verified.
///
/// # Errors
/// [`RigError::Missing`] with the series that no folder has; a folder of another campaign;
/// recordings that are damaged or another's; what the system refuses.
pub fn merge(plan: &Plan, folders: &[&Path], out: &Path) -> Result<Merged, RigError> {
    let folders = folders.iter().map(|path| CampaignFolder::existing(path, plan));
    let folders: Vec<CampaignFolder> = folders.collect::<Result<_, _>>()?;
    let inputs = fingerprint(plan).short();
    let (mut found, mut missing) = (Vec::new(), Vec::new());
    for series in &plan.series {
        match only(&folders, series)? {
            Some(file) => {
                verify(plan, series, &file, &inputs)?;
                found.push((series, file));
            }
            None => missing.push(series.name.clone()),
        }
    }
    if !missing.is_empty() {
        let of = plan.series.len();
        return Err(RigError::Missing { of, missing });
    }
    let whole = CampaignFolder::open(out, plan)?;
    let (mut copied, mut bytes) = (0, 0);
    for (series, file) in &found {
        let place = whole.file(series);
        match place.is_file() {
            true => same(&place, file)?,
            false => {
                let refused = |error| RigError::folder(&place, error);
                let mut bytes = File::open(file).map_err(refused)?;
                write_whole(&place, |to| io::copy(&mut bytes, to).map(|_| ())).map_err(refused)?;
                copied += 1;
            }
        }
        bytes += place.metadata().map_or(0, |data| data.len());
    }
    Ok(Merged { series: found.len(), copied, bytes })
}

/// The one recording of a series: where several folders have it, it is the same.
fn only(folders: &[CampaignFolder], series: &Series) -> Result<Option<PathBuf>, RigError> {
    let mut files = folders.iter().map(|folder| folder.file(series)).filter(|file| file.is_file());
    let first = files.next();
    if let Some(first) = &first {
        files.try_for_each(|other| same(first, &other))?;
    }
    Ok(first)
}

fn same(one: &Path, other: &Path) -> Result<(), RigError> {
    let read = |path: &Path| fs::read(path).map_err(|error| RigError::folder(path, error));
    match read(one)? == read(other)? {
        true => Ok(()),
        false => Err(RigError::Folder(format!(
            "{} and {} are the same series with other bytes: one is damaged; move it away",
            one.display(),
            other.display()
        ))),
    }
}

/// Another version may make other bits.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Name of the file in a folder of recordings that says which campaign it is.
pub const CAMPAIGN_FILE: &str = "campaign.toml";

/// A folder for the recordings of one campaign.
struct CampaignFolder {
    path: PathBuf,
}

/// Of all that recordings follow from, the program's version and commit included.
fn fingerprint(plan: &Plan) -> Fingerprint {
    Fingerprint::of("campaign", &(plan.seed, plan.experiment.canonical_text()))
}

impl CampaignFolder {
    /// Makes the folder if need be, and writes into it which campaign it is for.
    fn open(path: &Path, plan: &Plan) -> Result<Self, RigError> {
        fs::create_dir_all(path).map_err(|error| RigError::folder(path, error))?;
        match Self::existing(path, plan) {
            Err(_) if !path.join(CAMPAIGN_FILE).exists() => {}
            found => return found,
        }
        let folder = Self { path: path.to_owned() };
        if plan.series.iter().any(|series| folder.has(series)) {
            return Err(holds(
                path,
                "recordings, but no campaign.toml that says of which campaign",
            ));
        }
        let text = identity(plan);
        write_whole(&path.join(CAMPAIGN_FILE), |file| file.write_all(text.as_bytes()))
            .map_err(|error| RigError::folder(path, error))?;
        Ok(folder)
    }

    /// A folder that has recordings of this campaign; nothing is written.
    fn existing(path: &Path, plan: &Plan) -> Result<Self, RigError> {
        let file = path.join(CAMPAIGN_FILE);
        let found = fs::read_to_string(&file).map_err(|error| RigError::folder(&file, error))?;
        match found == identity(plan) {
            true => Ok(Self { path: path.to_owned() }),
            false => Err(holds(
                path,
                "another campaign, or this one by another build of the program, by its campaign.toml",
            )),
        }
    }

    /// Removes what a killed run has left of recordings under way.
    fn clear(&self, plan: &Plan) {
        let names: HashSet<String> = plan.series.iter().map(file_name).collect();
        remove_left_behind(&self.path, |file| names.contains(file));
    }

    fn file(&self, series: &Series) -> PathBuf {
        self.path.join(file_name(series))
    }

    fn has(&self, series: &Series) -> bool {
        self.file(series).is_file()
    }
}

fn holds(path: &Path, what: &str) -> RigError {
    RigError::AnotherCampaign(format!("{} holds {what}", path.display()))
}

fn file_name(series: &Series) -> String {
    format!("{}.h5", series.name)
}

/// What stands before the seed in a campaign's file.
const SEED: &str = " with seed ";

/// Text of a campaign's file: the experiment with a fingerprint above it, and the name that its
/// recordings have where it has no cases.
fn identity(plan: &Plan) -> String {
    let named = match (plan.experiment.cases().is_empty(), plan.cases.first()) {
        (true, Some(case)) => format!(" of `{}`", case.name),
        _ => String::new(),
    };
    format!(
        "# A campaign{named}{SEED}{}, inputs {}, by hertzchain {VERSION}{}. The recordings beside this file \
         are its own.\n{}",
        plan.seed,
        fingerprint(plan).short(),
        commit().map_or(String::new(), |commit| format!(" ({commit})")),
        plan.experiment.text()
    )
}

/// Returns the plan of the campaign whose recordings a folder holds.
///
/// # Errors
/// A folder without a campaign's file, or with one by another build of the program or with
/// numbers that a program has set: these are not in the file.
pub fn plan_of_folder(path: &Path) -> Result<Plan, RigError> {
    let file = path.join(CAMPAIGN_FILE);
    let text = fs::read_to_string(&file).map_err(|error| RigError::folder(&file, error))?;
    let other = || {
        RigError::Folder(format!(
            "{} is of another build of the program, or of an experiment whose numbers a program has \
             set: merge with the build that made the recordings",
            file.display()
        ))
    };
    let (line, toml) = text.split_once('\n').ok_or_else(other)?;
    let seed = line.split_once(SEED).and_then(|(_, rest)| rest.split_once(','));
    let seed = seed.and_then(|(seed, _)| seed.parse().ok()).ok_or_else(other)?;
    let name = line.split('`').nth(1).unwrap_or(CAMPAIGN_FILE);
    let plan = Plan::new(&Experiment::from_text(name, toml)?, Some(seed))?;
    match identity(&plan) == text {
        true => Ok(plan),
        false => Err(other()),
    }
}

/// True values of a shot, by name; the endings are the units.
pub(crate) type Truth = Vec<(&'static str, f64)>;

/// Makes a list of true values with their descriptions in recordings, and what computes them.
macro_rules! truths {
    (|$measured:ident| $($name:ident: $text:literal, $value:expr;)*) => {
        const LONG_NAMES: &[(&str, &str)] = &[
            $((stringify!($name), $text),)*
            ("overlap_before_m", "overlap of every contact before the shot, negative across a gap"),
        ];

        /// What only a simulation knows of a shot.
        pub(crate) fn truth($measured: &MeasuredShot) -> Truth {
            vec![$((stringify!($name), $value)),*]
        }
    };
}

truths! { |it|
    speed_m_s: "true speed of the striker at the touch", it.speed_m_s;
    touch_s: "time from the first sample to the striker's touch", it.record.touch_s;
    incident_peak_s: "time from the touch to the incident pulse's maximum at the sensor bead",
        it.shot.peaks_s[0];
    wall_peak_s: "time from the touch to the pulse's maximum at the wall", it.shot.peaks_s[1];
    reflected_peak_s: "time from the touch to the reflected pulse's maximum at the sensor bead",
        it.shot.peaks_s[2];
    incident_tof_s: "true incident time of flight", it.shot.incident_s;
    reflected_tof_s: "true reflected time of flight", it.shot.reflected_s;
    incident_peak_n: "largest force of the incident pulse at the sensor bead", it.shot.peaks_n[0];
    wall_peak_n: "largest force at the wall", it.shot.peaks_n[1];
    reflected_peak_n: "largest force of the reflected pulse at the sensor bead",
        it.shot.peaks_n[2];
    rebound_m_s: "final velocity of the striker, negative away from the chain",
        it.shot.rebound_m_s;
    rest_s: "time from the touch until all beads rest", it.shot.rest_s;
    open_before: "number of open contacts before the shot", open(&it.shot.gaps_before_m);
    gaps_before_m: "sum of all gaps before the shot", it.shot.gaps_before_m.iter().sum();
    largest_gap_before_m: "largest gap before the shot", largest(&it.shot.gaps_before_m);
    open_after: "number of open contacts after the shot, at rest", open(&it.shot.gaps_after_m);
    gaps_after_m: "sum of all gaps after the shot, at rest", it.shot.gaps_after_m.iter().sum();
    largest_gap_after_m: "largest gap after the shot, at rest", largest(&it.shot.gaps_after_m);
}

fn open(gaps_m: &[f64]) -> f64 {
    gaps_m.iter().filter(|gap| **gap > 0.0).count() as f64
}

fn largest(gaps_m: &[f64]) -> f64 {
    gaps_m.iter().copied().fold(0.0, f64::max)
}

/// Runs a series into a file, which has its name once it is whole.
///
/// # Errors
/// A shot that can't be computed, a file that can't be written.
fn write(
    plan: &Plan,
    series: &Series,
    path: &Path,
    inputs: &str,
    seen: &dyn Fn(),
) -> Result<(), RigError> {
    let mut writer = SeriesWriter::create(path, &info(plan, series, inputs))?;
    run_series(plan, series, &mut |measured| {
        writer.push(&ShotRow {
            shot: u64::from(measured.number),
            programmed_speed_m_s: measured.programmed_m_s,
            measured_speed_m_s: measured.measured_m_s,
            triggered: measured.record.triggered,
            samples: &measured.record.samples,
            truth: &truth(&measured),
            contacts: &[("overlap_before_m", &measured.shot.overlaps_before_m)],
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
fn verify(plan: &Plan, series: &Series, path: &Path, inputs: &str) -> Result<(), RigError> {
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
            experiment::Channels::Summed => SeriesChannels::Summed,
            experiment::Channels::Separate => SeriesChannels::Separate,
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
        long_names: LONG_NAMES,
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
            ("low_pass_order".to_owned(), amplifier.order.name().to_owned()),
            ("low_pass_kind".to_owned(), amplifier.kind.name().to_owned()),
        ],
    }
}
