//! K and A of the wet contacts as power laws of speed, fitted to whole curves.
//!
//! K(v) = K₀ (v/(1 m/s))^k and A(v) = A₀ (v/(1 m/s))^a: four numbers for a whole curve. Incident
//! times alone can determine them, although each speed determines only one combination of K and A.

use super::rows::{SAME, TIMES_DRY, shifts};
use super::{Gauge, LEAST_PROBABILITY, Match, NuisanceParameter, Oil, Verdict};
use crate::curve::{CurveProblem, MeasuredCurve, Supply};
use crate::data::Data;
use crate::{Covariance, Fit, Fitting, Goodness, Identifiability, InferError};
use crate::{Parameter, Problem, fit};
use hertzchain_measure::signal::{ChiSquare, power_law};

/// Numbers of both laws: ln K₀ (K₀ in N/m^{3/2}), k, ln A₀ (A₀ in s), a.
pub const LAWS: usize = 4;
/// Names of these numbers.
const NAMES: [&str; LAWS] = ["K at 1 m/s", "exponent of K", "A at 1 m/s", "exponent of A"];
/// Largest standard error of ln K and ln A at which the laws' errors are still an ellipse: times of
/// flight depend on A with more than its first power.
const MOST_LN_SD: f64 = 0.1;
/// Difference of χ²/2 within which two minima fit equally well.
const AS_GOOD: f64 = 1.0;

/// Power laws of K and A, fitted to the dry and the wet curve together.
#[derive(Clone, Debug)]
pub struct PowerForm {
    /// ln K₀, k, ln A₀, a.
    pub values: [f64; LAWS],
    /// Their covariance, with the errors of the dry contacts' numbers and nuisance parameters.
    pub covariance: [[f64; LAWS]; LAWS],
    /// Chi-square of both curves.
    pub chi_square: Option<ChiSquare>,
    /// Largest standard error of ln K and ln A at the speeds of the data.
    pub largest_ln_sd: f64,
    /// Other laws that fit equally well.
    pub others: Vec<[f64; LAWS]>,
    /// Combinations that the data do not determine, in words.
    pub undetermined: Vec<String>,
    /// The wet chain's nuisance parameters.
    pub own: Vec<NuisanceParameter>,
    /// Fitted values: the dry curve's parameters, then the wet chain's nuisance parameters.
    beside_laws: Vec<f64>,
}

/// Both laws at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtSpeed {
    /// Speed in m/s.
    pub speed_m_s: f64,
    /// ln K, K in N/m^{3/2}, and ln A, A in s.
    pub ln: [f64; 2],
    /// Standard errors of both.
    pub ln_sd: [f64; 2],
}

impl AtSpeed {
    /// K in N/m^{3/2} and A in s, each with its standard error.
    pub fn estimates(&self) -> [(f64, f64); 2] {
        [0, 1].map(|i| (self.ln[i].exp(), self.ln[i].exp() * self.ln_sd[i]))
    }
}

impl PowerForm {
    /// K and A at a speed in m/s: ln K = ln K₀ + k ln v with the variance
    /// var(ln K₀) + 2 cov(ln K₀, k) ln v + var(k) ln² v; A likewise.
    pub fn at(&self, speed_m_s: f64) -> AtSpeed {
        let (log, c) = (speed_m_s.ln(), &self.covariance);
        let variance = |i: usize| c[i][i] + 2.0 * c[i][i + 1] * log + c[i + 1][i + 1] * log * log;
        AtSpeed {
            speed_m_s,
            ln: [0, 2].map(|i| self.values[i] + self.values[i + 1] * log),
            ln_sd: [0, 2].map(|i| variance(i).sqrt()),
        }
    }

    /// Standard errors of ln K₀, k, ln A₀, a.
    pub fn sd(&self) -> [f64; LAWS] {
        [0, 1, 2, 3].map(|i| self.covariance[i][i].sqrt())
    }

    /// Whether four numbers and their covariance stand for both curves: these follow the laws and
    /// determine them.
    pub fn is_sufficient(&self) -> bool {
        self.fits() && self.is_determined()
    }

    fn is_determined(&self) -> bool {
        let is_unique = self.undetermined.is_empty() && self.others.is_empty();
        is_unique && self.largest_ln_sd <= MOST_LN_SD
    }

    fn fits(&self) -> bool {
        self.chi_square.is_none_or(|found| found.probability >= LEAST_PROBABILITY)
    }

    /// Warnings on the laws: curves that do not follow them, or do not determine them.
    pub fn doubts(&self) -> Option<String> {
        let mut doubts = Vec::new();
        if !self.fits() {
            doubts.push(
                "The curves do not follow power laws of K and A: these are averages over the measured \
                 speeds and do not extrapolate.",
            );
        }
        if !self.is_determined() {
            doubts.push(
                "The data do not determine both power laws (K and A change together), so that their \
                 standard errors are not valid: add reflected times of flight, ratios of peaks, or \
                 speeds with smaller errors.",
            );
        }
        if !self.is_sufficient() {
            doubts.push("Oils are compared with the whole curve, not with these laws.");
        }
        (!doubts.is_empty()).then(|| doubts.join(" "))
    }
}

impl Gauge {
    /// Fits power laws of K and A to the whole wet curve, together with the dry curve and its
    /// parameters, from several starts of A.
    ///
    /// # Errors
    /// Fewer measured values than unknowns, or a fit that fails.
    pub fn power_form(&self) -> Result<PowerForm, InferError> {
        let wet = self.wet_in_form("power")?;
        let unknowns = LAWS + self.wet_own(&self.data.speeds_m_s()).len();
        if self.data.value_count() < unknowns {
            return InferError::input(format!(
                "the wet curve has {} measured values for {unknowns} numbers of both power laws (and \
                 nuisance parameters): add speeds or reflected times of flight",
                self.data.value_count()
            ));
        }
        let about = |error: InferError| error.about("the wet curve");
        let minima = self.law_minima(&wet).map_err(about)?;
        let start = [&self.dry_fit.point[..], &minima[0].point].concat();
        let joint = self.both_curves(self.dry_curve(), wet, &start);
        let fit_result = fit(&joint, &accurate()).map_err(about)?;
        let mut form = self.form(&joint, &fit_result);
        form.others = others(&minima);
        Ok(form)
    }

    /// Fits of the wet curve with the dry contacts' numbers fixed, best first, at least one.
    fn law_minima(&self, wet: &MeasuredCurve) -> Result<Vec<Fit>, InferError> {
        let [stiffness, relaxation] = self.dry_contact;
        let dry = &self.dry_fit.point[..self.common()];
        let own = self.wet_own(&self.data.speeds_m_s());
        let laws = &self.laws(wet);
        let free = (0..own.len() + LAWS).map(Supply::Free);
        let supplies = dry.iter().copied().map(Supply::Fixed).chain(free).collect();
        let curve = wet.clone().supplied(supplies);
        let from = |times: &f64| {
            let start = [stiffness, 0.0, times * relaxation, 0.0];
            let laws = started(laws, &start);
            let parameters = own.iter().cloned().chain(laws).collect();
            fit(&CurveProblem::unchecked(parameters, vec![curve.clone()]), &rough())
        };
        let fits = TIMES_DRY.iter().step_by(2).map(from);
        let (found, failed): (Vec<_>, Vec<_>) = fits.partition(Result::is_ok);
        let mut found: Vec<Fit> = found.into_iter().flatten().collect();
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        match failed.into_iter().next_back() {
            Some(Err(error)) if found.is_empty() => Err(error),
            _ => Ok(found),
        }
    }

    /// Both curves: the dry curve's parameters, the wet chain's nuisance parameters and both laws,
    /// which start at these values.
    fn both_curves(&self, dry: MeasuredCurve, wet: MeasuredCurve, start: &[f64]) -> CurveProblem {
        let count = self.dry_fit.point.len();
        let own = self.wet_own(&wet.data().speeds_m_s());
        let laws = &self.laws(&wet);
        let fit_result = self.dry.parameters().iter().chain(&own).zip(start);
        let mut parameters: Vec<Parameter> = fit_result
            .map(|(parameter, value)| Parameter { start: *value, ..parameter.clone() })
            .collect();
        parameters.extend(started(laws, &start[count + own.len()..]));
        let of_wet = (0..self.common()).chain(count..parameters.len());
        let wet = wet.supplied(of_wet.map(Supply::Free).collect());
        CurveProblem::unchecked(parameters, vec![dry, wet])
    }

    /// Parameters of both laws, the last of the wet model's.
    fn laws(&self, wet: &MeasuredCurve) -> Vec<Parameter> {
        let all = wet.model().numbers().parameters(&wet.data().speeds_m_s());
        all[all.len() - LAWS..].to_vec()
    }

    /// Laws and their errors of a fit to both curves.
    fn form(&self, joint: &CurveProblem, fit_result: &Fit) -> PowerForm {
        let parameters = joint.parameters();
        let (dry, first) = (self.dry_fit.point.len(), parameters.len() - LAWS);
        let covariance = Covariance::new(parameters, fit_result);
        let label = |at: usize| joint.residual_label(at);
        let open = Identifiability::new(parameters, fit_result, label).unidentifiable;
        let own = (dry..first).map(|at| NuisanceParameter {
            parameter: parameters[at].clone(),
            value: fit_result.point[at],
            standard_error: covariance.sd[at],
        });
        let mut form = PowerForm {
            values: laws_of(fit_result),
            covariance: of_logarithms(&covariance, &fit_result.point[first..]),
            chi_square: Goodness::new(joint, fit_result).chi_square,
            largest_ln_sd: 0.0,
            others: Vec::new(),
            undetermined: open.into_iter().map(|direction| direction.words).collect(),
            own: own.collect(),
            beside_laws: fit_result.point[..first].to_vec(),
        };
        let speeds = self.data.speeds_m_s().into_iter();
        let errors = speeds.flat_map(|speed| form.at(speed).ln_sd);
        // `f64::max` would pass over NaN, the error of what is not determined.
        form.largest_ln_sd = errors.fold(0.0, |most: f64, sd| match sd.is_finite() {
            true => most.max(sd),
            false => f64::INFINITY,
        });
        form
    }

    /// Compares the fitted laws with those of each oil; whole curves, as [`Gauge::verdict`] does,
    /// where the laws are not [sufficient](PowerForm::is_sufficient).
    ///
    /// An oil's K and A need not be power laws. So its curve is computed at the speeds of the data,
    /// with the dry contacts' numbers and nuisance parameters as fitted, and laws are fitted to this
    /// curve as to the data. If the oil is on the contacts, the data's laws scatter about these by
    /// their covariance: a chi-square of four numbers (indirect inference
    /// [GourierouxMonfortRenault1993]).
    ///
    /// # Errors
    /// Names that the wet model does not know; an oil that fails is in the verdict.
    pub fn verdict_of_laws(&self, form: &PowerForm, oils: &[Oil]) -> Result<Verdict, InferError> {
        if !form.is_sufficient() {
            return self.verdict(oils);
        }
        let (each, power) = (self.wet_in_form("each")?, self.wet_in_form("power")?);
        Ok(Verdict::new(oils, |oil| {
            let expected = self.form_of_oil(form, oil, (&each, &power))?;
            distance(oil, form, &expected)
        }))
    }

    /// The laws that an oil's curve would give.
    fn form_of_oil(
        &self,
        form: &PowerForm,
        oil: &Oil,
        (each, power): (&MeasuredCurve, &MeasuredCurve),
    ) -> Result<PowerForm, InferError> {
        let (dry, own) = form.beside_laws.split_at(self.dry_fit.point.len());
        let [stiffness, relaxation] = self.contacts_of(oil);
        let point = [&dry[..self.common()], own, &stiffness, &relaxation].concat();
        let wet = power.with_data(computed(each, &point)?);
        let speeds = self.data.speeds_m_s();
        let mut start = form.beside_laws.clone();
        for values in [&stiffness, &relaxation] {
            let law = power_law(&speeds, values, None);
            let law = law.map_err(|error| InferError::Input(error.to_string()))?;
            start.extend([law.prefactor, law.exponent]);
        }
        let own = self.dry_curve();
        let dry = own.with_data(computed(&own, dry)?);
        let joint = self.both_curves(dry, wet, &start);
        Ok(self.form(&joint, &fit(&joint, &accurate())?))
    }
}

/// A fit that shows which start is best: to a tenth of a standard error.
fn rough() -> Fitting {
    Fitting { tolerance: 0.005, iterations: 15, ..Fitting::default() }
}

/// A fit to a thirtieth of a standard error: a hundredth of what would change a verdict.
fn accurate() -> Fitting {
    Fitting { tolerance: 0.0005, iterations: 40, ..Fitting::default() }
}

/// Laws of other minima that fit as well as the best, the first.
fn others(minima: &[Fit]) -> Vec<[f64; LAWS]> {
    let mut distinct: Vec<[f64; LAWS]> = Vec::new();
    let good = |other: &&Fit| other.cost < minima[0].cost + AS_GOOD;
    for laws in minima.iter().filter(good).map(laws_of) {
        if distinct.iter().all(|known| (known[2] - laws[2]).abs() > SAME) {
            distinct.push(laws);
        }
    }
    distinct.into_iter().skip(1).collect()
}

/// Chi-square |L⁻¹ d|² of the difference d of laws from an oil's, whose covariance is L Lᵀ.
fn distance(oil: &Oil, form: &PowerForm, expected: &PowerForm) -> Result<Match, InferError> {
    let misses = [0, 1, 2, 3].map(|i| form.values[i] - expected.values[i]);
    let columns = shifts(&expected.covariance.map(|row| row.to_vec()));
    let mut independent = [0.0; LAWS];
    for i in 0..LAWS {
        let known: f64 = (0..i).map(|j| columns[j][i] * independent[j]).sum();
        independent[i] = (misses[i] - known) / columns[i][i];
    }
    let sum = independent.iter().map(|x| x * x).sum();
    let Some(chi_square) = ChiSquare::of(sum, LAWS) else {
        return InferError::input(
            "the data do not determine both laws, so that no distance is finite",
        );
    };
    let sd = expected.sd();
    let pulls = [0, 1, 2, 3].map(|i| misses[i] / sd[i]);
    let largest = (0..LAWS).max_by(|a, b| pulls[*a].abs().total_cmp(&pulls[*b].abs()));
    let largest = largest.unwrap_or(0);
    Ok(Match {
        oil: oil.name.clone(),
        distance: (chi_square.value / LAWS as f64).sqrt(),
        chi_square,
        largest: (NAMES[largest].to_owned(), pulls[largest]),
        own: form.own.clone(),
    })
}

/// A curve's data with the values that its model computes, and the measured ones' errors.
fn computed(of: &MeasuredCurve, point: &[f64]) -> Result<Data, InferError> {
    let curve = of.predicted(&[point.to_vec()]).remove(0)?;
    let mut data = of.data().clone();
    for (row, computed) in data.rows.iter_mut().zip(curve) {
        for (value, computed) in row.values.iter_mut().zip(computed) {
            let Some(value) = value else { continue };
            let Some(computed) = computed else {
                return InferError::input("its curve lacks a pulse that was measured");
            };
            value.value = computed;
        }
    }
    Ok(data)
}

/// Laws' parameters that start at these values; a prefactor's scale is its size.
fn started<'a>(laws: &'a [Parameter], values: &'a [f64]) -> impl Iterator<Item = Parameter> + 'a {
    laws.iter().zip(values).map(|(law, value)| Parameter {
        start: *value,
        scale: match !law.unit.is_empty() && *value > 0.0 {
            true => *value,
            false => law.scale,
        },
        ..law.clone()
    })
}

/// ln K₀, k, ln A₀, a of a fit whose last parameters are K₀, k, A₀, a.
fn laws_of(fit_result: &Fit) -> [f64; LAWS] {
    let laws = &fit_result.point[fit_result.point.len() - LAWS..];
    [laws[0].ln(), laws[1], laws[2].ln(), laws[3]]
}

/// Covariance of the last parameters K₀, k, A₀, a, for the prefactors' logarithms.
fn of_logarithms(covariance: &Covariance, laws: &[f64]) -> [[f64; LAWS]; LAWS] {
    let first = covariance.sd.len() - LAWS;
    let size = [laws[0], 1.0, laws[2], 1.0];
    let entry = |i: usize, j: usize| match i == j && covariance.sd[first + i].is_infinite() {
        // The matrix holds resolved directions alone.
        true => f64::INFINITY,
        false => covariance.matrix[first + i][first + j] / (size[i] * size[j]),
    };
    [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| entry(i, j)))
}
