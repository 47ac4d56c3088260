//! Which of the known oils it is, if any.

use super::oils::Oil;
use super::{CONTACT, Gauge, GaugeError};
use crate::curve::{CurveProblem, Joint, Part, Supply};
use crate::free::{FreeNumber, FreeNumbers};
use crate::{Covariance, Fitting, Parameter, Problem, fit, largest_residual};
use hertzchain_measure::signal::{ChiSquare, Estimate, chi_square};

/// How far the wet data are from what an oil would give.
#[derive(Clone, Debug, PartialEq)]
pub struct Match {
    /// The oil.
    pub oil: String,
    /// Chi-square of the wet data against the oil's curve, the dry contacts as
    /// both curves together want them.
    pub chi_square: ChiSquare,
    /// Root mean square distance of measured from predicted, in standard errors.
    pub distance: f64,
    /// The farthest of the wet residuals: what it belongs to, and its size.
    pub farthest: (String, f64),
    /// The wet chain's own numbers at this oil's best.
    pub own: Vec<OwnNumber>,
}

/// A number that a chain has for itself, as an oil wants it.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnNumber {
    /// Which.
    pub parameter: Parameter,
    /// Its value, in its unit.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Match {
    /// Whether chance alone gives such a distance at least once in a hundred times.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.chi_square.probability >= LEAST_PROBABILITY
    }
}

/// Fall of chi-square/2 below which an oil's distance is known well enough: a
/// hundredth of what would change a verdict.
const TOLERANCE: f64 = 0.01;

/// Iterations after which an oil is as near as it gets: two or three numbers that
/// start at their dry values.
const ITERATIONS: usize = 20;

/// Probabilities below are not told: no error is so exactly normal.
pub const NEVER: f64 = 1e-9;

/// Below this probability an oil is rejected.
pub(super) const LEAST_PROBABILITY: f64 = 0.01;

/// What the gauge says.
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
    #[must_use]
    pub fn sentence(&self) -> String {
        let names: Vec<&str> = self.allowed().map(|found| found.oil.as_str()).collect();
        let nearest = self.matches.first();
        match (&names[..], nearest) {
            ([only], _) => format!("It is {only}: no other known oil gives these times."),
            ([], None) => "None of the known oils could be computed.".to_owned(),
            ([], Some(nearest)) => format!(
                "None of these: the nearest, {}, is off by {:.1} standard errors in the mean, which chance \
                 gives in {} of repetitions.",
                nearest.oil,
                nearest.distance,
                match nearest.chi_square.probability {
                    probability if probability < NEVER =>
                        format!("less than {:.0e} %", 100.0 * NEVER),
                    probability => format!("{:.0e} %", 100.0 * probability),
                }
            ),
            (several, _) => format!("The data do not tell {} apart.", several.join(" and ")),
        }
    }
}

impl Gauge {
    /// Holds the wet data against each oil.
    ///
    /// An oil's curve is computed with its K and A at every speed. The dry
    /// contacts' numbers are fitted to both curves at once, so that their
    /// uncertainty counts; so are numbers that each chain has for itself.
    ///
    /// # Errors
    /// Names that the wet model does not know; an oil that fails is told in the
    /// verdict.
    pub fn verdict(&self, oils: &[Oil]) -> Result<Verdict, GaugeError> {
        let wet = self.wet_by_speed()?;
        let mut verdict = Verdict {
            matches: Vec::new(),
            failed: Vec::new(),
        };
        for oil in oils {
            match self.held_against(oil, &wet) {
                Ok(found) => verdict.matches.push(found),
                Err(why) => verdict.failed.push((oil.name.clone(), why)),
            }
        }
        let matches = &mut verdict.matches;
        matches.sort_by(|a, b| a.chi_square.value.total_cmp(&b.chi_square.value));
        Ok(verdict)
    }

    /// The wet curve, K and A of each speed a parameter.
    pub(super) fn wet_by_speed(&self) -> Result<CurveProblem, GaugeError> {
        let experiment = self.wet.experiment();
        let own = self.wet.numbers().as_slice();
        let mut numbers: Vec<FreeNumber> = own[..own.len() - CONTACT].to_vec();
        for name in ["wet.K:each", "wet.A:each"] {
            numbers.push(FreeNumber::find(experiment, name, None)?);
        }
        let model = crate::Model::new(experiment, FreeNumbers::new(numbers)?)?;
        let model = model.with_accuracy(self.wet.accuracy);
        Ok(CurveProblem::part(model, self.data.clone()))
    }

    fn held_against(&self, oil: &Oil, wet: &CurveProblem) -> Result<Match, String> {
        let count = self.dry_fit.point.len();
        let contacts: Vec<(f64, f64)> = (self.data.speeds_m_s().iter())
            .map(|speed| oil.contact(self.radius_m, *speed))
            .collect();
        let stiffness = contacts.iter().map(|contact| Supply::Fixed(contact.0));
        let relaxation = contacts.iter().map(|contact| Supply::Fixed(contact.1));
        let free: Vec<Supply> = (0..count).map(Supply::Free).collect();
        let own = self.wet_own(&self.data.speeds_m_s());
        let of_wet = (0..self.common()).chain(count..count + own.len());
        let wet_part = Part {
            problem: wet.clone(),
            supplies: of_wet
                .map(Supply::Free)
                .chain(stiffness)
                .chain(relaxation)
                .collect(),
        };
        let dry_part = Part {
            problem: self.dry.clone(),
            supplies: free,
        };
        let mut parameters = self.dry.parameters().to_vec();
        for (parameter, value) in parameters.iter_mut().zip(&self.dry_fit.point) {
            parameter.start = *value;
        }
        parameters.extend(own.iter().cloned());
        let joint = Joint::new(parameters, vec![dry_part, wet_part]);
        let how = Fitting {
            tolerance: TOLERANCE,
            iterations: ITERATIONS,
            ..Fitting::default()
        };
        let fitted = fit(&joint, &how).map_err(|error| error.to_string())?;
        let wet_residuals = &fitted.residuals[self.dry.residual_count()..];
        let sd = Covariance::new(joint.parameters(), &fitted).sd;
        let best = fitted.point.iter().zip(&sd).skip(count);
        let own = own.into_iter().zip(best);
        let own = own.map(|(parameter, (value, standard_error))| OwnNumber {
            parameter,
            value: *value,
            standard_error: *standard_error,
        });
        let rows = self.dry.residual_count()..fitted.residuals.len();
        let largest = largest_residual(&joint, &fitted, rows.clone());
        let farthest = match largest {
            Some(found) => (
                wet.residual_label(found.residual - rows.start),
                found.sigmas,
            ),
            None => return Err("no wet number is checked by others".to_owned()),
        };
        matched(&oil.name, wet_residuals, farthest, own.collect())
    }
}

fn matched(
    name: &str,
    residuals: &[f64],
    farthest: (String, f64),
    own: Vec<OwnNumber>,
) -> Result<Match, String> {
    if residuals.len() <= own.len() {
        return Err(format!(
            "{} measured values for {} numbers of the chain's own leave nothing to judge by: expected more speeds",
            residuals.len(),
            own.len()
        ));
    }
    let rows = residuals.iter().map(|value| Estimate {
        value: *value,
        sigma: 1.0,
    });
    let rows: Vec<Estimate> = rows.collect();
    let chi_square =
        chi_square(&rows, &vec![0.0; rows.len()], own.len()).ok_or("its distance is not finite")?;
    Ok(Match {
        oil: name.to_owned(),
        distance: (chi_square.value / chi_square.freedom as f64).sqrt(),
        chi_square,
        farthest,
        own,
    })
}
