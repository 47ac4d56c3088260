//! `measure`: which recordings, how read, how picked.

mod results;

pub use results::{json, write_json};
// For the verb `live`, which WebAssembly has not.
#[cfg(not(target_family = "wasm"))]
pub(crate) use results::{law, row, shot};

use crate::failure::{Failure, unread};
use crate::options::{
    Corner, CurveOptions, Input, MeasureOptions as Arguments, MethodName, PickOptions as Picking,
};
use crate::{inference, input};
use hertzchain_experiment::Experiment;
use hertzchain_infer::Data;
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{Parts, ReadOptions, Rows, is_recording, seekable, text};
use hertzchain_measure::signal::{
    Bandwidth, FindOptions, LowPass, Method, Polarity, SensorCalibration, Shape, SignalOptions,
};
use hertzchain_measure::{
    Curves, Cut, Grouping, Level, Measurement, Note, Options, Shot, ShotList, Watch, speeds_csv,
};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Order of one run of the low-pass.
const ORDER: usize = 4;

/// The power of a cosine that pulses of Hertz contacts come nearest to.
const POWER: f64 = 6.0;

/// Full width of its fit, in full widths at half maximum.
const FIT_WIDTHS: f64 = 2.0;

/// Files, each once, and those of folders in order of their names, with a note on what else lies in these;
/// the table of shots may lie among them.
///
/// # Errors
/// A folder without recordings; a pipe that can't be read.
pub fn files(given: &[PathBuf], list: Option<&Path>) -> Result<(Vec<PathBuf>, Vec<Note>), Failure> {
    let (mut files, mut notes) = (Vec::new(), Vec::new());
    let is_list = is_list(list);
    for path in given {
        if !path.is_dir() {
            // One that is not there is refused as a record, beside the others.
            files.push(match seekable(path) {
                Err(error) if error.kind() == ErrorKind::NotFound => path.clone(),
                found => found.map_err(unread(path))?,
            });
            continue;
        }
        let (found, mut others) = inside(path)?;
        files.extend(found);
        others.retain(|(other, _)| !is_list(other));
        notes.extend(passed_over(path, others));
    }
    files.retain(|file| !is_list(file));
    let mut known = BTreeSet::new();
    let (files, again): (Vec<_>, Vec<_>) = files
        .into_iter()
        .partition(|file| file.canonicalize().map_or(true, |own| known.insert(own)));
    if !again.is_empty() {
        notes.push(Note { text: "given twice, measured once".to_owned(), files: again });
    }
    Ok((files, notes))
}

/// Whether a file is the table of shots, by whatever path.
pub(crate) fn is_list(list: Option<&Path>) -> impl Fn(&PathBuf) -> bool + use<> {
    let list = list.and_then(|list| list.canonicalize().ok());
    move |file| list.is_some() && file.canonicalize().ok() == list
}

/// Tables of an earlier run, beside `measured.json`.
const TABLES: [&str; 4] = ["shots.csv", "speeds.csv", "power-laws.csv", "ratios.csv"];

/// What a folder has beside recordings; an instrument's binary file with how it is exported.
pub(crate) type Others = Vec<(PathBuf, Option<String>)>;

/// Recordings in a folder, and what else is there, in order of their names.
pub(crate) fn recordings(folder: &Path) -> Result<(Vec<PathBuf>, Others), Failure> {
    let refused = |error| Failure::User(format!("{}: {error}", folder.display()));
    let entries = fs::read_dir(folder).map_err(refused)?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    let is_readme = |path: &Path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        name.eq_ignore_ascii_case("readme")
    };
    let is_measured = folder.join("measured.json").exists();
    let is_table = |path: &Path| {
        let name = path.file_name().and_then(|name| name.to_str());
        is_measured && name.is_some_and(|name| TABLES.contains(&name))
    };
    let (mut found, mut others) = (Vec::new(), Vec::new());
    for path in paths {
        let may_be = path.is_file() && !is_readme(&path) && !is_table(&path);
        match if may_be { is_recording(&path) } else { Err(None) } {
            Ok(()) => found.push(path),
            Err(export) => others.push((path, export)),
        }
    }
    Ok((found, others))
}

/// The same of a folder that must have recordings.
fn inside(folder: &Path) -> Result<(Vec<PathBuf>, Others), Failure> {
    let (found, others) = recordings(folder)?;
    if !found.is_empty() {
        return Ok((found, others));
    }
    let name = |file: &PathBuf| file.file_name().unwrap_or_default().display().to_string();
    let export = |(export, files): (String, Vec<PathBuf>)| {
        format!("; {} {export}", files.first().map(name).unwrap_or_default())
    };
    let exports: String = to_export(&others).into_iter().map(export).collect();
    Err(Failure::User(format!(
        "{}: no recordings in it (of .h5, .mat, .csv, .txt, .npy, .npz, .wav, .tdms and their like){exports}",
        folder.display()
    )))
}

/// Binary files of instruments, by how they are exported.
fn to_export(others: &Others) -> BTreeMap<String, Vec<PathBuf>> {
    let mut files: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for (file, export) in others {
        if let Some(export) = export {
            files.entry(export.clone()).or_default().push(file.clone());
        }
    }
    files
}

const MOST_NAMES: usize = 8;

/// Notes on what a folder has beside recordings, but for hidden files without an extension: one a kind
/// of instruments' binary files, and one on the others.
pub(crate) fn passed_over(folder: &Path, others: Others) -> Vec<Note> {
    let exports = to_export(&others).into_iter().map(|(text, files)| Note { text, files });
    let name = |path: &PathBuf| {
        let name = path.file_name()?.to_str()?;
        let is_listed = !name.starts_with('.') || path.extension().is_some();
        is_listed.then(|| if path.is_dir() { format!("{name}/") } else { name.to_owned() })
    };
    let plain = others.iter().filter(|other| other.1.is_none());
    let names: Vec<String> = plain.filter_map(|other| name(&other.0)).collect();
    let more = match names.len().saturating_sub(MOST_NAMES) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let shown = names.get(..MOST_NAMES).unwrap_or(&names).join(", ");
    let listed = (!names.is_empty()).then(|| Note {
        text: format!("not read as recordings: {shown}{more}; a file that is named is read"),
        files: vec![folder.to_owned()],
    });
    exports.chain(listed).collect()
}

/// Times of flight of recordings: every shot, and curves against speed.
pub struct MeasureResult {
    /// Shots with their times of flight, and what was rejected.
    pub shots: Measurement,
    /// Means at each speed, power laws and ratios.
    pub curves: Curves,
}

impl MeasureResult {
    /// Of shots, if the options suit them.
    pub(crate) fn new(mut shots: Measurement, options: &Arguments) -> Result<Self, Failure> {
        suits(&shots)?;
        let curves = shots.curves(&grouping(options));
        inference::check_cancelled()?;
        Ok(Self { shots, curves })
    }

    /// Returns the curve of a case as a fit takes it; `""` is the case of shots without one.
    ///
    /// # Errors
    /// A case that was not measured, or whose curve can't be fitted.
    pub fn curve(&self, case: &str) -> Result<Data, Failure> {
        // The same numbers as in speeds.csv, bit for bit.
        let case = Some(case.to_owned()).filter(|case| !case.is_empty());
        inference::parsed("measured", &speeds_csv(&self.curves), &CurveOptions::default(), case)
    }
}

/// Measures times of flight on recordings.
///
/// ```no_run
/// use hertzchain::prelude::*;
///
/// let measured = measure(&["shots".into()], &MeasureOptions::default())?;
/// let found = fit(&measured.curve("dry")?, &preset("dry")?, &FitOptions::free(["eta", "B"]))?;
/// println!("{} ± {}", found.inferred.fit.point[0], found.inferred.standard_error(0));
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// Files and options that can't be used.
pub fn measure(records: &[PathBuf], options: &Arguments) -> Result<MeasureResult, Failure> {
    measure_watched(records, options, &self::options(options, rig(options)?.as_ref())?, &())
}

/// The same as `how` says, watched on the way.
///
/// # Errors
/// Files that can't be used; that it was broken off.
pub fn measure_watched(
    records: &[PathBuf],
    options: &Arguments,
    how: &Options,
    watch: &dyn Watch,
) -> Result<MeasureResult, Failure> {
    let (files, notes) = files(records, options.shots.as_deref())?;
    let mut shots = hertzchain_measure::measure(&files, how, watch);
    shots.notes.splice(0..0, notes);
    inference::check_cancelled()?;
    MeasureResult::new(shots, options)
}

/// How recordings are read and measured.
///
/// # Errors
/// Options that do not go together; a table of shots that can't be used.
pub fn options(arguments: &Arguments, rig: Option<&Experiment>) -> Result<Options, Failure> {
    let reading = &arguments.reading;
    if reading.channel.len() > 2 {
        return Err(Failure::User(
            "a shot has at most two channels: --channel once if one sums both sensors, twice for \
             the sensor bead's and the wall's"
                .to_owned(),
        ));
    }
    if let [one, other] = &reading.channel[..]
        && one == other
    {
        return Err(Failure::User(format!(
            "--channel {one} twice: expected the sensor bead's and the wall's; once, if it sums both"
        )));
    }
    let high_pass_hz = ac_coupling_hz(&arguments.picking, rig);
    Ok(Options {
        keep_droop: high_pass_hz == Some(0.0),
        keep_low_pass: arguments.picking.low_pass == Some(Corner(0.0)),
        reading: ReadOptions {
            rate_hz: reading.rate.map(|rate| rate.0),
            trust_rate: reading.trust_rate,
            channels: reading.channel.clone(),
            time_unit_s: reading.time_unit.map(|unit| unit.0),
            parts: match (reading.shot_samples, reading.level) {
                (Some(samples), None) => Parts::Shots(samples.0),
                _ => Parts::Whole,
            },
            rows: reading.rows.map_or(Rows::Auto, Into::into),
        },
        cutting: match (reading.level, reading.whole) {
            (Some(volts), _) => Cut::Level(Level {
                volts: volts.0,
                samples: reading.shot_samples.map(|samples| samples.0),
            }),
            (None, true) => Cut::Never,
            (None, false) => Cut::Plain,
        },
        measuring: measuring(&arguments.picking, rig, high_pass_hz)?,
        most_flagged: 0,
        list: arguments.shots.as_deref().map(list).transpose()?,
        speed_error_m_s: arguments
            .speed_error
            .map(|error| error.0)
            .or_else(|| Some(rig?.campaign().photogate.error_m_s)),
    })
}

/// Returns the rig that an option names: its file, or a preset by its name.
///
/// # Errors
/// A rig that can't be used.
pub fn rig(arguments: &Arguments) -> Result<Option<Experiment>, Failure> {
    arguments.rig.as_deref().map(open_rig).transpose()
}

fn open_rig(file: &Path) -> Result<Experiment, Failure> {
    let preset = file.to_str().filter(|_| !input::is_file(file));
    let preset = preset.filter(|name| hertzchain_experiment::preset(name).is_ok());
    input::open(&Input {
        file: preset.is_none().then(|| file.to_owned()),
        preset: preset.map(str::to_owned),
    })
}

/// The table of shots.
///
/// # Errors
/// A file that can't be read, or is no such table.
pub fn list(file: &Path) -> Result<ShotList, Failure> {
    let wrong = |error: &dyn std::error::Error| {
        Failure::User(format!("--shots {}: {error}", file.display()))
    };
    let text = text(file).map_err(|error| wrong(&error))?;
    ShotList::parse(&text).map_err(|error| wrong(&error))
}

/// Corner of the amplifier's high-pass in Hz, 0 for none, if an option or the rig's file has it.
fn ac_coupling_hz(picking: &Picking, rig: Option<&Experiment>) -> Option<f64> {
    let of_rig = || Some(rig?.campaign().amplifier.high_pass_hz);
    picking.ac_coupling.map(|corner| corner.0).or_else(of_rig)
}

fn measuring(
    picking: &Picking,
    rig: Option<&Experiment>,
    high_pass_hz: Option<f64>,
) -> Result<SignalOptions, Failure> {
    let beads = picking.beads.zip(picking.sensor).map(|(beads, sensor)| (beads.0, sensor.0));
    if let Some((beads, sensor)) = beads.filter(|(beads, sensor)| sensor >= beads) {
        return Err(Failure::User(format!(
            "--sensor {sensor} is not one of --beads {beads} before the last"
        )));
    }
    let of_rig = || Some((rig?.beads(), rig?.sensor_bead()));
    let given = |corner: Option<Corner>| corner.map(|corner| corner.0).filter(|hz| *hz > 0.0);
    Ok(SignalOptions {
        find: FindOptions {
            polarity: picking.polarity.map_or(Polarity::Auto, Into::into),
            wall_polarity: picking.wall_polarity.map_or(Polarity::Auto, Into::into),
            beads: beads.or_else(of_rig),
            ..FindOptions::default()
        },
        method: method(picking)?,
        high_pass_s: high_pass_hz.filter(|hz| *hz > 0.0).map(|hz| (TAU * hz).recip()),
        low_pass: given(picking.smooth).map(|cutoff_hz| LowPass { cutoff_hz, order: ORDER }),
        bandwidth: bandwidth(picking, rig)?,
        mains_hz: given(picking.mains),
        calibration: SensorCalibration {
            sensitivities_v_n: sensitivities_v_n(picking, rig),
            skew_s: picking.skew.map_or(0.0, |skew| skew.0),
        },
    })
}

/// Sensitivities of both sensors: an option's, or a rig's of unlike sensors, whose ratios of peaks are
/// otherwise none of forces.
fn sensitivities_v_n(picking: &Picking, rig: Option<&Experiment>) -> Option<[f64; 2]> {
    let given = picking
        .sensitivity
        .map(|sensor| [sensor.0, picking.wall_sensitivity.map_or(sensor.0, |wall| wall.0)]);
    given.or_else(|| {
        let amplifier = &rig?.campaign().amplifier;
        let charges_c_n = [amplifier.sensitivity_c_n, amplifier.wall_sensitivity_c_n];
        let unlike = charges_c_n[0] != charges_c_n[1];
        unlike.then(|| charges_c_n.map(|charge_c_n| amplifier.gain_v_c * charge_c_n))
    })
}

/// The amplifier's low-pass, if an option or the rig's file states it; 0 for none.
fn bandwidth(picking: &Picking, rig: Option<&Experiment>) -> Result<Option<Bandwidth>, Failure> {
    let amplifier = rig.map(|rig| &rig.campaign().amplifier);
    let corner_hz = picking.low_pass.map(|corner| corner.0).or(amplifier.map(|of| of.low_pass_hz));
    if picking.filter.is_some() && corner_hz.is_none() {
        return Err(Failure::User(
            "--filter is of the amplifier's low-pass, whose corner --low-pass or --rig states"
                .to_owned(),
        ));
    }
    let local = picking.method == MethodName::Local;
    let Some(corner_hz) = corner_hz.filter(|hz| *hz > 0.0 && (local || picking.low_pass.is_some()))
    else {
        return Ok(None);
    };
    if !local {
        return Err(Failure::User(
            "--low-pass corrects maxima, the times of --method local, and no others".to_owned(),
        ));
    }
    let (order, kind) = match (picking.filter, amplifier) {
        (Some(filter), _) => filter.names(),
        (None, Some(of)) => (of.order.name(), Some(of.kind.name())),
        (None, None) => ("as the recording states", None),
    };
    let orders = ["first", "second", "third", "fourth"];
    let order = orders.iter().position(|name| *name == order).map_or(0, |index| index + 1);
    Ok(Some(Bandwidth { corner_hz, order, bessel: order > 1 && kind == Some("bessel") }))
}

/// Share of its height at which a pulse has its onset.
const ONSET: f64 = 0.5;

fn method(picking: &Picking) -> Result<Method, Failure> {
    if picking.onset.is_some() && picking.method != MethodName::Onset {
        return Err(Failure::User("--onset is of --method onset, and no other".to_owned()));
    }
    Ok(match picking.method {
        MethodName::Local => Method::default(),
        MethodName::Onset => {
            Method::Onset { fraction: picking.onset.map_or(ONSET, |share| share.0) }
        }
        MethodName::Correlation => Method::CrossCorrelation,
        MethodName::Shape => {
            Method::MatchedShape { shape: Shape::cos_power(POWER), width: FIT_WIDTHS }
        }
    })
}

pub(crate) fn grouping(arguments: &Arguments) -> Grouping {
    Grouping {
        gap_m_s: arguments.speed_gap.0,
        reference: arguments.reference.clone(),
        keep_dubious: arguments.keep_dubious,
    }
}

/// Refuses an option that no record takes, as a low-pass above half their sampling rate: it is
/// reported once, not with every shot.
fn suits(measured: &Measurement) -> Result<(), Failure> {
    let unsuited = |shot: &&Shot| {
        matches!(shot.flight, Err(MeasureError::Option(..) | MeasureError::LowCorner(..)))
    };
    let first = measured.shots.first();
    let error = first.and_then(|shot| Some((shot, shot.flight.as_ref().err()?)));
    match error {
        Some((first, error)) if measured.shots.iter().all(|shot| unsuited(&shot)) => {
            Err(Failure::User(format!(
                "{error}; {} is sampled at {:.0} Hz, and no record takes it",
                first.source,
                first.interval_s.recip()
            )))
        }
        _ => Ok(()),
    }
}

/// Refused records and such without a time of flight make the run one with mistakes,
/// whatever else was measured.
///
/// # Errors
/// What was refused or not found.
pub fn evaluate(measured: &Measurement) -> Result<(), Failure> {
    let refused = measured.refused.len();
    let all = refused + measured.shots.len();
    let timeless = measured.shots.iter().filter(|shot| shot.flight.is_err());
    let timeless = timeless.count();
    let wrong = match (refused, timeless) {
        (0, 0) if all == 0 => {
            Some("there is no recording, or none but the table of shots".to_owned())
        }
        (0, 0) => None,
        (0, _) => Some(no_time(timeless, all)),
        (_, 0) => Some(format!("{refused} of {all} records were refused")),
        _ => Some(format!(
            "{refused} of {all} records were refused, and {}",
            no_time(timeless, measured.shots.len())
        )),
    };
    let reported = match refused + timeless < all {
        true => wrong.map(|wrong| wrong + "; the others were measured"),
        false => Some("nothing was measured: ".to_owned() + &wrong.unwrap_or_default()),
    };
    reported.map_or(Ok(()), |reported| Err(Failure::User(reported)))
}

fn no_time(timeless: usize, all: usize) -> String {
    let have = if all == 1 { "has" } else { "have" };
    format!("{timeless} of {all} that were read {have} no time of flight, as their flags say")
}
