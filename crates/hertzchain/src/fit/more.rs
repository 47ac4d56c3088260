//! Uncertainty beyond the covariance.

use super::Arguments;
use super::checkpoint::{Saving, started};
use crate::failure::Failure;
use crate::inference::{check_cancelled, user};
use crate::options::Method;
use hertzchain_infer::{
    Chain, Covariance, CurveProblem, Fit, Posterior, Problem, Profile, Profiling, Requirements,
    Surrogate, Unconverged, profile,
};
use hertzchain_sim::note_progress;

/// What a method determines beside the covariance.
///
/// ```
/// use hertzchain::fit::More;
/// use hertzchain::prelude::*;
///
/// let table = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n\
///              0.2,1e-4,9.030e-4,2e-7\n0.5,1e-4,7.565e-4,2e-7\n1.0,1e-4,6.829e-4,2e-7\n";
/// let mut options = FitOptions::free(["eta"]);
/// let data = inference::parsed("table", table, &options.measured, None)?;
/// options.method = Method::Profile;
/// let More::Profiles(profiles) = fit(&data, &preset("dry")?, &options)?.inferred.more else {
///     unreachable!("profiles were asked for")
/// };
/// assert!(profiles[0].rise.iter().all(|rise| *rise >= 0.0));
/// options.method = Method::Posterior;
/// options.steps = 100; // too few to converge: the chain can be continued
/// let found = fit(&data, &preset("dry")?, &options)?;
/// assert!(matches!(&found.inferred.more, More::Sampled(sampled) if sampled.posterior.is_err()));
/// # Ok::<(), hertzchain::Failure>(())
/// ```
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

/// As the method asks, by interpolated curves where that is as good.
pub(super) fn more(
    problem: &CurveProblem,
    found: (&Fit, &Covariance),
    arguments: &Arguments,
) -> Result<More, Failure> {
    if arguments.method != Method::Posterior || arguments.direct {
        return more_of(problem, problem, found, Curves::Computed(None), arguments);
    }
    note_progress(&"posterior: computing the curves that others are interpolated between");
    let why = match Surrogate::new(problem, found.0, found.1) {
        Ok(surrogate) if surrogate.is_right() => {
            let speeds_m_s = surrogate.computed_speeds_m_s();
            let curves = Curves::Interpolated(surrogate.error, speeds_m_s);
            return more_of(&surrogate, problem, found, curves, arguments);
        }
        Ok(surrogate) => {
            format!("interpolated ones would be off by {:.2} standard errors", surrogate.error)
        }
        Err(error) => error.to_string(),
    };
    check_cancelled()?;
    note_progress(&format_args!("posterior: every curve is computed: {why}"));
    let curves = Curves::Computed(Some(why));
    more_of(problem, problem, found, curves, arguments)
}

/// As the method asks: samples `problem`, profiles `exact`; `curves` says where its curves come from.
pub(super) fn more_of(
    problem: &dyn Problem,
    exact: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    curves: Curves,
    arguments: &Arguments,
) -> Result<More, Failure> {
    match arguments.method {
        Method::Covariance => Ok(More::Nothing),
        Method::Profile => {
            let all: Vec<usize> = (0..fit.point.len()).collect();
            let how = Profiling::default();
            let found = profile(exact, fit, covariance, &all, &how);
            check_cancelled()?;
            Ok(More::Profiles(found.map_err(user)?))
        }
        Method::Posterior => {
            let mut chain = started(problem, (fit, covariance), arguments)?;
            let mut saving = Saving::new(arguments);
            let posterior =
                chain.lead(problem, &Requirements::default(), arguments.steps, &mut |chain| {
                    saving.seen(chain)
                })?;
            Ok(More::Sampled(Box::new(Sampled { chain, posterior, curves })))
        }
    }
}
