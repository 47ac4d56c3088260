//! The oil gauge: what a liquid makes of the contacts, and which liquid it is.
//!
//! The dry curve tells the dry contacts, those in front of the sensor bead among
//! them; with these known, the wet curve tells the stiffness K and the relaxation
//! time A of the wet ones, speed by speed.

mod contacts;
mod dry;
mod form;
mod laws;
mod neighbours;
mod oils;
mod scan;
mod solutions;
mod told;
mod verdict;

pub use contacts::{Branch, Combination, Contact, Pair, WetRow, is_told};
pub use form::{AtSpeed, LAWS, PowerForm};
pub use laws::{GaugeLaws, SharedLaw};
pub use oils::{Description, Law, Oil, OilError, known_oils, oils};
pub use scan::Scan;
use verdict::LEAST_PROBABILITY;
pub use verdict::{Match, NEVER, OwnNumber, Verdict};

use crate::curve::{CurveError, CurveProblem, Model};
use crate::data::{Data, Observable};
use crate::free::{FreeError, FreeNumber, FreeNumbers};
use crate::{Covariance, Fit, FitError, Fitting, Goodness, ModelError, Parameter, Problem, fit};
use hertzchain_experiment::{Experiment, Mistakes};

/// Why a liquid can't be gauged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GaugeError {
    /// A number that can't be free.
    #[error(transparent)]
    Free(#[from] FreeError),
    /// A model that is none.
    #[error(transparent)]
    Model(#[from] Mistakes),
    /// Data that do not suit the model.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The dry curve can't be fitted.
    #[error("the dry curve: {0}")]
    Dry(FitError),
    /// The wet curve can't be computed at all.
    #[error("the wet curve: {0}")]
    Wet(FitError),
    /// Fewer numbers than both laws have.
    #[error(
        "the wet curve has {values} measured values for {asked} numbers of both power laws (and the chain's own): \
         add speeds or reflected times of flight"
    )]
    FewForLaws {
        /// Measured values.
        values: usize,
        /// Free numbers.
        asked: usize,
    },
    /// The wet model has no wet contacts.
    #[error(
        "{0} has no wet contacts: expected a section of [[contacts]] with `wet = true` in the \
         model of the wet chain"
    )]
    NoWetContacts(String),
    /// The model at the best fit.
    #[error(transparent)]
    At(#[from] ModelError),
}

/// The models of both chains and what is free in the dry contacts of both.
pub struct Chains<'a> {
    /// The dry chain.
    pub dry: &'a Experiment,
    /// The same chain with a wet section.
    pub wet: &'a Experiment,
    /// Free numbers of the dry contacts, by names that both experiments know.
    pub free: &'a [String],
    /// Numbers that each chain has for itself, known to both experiments by the
    /// same names: the load of a tapped row, which friction holds and no model
    /// foretells.
    pub own: &'a [String],
    /// Relative accuracy of times of flight.
    pub accuracy: f64,
}

/// A gauge that knows its dry contacts.
pub struct Gauge {
    dry: CurveProblem,
    /// Fit of the dry curve.
    pub dry_fit: Fit,
    /// Its covariance.
    pub dry_covariance: Covariance,
    wet: Model,
    /// K and A of the dry contacts as the models have them.
    dry_contact: [f64; 2],
    /// How many numbers each chain has for itself: the last of the dry model's,
    /// and of the wet model's those before K and A.
    own: usize,
    data: Data,
    /// Reduced radius of wet contacts in m.
    radius_m: f64,
}

/// The load that friction holds in a tapped row.
const PUSH: &str = "near_end.force";

/// Of a dry curve that its model does not give.
const NOT_THE_DRY_CHAIN: &str = "The dry curve does not follow its model, so the wet one is judged by a \
     chain that is not the measured one. Look whether --dry names the curve of the dry chain, and not a \
     wet one's, and whether the models are of this rig.";

/// Of a row that was tapped.
const HELD_LOADS: &str = "A row that was tapped or shot before holds loads that are not its file's, since \
     friction froze them, and its split returns depend on each of them.";

/// Numbers of a wet contact, the last of the wet model's: K and A.
const CONTACT: usize = 2;

impl Gauge {
    /// Fits the dry curve.
    ///
    /// # Errors
    /// See [`GaugeError`].
    pub fn new(chains: &Chains<'_>, dry: Data, wet: Data) -> Result<Self, GaugeError> {
        let numbers = |experiment: &Experiment, more: &[&str]| {
            let names = chains.free.iter().chain(chains.own).map(String::as_str);
            let found = names
                .chain(more.iter().copied())
                .map(|name| FreeNumber::find(experiment, name, None));
            FreeNumbers::new(found.collect::<Result<_, _>>()?)
        };
        let radius_m = dry::wet_radius_m(chains.wet)
            .ok_or_else(|| GaugeError::NoWetContacts(chains.wet.name().to_owned()))?;
        let model = Model::new(chains.dry, numbers(chains.dry, &[])?)?;
        let dry = dry::problem(model.with_accuracy(chains.accuracy), dry)?;
        let dry_fit = fit(&dry, &Fitting::default()).map_err(GaugeError::Dry)?;
        let parameters = Problem::parameters(&dry);
        let dry_covariance = Covariance::new(parameters, &dry_fit);
        let wet_model = Model::new(chains.wet, numbers(chains.wet, &["wet.K", "wet.A"])?)?;
        Ok(Self {
            own: chains.own.len(),
            dry_contact: dry::contact(chains)?,
            dry_covariance,
            dry_fit,
            dry,
            wet: wet_model.with_accuracy(chains.accuracy),
            data: wet,
            radius_m,
        })
    }

    /// The dry curve against its model.
    #[must_use]
    pub fn dry(&self) -> &CurveProblem {
        &self.dry
    }

    /// How well the dry curve follows its model.
    #[must_use]
    pub fn dry_goodness(&self) -> Goodness {
        Goodness::new(&self.dry, &self.dry_fit)
    }

    /// What speaks against believing the verdict, and what to do: a dry curve that is
    /// not its model's, or a pushed row of nothing known whose load is taken from the
    /// file, or judged by its returns too.
    #[must_use]
    pub fn doubts(&self, verdict: &Verdict) -> Option<String> {
        let dry = self.dry_goodness().chi_square;
        let dry_misses = dry.is_some_and(|found| found.probability < LEAST_PROBABILITY);
        let unknown = verdict.allowed().next().is_none();
        let of_dry = dry_misses.then(|| NOT_THE_DRY_CHAIN.to_owned());
        let of_loads = self.loads_doubted(dry_misses, unknown);
        let doubts: Vec<String> = of_dry.into_iter().chain(of_loads).collect();
        (!doubts.is_empty()).then(|| doubts.join(" "))
    }

    /// That loads may be others than the models', and what to do of what is not done yet.
    fn loads_doubted(&self, dry_misses: bool, unknown: bool) -> Option<String> {
        let pushed = self.wet.experiment().get(PUSH).is_ok();
        let returns = self.data.has(Observable::Reflected);
        let all = format!("--own {PUSH} --use incident");
        let remedy = match (pushed, self.own) {
            (false, _) if dry_misses => format!(
                "If this one was, take a model with a push (such as --preset paper --dry-preset paper) \
                 and let each chain have its own load ({all})."
            ),
            (true, 0) if unknown || dry_misses => format!(
                "Let each chain have its own load, with incident times alone ({all}), or lay it with \
                 less friction."
            ),
            (true, _) if returns && (unknown || dry_misses) => {
                "One load for each chain, as here, does for incident times alone: leave the reflected \
                 ones out (--use incident), or lay it with less friction."
                    .to_owned()
            }
            _ => return None,
        };
        Some(format!("{HELD_LOADS} {remedy}"))
    }

    /// How many of the dry fit's parameters hold for both chains: the first.
    fn common(&self) -> usize {
        let numbers = self.dry.model().numbers().as_slice();
        let common = numbers.iter().take(numbers.len() - self.own);
        let speeds = self.dry.data().rows.len();
        common.map(|number| number.parameter_count(speeds)).sum()
    }

    /// The wet chain's own numbers over these speeds in m/s, as its model has them.
    #[must_use]
    pub fn wet_own(&self, speeds_m_s: &[f64]) -> Vec<Parameter> {
        let numbers = self.wet.numbers().as_slice();
        let end = numbers.len() - CONTACT;
        let own = numbers[end - self.own..end].iter();
        let own = own.flat_map(|number| number.parameters(speeds_m_s));
        own.map(|parameter| Parameter {
            name: format!("{} (wet)", parameter.name),
            ..parameter
        })
        .collect()
    }

    /// Reduced radius of the wet contacts in m.
    #[must_use]
    pub fn wet_radius_m(&self) -> f64 {
        self.radius_m
    }

    /// The wet chain's model.
    #[must_use]
    pub fn wet_model(&self) -> &Model {
        &self.wet
    }

    /// The wet data.
    #[must_use]
    pub fn wet(&self) -> &Data {
        &self.data
    }
}
