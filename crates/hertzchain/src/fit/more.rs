//! Uncertainty beyond the covariance.

use super::{Arguments, Inferred, partial};
use crate::arguments::infer::Method;
use crate::failure::Failure;
use crate::inference::{user, wanted};
use hertzchain_infer::{
    Chain, Covariance, CurveProblem, Fit, Posterior, Problem, Profile, Profiling, Requirements,
    Sampling, Surrogate, Unconverged, profile,
};
use hertzchain_measure::records::write_whole;
use hertzchain_sim::{StudyError, note_progress, stopped};
use std::fs;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// What a method tells beside the covariance.
pub enum More {
    /// Nothing.
    Nothing,
    /// Profiles of all parameters.
    Profiles(Vec<Profile>),
    /// A sampled posterior.
    Sampled(Box<Sampled>),
}

/// A chain and what it says.
pub struct Sampled {
    /// The chain, to be continued.
    pub chain: Chain,
    /// Its posterior, if it has converged.
    pub posterior: Result<Posterior, Unconverged>,
    /// Whether curves were interpolated.
    pub curves: Curves,
}

/// Where a posterior's curves come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Curves {
    /// From others around the best fit, right to so many standard errors; but for these speeds
    /// in m/s, where the model jumps.
    Interpolated(f64, Vec<f64>),
    /// Every one was computed, for this reason if interpolation was wanted.
    Computed(Option<String>),
}

/// As the method asks, by interpolated curves where that is as good. Beside the problem
/// stands the same one as it [remembers](super::partial).
pub(super) fn more(
    (problem, kept): (&CurveProblem, &dyn Problem),
    found: (&Fit, &Covariance),
    arguments: &Arguments,
) -> Result<More, Failure> {
    if arguments.method != Method::Posterior || arguments.direct {
        return more_of((problem, kept), found, Curves::Computed(None), arguments);
    }
    note_progress(&"posterior: computing the curves that others are interpolated between");
    let why = match Surrogate::new(problem, found.0, found.1) {
        Ok(surrogate) if surrogate.is_right() => {
            let speeds_m_s = surrogate.computed_speeds_m_s();
            let curves = Curves::Interpolated(surrogate.error, speeds_m_s);
            return more_of((&surrogate, kept), found, curves, arguments);
        }
        Ok(surrogate) => format!(
            "interpolated ones would be off by {:.2} standard errors",
            surrogate.error
        ),
        Err(error) => error.to_string(),
    };
    wanted()?;
    let curves = Curves::Computed(Some(why));
    more_of((problem, kept), found, curves, arguments)
}

/// As the method asks, of any problem; `curves` tells where its curves come from.
///
/// # Errors
/// What is in the way.
pub(super) fn more_of(
    (problem, kept): (&dyn Problem, &dyn Problem),
    (fit, covariance): (&Fit, &Covariance),
    curves: Curves,
    arguments: &Arguments,
) -> Result<More, Failure> {
    match arguments.method {
        Method::Covariance => Ok(More::Nothing),
        Method::Profile => {
            let all: Vec<usize> = (0..fit.point.len()).collect();
            let how = Profiling::default();
            let found = profile(kept, fit, covariance, &all, &how);
            wanted()?;
            Ok(More::Profiles(found.map_err(user)?))
        }
        Method::Posterior => {
            let mut chain = started(problem, (fit, covariance), arguments)?;
            let mut saving = Saving::new(arguments);
            let posterior = chain.lead(
                problem,
                &Requirements::default(),
                arguments.steps,
                &mut |chain| saving.seen(chain),
            )?;
            Ok(More::Sampled(Box::new(Sampled {
                chain,
                posterior,
                curves,
            })))
        }
    }
}

/// A new chain, or the one that lies in the output folder if a run left one.
fn started(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    arguments: &Arguments,
) -> Result<Chain, Failure> {
    let path = arguments.out.as_deref().map(|out| out.join(CHAIN));
    let Some(path) = path.filter(|path| arguments.resume && path.exists()) else {
        let walkers = WALKERS.max(4 * fit.point.len());
        let how = Sampling {
            walkers,
            seed: arguments.seed,
            ..Sampling::default()
        };
        return Chain::start(problem, fit, covariance, &how).map_err(user);
    };
    let unread = |error: &dyn std::fmt::Display| {
        Failure::User(format!("--resume: {}: {error}", path.display()))
    };
    let mut bytes = Vec::new();
    let read = fs::File::open(&path).and_then(|file| Wanted(file).read_to_end(&mut bytes));
    wanted()?;
    read.map_err(|error| unread(&error))?;
    let damaged = || unread(&"damaged; remove it, or leave --resume out to begin anew");
    let text = partial::checked(&bytes).ok_or_else(damaged)?;
    let read = serde_json::from_reader(BufReader::with_capacity(PIECE, Wanted(text)));
    wanted()?;
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
struct Saving<'a> {
    folder: Option<&'a Path>,
    saved: Instant,
    most_steps: u64,
}

/// Time between saved states: what a broken run loses.
const SAVE_EVERY: Duration = Duration::from_secs(10);

impl<'a> Saving<'a> {
    fn new(arguments: &'a Arguments) -> Self {
        Self {
            folder: arguments.out.as_deref(),
            saved: Instant::now(),
            most_steps: arguments.steps,
        }
    }

    fn seen(&mut self, chain: &Chain) -> Result<(), Failure> {
        wanted()?;
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
        if self.saved.elapsed() < SAVE_EVERY {
            return Ok(());
        }
        let ours = |error: &dyn std::fmt::Display| Failure::Ours(error.to_string());
        fs::create_dir_all(folder).map_err(|error| ours(&error))?;
        let path = folder.join(CHAIN);
        let saved = saved(chain)?;
        write_whole(&path, |file| file.write_all(&saved)).map_err(|error| ours(&error))?;
        // From the end of writing: a long chain takes its time.
        self.saved = Instant::now();
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
    Ok(partial::sealed(text.0))
}

/// Leaves a fit's walkers in the output folder, to be led on, and nothing of what it took to
/// come there: for those who write no other files.
///
/// # Errors
/// A folder that can't be written.
pub fn leave(found: &Inferred, out: &Path) -> Result<(), Failure> {
    if let More::Sampled(sampled) = &found.more {
        let saved = saved(&sampled.chain)?;
        let path = out.join(CHAIN);
        let written = fs::create_dir_all(out)
            .and_then(|()| write_whole(&path, |file| file.write_all(&saved)));
        written.map_err(|error| Failure::Ours(error.to_string()))?;
    }
    partial::finished(out);
    Ok(())
}

/// Text that nobody writes or reads on once it is no longer wanted: of long chains it has
/// a hundred megabytes.
struct Wanted<T>(T);

impl<T> Wanted<T> {
    fn still(&self) -> io::Result<()> {
        match stopped() {
            true => Err(io::Error::other(StudyError::Stopped)),
            false => Ok(()),
        }
    }
}

impl Write for Wanted<Vec<u8>> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.still()?;
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<T: Read> Read for Wanted<T> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.still()?;
        self.0.read(into)
    }
}
