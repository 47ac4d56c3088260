//! Checkpoints of a posterior in its output folder: walkers, and the options that they belong to.

use super::{Arguments, Inferred, More};
use crate::failure::Failure;
use crate::inference::{check_cancelled, user};
use crate::options;
use hertzchain_infer::{Chain, Covariance, Fit, Problem, Sampling};
use hertzchain_measure::records::write_whole;
use hertzchain_sim::{Fingerprint, StudyError, note_progress, stopped};
use serde_json::{Map, Value};
use std::fs;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

const OPTIONS: &str = "options.json";

/// The option that may differ where a run is resumed: how far it goes.
const MAY_DIFFER: &str = "steps";

/// Checks that the options of a resumed run are those of the run that it continues.
pub(super) fn check_options(arguments: &Arguments) -> Result<(), Failure> {
    let Some(out) =
        arguments.out.as_deref().filter(|_| arguments.method == options::Method::Posterior)
    else {
        return Ok(());
    };
    let chain = out.join(CHAIN);
    let path = out.join(OPTIONS);
    if !arguments.resume || !(path.exists() || chain.exists()) {
        return Ok(());
    }
    let now = options::recorded(arguments);
    let unread = |error: &dyn std::fmt::Display| {
        let way_out = format!("remove {} to begin anew", chain.display());
        Failure::User(format!("--resume: {}: {error}; {way_out}", path.display()))
    };
    let text = fs::read_to_string(&path).map_err(|error| unread(&error))?;
    let before: Map<String, Value> = serde_json::from_str(&text).map_err(|error| unread(&error))?;
    let missing =
        now.as_object().into_iter().flatten().filter(|(name, _)| !before.contains_key(*name));
    let names = before.keys().chain(missing.map(|(name, _)| name));
    let was = |name: &str| before.get(name).unwrap_or(&Value::Null);
    let differ = names.filter(|name| *name != MAY_DIFFER && now[name.as_str()] != *was(name));
    let differ: Vec<String> = differ
        .map(|name| format!("{name} was {}, now {}", was(name), now[name.as_str()]))
        .collect();
    match differ.is_empty() {
        true => Ok(()),
        false => Err(Failure::User(format!(
            "--resume continues the run in {}, which had other options: {}",
            out.display(),
            differ.join("; ")
        ))),
    }
}

/// Writes the options of a run whose walkers begin, in the place of those of an earlier one.
fn begin(out: &Path, arguments: &Arguments) -> Result<(), Failure> {
    let chain = out.join(CHAIN);
    match fs::remove_file(&chain) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            return Err(Failure::Ours(format!("{}: {error}", chain.display())));
        }
        _ => {}
    }
    write(out, OPTIONS, options::recorded(arguments).to_string().as_bytes())
}

/// Removes the options where no walkers are left to continue.
pub fn finished(out: &Path) {
    if !out.join(CHAIN).exists() {
        // What stays does no harm: a new run writes its own.
        let _ = fs::remove_file(out.join(OPTIONS));
    }
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), Failure> {
    let written = fs::create_dir_all(folder)
        .and_then(|()| write_whole(&folder.join(name), |file| file.write_all(bytes)));
    written.map_err(|error| Failure::Ours(error.to_string()))
}

const HASH: usize = 64;

/// Bytes with their hash after them, in hexadecimal digits.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(Fingerprint::of_bytes(&bytes).to_string().into_bytes());
    bytes
}

/// The bytes before their hash; `None` if it is not theirs.
fn checked(bytes: &[u8]) -> Option<&[u8]> {
    let length = bytes.len().checked_sub(HASH)?;
    let (whole, hash) = bytes.split_at(length);
    (Fingerprint::of_bytes(whole).to_string().as_bytes() == hash).then_some(whole)
}

/// A new chain, or the one that lies in the output folder if a run left one.
pub(super) fn started(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    arguments: &Arguments,
) -> Result<Chain, Failure> {
    let path = arguments.out.as_deref().map(|out| out.join(CHAIN));
    let Some(path) = path.filter(|path| arguments.resume && path.exists()) else {
        arguments.out.as_deref().map_or(Ok(()), |out| begin(out, arguments))?;
        let walkers = WALKERS.max(4 * fit.point.len());
        let how = Sampling { walkers, seed: arguments.seed, ..Sampling::default() };
        return Chain::start(problem, fit, covariance, &how).map_err(user);
    };
    let unread = |error: &dyn std::fmt::Display| {
        Failure::User(format!("--resume: {}: {error}", path.display()))
    };
    let mut bytes = Vec::new();
    let read = fs::File::open(&path).and_then(|file| Wanted(file).read_to_end(&mut bytes));
    check_cancelled()?;
    read.map_err(|error| unread(&error))?;
    let damaged = || unread(&"damaged; remove it, or leave --resume out to begin anew");
    let text = checked(&bytes).ok_or_else(damaged)?;
    let read = serde_json::from_reader(BufReader::with_capacity(PIECE, Wanted(text)));
    check_cancelled()?;
    let chain: Chain = read.map_err(|error| unread(&error))?;
    chain.belongs_to(problem).map_err(|error| unread(&error))?;
    Ok(chain)
}

/// Bytes of a chain that are read between looks at whether it is still wanted.
const PIECE: usize = 1 << 18;

/// Walkers of each ensemble, unless parameters are many.
const WALKERS: usize = 32;

/// The chain's file in the output folder.
pub const CHAIN: &str = "chain.json";

/// Looks at whether to break off, and saves walkers on their way, so that a run
/// that is broken off or killed goes on with `--resume`.
pub(super) struct Saving<'a> {
    folder: Option<&'a Path>,
    saved: Option<Instant>,
    most_steps: u64,
}

/// Time between saved states: what a broken run loses.
const SAVE_EVERY: Duration = Duration::from_secs(10);

impl<'a> Saving<'a> {
    pub(super) fn new(arguments: &'a Arguments) -> Self {
        Self { folder: arguments.out.as_deref(), saved: None, most_steps: arguments.steps }
    }

    pub(super) fn seen(&mut self, chain: &Chain) -> Result<(), Failure> {
        check_cancelled()?;
        note_progress(&format_args!(
            "posterior: {} of at most {} steps of {} walkers, {:.0} % of proposals accepted",
            chain.steps(),
            self.most_steps,
            chain.walkers(),
            100.0 * chain.acceptance()
        ));
        let Some(folder) = self.folder else {
            return Ok(());
        };
        if self.saved.is_some_and(|saved| saved.elapsed() < SAVE_EVERY) {
            return Ok(());
        }
        write(folder, CHAIN, &saved(chain)?)?;
        // From the end of writing: a long chain takes its time.
        self.saved = Some(Instant::now());
        Ok(())
    }
}

/// A chain as it lies in the output folder: JSON, and a line with its hash.
///
/// # Errors
/// Numbers that are none, of which JSON knows nothing; a wish to stop.
pub fn saved(chain: &Chain) -> Result<Vec<u8>, Failure> {
    let mut text = Wanted(Vec::new());
    let written = serde_json::to_writer(&mut text, chain);
    written.map_err(|error| Failure::Ours(error.to_string()))?;
    text.0.push(b'\n');
    Ok(sealed(text.0))
}

/// Leaves a fit's walkers in the output folder, to be continued: for callers that write no other files.
///
/// # Errors
/// A folder that can't be written.
pub fn leave(found: &Inferred, out: &Path) -> Result<(), Failure> {
    if let More::Sampled(sampled) = &found.more {
        write(out, CHAIN, &saved(&sampled.chain)?)?;
    }
    finished(out);
    Ok(())
}

/// Text whose reading and writing ends when the caller wants to stop: long chains have a hundred
/// megabytes.
struct Wanted<T>(T);

impl<T> Wanted<T> {
    fn check(&self) -> io::Result<()> {
        match stopped() {
            true => Err(io::Error::other(StudyError::Stopped)),
            false => Ok(()),
        }
    }
}

impl Write for Wanted<Vec<u8>> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.check()?;
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<T: Read> Read for Wanted<T> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.check()?;
        self.0.read(into)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/checkpoint.rs"]
mod tests;
