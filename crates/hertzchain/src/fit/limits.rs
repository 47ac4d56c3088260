//! How far from its bound a parameter may be that the best fit has there, or near it.

use super::More;
use crate::failure::Failure;
use crate::inference::check_cancelled;
use hertzchain_infer::{
    Covariance, End, Fit, Identifiability, Parameter, Problem, Profile, Profiling, profile,
};
use serde_json::{Value, json};

/// A parameter at a bound has no standard error: the data would have it beyond. One whose
/// 95 % interval by covariance reaches beyond a bound has none that means much: an incline near 0
/// changes static overlaps as its 2/3rd power. What the data say of either is a limit on the
/// other side, by profile: where χ² has risen by 1 and by 3.84 above the best fit within
/// bounds. Farther values are excluded at least as often as by 68 and 95 %, since χ² could fall
/// beyond the bound, too.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Which parameter.
    pub parameter: usize,
    /// Whether it is at or near its lower bound, so that the limit is one above.
    pub is_above: bool,
    /// Ends at 68 and 95 %.
    pub ends: [End; 2],
}

/// Standard errors to either side of a value that hold 95 %.
const REACH: f64 = 1.96;

/// Limits of all parameters at bounds; why there are none in place of those, if profiles
/// met something better.
pub(crate) type Limits = Result<Vec<Limit>, String>;

/// From the profiles that there are, or from new ones of these parameters.
pub(super) fn limits(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    identified: &Identifiability,
    more: &More,
) -> Result<Limits, Failure> {
    let parameters = problem.parameters();
    // Where the data leave a parameter open, how far it may be is no question.
    let sd = |k: usize| match identified.leaves_open(k, covariance.sd[k]) {
        true => 0.0,
        false => covariance.sd[k],
    };
    let near: Vec<(usize, bool)> = (0..parameters.len())
        .filter_map(|k| Some((k, is_above(&parameters[k], fit.point[k], sd(k))?)))
        .collect();
    let held: Vec<usize> = near.iter().map(|(k, _)| *k).collect();
    if held.is_empty() || !fit.ending.converged() {
        return Ok(Ok(Vec::new()));
    }
    let own;
    let profiles = match more {
        More::Profiles(profiles) => profiles,
        _ => {
            let found = profile(problem, fit, covariance, &held, &Profiling::default());
            check_cancelled()?;
            match found {
                Err(error) => return Ok(Err(error.to_string())),
                Ok(found) => own = found,
            }
            &own
        }
    };
    let found = profiles.iter().filter_map(|found| {
        let side = near.iter().find(|(k, _)| *k == found.parameter);
        limit(found, side?.1)
    });
    Ok(Ok(found.collect()))
}

/// Whether a parameter is at or near its lower bound, or its upper one.
fn is_above(parameter: &Parameter, value: f64, sd: f64) -> Option<bool> {
    let below = value - parameter.lower <= REACH * sd;
    let above = parameter.upper - value <= REACH * sd;
    (below || above).then_some(below)
}

fn limit(found: &Profile, is_above: bool) -> Option<Limit> {
    let ends = found.intervals.iter().map(|interval| match is_above {
        true => interval.upper,
        false => interval.lower,
    });
    let ends: Vec<End> = ends.collect();
    Some(Limit { parameter: found.parameter, is_above, ends: ends.try_into().ok()? })
}

impl Limit {
    pub(crate) const fn side(&self) -> &'static str {
        match self.is_above {
            true => "at most",
            false => "at least",
        }
    }

    pub(super) fn json(&self) -> Value {
        let [narrow, wide] = self.ends.map(End::closed);
        json!({ "side": self.side(), "percent_68": narrow, "percent_95": wide })
    }
}
