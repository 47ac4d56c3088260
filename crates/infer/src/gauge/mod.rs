//! The oil gauge: K and A of wet contacts at each speed, and which of the known oils gives them.
//!
//! The dry curve determines the dry contacts, those in front of the sensor bead among them; with
//! these known, the wet curve determines the stiffness K and the relaxation time A of the wet ones,
//! speed by speed.

mod form;
mod oils;
mod rows;
mod scan;

pub use self::{
    form::{AtSpeed, LAWS, PowerForm},
    oils::{Description, Oil, OilLaw, known_oils, oils},
    rows::{Branch, Combination, Contact, Pair, WetRow, is_determined},
    scan::Scan,
};

use crate::curve::{CurveProblem, MeasuredCurve, Model, Supply};
use crate::data::{Data, Observable};
use crate::free::{FreeNumber, FreeNumbers};
use crate::goodness::chi_square_of;
use crate::{
    Covariance, Fit, Fitting, Goodness, InferError, Parameter, Prior, Problem, fit,
    largest_residual,
};
use hertzchain_experiment::Experiment;
use hertzchain_measure::signal::{ChiSquare, FitError, PowerLaw, power_law};

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
    /// Number of nuisance parameters of each chain: the last of the dry model's numbers, and those
    /// before K and A of the wet model's.
    own: usize,
    data: Data,
    radius_m: f64,
}

/// The load that friction holds in a tapped row.
const PUSH: &str = "near_end.force";

/// Numbers of a wet contact, the last of the wet model's: K and A.
const CONTACT: usize = 2;

impl Gauge {
    /// Fits the dry curve.
    ///
    /// # Errors
    /// A number that can't be free, a wet model without wet contacts, or what is in the way of the
    /// dry fit.
    pub fn new(chains: &Chains<'_>, dry: Data, wet: Data) -> Result<Self, InferError> {
        let model = |experiment: &Experiment, more: &[&str]| -> Result<Model, InferError> {
            let find = |name: &str| FreeNumber::find(experiment, name, None);
            let free = chains.free.iter().map(|name| find(name));
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
        let dry_model = model(chains.dry, &[])?;
        let parameters = dry_model.numbers().parameters(&dry.speeds_m_s());
        let dry = CurveProblem::new(dry_model, dry, parameters)?;
        let dry_fit =
            fit(&dry, &Fitting::default()).map_err(|error| error.about("the dry curve"))?;
        // Where the dry model has no one K or A, that of the wet contacts.
        let value = |name: &str| -> Result<f64, InferError> {
            let dry = FreeNumber::find(chains.dry, &format!("dry.{name}"), None);
            let wet = |_| FreeNumber::find(chains.wet, &format!("wet.{name}"), None);
            Ok(dry.or_else(wet)?.parameters(&[]).first().map_or(f64::NAN, |p| p.start))
        };
        Ok(Self {
            own: chains.own.len(),
            dry_contact: [value("K")?, value("A")?],
            dry_covariance: Covariance::new(dry.parameters(), &dry_fit),
            dry_fit,
            dry,
            wet: model(chains.wet, &["wet.K", "wet.A"])?,
            data: wet,
            radius_m,
        })
    }

    /// The dry curve against its model.
    pub fn dry(&self) -> &CurveProblem {
        &self.dry
    }

    fn dry_curve(&self) -> MeasuredCurve {
        self.dry.curves()[0].clone()
    }

    /// How well the dry curve follows its model.
    pub fn dry_goodness(&self) -> Goodness {
        Goodness::new(&self.dry, &self.dry_fit)
    }

    /// Reduced radius of the wet contacts in m.
    pub fn wet_radius_m(&self) -> f64 {
        self.radius_m
    }

    /// The wet chain's model.
    pub fn wet_model(&self) -> &Model {
        &self.wet
    }

    /// The wet data.
    pub fn wet(&self) -> &Data {
        &self.data
    }

    /// The wet chain's nuisance parameters over these speeds in m/s, as its model has them.
    pub fn wet_own(&self, speeds_m_s: &[f64]) -> Vec<Parameter> {
        let numbers = self.wet.numbers().as_slice();
        let end = numbers.len() - CONTACT;
        let own = numbers[end - self.own..end].iter();
        let own = own.flat_map(|number| number.parameters(speeds_m_s));
        own.map(|p| Parameter { name: format!("{} (wet)", p.name), ..p }).collect()
    }

    /// How many of the dry fit's parameters hold for both chains: the first.
    fn common(&self) -> usize {
        let numbers = self.dry.model().numbers().as_slice();
        let common = numbers.iter().take(numbers.len() - self.own);
        let speeds = self.dry.data().rows.len();
        common.map(|number| number.parameter_count(speeds)).sum()
    }

    /// What to add to data that do not separate K from A.
    pub fn to_add(&self) -> Option<&'static str> {
        let has_both = self.data.rows.iter().any(|row| row.observables().count() > 1);
        (!has_both && !self.data.has(Observable::Reflected)).then_some(
            "add reflected times of flight (a column tof_reflected_s with its errors), or ratios of \
             the returning to the passing peak (--use incident,returning-ratio); or take K and A for power \
             laws of speed, which a whole curve determines where speeds are known well (--form power)",
        )
    }

    /// Warnings on the verdict: a dry curve that its model does not describe, or a pushed row of no
    /// known oil whose load is taken from the file, or compared by its reflected times too.
    pub fn doubts(&self, verdict: &Verdict) -> Option<String> {
        let chi_square = self.dry_goodness().chi_square;
        let rejected = chi_square.filter(|found| found.probability < LEAST_PROBABILITY);
        let is_unknown = verdict.allowed().next().is_none();
        let mut doubts: Vec<String> = Vec::new();
        doubts.extend(rejected.map(|found| {
            format!(
                "The dry curve does not follow its model (p = {:.1e}): check that --dry names the curve of the dry chain \
                 and that the models are of this rig.",
                found.probability
            )
        }));
        let is_pushed = self.wet.experiment().get(PUSH).is_ok();
        let has_reflected = self.data.has(Observable::Reflected);
        let remedy = match (is_pushed, self.own) {
            (false, _) if rejected.is_some() => Some(
                "If this row was, take a model with a push (such as --preset paper --dry-preset paper) \
                 and a load for each chain (--own near_end.force --use incident).",
            ),
            (true, 0) if is_unknown || rejected.is_some() => Some(
                "Fit a load for each chain, to incident times alone (--own near_end.force --use incident).",
            ),
            (true, 1..) if has_reflected && (is_unknown || rejected.is_some()) => Some(
                "One load for each chain describes incident times alone: leave the reflected ones out \
                 (--use incident).",
            ),
            _ => None,
        };
        let loads = "A row that was tapped or shot before holds loads by friction, on which reflected times depend.";
        doubts.extend(remedy.map(|remedy| format!("{loads} {remedy}")));
        (!doubts.is_empty()).then(|| doubts.join(" "))
    }
}

/// Reduced radius in m of the wet contact whose K is fitted; `None` without any.
fn wet_radius_m(experiment: &Experiment) -> Option<f64> {
    let section = experiment.sections().iter().find(|section| section.wet)?;
    let stiffness = FreeNumber::find(experiment, "wet.K", None).ok();
    let reference = stiffness.as_ref().and_then(|number| number.reference()?.contact);
    let (chain, _) = experiment.chain(None).ok()?;
    Some(chain.pair(reference.unwrap_or(section.from))?.radius_m)
}

/// The wet data compared with what an oil would give.
#[derive(Clone, Debug, PartialEq)]
pub struct Match {
    /// The oil.
    pub oil: String,
    /// Chi-square of the wet data against the oil's curve, the dry contacts at their best for both
    /// curves together.
    pub chi_square: ChiSquare,
    /// Root mean square distance of measured from predicted, in standard errors.
    pub distance: f64,
    /// The largest of the wet residuals: what it belongs to, and its size in standard errors.
    pub largest: (String, f64),
    /// The wet chain's nuisance parameters at this oil's best.
    pub own: Vec<NuisanceParameter>,
}

/// A fitted nuisance parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct NuisanceParameter {
    /// Which.
    pub parameter: Parameter,
    /// Its value, in its unit.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// Below this probability an oil is rejected.
const LEAST_PROBABILITY: f64 = 0.01;

/// Probabilities below are not reported to their digits: no error is so exactly normal.
pub const NEVER: f64 = 1e-9;

impl Match {
    /// Whether the data allow the oil (p ≥ 0.01).
    pub fn fits(&self) -> bool {
        self.chi_square.probability >= LEAST_PROBABILITY
    }
}

/// Which of the known oils the data allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// All oils, nearest first.
    pub matches: Vec<Match>,
    /// Oils that could not be computed, and why.
    pub failed: Vec<(String, String)>,
}

impl Verdict {
    /// The verdict on oils, each compared by this function.
    fn new(oils: &[Oil], compare: impl Fn(&Oil) -> Result<Match, InferError>) -> Self {
        let (mut matches, mut failed) = (Vec::new(), Vec::new());
        for oil in oils {
            match compare(oil) {
                Ok(found) => matches.push(found),
                Err(why) => failed.push((oil.name.clone(), why.to_string())),
            }
        }
        matches.sort_by(|a: &Match, b| a.chi_square.value.total_cmp(&b.chi_square.value));
        Self { matches, failed }
    }

    /// Oils that the data allow.
    pub fn allowed(&self) -> impl Iterator<Item = &Match> {
        self.matches.iter().filter(|found| found.fits())
    }

    /// The verdict in a sentence.
    pub fn sentence(&self) -> String {
        let names: Vec<&str> = self.allowed().map(|found| found.oil.as_str()).collect();
        match (&names[..], self.matches.first()) {
            ([only], _) => format!("It is {only}: no other known oil gives these times."),
            ([], None) => "None of the known oils could be computed.".to_owned(),
            ([], Some(nearest)) => format!(
                "None of these: the nearest, {}, is off by {:.1} standard errors in the mean ({}).",
                nearest.oil,
                nearest.distance,
                match nearest.chi_square.probability {
                    p if p < NEVER => format!("p < {NEVER:.0e}"),
                    p => format!("p = {p:.0e}"),
                }
            ),
            (names, _) => format!("The data do not distinguish {}.", names.join(" and ")),
        }
    }
}

impl Gauge {
    /// Compares the wet data with each oil.
    ///
    /// An oil's curve is computed with its K and A at every speed. The dry contacts' numbers are
    /// fitted to both curves at once, so that their uncertainty counts; so are nuisance parameters.
    ///
    /// # Errors
    /// Names that the wet model does not know; an oil that fails is in the verdict.
    pub fn verdict(&self, oils: &[Oil]) -> Result<Verdict, InferError> {
        let wet = self.wet_in_form("each")?;
        Ok(Verdict::new(oils, |oil| self.compare(oil, &wet)))
    }

    /// The wet curve with K and A that depend on speed as `power` or `each` says.
    fn wet_in_form(&self, form: &str) -> Result<MeasuredCurve, InferError> {
        let experiment = self.wet.experiment();
        let own = self.wet.numbers().as_slice();
        let mut numbers: Vec<FreeNumber> = own[..own.len() - CONTACT].to_vec();
        for name in ["wet.K", "wet.A"] {
            let name = format!("{name}:{form}");
            numbers.push(FreeNumber::find(experiment, &name, None)?);
        }
        let model = Model::new(experiment, FreeNumbers::new(numbers)?)?;
        let model = model.with_accuracy(self.wet.accuracy);
        Ok(MeasuredCurve::new(model, self.data.clone()))
    }

    /// K in N/m^{3/2} and A in s that an oil gives at the speeds of the wet data.
    fn contacts_of(&self, oil: &Oil) -> [Vec<f64>; 2] {
        let speeds = self.data.speeds_m_s().into_iter();
        let (stiffness, relaxation) = speeds.map(|speed| oil.contact(self.radius_m, speed)).unzip();
        [stiffness, relaxation]
    }

    fn compare(&self, oil: &Oil, wet: &MeasuredCurve) -> Result<Match, InferError> {
        let count = self.dry_fit.point.len();
        let speeds = self.data.speeds_m_s();
        let [stiffness, relaxation] = self.contacts_of(oil);
        let own = self.wet_own(&speeds);
        let of_wet = (0..self.common()).chain(count..count + own.len()).map(Supply::Free);
        let contacts = stiffness.into_iter().chain(relaxation).map(Supply::Fixed);
        let wet = wet.clone().supplied(of_wet.chain(contacts).collect());
        let pairs = self.dry.parameters().iter().zip(&self.dry_fit.point);
        let dry = pairs.map(|(parameter, value)| Parameter { start: *value, ..parameter.clone() });
        let parameters = dry.chain(own.clone()).collect();
        let joint = CurveProblem::unchecked(parameters, vec![self.dry_curve(), wet]);
        // Two or three numbers that start at their dry values, to a hundredth of what would change a
        // verdict.
        let how = Fitting { tolerance: 0.01, iterations: 20, ..Fitting::default() };
        let fit_result = fit(&joint, &how)?;
        let first = self.dry.residual_count();
        let residuals = &fit_result.residuals[first..];
        let sd = Covariance::new(joint.parameters(), &fit_result).sd;
        let Some(largest) =
            largest_residual(&joint, &fit_result, first..fit_result.residuals.len())
        else {
            return InferError::input("no wet number is checked by others");
        };
        if residuals.len() <= own.len() {
            return InferError::input(format!(
                "{} measured values for {} nuisance parameters leave no degree of freedom: expected more speeds",
                residuals.len(),
                own.len()
            ));
        }
        let chi_square = match joint.parameters().iter().any(|p| p.prior != Prior::Flat) {
            false => chi_square_of(residuals.iter().copied(), own.len()),
            // What the wet curve makes worse: a shared error must not be pulled for nothing.
            true => {
                let rise = whole_chi_square(&joint, &fit_result)
                    - whole_chi_square(&self.dry, &self.dry_fit);
                ChiSquare::of(rise.max(0.0), residuals.len() - own.len())
            }
        };
        let Some(chi_square) = chi_square else {
            return InferError::input("its distance is not finite");
        };
        let label = joint.curves()[1].labels()[largest.residual - first].clone();
        let own = own.into_iter().enumerate().map(|(at, parameter)| NuisanceParameter {
            parameter,
            value: fit_result.point[count + at],
            standard_error: sd[count + at],
        });
        Ok(Match {
            oil: oil.name.clone(),
            distance: (chi_square.value / chi_square.freedom as f64).sqrt(),
            chi_square,
            largest: (label, largest.sigmas),
            own: own.collect(),
        })
    }
}

/// Chi-square of data and priors.
fn whole_chi_square(problem: &CurveProblem, fit: &Fit) -> f64 {
    let priors = problem.parameters().iter().zip(&fit.point);
    let priors = priors.filter_map(|(parameter, value)| parameter.prior.residual(*value));
    fit.chi_square() + priors.map(|r| r * r).sum::<f64>()
}

/// A power law of speed through values that share a part of their errors.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedLaw {
    /// The law, with standard errors from the rows' own.
    pub law: PowerLaw,
    /// Standard error of ln prefactor with what the rows share.
    pub ln_prefactor_sd: f64,
    /// Standard error of the exponent with what the rows share.
    pub exponent_sd: f64,
    /// Chi-square of the rows' own errors over degrees of freedom: well above 1, the values follow
    /// no power law.
    pub reduced_chi_square: f64,
}

/// Power laws of K and of A against speed.
#[derive(Clone, Debug, PartialEq)]
pub struct GaugeLaws {
    /// K in N/m^{3/2}.
    pub stiffness: SharedLaw,
    /// A in s.
    pub relaxation: SharedLaw,
}

impl GaugeLaws {
    /// Through all rows whose K and A are known.
    ///
    /// # Errors
    /// Fewer than three such rows.
    pub fn through(rows: &[WetRow]) -> Result<Self, FitError> {
        let known = rows.iter().filter_map(|row| {
            let contact = row.contact.as_ref().ok().filter(|contact| contact.is_known())?;
            Some((row.speed_m_s, &contact.first))
        });
        let known: Vec<(f64, &Pair)> = known.collect();
        Ok(Self { stiffness: law(&known, 0)?, relaxation: law(&known, 1)? })
    }
}

fn law(known: &[(f64, &Pair)], of: usize) -> Result<SharedLaw, FitError> {
    if known.len() < 3 {
        return Err(FitError::TooFew);
    }
    let speeds: Vec<f64> = known.iter().map(|(speed, _)| *speed).collect();
    let relative: Vec<f64> = known.iter().map(|(_, c)| c.own[of][of].sqrt()).collect();
    let through = |shift: &dyn Fn(&Pair) -> f64| {
        let values = known.iter().map(|(_, pair)| (pair.ln[of] + shift(pair)).exp());
        let values: Vec<f64> = values.collect();
        let sigmas: Vec<f64> = values.iter().zip(&relative).map(|(v, r)| v * r).collect();
        power_law(&speeds, &values, Some(&sigmas))
    };
    let own = through(&|_| 0.0)?;
    let shifts = known.iter().map(|(_, c)| c.shared.len()).min().unwrap_or(0);
    let ln_prefactor = own.prefactor_error / own.prefactor;
    let mut variances = [ln_prefactor.powi(2), own.exponent_error.powi(2)];
    for number in 0..shifts {
        let moved = through(&|pair| pair.shared[number][of])?;
        variances[0] += (moved.prefactor / own.prefactor).ln().powi(2);
        variances[1] += (moved.exponent - own.exponent).powi(2);
    }
    let misses = own.residuals.iter().zip(&relative);
    let chi_square: f64 = misses.map(|(miss, sigma)| (miss / sigma).powi(2)).sum();
    Ok(SharedLaw {
        ln_prefactor_sd: variances[0].sqrt(),
        exponent_sd: variances[1].sqrt(),
        reduced_chi_square: chi_square / (known.len() as f64 - 2.0),
        law: own,
    })
}
