//! Uncertainty beyond the covariance, and other models of the same data.

use super::Arguments;
use crate::arguments::infer::{Against, Method};
use crate::failure::Failure;
use crate::inference::{self, user, wanted};
use hertzchain_infer::{
    Chain, Compared, Comparison, Covariance, CrossValidation, CurveProblem, Fit, Fitting, Folding,
    Posterior, Problem, Profile, Profiling, Requirements, Sampling, Surrogate, Unconverged,
    compare, cross_validate, fit, profile,
};
use hertzchain_study::reproduce::write_atomically;
use hertzchain_study::{StudyError, stopped};
use std::fs;
use std::io::{self, Write};
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
    /// From others around the best fit, right to so many standard errors.
    Interpolated(f64),
    /// Every one was computed, for this reason if interpolation was wanted.
    Computed(Option<String>),
}

/// As the method asks, by interpolated curves where that is as good.
pub fn more(
    problem: &CurveProblem,
    fit: &Fit,
    covariance: &Covariance,
    arguments: &Arguments,
) -> Result<More, Failure> {
    let found = (fit, covariance);
    if arguments.method != Method::Posterior || arguments.direct {
        return more_of(problem, found, Curves::Computed(None), arguments);
    }
    let why = match Surrogate::new(problem, fit, covariance) {
        Ok(surrogate) if surrogate.error <= SURROGATE_ERROR => {
            let curves = Curves::Interpolated(surrogate.error);
            return more_of(&surrogate, found, curves, arguments);
        }
        Ok(surrogate) => format!(
            "interpolated ones would be off by {:.2} standard errors",
            surrogate.error
        ),
        Err(error) => error.to_string(),
    };
    more_of(problem, found, Curves::Computed(Some(why)), arguments)
}

/// As the method asks, of any problem; `curves` tells where its curves come from.
///
/// # Errors
/// What is in the way.
pub fn more_of(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    curves: Curves,
    arguments: &Arguments,
) -> Result<More, Failure> {
    match arguments.method {
        Method::Covariance => Ok(More::Nothing),
        Method::Profile => {
            let all: Vec<usize> = (0..fit.point.len()).collect();
            let how = Profiling::default();
            let found = profile(problem, fit, covariance, &all, &how);
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

/// Interpolated curves may be off by so many standard errors.
const SURROGATE_ERROR: f64 = 0.1;

/// A new chain, or the one that lies in the output folder.
fn started(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    arguments: &Arguments,
) -> Result<Chain, Failure> {
    let Some(folder) = arguments.out.as_deref().filter(|_| arguments.resume) else {
        let walkers = WALKERS.max(4 * fit.point.len());
        let how = Sampling {
            walkers,
            seed: arguments.seed,
            ..Sampling::default()
        };
        return Chain::start(problem, fit, covariance, &how).map_err(user);
    };
    let path = folder.join(CHAIN);
    let unread = |error: &dyn std::fmt::Display| {
        Failure::User(format!("--resume: {}: {error}", path.display()))
    };
    let text = fs::read(&path).map_err(|error| unread(&error))?;
    let chain: Chain = serde_json::from_slice(&text).map_err(|error| unread(&error))?;
    chain.belongs_to(problem).map_err(|error| unread(&error))?;
    Ok(chain)
}

/// Walkers of each ensemble, unless parameters are many.
const WALKERS: usize = 32;

/// The chain's file in the output folder.
pub const CHAIN: &str = "chain.json";

/// Looks at whether to break off, and saves walkers on their way, so that a run
/// that is broken off or killed goes on with `--resume`.
struct Saving<'a> {
    folder: Option<&'a Path>,
    saved: Instant,
}

/// Time between saved states: what a broken run loses.
const SAVE_EVERY: Duration = Duration::from_secs(10);

impl<'a> Saving<'a> {
    fn new(arguments: &'a Arguments) -> Self {
        Self {
            folder: arguments.out.as_deref(),
            saved: Instant::now(),
        }
    }

    fn seen(&mut self, chain: &Chain) -> Result<(), Failure> {
        wanted()?;
        let Some(folder) = self.folder else {
            return Ok(());
        };
        if self.saved.elapsed() < SAVE_EVERY {
            return Ok(());
        }
        let ours = |error: &dyn std::fmt::Display| Failure::Ours(error.to_string());
        fs::create_dir_all(folder).map_err(|error| ours(&error))?;
        let path = folder.join(CHAIN);
        write_atomically(&path, &saved(chain)?).map_err(|error| ours(&error))?;
        // From the end of writing: a long chain takes its time.
        self.saved = Instant::now();
        Ok(())
    }
}

/// A chain as it lies in the output folder.
///
/// # Errors
/// Numbers that are none, of which JSON knows nothing; a wish to stop.
pub fn saved(chain: &Chain) -> Result<Vec<u8>, Failure> {
    let mut text = Wanted::default();
    let written = serde_json::to_writer(&mut text, chain);
    written.map_err(|error| Failure::Ours(error.to_string()))?;
    Ok(text.0)
}

/// Text that nobody writes on once it is no longer wanted: of long chains it has
/// a hundred megabytes.
#[derive(Default)]
struct Wanted(Vec<u8>);

impl Write for Wanted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if stopped() {
            return Err(io::Error::other(StudyError::Stopped));
        }
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A model that was fitted to the same data.
pub struct Rival {
    /// Its name, with what is free.
    pub name: String,
    /// Its fit.
    pub fit: Fit,
    /// How well it foretells what it has not seen.
    pub foretells: CrossValidation,
}

/// A model that found no minimum.
pub struct Lost {
    /// Its name, with what is free.
    pub name: String,
    /// How far from the data it ended.
    pub chi_square: f64,
    /// Why it ended there.
    pub why: String,
}

/// All models, the fit's own first, and what the data say of them.
pub struct Rivals {
    /// Models.
    pub all: Vec<Rival>,
    /// Models that found no minimum, and so are out of the comparison.
    pub lost: Vec<Lost>,
    /// Their comparison, if at least two are left.
    pub comparison: Option<Comparison>,
}

/// Fits the other models to the same data, if any are asked for.
pub fn rivals(
    problem: &CurveProblem,
    own: &Fit,
    arguments: &Arguments,
) -> Result<Option<Rivals>, Failure> {
    if arguments.against.is_empty() {
        return Ok(None);
    }
    let name = format!(
        "{} ({})",
        problem.model().experiment().name(),
        arguments.freed.free.join(", ")
    );
    let mut all = vec![rival(name, problem, own.clone(), arguments.seed)?];
    let mut lost = Vec::new();
    for against in &arguments.against {
        match other(against, problem, arguments)? {
            Ok(rival) => all.push(rival),
            Err(without) => lost.push(without),
        }
    }
    let compared: Vec<Compared<'_>> = all
        .iter()
        .map(|rival| Compared {
            name: &rival.name,
            fit: &rival.fit,
            cross_validation: Some(&rival.foretells),
        })
        .collect();
    let comparison = match compared.len() {
        1 => None,
        _ => Some(compare(&compared).map_err(user)?),
    };
    Ok(Some(Rivals {
        all,
        lost,
        comparison,
    }))
}

fn other(
    against: &Against,
    problem: &CurveProblem,
    arguments: &Arguments,
) -> Result<Result<Rival, Lost>, Failure> {
    let (mut modelled, freed) = against.options(&arguments.modelled);
    // A model far from the data is steep there: its noise would hide the minimum.
    modelled.accuracy = modelled.accuracy.min(RIVALS_ACCURACY);
    let data = problem.data().clone();
    let experiment = inference::experiment(&modelled, Some(&data.case))?;
    let model = inference::model(&experiment, &modelled, &freed)?;
    let problem = inference::problem(model, data, &freed)?;
    let name = format!("{} ({})", against.model, freed.free.join(", "));
    let how = Fitting {
        starts: arguments.starts,
        seed: arguments.seed,
        ..Fitting::default()
    };
    let fit =
        fit(&problem, &how).map_err(|error| Failure::User(format!("--against {name}: {error}")))?;
    if !fit.ending.converged() {
        return Ok(Err(Lost {
            chi_square: fit.chi_square(),
            why: fit.ending.to_string(),
            name,
        }));
    }
    Ok(Ok(rival(name, &problem, fit, arguments.seed)?))
}

/// Relative accuracy of other models' times of flight.
const RIVALS_ACCURACY: f64 = 1e-6;

fn rival(name: String, problem: &CurveProblem, fit: Fit, seed: u64) -> Result<Rival, Failure> {
    // What was measured at one speed is left out together.
    let groups = problem.measured().into_iter().map(|(row, _)| row).collect();
    let how = Folding {
        groups,
        parts: Some(PARTS.min(problem.data().rows.len())),
        seed,
    };
    let foretells = cross_validate(problem, &fit, &how)
        .map_err(|error| Failure::User(format!("{name}: {error}")))?;
    Ok(Rival {
        name,
        fit,
        foretells,
    })
}

/// Parts into which rows are dealt for cross-validation.
const PARTS: usize = 5;
