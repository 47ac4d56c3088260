//! Which of the known oils the wet curve allows.

use super::{CONTACT, Gauge, Oil};
use crate::curve::{CurveProblem, MeasuredCurve, Model, Supply};
use crate::free::{FreeNumber, FreeNumbers};
use crate::goodness::chi_square_of;
use crate::{
    Covariance, Fit, Fitting, InferError, Parameter, Prior, Problem, fit, largest_residual,
};
use hertzchain_measure::signal::ChiSquare;

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

/// Below this probability an oil or a film is rejected.
pub const LEAST_PROBABILITY: f64 = 0.01;

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
    /// Oils that the data allow.
    pub fn allowed(&self) -> impl Iterator<Item = &Match> {
        self.matches.iter().filter(|found| found.fits())
    }

    /// The verdict in a sentence.
    pub fn sentence(&self) -> String {
        let names: Vec<&str> = self.allowed().map(|found| found.oil.as_str()).collect();
        match (&names[..], self.matches.first()) {
            ([only], _) => format!("Of the known oils only {only} gives these times."),
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
        let experiment = &self.wet.experiment;
        let own = &self.wet.numbers;
        let mut numbers: Vec<FreeNumber> = own[..own.len() - self.contact_numbers()].to_vec();
        for name in CONTACT {
            numbers.push(FreeNumber::find(experiment, &format!("{name}:each"), None)?);
        }
        let model = Model::new(experiment, FreeNumbers::new(numbers)?)?;
        let wet = MeasuredCurve::new(model.with_accuracy(self.wet.accuracy), self.data.clone());
        let (mut matches, mut failed): (Vec<Match>, _) = (Vec::new(), Vec::new());
        for oil in oils {
            match self.compare(oil, &wet) {
                Ok(found) => matches.push(found),
                Err(why) => failed.push((oil.name.clone(), why.to_string())),
            }
        }
        matches.sort_by(|a, b| a.chi_square.value.total_cmp(&b.chi_square.value));
        Ok(Verdict { matches, failed })
    }

    /// The film's numbers over both curves together, with the dry contacts' and the nuisance
    /// parameters, and chi-square of the wet data: by how much the wet curve raises that of the dry
    /// one. `None` where no degree of freedom is left.
    ///
    /// # Errors
    /// What is in the way of the fit.
    pub fn film(&self) -> Result<(CurveProblem, Fit, Option<ChiSquare>), InferError> {
        let speeds = self.data.speeds_m_s();
        let numbers = &self.wet.numbers;
        let film = numbers[numbers.len() - self.film..].iter();
        let more =
            self.wet_own(&speeds).into_iter().chain(film.flat_map(|n| n.parameters(&speeds)));
        let problem =
            self.joint(MeasuredCurve::new(self.wet.clone(), self.data.clone()), more, &[]);
        let fit = fit(&problem, &Fitting::default())?;
        // The dry numbers cost no degree of freedom of the wet data: the dry curve has paid for them.
        let determined = fit.rank.saturating_sub(self.dry_fit.rank);
        let freedom = (fit.residuals.len() - self.dry_fit.residuals.len()).checked_sub(determined);
        let rise = self.rise(&fit);
        let chi_square = freedom.and_then(|freedom| ChiSquare::of(rise, freedom, 1.0));
        Ok((problem, fit, chi_square))
    }

    /// Both curves: the wet one with the numbers that both share, then its own, `more`, then fixed ones.
    fn joint(
        &self,
        wet: MeasuredCurve,
        more: impl Iterator<Item = Parameter>,
        fixed: &[f64],
    ) -> CurveProblem {
        let pairs = self.dry.parameters().iter().zip(&self.dry_fit.point);
        let dry = pairs.map(|(parameter, value)| Parameter { start: *value, ..parameter.clone() });
        let parameters: Vec<Parameter> = dry.chain(more).collect();
        let of_wet = (0..self.common()).chain(self.dry_fit.point.len()..parameters.len());
        let supplies = of_wet.map(Supply::Free).chain(fixed.iter().copied().map(Supply::Fixed));
        let wet = wet.supplied(supplies.collect());
        CurveProblem::unchecked(parameters, vec![self.dry.curves[0].clone(), wet])
    }

    /// By how much chi-square of both curves together exceeds that of the dry one alone.
    fn rise(&self, fit: &Fit) -> f64 {
        (whole_chi_square(fit) - whole_chi_square(&self.dry_fit)).max(0.0)
    }

    fn compare(&self, oil: &Oil, wet: &MeasuredCurve) -> Result<Match, InferError> {
        let count = self.dry_fit.point.len();
        let speeds = self.data.speeds_m_s();
        let (stiffness, relaxation): (Vec<f64>, Vec<f64>) =
            speeds.iter().map(|speed| oil.contact(self.radius_m, *speed)).unzip();
        let own = self.wet_own(&speeds);
        let contacts: Vec<f64> = stiffness.into_iter().chain(relaxation).collect();
        let joint = self.joint(wet.clone(), own.iter().cloned(), &contacts);
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
            false => {
                let freedoms = fit_result.freedoms[first..].iter().copied();
                chi_square_of(residuals.iter().copied().zip(freedoms), own.len())
            }
            // What the wet curve makes worse: a shared error must not be pulled for nothing.
            true => {
                let freedom = residuals.len() - own.len();
                ChiSquare::of(self.rise(&fit_result), freedom, 1.0)
            }
        };
        let Some(chi_square) = chi_square else {
            return InferError::input("its distance is not finite");
        };
        let label = joint.curves[1].labels()[largest.residual - first].clone();
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

fn whole_chi_square(fit: &Fit) -> f64 {
    fit.chi_square() + fit.priors.iter().map(|r| r * r).sum::<f64>()
}
