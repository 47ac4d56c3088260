//! What a fit has computed so far, in the output folder, for a run that goes on.
//!
//! A descent, a profile, whatever asks for residuals comes to the same bits if they
//! come to it from a file: so no state of any of them is saved, but what the model
//! said. The sampler has its [own file](super::CHAIN), as it asks a million times.

use super::{Arguments, words};
use crate::failure::Failure;
use hertzchain_infer::{ModelError, Parameter, Problem, Residuals};
use hertzchain_measure::records::{remove_left_behind, write_whole};
use hertzchain_sim::{Fingerprint, StudyError, count_done, stopped};
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Where residuals lie in the output folder, part by part.
pub const PARTIAL: &str = "partial";

/// Time between parts: what a broken run loses.
const EVERY: Duration = Duration::from_secs(1);

/// How each part begins, before the problem's fingerprint.
const HEAD: &str = "hertzchain residuals 2 ";

/// What a part's name begins with.
const PART: &str = "part-";

/// What the name of another model's folder begins with, within that of the fit.
const RIVAL: &str = "against-";

/// The same of a fit that was repeated with more accurate curves.
const FINER: &str = "finer-";

/// Digits of a hash.
const HASH: usize = 64;

/// Bytes of a number.
const NUMBER: usize = 8;

/// A problem that remembers what a run before has computed, and leaves what this one
/// computes to the next.
pub(super) struct Remembered<'a> {
    problem: &'a dyn Problem,
    kept: Option<Mutex<Kept>>,
}

/// What was found in a folder, and what is to be put there.
struct Kept {
    folder: PathBuf,
    head: Vec<u8>,
    /// By the bits of the point.
    known: HashMap<Vec<u64>, Residuals>,
    fresh: Vec<u8>,
    parts: usize,
    saved: Instant,
    failed: Option<String>,
}

impl<'a> Remembered<'a> {
    /// Of a problem by its fingerprint: with what lies in the output folder if the run is
    /// to go on, else from nothing.
    ///
    /// # Errors
    /// Residuals of another problem, or a folder that can't be read or written.
    pub(super) fn new(
        problem: &'a dyn Problem,
        fingerprint: impl FnOnce() -> Fingerprint,
        arguments: &Arguments,
    ) -> Result<Self, Failure> {
        let folder = arguments.out.as_ref().map(|out| out.join(PARTIAL));
        Self::within((problem, folder), fingerprint, arguments.resume)
    }

    /// The same of another model, by its number among those that a fit is held against, or of
    /// the fit's own; computed more accurately so many times.
    ///
    /// # Errors
    /// As [`Remembered::new`].
    pub(super) fn of_attempt(
        problem: &'a dyn Problem,
        (rival, finer): (Option<usize>, u32),
        fingerprint: impl FnOnce() -> Fingerprint,
        arguments: &Arguments,
    ) -> Result<Self, Failure> {
        let folder = arguments.out.as_ref().map(|out| {
            let out = out.join(PARTIAL);
            match (rival, finer) {
                (None, 0) => out,
                (None, finer) => out.join(format!("{FINER}{finer}")),
                (Some(number), 0) => out.join(format!("{RIVAL}{number}")),
                (Some(number), finer) => out.join(format!("{RIVAL}{number}-{FINER}{finer}")),
            }
        });
        Self::within((problem, folder), fingerprint, arguments.resume)
    }

    fn within(
        (problem, folder): (&'a dyn Problem, Option<PathBuf>),
        fingerprint: impl FnOnce() -> Fingerprint,
        resume: bool,
    ) -> Result<Self, Failure> {
        let open = |folder| {
            let head = format!("{HEAD}{}\n", fingerprint()).into_bytes();
            Kept::open(folder, head, resume).map(Mutex::new)
        };
        let kept = folder.map(open).transpose()?;
        Ok(Self { problem, kept })
    }

    /// Whether all that was computed could be kept.
    ///
    /// # Errors
    /// What was in the way of writing.
    pub(super) fn sound(&self) -> Result<(), Failure> {
        let Some(kept) = &self.kept else {
            return Ok(());
        };
        let kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        let failed = kept.failed.clone().map(Failure::Ours);
        failed.map_or(Ok(()), Err)
    }
}

impl Kept {
    fn open(folder: PathBuf, head: Vec<u8>, resume: bool) -> Result<Self, Failure> {
        let mut kept = Self {
            folder,
            head,
            known: HashMap::new(),
            fresh: Vec::new(),
            parts: 0,
            saved: Instant::now(),
            failed: None,
        };
        remove_left_behind(&kept.folder, |_| true);
        match resume {
            true => kept.read()?,
            false => forget(&kept.folder),
        }
        // At once: from here on there is something to go on from.
        kept.save();
        Ok(kept)
    }

    fn read(&mut self) -> Result<(), Failure> {
        for path in parts(&self.folder) {
            let refused = |why: &dyn std::fmt::Display| {
                Failure::User(format!("--resume: {}: {why}", path.display()))
            };
            let bytes = fs::read(&path).map_err(|error| refused(&error))?;
            if stopped() {
                return Err(Failure::User(StudyError::Stopped.to_string()));
            }
            let damaged = || refused(&"damaged; remove it, or leave --resume out to begin anew");
            let whole = checked(&bytes).ok_or_else(damaged)?;
            let numbers = whole.strip_prefix(&self.head[..]).ok_or_else(|| {
                refused(&"other data, another model or another build of the program; leave --resume out to begin anew")
            })?;
            self.known.extend(entries(numbers).ok_or_else(damaged)?);
            self.parts += 1;
        }
        Ok(())
    }

    /// Residuals that are known of points, which are then forgotten: a point is
    /// asked for once, and some have a hundred thousand residuals.
    fn recalled(&mut self, points: &[Vec<f64>]) -> Vec<Option<Residuals>> {
        let known = |point: &Vec<f64>| self.known.remove(&bits(point));
        points.iter().map(known).collect()
    }

    /// Takes down what was computed, and writes it if it is time.
    fn keep(&mut self, points: &[Vec<f64>], found: &[Result<Residuals, ModelError>]) {
        // What was broken off on the way is nobody's result.
        let broken = stopped();
        if !broken {
            let pairs = points.iter().zip(found);
            pairs.for_each(|(point, found)| self.take(point, found));
        }
        if broken || self.saved.elapsed() >= EVERY {
            self.save();
        }
    }

    /// Takes down a point's residuals. Failures are not: the next run sees for itself.
    fn take(&mut self, point: &[f64], found: &Result<Residuals, ModelError>) {
        let Ok(found) = found else { return };
        let lists = [point, &found.standardised, &found.ln_sigmas];
        for list in lists {
            self.fresh.extend((list.len() as u64).to_le_bytes());
        }
        let numbers = lists.into_iter().flatten();
        self.fresh.extend(numbers.flat_map(|x| x.to_le_bytes()));
    }

    fn save(&mut self) {
        if self.failed.is_some() || self.parts > 0 && self.fresh.is_empty() {
            return;
        }
        let path = self.folder.join(format!("{PART}{:06}", self.parts));
        let mut bytes = self.head.clone();
        bytes.append(&mut self.fresh);
        let bytes = sealed(bytes);
        let written = fs::create_dir_all(&self.folder)
            .and_then(|()| write_whole(&path, |file| file.write_all(&bytes)));
        match written {
            Ok(()) => self.parts += 1,
            Err(error) => self.failed = Some(error.to_string()),
        }
        self.saved = Instant::now();
    }
}

/// Bytes with their hash after them, in hexadecimal digits.
pub(super) fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(Fingerprint::of_bytes(&bytes).to_string().into_bytes());
    bytes
}

/// The bytes before their hash; `None` if it is not theirs.
pub(super) fn checked(bytes: &[u8]) -> Option<&[u8]> {
    let length = bytes.len().checked_sub(HASH)?;
    let (whole, hash) = bytes.split_at(length);
    (Fingerprint::of_bytes(whole).to_string().as_bytes() == hash).then_some(whole)
}

/// Points and residuals of a part; none if it is damaged.
fn entries(mut bytes: &[u8]) -> Option<Vec<(Vec<u64>, Residuals)>> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let counts = taken(&mut bytes, 3)?;
        let mut list = |at: usize| taken(&mut bytes, usize::try_from(counts[at]).ok()?);
        let (point, standardised, ln_sigmas) = (list(0)?, list(1)?, list(2)?);
        let floats = |list: Vec<u64>| list.into_iter().map(f64::from_bits).collect();
        let residuals = Residuals {
            standardised: floats(standardised),
            ln_sigmas: floats(ln_sigmas),
        };
        found.push((point, residuals));
    }
    Some(found)
}

/// So many numbers from the beginning of bytes, as bits.
fn taken(bytes: &mut &[u8], count: usize) -> Option<Vec<u64>> {
    let (own, rest) = bytes.split_at_checked(count.checked_mul(NUMBER)?)?;
    *bytes = rest;
    let numbers = own.chunks_exact(NUMBER);
    let number = |bytes: &[u8]| bytes.try_into().ok().map(u64::from_le_bytes);
    numbers.map(number).collect()
}

fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| x.to_bits()).collect()
}

/// Parts in a folder, in the order in which they were written.
fn parts(folder: &Path) -> Vec<PathBuf> {
    named(folder, PART)
}

/// What lies in a folder under names that begin so, in their order.
fn named(folder: &Path, begin: &str) -> Vec<PathBuf> {
    let Ok(found) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let is_one = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| name.starts_with(begin))
    };
    let paths = found.filter_map(|entry: io::Result<fs::DirEntry>| Some(entry.ok()?.path()));
    let mut paths: Vec<PathBuf> = paths.filter(is_one).collect();
    paths.sort();
    paths
}

/// Removes parts, other models' among them, and their folder if nothing else is in it.
fn forget(folder: &Path) {
    for other in [RIVAL, FINER].iter().flat_map(|begin| named(folder, begin)) {
        forget(&other);
    }
    for part in parts(folder) {
        // What stays is refused by its fingerprint, or right.
        let _ = fs::remove_file(part);
    }
    let _ = fs::remove_dir(folder);
}

/// Whether a run that was broken off left anything in an output folder.
#[must_use]
pub fn begun(out: &Path) -> bool {
    !parts(&out.join(PARTIAL)).is_empty()
}

/// Removes what a run leaves to the next from an output folder: its result is there.
pub fn finished(out: &Path) {
    forget(&out.join(PARTIAL));
    words::finished(out);
}

impl Problem for Remembered<'_> {
    fn parameters(&self) -> &[Parameter] {
        self.problem.parameters()
    }

    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let Some(kept) = &self.kept else {
            return self.problem.residuals(points);
        };
        let lock = || kept.lock().unwrap_or_else(PoisonError::into_inner);
        let recalled = lock().recalled(points);
        let wanted = points
            .iter()
            .zip(&recalled)
            .filter(|(_, own)| own.is_none());
        let wanted: Vec<Vec<f64>> = wanted.map(|(point, _)| point.clone()).collect();
        count_done(points.len() - wanted.len());
        let computed = self.problem.residuals(&wanted);
        lock().keep(&wanted, &computed);
        let mut computed = computed.into_iter();
        let none = || Err(ModelError("no residuals were computed".into()));
        let all = recalled.into_iter();
        all.map(|own| own.map_or_else(|| computed.next().unwrap_or_else(none), Ok))
            .collect()
    }

    fn residual_label(&self, index: usize) -> String {
        self.problem.residual_label(index)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/partial.rs"]
mod tests;
