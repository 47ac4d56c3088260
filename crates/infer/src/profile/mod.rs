//! Uncertainty by re-optimising everything else.

mod walk;

use crate::covariance::Covariance;
use crate::least_squares::{Descent, Merit, drive};
use crate::{Fit, Fitting, Problem};
use walk::Walk;

/// How to profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Profiling {
    /// Rises of χ² whose intervals are wanted, ascending: 1 and 3.841459 for
    /// 68.3 and 95 %.
    pub levels: Vec<f64>,
    /// Most values of a parameter on either side of the optimum.
    pub most_values: usize,
}

/// Rise of χ² that bounds a 95 % interval of one parameter.
pub const RISE_OF_95_PERCENT: f64 = 3.841_458_820_694_124;

impl Default for Profiling {
    fn default() -> Self {
        Self {
            levels: vec![1.0, RISE_OF_95_PERCENT],
            most_values: 60,
        }
    }
}

/// The least χ² as a function of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Which parameter.
    pub parameter: usize,
    /// Its values, ascending, the optimum among them.
    pub values: Vec<f64>,
    /// χ² above the optimum at each value, all other parameters re-optimised;
    /// priors and ln σ are counted in, a robust loss replaces the squares.
    pub rise: Vec<f64>,
    /// All parameters at each value.
    pub points: Vec<Vec<f64>>,
    /// One interval a level.
    pub intervals: Vec<Interval>,
}

/// An interval of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Rise of χ² at its ends.
    pub level: f64,
    /// Lower end.
    pub lower: End,
    /// Upper end.
    pub upper: End,
}

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// χ² has risen to the level here.
    At(f64),
    /// χ² does not rise to the level up to this bound of the parameter.
    Bound(f64),
    /// χ² did not rise to the level as far as it was followed: the data set no limit.
    Open(f64),
    /// Beyond this value the others cannot be re-optimised, though χ² has not
    /// risen to the level: the model fails there, or is computed too coarsely.
    ModelFails(f64),
}

impl End {
    /// The value if the data determine it.
    #[must_use]
    pub fn closed(self) -> Option<f64> {
        match self {
            Self::At(value) => Some(value),
            _ => None,
        }
    }
}

/// Why there is no profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// A better fit was met on the way.
    #[error(
        "a better fit was found on the way, chi-square lower by {by:.3}, at {point:?}: fit again from there"
    )]
    BetterFit {
        /// Where.
        point: Vec<f64>,
        /// How much lower χ² is.
        by: f64,
    },
    /// The fit has not converged, so its surroundings mean nothing.
    #[error("the fit has not converged: a profile needs a minimum to start from")]
    NotConverged,
    /// Levels that are not positive and ascending.
    #[error("levels {levels:?} must be positive and ascending")]
    Levels {
        /// As given.
        levels: Vec<f64>,
    },
}

/// Fall of χ² below the optimum's that is more than noise of the model.
const BETTER: f64 = 0.01;

/// Profiles of those of some parameters that there are, all walks and descents
/// side by side.
///
/// From the optimum outward, each value is held and the others re-optimised from
/// where the last two values' optima point; the ends are found on √(χ² rise),
/// which is straight where the problem is linear, to 10⁻³ standard errors.
///
/// # Errors
/// An unconverged fit, a better fit met on the way, unusable levels.
pub fn profile(
    problem: &dyn Problem,
    fit: &Fit,
    covariance: &Covariance,
    which: &[usize],
    how: &Profiling,
) -> Result<Vec<Profile>, ProfileError> {
    let sound = how
        .levels
        .iter()
        .all(|level| *level > 0.0 && level.is_finite());
    if !sound || how.levels.is_empty() || !how.levels.is_sorted() {
        let levels = how.levels.clone();
        return Err(ProfileError::Levels { levels });
    }
    if !fit.ending.converged() {
        return Err(ProfileError::NotConverged);
    }
    let known = which.iter().filter(|k| **k < fit.point.len());
    let mut walks: Vec<Walk> = known
        .flat_map(|k| [-1.0, 1.0].map(|side| Walk::new(problem, (fit, covariance), *k, side, how)))
        .collect();
    while walk_on(problem, fit, &mut walks)? {}
    Ok(walks.chunks(2).map(|pair| joined(pair, how)).collect())
}

/// One round: a value for each walk that is not at its end; whether there was any.
fn walk_on(problem: &dyn Problem, fit: &Fit, walks: &mut [Walk]) -> Result<bool, ProfileError> {
    let merit = Merit::new(problem, fit.loss);
    let mut going: Vec<(&mut Walk, Vec<f64>)> = (walks.iter_mut())
        .filter_map(|walk| walk.next().map(|point| (walk, point)))
        .collect();
    let limits = Fitting::default().limits();
    let descents = (going.iter())
        .map(|(walk, point)| {
            let others = (0..point.len()).filter(|k| *k != walk.parameter).collect();
            Descent::new(merit.clone(), point.clone(), others, limits)
                .with_steps(&fit.jacobian.steps)
        })
        .collect();
    let reached = drive(problem, descents).reached;
    for ((walk, _), reached) in going.iter_mut().zip(reached) {
        let rise = 2.0 * (reached.cost() - fit.cost);
        if rise < -BETTER {
            let point = reached.point;
            return Err(ProfileError::BetterFit { point, by: -rise });
        }
        let found = reached.ending.converged().then_some((reached.point, rise));
        walk.take(found);
    }
    Ok(!going.is_empty())
}

fn joined(pair: &[Walk], how: &Profiling) -> Profile {
    let (down, up) = (&pair[0], &pair[pair.len() - 1]);
    let below = down.met.iter().skip(1).rev();
    let all: Vec<_> = below.chain(&up.met).collect();
    let levels = how.levels.iter().enumerate();
    Profile {
        parameter: up.parameter,
        values: all.iter().map(|met| met.point[up.parameter]).collect(),
        rise: all.iter().map(|met| met.rise).collect(),
        points: all.iter().map(|met| met.point.clone()).collect(),
        intervals: levels
            .map(|(i, level)| Interval {
                level: *level,
                lower: down.end(i),
                upper: up.end(i),
            })
            .collect(),
    }
}
