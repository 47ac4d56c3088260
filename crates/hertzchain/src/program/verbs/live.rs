//! `hertzchain live`: shots measured as they are recorded.

use super::measure::{MEASURED, summary, tables};
use crate::live::LiveMeasurement;
use crate::measure::{self, MeasureResult};
use crate::options::{
    DesignOptions, LiveOptions, MeasureOptions, ModelOptions, ParameterOptions, ReadingOptions,
    RowsAre,
};
use crate::program::{Failure, Folder, failure, format, print};
use crate::{design, inference, sweep};
use hertzchain_measure::records::{StreamFormat, stream_pieces, write_npy, write_whole};
use hertzchain_measure::{Case, Level, MeasureError, Shot, SpeedRow, shots_at_level};
use serde_json::{Value, json};
use std::fs::{self, File, TryLockError};
use std::io::{self, Read};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle, sleep};
use std::time::{Duration, Instant};

/// Time between two looks into the folder. A recording is measured after the second one.
const LOOK: Duration = Duration::from_millis(100);

pub(crate) fn run(arguments: &LiveOptions) -> Result<(), Failure> {
    let Source { folder, measured, recording } = Source::open(arguments)?;
    let mut live = LiveMeasurement::new(&folder, &measured)?;
    failure::print_improbable(&measure::rig(&measured)?);
    if let Some(out) = &measured.out {
        Folder::open(out, &[MEASURED], measured.force || continues(out, &folder))?;
    }
    print::note(&format!("measuring what comes into {}; Ctrl-C ends", folder.display()));
    let proposals = Proposals::start(arguments)?;
    let (mut last, mut list_error) = (Instant::now(), None);
    loop {
        // Asked before the look, which then sees what the stream has brought last.
        let ended = recording.as_ref().is_some_and(JoinHandle::is_finished);
        let files = live.update()?;
        if live.list_error != list_error {
            list_error.clone_from(&live.list_error);
            print::warn(&list_error);
        }
        if !files.is_empty() {
            report(&measured, &live, &files, proposals.as_ref())?;
        }
        // Neither measuring nor a proposal, which the user may wait for, is silence.
        if !files.is_empty() || proposals.as_ref().is_some_and(Proposals::is_busy) {
            last = Instant::now();
        }
        let stop = arguments.stop_after.map(|time| Duration::from_secs_f64(time.0));
        if stop.is_some_and(|stop| last.elapsed() > stop) || (ended && live.is_complete()) {
            break;
        }
        sleep(LOOK);
    }
    if recording.as_ref().is_some_and(JoinHandle::is_finished) {
        print::note("the stream has ended");
    }
    ended_well(recording)?;
    proposals.map_or(Ok(()), Proposals::finish)?;
    let MeasureResult { shots, curves } = live.result();
    if !measured.json {
        print::print(&summary::text(&shots, &curves, &measured.reference))?;
    }
    measure::evaluate(&shots)
}

/// Whether tables in the output folder are of recordings in the followed one.
fn continues(out: &Path, followed: &Path) -> bool {
    let text = fs::read(out.join(MEASURED)).unwrap_or_default();
    let all: Value = serde_json::from_slice(&text).unwrap_or_default();
    let is_followed = |shot: &Value| {
        shot["file"].as_str().is_some_and(|file| Path::new(file).parent() == Some(followed))
    };
    all["shots"].as_array().is_some_and(|shots| shots.iter().all(is_followed))
}

struct Source {
    /// Where they lie.
    folder: PathBuf,
    /// How they are measured there.
    measured: MeasureOptions,
    /// What stores the shots of a stream in the folder.
    recording: Option<JoinHandle<Result<(), MeasureError>>>,
}

impl Source {
    fn open(arguments: &LiveOptions) -> Result<Self, Failure> {
        let measured = arguments.measured.clone();
        let [source] = measured.records.as_slice() else {
            return Err(wrong("one source is followed: a folder, - or tcp://HOST:PORT"));
        };
        if measured.report.is_some() {
            return Err(wrong("--report is written by measure, of the same recordings"));
        }
        let source = source.clone();
        match source.to_str() {
            Some("-") => Self::stream(io::stdin(), "standard input".to_owned(), arguments),
            Some(address) if address.starts_with("tcp://") => {
                let stream = TcpStream::connect(&address["tcp://".len()..])
                    .map_err(|error| wrong(&format!("{address} can't be opened: {error}")))?;
                Self::stream(stream, address.to_owned(), arguments)
            }
            _ if source.is_dir() => Ok(Self { folder: source, measured, recording: None }),
            _ => Err(wrong(&format!(
                "{} is no folder; live follows a folder, - (standard input) or tcp://HOST:PORT",
                source.display()
            ))),
        }
    }

    /// Shots of a stream, each stored whole before it is measured.
    fn stream(
        reader: impl Read + Send + 'static,
        name: String,
        arguments: &LiveOptions,
    ) -> Result<Self, Failure> {
        let reading = &arguments.measured.reading;
        let (Some(rate), Some(volts), Some(out)) =
            (reading.rate, reading.level, &arguments.measured.out)
        else {
            return Err(wrong(
                "a stream needs --rate, --level (in the unit of its samples) and --out, where its \
                 shots are stored",
            ));
        };
        let folder = out.join("records");
        fs::create_dir_all(&folder)
            .map_err(|error| wrong(&format!("cannot write into {}: {error}", folder.display())))?;
        let samples = format!("{:?}", arguments.samples).to_lowercase();
        let stated =
            format!("--rate {} --channels {} --samples {samples}", rate.0, arguments.channels);
        let claimed = claim(&folder, &stated)?;
        let level =
            Level { volts: volts.0, samples: reading.shot_samples.map(|samples| samples.0) };
        let format = StreamFormat {
            rate_hz: rate.0,
            channels: usize::from(arguments.channels),
            kind: arguments.samples.into(),
        };
        let pieces = stream_pieces(name, reader, format);
        let into = folder.clone();
        let recording = thread::spawn(move || {
            let _claimed = claimed;
            let next = stored(&into) + 1;
            for (shot, number) in shots_at_level(pieces, level).zip(next..) {
                let file = into.join(format!("shot-{number:06}.npy"));
                write_npy(&file, &shot?, format.kind).map_err(|error| {
                    MeasureError::Unwritable(file.display().to_string(), error.to_string())
                })?;
            }
            Ok(())
        });
        let rows = (format.channels > 1).then_some(RowsAre::Times);
        let reading = ReadingOptions {
            level: None,
            shot_samples: None,
            whole: true,
            rows: rows.or(reading.rows),
            ..reading.clone()
        };
        let measured = MeasureOptions { reading, ..arguments.measured.clone() };
        Ok(Self { folder, measured, recording: Some(recording) })
    }
}

/// What has broken a stream off, if it has ended.
fn ended_well(recording: Option<JoinHandle<Result<(), MeasureError>>>) -> Result<(), Failure> {
    let Some(recording) = recording.filter(JoinHandle::is_finished) else {
        return Ok(());
    };
    let ended = recording.join();
    let broken = |_| Failure::Ours("storing the shots of the stream was broken off".to_owned());
    ended.map_err(broken)?.map_err(|error| wrong(&error.to_string()))
}

/// Rate, channels and samples of the stored shots, which their files do not state.
const STREAM: &str = ".stream";

/// Refuses a folder with shots of a stream of another format, or of one that another program stores;
/// notes the format of a new one. The folder is free again when what is returned is dropped; a system
/// that locks no folders does without.
fn claim(folder: &Path, format: &str) -> Result<Option<File>, Failure> {
    let lock = File::open(folder).ok();
    let is_taken = |lock: &File| matches!(lock.try_lock(), Err(TryLockError::WouldBlock));
    if lock.as_ref().is_some_and(is_taken) {
        return Err(wrong(&format!(
            "another program is storing a stream in {}; name another folder by --out",
            folder.display()
        )));
    }
    let path = folder.join(STREAM);
    match fs::read_to_string(&path) {
        Ok(before) if stored(folder) > 0 && before != format => Err(wrong(&format!(
            "{} has shots of a stream with {before}, not {format}; name another folder by --out",
            folder.display()
        ))),
        _ => write_whole(&path, |out| out.write_all(format.as_bytes()))
            .map_err(|error| wrong(&format!("cannot write {}: {error}", path.display())))
            .map(|()| lock),
    }
}

/// Largest number of a stored shot; 0 for none.
fn stored(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let number = |entry: fs::DirEntry| {
        let name = entry.file_name();
        name.to_str()?.strip_prefix("shot-")?.strip_suffix(".npy")?.parse().ok()
    };
    entries.filter_map(number).max().unwrap_or(0)
}

fn wrong(text: &str) -> Failure {
    Failure::User(text.to_owned())
}

/// Prints the shots of new files, each with what it does to the mean and the power law; writes the
/// tables anew; asks what to measure after the last of them.
fn report(
    measured: &MeasureOptions,
    live: &LiveMeasurement,
    files: &[PathBuf],
    proposals: Option<&Proposals>,
) -> Result<(), Failure> {
    let result = live.result();
    if let Some(out) = &measured.out {
        let mut folder = Folder::open(out, &[], true)?;
        tables(&mut folder, &result.shots, &result.curves)?;
        folder.finish()?;
    }
    let refused = files.iter().filter_map(|file| live.measured(file)).flat_map(|of| &of.refused);
    refused.for_each(|refused| print::note(&format!("refused: {refused}")));
    let new: Vec<&Shot> =
        result.shots.shots.iter().filter(|shot| files.contains(&shot.file)).collect();
    let keep_dubious = result.curves.keep_dubious;
    for shot in &new {
        let place = place(&result, shot);
        match measured.json {
            true => print::print(&line_json(shot, place, keep_dubious).to_string())?,
            false => print::print(&line_text(shot, place, keep_dubious))?,
        }
    }
    if let (Some(proposals), Some(last)) = (proposals, new.last().copied().cloned()) {
        proposals.ask(last, result);
    }
    Ok(())
}

/// The curve of a shot, and its row there; `None` for a shot that counts in none.
fn place<'a>(result: &'a MeasureResult, shot: &Shot) -> Option<(&'a Case, &'a SpeedRow)> {
    let speed_m_s = shot.speed_m_s?.value;
    let case = result.curves.cases.iter().find(|case| case.name == shot.case)?;
    let off = |row: &&SpeedRow| (row.speed_m_s.value - speed_m_s).abs();
    Some((case, case.rows.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?))
}

/// The file of a shot, and its number there.
fn name(shot: &Shot) -> String {
    let name = shot.file.file_name().unwrap_or_default().to_string_lossy();
    let number = shot.shot.map_or(String::new(), |shot| format!(" {shot}"));
    format!("{name}{number}")
}

fn line_text(shot: &Shot, place: Option<(&Case, &SpeedRow)>, keep_dubious: bool) -> String {
    let speed = shot.speed_m_s.map(|speed| format!("  {} m/s", format::digits(speed.value, 4)));
    let speed = speed.unwrap_or_default();
    let times = match &shot.flight {
        Ok(flight) => {
            let reflected = flight.reflected_s.map_or("–".to_owned(), summary::micro);
            format!("incident {} µs  reflected {reflected} µs", summary::micro(flight.incident_s))
        }
        Err(_) => "no time of flight".to_owned(),
    };
    let flags = Some(shot.flags()).filter(|flags| !flags.is_empty());
    let flags = flags.map_or(String::new(), |flags| format!("  [{flags}]"));
    let reasons = Some(shot.reasons(keep_dubious)).filter(|codes| !codes.is_empty());
    let reasons =
        reasons.map_or(String::new(), |codes| format!("  not counted: {}", codes.join(" ")));
    let mut text = format!("{}{speed}  {times}{flags}{reasons}\n", name(shot));
    if let Some((case, row)) = place {
        let mean = summary::mean(&row.incident_s);
        let (shots, speed) = (row.shots.0, format::digits(row.speed_m_s.value, 4));
        let named = summary::named(&case.name);
        text += &format!("  mean {mean} µs of {shots} ({named}, {speed} m/s)\n");
        let law = summary::law("incident", case, &case.laws.incident);
        text += &(if law.is_empty() { law } else { format!("  {law}") });
    }
    text
}

/// A shot's line; what to measure next has one of its own, later.
fn line_json(shot: &Shot, place: Option<(&Case, &SpeedRow)>, keep_dubious: bool) -> Value {
    json!({
        "shot": measure::shot(shot, keep_dubious),
        "mean": place.map(|(_, row)| measure::row(row)),
        "power_law_incident": place.map(|(case, _)| measure::law(case, &case.laws.incident)),
        "next": null,
        "next_missing": null,
    })
}

/// A shot, and all shots until then.
type Request = (Shot, MeasureResult);

/// Proposals of the next measurement, each printed when it is known.
struct Proposals {
    requests: Sender<Request>,
    busy: Arc<AtomicBool>,
    worker: JoinHandle<Result<(), Failure>>,
}

impl Proposals {
    /// Starts if a model is named.
    fn start(arguments: &LiveOptions) -> Result<Option<Self>, Failure> {
        let Some(model) = &arguments.model else { return Ok(None) };
        let modelled = ModelOptions::default().of_other(model);
        let free = arguments.free.clone();
        let freed = ParameterOptions { free, ..ParameterOptions::default() };
        let options = DesignOptions { modelled, freed, ..DesignOptions::default() };
        failure::print_improbable([&inference::experiment(&options.modelled, None)?]);
        let (requests, waiting) = channel();
        let json = arguments.measured.json;
        let busy = Arc::new(AtomicBool::new(false));
        let computing = busy.clone();
        let worker = thread::spawn(move || follow(&waiting, &options, json, &computing));
        Ok(Some(Self { requests, busy, worker }))
    }

    /// Asks for what follows a shot; while another is computed, the latest request waits alone.
    fn ask(&self, shot: Shot, result: MeasureResult) {
        self.busy.store(true, Ordering::Relaxed);
        // A worker that has ended could not print; that is reported at the end.
        let _ended = self.requests.send((shot, result));
    }

    /// Whether a proposal is being computed that the user may wait for.
    fn is_busy(&self) -> bool {
        self.busy.load(Ordering::Relaxed) && !self.worker.is_finished()
    }

    /// Waits for the last proposal.
    fn finish(self) -> Result<(), Failure> {
        drop(self.requests);
        let broken = |_| Failure::Ours("proposing measurements was broken off".to_owned());
        self.worker.join().map_err(broken)?
    }
}

fn follow(
    waiting: &Receiver<Request>,
    options: &DesignOptions,
    json: bool,
    busy: &AtomicBool,
) -> Result<(), Failure> {
    // Threads of its own, so that it keeps no shot from being measured.
    let pool = sweep::pool(None)?;
    while let Ok(first) = waiting.recv() {
        busy.store(true, Ordering::Relaxed);
        let (shot, result) = waiting.try_iter().last().unwrap_or(first);
        let next = pool.install(|| proposed(&result, &shot.case, options));
        match json {
            true => print::print(&next_json(&shot, &next))?,
            false => print::print(&next_text(&shot, &next))?,
        }
        busy.store(false, Ordering::Relaxed);
    }
    Ok(())
}

/// What the model would measure next, by name.
fn proposed(
    result: &MeasureResult,
    case: &str,
    options: &DesignOptions,
) -> Result<String, Failure> {
    let experiment = inference::experiment(&options.modelled, Some(case))?;
    let (_, found) = design::design(&result.curve(case)?, &experiment, options)?;
    let best = found.design.ranked.first().map(|best| &found.candidates[best.candidate]);
    best.map(|best| best.name.clone()).ok_or_else(|| Failure::User("nothing would help".to_owned()))
}

fn next_text(shot: &Shot, next: &Result<String, Failure>) -> String {
    let name = name(shot);
    match next {
        Ok(best) => format!("  next after {name}: {best}\n"),
        Err(error) => format!("  next after {name}: not known yet: {error}\n"),
    }
}

fn next_json(shot: &Shot, next: &Result<String, Failure>) -> String {
    let line = json!({
        "shot": { "file": shot.file.display().to_string(), "shot": shot.shot, "case": shot.case },
        "next": next.as_ref().ok(),
        "next_missing": next.as_ref().err().map(ToString::to_string),
    });
    line.to_string()
}
