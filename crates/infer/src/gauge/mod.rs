//! The oil gauge: K and A of wet contacts at each speed, and which of the known oils gives them.
//!
//! The dry curve determines the dry contacts, those in front of the sensor bead among them; with
//! these known, the wet curve determines the stiffness K and the relaxation time A of the wet ones,
//! speed by speed.

mod branches;
mod oils;
mod rows;
mod verdict;

pub use self::{
    oils::{Oil, known_oils, oils},
    rows::{Branch, Combination, Contact, Pair, WetRow, is_determined},
    verdict::{LEAST_PROBABILITY, Match, NEVER, NuisanceParameter, Verdict},
};

use crate::curve::{CurveProblem, Model};
use crate::data::{Data, Observable};
use crate::free::{Form, FreeNumber, FreeNumbers};
use crate::{Covariance, Fit, Fitting, Goodness, InferError, Parameter, Problem, fit};
use hertzchain_experiment::Experiment;

/// The models of both chains and what is free in the dry contacts of both.
pub struct Chains<'a> {
    /// The dry chain.
    pub dry: &'a Experiment,
    /// The same chain with a wet section.
    pub wet: &'a Experiment,
    /// Free numbers of the dry contacts, by names that both experiments know.
    pub free: &'a [String],
    /// Systematic errors that both curves share, each with its standard deviation in SI.
    pub systematic: &'a [(String, f64)],
    /// Nuisance parameters that each chain has for itself, known to both experiments by the same
    /// names: the load of a tapped row, which friction holds and no model predicts.
    pub own: &'a [String],
    /// Numbers of a film on the wet contacts that are free in place of K and A: the first at each
    /// speed, all of them together over both curves.
    pub film: &'a [String],
    /// Relative accuracy of times of flight.
    pub accuracy: f64,
}

/// Both curves with their models, the dry contacts fitted.
pub struct Gauge {
    /// The dry curve against its model.
    pub dry: CurveProblem,
    /// Fit of the dry curve.
    pub dry_fit: Fit,
    /// Its covariance.
    pub dry_covariance: Covariance,
    /// Model of the wet chain.
    pub wet: Model,
    /// The wet curve.
    pub data: Data,
    /// Reduced radius of the wet contacts in m.
    pub radius_m: f64,
    /// K and A of the dry contacts, or a film's numbers, as the models have them.
    contact: [f64; 2],
    /// How many numbers of a film are free; 0 where K and A are.
    film: usize,
    /// Nuisance parameters of each chain: last of the dry numbers, before K and A of the wet.
    own: usize,
}

/// The load that friction holds in a tapped row.
const PUSH: &str = "near_end.force";

/// Numbers of a wet contact, the last of the wet model's, where no film's are free.
const CONTACT: [&str; 2] = ["wet.K", "wet.A"];

/// Ends of the paths of a film's numbers.
const FILM: [&str; 3] =
    ["film_entrained.viscosity", "film_entrained.pressure_viscosity", "film_entrained.volume"];

impl Gauge {
    /// Fits the dry curve.
    ///
    /// # Errors
    /// A number that can't be free, a wet model without wet contacts, or what is in the way of the
    /// dry fit.
    pub fn new(chains: &Chains<'_>, dry: Data, wet: Data) -> Result<Self, InferError> {
        let model = |experiment: &Experiment, more: &[&str]| -> Result<Model, InferError> {
            let find = |name: &str| FreeNumber::find(experiment, name, None);
            let remedy = |error| {
                InferError::Input(format!("{error}; --dry-free names what is free in the dry row"))
            };
            let free = chains.free.iter().map(|name| find(name).map_err(remedy));
            let known = chains.systematic.iter();
            let known = known.map(|(name, sd)| FreeNumber::systematic(experiment, name, *sd));
            let own = chains.own.iter().map(|name| find(name));
            let all = free.chain(known).chain(own).chain(more.iter().map(|name| find(name)));
            let numbers = FreeNumbers::new(all.collect::<Result<_, _>>()?)?;
            Ok(Model::new(experiment, numbers)?.with_accuracy(chains.accuracy))
        };
        let Some(radius_m) = wet_radius_m(chains.wet) else {
            return InferError::input(format!(
                "{} has no wet contacts: expected a section of [[contacts]] with `wet = true` in the \
                 model of the wet chain",
                chains.wet.name()
            ));
        };
        let film = film_names(chains.wet, chains.film)?;
        let film: Vec<&str> = film.iter().map(String::as_str).collect();
        let dry_model = model(chains.dry, &[])?;
        let parameters = dry_model.numbers.parameters(&dry.speeds_m_s());
        let dry = CurveProblem::new(dry_model, dry, parameters)?;
        let dry_fit =
            fit(&dry, &Fitting::default()).map_err(|error| error.about("the dry curve"))?;
        // Where the dry model has no one K or A, that of the wet contacts.
        let value = |name: &str| -> Result<f64, InferError> {
            let dry = FreeNumber::find(chains.dry, &format!("dry.{name}"), None);
            let wet = |_| FreeNumber::find(chains.wet, &format!("wet.{name}"), None);
            Ok(dry.or_else(wet)?.parameters(&[]).first().map_or(f64::NAN, |p| p.start))
        };
        let wet_model = model(chains.wet, if film.is_empty() { &CONTACT } else { &film })?;
        let start = |at: usize| {
            let number = wet_model.numbers.iter().rev().nth(film.len().checked_sub(at + 1)?)?;
            number.parameters(&[]).first().map(|p| p.start)
        };
        Ok(Self {
            own: chains.own.len(),
            contact: match film.is_empty() {
                true => [value("K")?, value("A")?],
                false => [0, 1].map(|at| start(at).unwrap_or(f64::NAN)),
            },
            film: film.len(),
            dry_covariance: Covariance::new(dry.parameters(), &dry_fit),
            dry_fit,
            dry,
            wet: wet_model,
            data: wet,
            radius_m,
        })
    }

    /// The number of a film that each speed gives, if one is free.
    pub fn film_number(&self) -> Option<Parameter> {
        let at = self.wet.numbers.len() - self.film;
        self.wet.numbers.get(at)?.parameters(&[]).first().cloned()
    }

    /// How well the dry curve follows its model.
    pub fn dry_goodness(&self) -> Goodness {
        Goodness::new(&self.dry, &self.dry_fit)
    }

    /// The wet chain's nuisance parameters over these speeds in m/s, as its model has them.
    pub fn wet_own(&self, speeds_m_s: &[f64]) -> Vec<Parameter> {
        let numbers = &self.wet.numbers;
        let end = numbers.len() - self.contact_numbers();
        let own = numbers[end - self.own..end].iter();
        let own = own.flat_map(|number| number.parameters(speeds_m_s));
        own.map(|p| Parameter { name: format!("{} (wet)", p.name), ..p }).collect()
    }

    /// How many of the wet model's numbers, its last, are of the wet contacts.
    fn contact_numbers(&self) -> usize {
        if self.film > 0 { self.film } else { CONTACT.len() }
    }

    /// How many of the dry fit's parameters hold for both chains: the first.
    fn common(&self) -> usize {
        let numbers = &self.dry.model().numbers;
        let common = numbers.iter().take(numbers.len() - self.own);
        let speeds = self.dry.data().rows.len();
        common.map(|number| number.parameter_count(speeds)).sum()
    }

    /// What to add to data that do not separate K from A.
    pub fn to_add(&self) -> Option<&'static str> {
        let has_both = self.data.rows.iter().any(|row| row.observables().count() > 1);
        (self.film == 0 && !has_both && !self.data.has(Observable::Reflected)).then_some(
            "add reflected times of flight (a column tof_reflected_s with its errors), or ratios of \
             the returning to the passing peak (--use incident,returning-ratio)",
        )
    }

    /// Warnings on the verdict: a dry curve that its model does not describe, or a pushed row of no
    /// known oil whose load is taken from the file, or compared by its reflected times too; a film's fit,
    /// if there is one, that ended where the curve jumps.
    pub fn doubts(&self, verdict: &Verdict, film: Option<(&CurveProblem, &Fit)>) -> Option<String> {
        let chi_square = self.dry_goodness().chi_square;
        let rejected = chi_square.filter(|found| found.probability < LEAST_PROBABILITY);
        let dry = rejected.map(|found| {
            format!(
                "The dry curve does not follow its model (p = {:.1e}): check that --dry names the curve of the dry \
                 chain and that the models are of this rig.",
                found.probability
            )
        });
        let none = self.film == 0 && verdict.allowed().next().is_none();
        let fails = rejected.is_some() || none;
        let can_be_loaded = fails && self.wet.experiment.get(PUSH).is_ok();
        let has_reflected = self.data.has(Observable::Reflected);
        let options = [
            (self.own == 0).then_some("a load for each chain (--own near_end.force)"),
            has_reflected.then_some("incident times alone (--use incident)"),
        ];
        let options: Vec<&str> = options.into_iter().flatten().collect();
        let loads = (can_be_loaded && !options.is_empty()).then(|| {
            format!(
                "Friction holds loads in a tapped row, on which reflected times depend: take {}.",
                options.join(" and ")
            )
        });
        let film = film.and_then(|(problem, fit)| rows::jump(problem.parameters(), fit));
        let film = film.map(|jump| format!("Of the film's numbers over all speeds: {jump}."));
        dry.into_iter().chain(loads).chain(film).reduce(|doubts, more| format!("{doubts} {more}"))
    }
}

/// Names of a film's numbers on the wet contacts; rejects others.
fn film_names(wet: &Experiment, names: &[String]) -> Result<Vec<String>, InferError> {
    if names.is_empty() {
        return Ok(Vec::new());
    }
    if names.len() > CONTACT.len() {
        return InferError::input("two numbers of a film at most can be free");
    }
    let mut laws = wet.sections().iter().filter(|section| section.wet).flat_map(|of| &of.laws);
    if !laws.any(|law| law.name() == "film_entrained") {
        return InferError::input(format!(
            "{} has no film: add film_entrained to its wet contacts, or use --preset pump-film",
            wet.name()
        ));
    }
    names.iter().map(|name| film_name(wet, name)).collect()
}

/// The name, or, where `[liquid]` has a number of that name, the end of the film's path.
fn film_name(wet: &Experiment, name: &str) -> Result<String, InferError> {
    let number = FreeNumber::find(wet, name, None)?;
    let of_film = |path: &str| FILM.iter().any(|end| path.ends_with(end));
    if !of_film(number.path().unwrap_or_default()) {
        let longer = format!("film_entrained.{name}");
        return match of_film(&longer) {
            true => Ok(longer),
            false => InferError::input(format!(
                "{name} is no number of a film: expected viscosity, pressure_viscosity or volume"
            )),
        };
    }
    match number.form {
        Form::Constant => Ok(name.to_owned()),
        _ => InferError::input("a film's numbers do not depend on speed: name them alone"),
    }
}

/// Reduced radius in m of the wet contact whose K is fitted; `None` without any.
fn wet_radius_m(experiment: &Experiment) -> Option<f64> {
    let section = experiment.sections().iter().find(|section| section.wet)?;
    let stiffness = FreeNumber::find(experiment, "wet.K", None).ok();
    let reference = stiffness.as_ref().and_then(|number| number.reference.as_ref()?.contact);
    let (chain, _) = experiment.chain(None).ok()?;
    Some(chain.pair(reference.unwrap_or(section.from))?.radius_m)
}
