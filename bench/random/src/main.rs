//! Random harsh chains: the program beside an independent integration.
//!
//! `cargo run --release -p hertzchain-random -- 1000` draws rows of unlike beads, integrates each by
//! a method and code of its own, asks the program about it in several ways, and prints what differs.
//! Files of rows with a finding are kept.

mod arrival;
mod compare;
mod draw;
mod motion;
mod physics;
mod program;
mod reference;
mod row;
#[cfg(test)]
mod tests;

use arrival::Arrival;
use compare::{Finding, Verdict, compare};
use draw::Family;
use program::{Answer, Ask, Silence, ask};
use reference::{BEYOND, Reference};
use row::Row;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

const USAGE: &str = "usage: hertzchain-random [COUNT] [--seed N] [--from N] [--jobs N] \
     [--program FILE] [--keep FOLDER] [--only \"shot\"|\"sweep -a 1e-6\"|...] [--all] \
     [--family light|heavy|split|loaded|soft|stops] [--beads MOST] [--seconds N] [--sample] [--maxima]";

/// What is to be done.
struct Options {
    count: u64,
    seed: u64,
    from: u64,
    jobs: usize,
    program: PathBuf,
    keep: PathBuf,
    only: Option<String>,
    /// Every row is asked for in all ways, not in four by turns.
    all: bool,
    family: Option<Family>,
    /// Longer rows are left out.
    beads: usize,
    /// No row is begun after this time.
    limit: Duration,
    /// Print reference numbers for the test of a fixed sample instead.
    sample: bool,
    /// Print the reference's maxima instead.
    maxima: bool,
}

impl Options {
    fn parsed(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let jobs = std::thread::available_parallelism().map_or(1, usize::from);
        let mut options = Self {
            count: 100,
            seed: 1,
            from: 0,
            jobs,
            program: "target/release/hertzchain".into(),
            keep: "target/random".into(),
            only: None,
            all: false,
            family: None,
            beads: usize::MAX,
            limit: Duration::MAX,
            sample: false,
            maxima: false,
        };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| USAGE.to_owned());
            let number = |text: String| text.parse::<u64>().map_err(|_| USAGE.to_owned());
            match word.as_str() {
                "--seed" => options.seed = number(value()?)?,
                "--from" => options.from = number(value()?)?,
                "--jobs" => options.jobs = number(value()?)?.max(1) as usize,
                "--program" => options.program = value()?.into(),
                "--keep" => options.keep = value()?.into(),
                "--only" => options.only = Some(value()?),
                "--beads" => options.beads = number(value()?)? as usize,
                "--all" => options.all = true,
                "--family" => {
                    options.family =
                        Some(Family::named(&value()?).ok_or_else(|| USAGE.to_owned())?);
                }
                "--seconds" => options.limit = Duration::from_secs(number(value()?)?),
                "--maxima" => options.maxima = true,
                "--sample" => options.sample = true,
                count => options.count = number(count.to_owned())?,
            }
        }
        Ok(options)
    }
}

/// One row, one way of asking.
struct Outcome {
    name: String,
    said: Result<Answer, Silence>,
    error: Option<f64>,
    finding: Option<Finding>,
}

/// Ways to ask the program about a row: `shot`, and two others by turns.
fn asks(options: &Options, at: u64) -> Vec<Ask> {
    let mut others = Vec::new();
    for accuracy in ["1e-3", "1e-4", "1e-5", "1e-6", "1e-7"] {
        others.push(Ask::new("sweep", &["-a", accuracy]));
    }
    for accuracy in ["1e-9", "1e-3", "1e-8"] {
        others.push(Ask::new("shot", &["-a", accuracy]));
    }
    if options.only.is_none() && !options.all {
        let turn = at as usize % others.len();
        others.rotate_left(turn);
        others.swap(1, 3);
        others.truncate(2);
    }
    others.insert(0, Ask::new("shot", &[]));
    let only = options.only.as_deref();
    others.retain(|ask| only.is_none_or(|only| ask.name() == only));
    others
}

/// The same shot with durations that cover the window in which its pulses are looked for.
fn durations(options: &Options, at: u64, answer: &Answer) -> Vec<Ask> {
    let Ok(peaks) = &answer.peaks else {
        return Vec::new();
    };
    if options.only.is_some() {
        return Vec::new();
    }
    let until_s = peaks.search_ends_s();
    let ask = |share: f64| Ask::new("shot", &["--duration", &format!("{:?} s", share * until_s)]);
    let mut asks = [1.0001, 1.3, 3.0].map(ask).to_vec();
    if !options.all {
        asks.swap(0, at as usize % 3);
        asks.truncate(1);
    }
    asks
}

/// Asks about a row, and compares.
fn outcomes(options: &Options, (at, row): (u64, &Row), file: &Path) -> Vec<Outcome> {
    let ask = |how: Ask| {
        let said = ask(&options.program, file, row.speed_m_s, &how);
        (how.name(), said)
    };
    let mut said = Vec::new();
    for how in asks(options, at) {
        said.push(ask(how));
        if matches!(said.last(), Some((_, Err(Silence::TooSlow)))) {
            break;
        }
    }
    if let Some((_, Ok(answer))) = said.first() {
        said.extend(durations(options, at, answer).into_iter().map(ask));
    }
    let needed = said.iter().filter_map(|(_, said)| {
        let said = said.as_ref().ok()?;
        Some(said.peaks.as_ref().map_or(said.duration_s, Arrival::search_ends_s))
    });
    let until_s = BEYOND * needed.fold(0.0, f64::max);
    let verdicts = verdicts(row, until_s, &said);
    let outcome = |((name, said), verdict): ((String, Result<Answer, Silence>), Verdict)| Outcome {
        name,
        said,
        error: verdict.error,
        finding: verdict.finding,
    };
    said.into_iter().zip(verdicts).map(outcome).collect()
}

/// By a quick reference, and where that differs by one as right as can be.
fn verdicts(row: &Row, until_s: f64, said: &[(String, Result<Answer, Silence>)]) -> Vec<Verdict> {
    let all = |mut reference: Reference| -> Vec<Verdict> {
        let unresolved = until_s > 0.0 && reference.cover(until_s).is_err();
        let verdict = |(_, said): &(String, Result<Answer, Silence>)| match said {
            Ok(answer) if !unresolved => compare(answer, &reference),
            said => Verdict { error: None, finding: said.is_ok().then_some(Finding::Unresolved) },
        };
        said.iter().map(verdict).collect()
    };
    let quick = all(Reference::quick(row));
    match quick.iter().any(|verdict| verdict.finding.is_some()) {
        true => all(Reference::tight(row)),
        false => quick,
    }
}

/// Counts by way of asking.
#[derive(Default)]
struct Tally {
    runs: u64,
    refused: u64,
    too_slow: u64,
    findings: BTreeMap<&'static str, u64>,
    worst_over: f64,
    force_passes: f64,
}

fn tallied(tally: &mut Tally, outcome: &Outcome) {
    match &outcome.said {
        Err(Silence::Refused(_)) => tally.refused += 1,
        Err(Silence::TooSlow) => tally.too_slow += 1,
        Ok(answer) => {
            tally.runs += 1;
            tally.force_passes += answer.force_passes;
            let stated = answer.reached.unwrap_or(answer.asked);
            if !matches!(outcome.finding, Some(Finding::Unresolved)) {
                tally.worst_over = tally.worst_over.max(outcome.error.unwrap_or(0.0) / stated);
            }
        }
    }
    if let Some(finding) = &outcome.finding {
        *tally.findings.entry(finding.word()).or_default() += 1;
    }
}

/// One line a finding, and the file kept.
fn print_findings(options: &Options, at: u64, text: &str, outcomes: &[Outcome]) {
    let name = format!("{}-{at}.toml", options.seed);
    let mut keep = false;
    for outcome in outcomes {
        let finding = match (&outcome.finding, &outcome.said) {
            (Some(Finding::Unresolved), Ok(_)) | (None, Ok(_)) => continue,
            (Some(finding), Ok(answer)) => format!(
                "{finding:?}, accuracy reached {:?}, notes {:?}",
                answer.reached, answer.notes
            ),
            (_, Err(Silence::TooSlow)) => "too slow".into(),
            (_, Err(Silence::Refused(why))) => format!("refused: {why}"),
        };
        keep = true;
        println!("{name}\t{}\t{finding}", outcome.name);
    }
    if keep && let Err(error) = std::fs::write(options.keep.join(&name), text) {
        eprintln!("error: {name}: {error}");
    }
}

fn run(options: &Options) -> std::io::Result<BTreeMap<String, Tally>> {
    std::fs::create_dir_all(&options.keep)?;
    let (next, begun) = (AtomicU64::new(options.from), Instant::now());
    let tallies = Mutex::new(BTreeMap::<String, Tally>::new());
    let work = |job: usize| {
        let file = options.keep.join(format!(".row-{}-{job}.toml", std::process::id()));
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= options.from + options.count || begun.elapsed() > options.limit {
                break;
            }
            let row = draw::row(options.seed, at, options.family);
            if row.beads.len() > options.beads {
                continue;
            }
            let text = row.toml();
            if let Err(error) = std::fs::write(&file, &text) {
                eprintln!("error: {}: {error}", file.display());
                break;
            }
            let outcomes = outcomes(options, (at, &row), &file);
            let Ok(mut tallies) = tallies.lock() else {
                break;
            };
            print_findings(options, at, &text, &outcomes);
            for outcome in &outcomes {
                let name = match outcome.name.split_once("--duration") {
                    Some((verb, _)) => format!("{verb}--duration"),
                    None => outcome.name.clone(),
                };
                tallied(tallies.entry(name).or_default(), outcome);
            }
        }
        let _ = std::fs::remove_file(&file);
    };
    std::thread::scope(|scope| {
        for job in 0..options.jobs {
            scope.spawn(move || work(job));
        }
    });
    Ok(tallies.into_inner().unwrap_or_default())
}

/// Longest row of the fixed sample, so that its test is quick.
const SAMPLED: usize = 30;

/// Reference numbers of the rows on which the program and the reference agree.
fn sample(options: &Options) -> std::io::Result<()> {
    std::fs::create_dir_all(&options.keep)?;
    let file = options.keep.join("sample.toml");
    println!("seed,row,incident_s,reflected_s");
    for at in options.from..options.from + options.count {
        let row = draw::row(options.seed, at, options.family);
        if row.beads.len() > SAMPLED {
            continue;
        }
        std::fs::write(&file, row.toml())?;
        let how = Ask::new("shot", &["-a", "1e-9"]);
        let Ok(answer) = ask(&options.program, &file, row.speed_m_s, &how) else {
            continue;
        };
        let mut reference = Reference::tight(&row);
        if reference.cover(0.0).is_err() {
            continue;
        }
        let Some(right) = reference.signals().arrival() else {
            continue;
        };
        let agrees = compare(&answer, &reference).finding.is_none();
        if let (true, Some(incident)) = (agrees, right.incident) {
            let incident_s = right.wall.time_s - incident.time_s;
            let back =
                right.reflected.filter(|_| answer.peaks.is_ok_and(|it| it.reflected.is_some()));
            let reflected_s = back.map_or(f64::NAN, |back| back.time_s - right.wall.time_s);
            println!("{},{at},{incident_s:.12e},{reflected_s:.12e}", options.seed);
        }
    }
    Ok(())
}

/// Time in s and height in N of the reference's maxima: sensor bead, wall.
fn print_maxima(options: &Options) {
    for at in options.from..options.from + options.count {
        let mut reference = Reference::tight(&draw::row(options.seed, at, options.family));
        if reference.cover(0.0).is_err() {
            println!("row {at}: unresolved");
            continue;
        }
        println!("row {at}: {:?}", reference.signals().arrival());
        let signals = reference.signals();
        for (name, maxima) in [("sensor", signals.sensor), ("wall", signals.wall)] {
            for maximum in maxima {
                println!("{name}\t{:.9e}\t{:.9e}", maximum.time_s, maximum.height_n);
            }
        }
    }
}

fn main() -> ExitCode {
    let options = match Options::parsed(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(usage) => {
            eprintln!("{usage}");
            return ExitCode::from(2);
        }
    };
    if options.maxima {
        print_maxima(&options);
        return ExitCode::SUCCESS;
    }
    if options.sample {
        return match sample(&options) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("error: {}: {error}", options.keep.display());
                ExitCode::FAILURE
            }
        };
    }
    let tallies = match run(&options) {
        Ok(tallies) => tallies,
        Err(error) => {
            eprintln!("error: {}: {error}", options.keep.display());
            return ExitCode::FAILURE;
        }
    };
    let mut wrong = false;
    for (name, tally) in &tallies {
        println!(
            "{name}: {} runs, {} refused, {} too slow, worst error over the accuracy stated {:.2}, \
             force passes {:.3e}, {:?}",
            tally.runs,
            tally.refused,
            tally.too_slow,
            tally.worst_over,
            tally.force_passes,
            tally.findings
        );
        wrong |= tally.findings.keys().any(|word| *word != "unresolved");
    }
    match wrong {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    }
}
