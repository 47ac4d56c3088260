//! K and A of the wet contacts as power laws of speed, fitted to whole curves.
//!
//! K(v) = K₀ (v/(1 m/s))^k and A(v) = A₀ (v/(1 m/s))^a: four numbers for a whole curve,
//! which incident times alone can determine, where each speed for itself tells one
//! combination of K and A.

use super::dry::shifts;
use super::oils::Oil;
use super::solutions::{AS_GOOD, SAME, TIMES_DRY};
use super::verdict::{LEAST_PROBABILITY, Match, OwnNumber, Verdict};
use super::{CONTACT, Gauge, GaugeError};
use crate::curve::{CurveProblem, Joint, Part, Supply};
use crate::data::Data;
use crate::free::{FreeNumber, FreeNumbers};
use crate::{
    Covariance, Fit, FitError, Fitting, Goodness, Identifiability, Model, Parameter, Problem, fit,
};
use hertzchain_measure::signal::{ChiSquare, Estimate, chi_square};

/// Numbers of both laws: ln K₀ (K₀ in N/m^{3/2}), k, ln A₀ (A₀ in s), a.
pub const LAWS: usize = 4;

/// Largest standard error of ln K and ln A at which errors of laws are still an ellipse: A
/// enters times of flight with more than its first power.
const MOST_LN_SD: f64 = 0.1;

/// What each of them is called.
const CALLED: [&str; LAWS] = ["K at 1 m/s", "exponent of K", "A at 1 m/s", "exponent of A"];

/// Power laws of K and A that both curves ask for.
#[derive(Clone, Debug)]
pub struct PowerForm {
    /// ln K₀, k, ln A₀, a.
    pub values: [f64; LAWS],
    /// Their covariance, the dry contacts' and the chain's own numbers fitted along.
    pub covariance: [[f64; LAWS]; LAWS],
    /// How well both curves follow them.
    pub chi_square: Option<ChiSquare>,
    /// Largest standard error of ln K and ln A at the speeds of the data.
    pub largest_ln_sd: f64,
    /// Other laws that fit as well.
    pub others: Vec<[f64; LAWS]>,
    /// Combinations that the data leave open, in words.
    pub undetermined: Vec<String>,
    /// The wet chain's own numbers.
    pub own: Vec<OwnNumber>,
    /// Everything that was fitted: the dry curve's parameters, the wet chain's own
    /// numbers, both laws.
    fit: Fit,
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

impl PowerForm {
    /// K and A at a speed in m/s: ln K = ln K₀ + k ln v, and its error from the
    /// covariance of ln K₀ and k; so A.
    #[must_use]
    pub fn at(&self, speed_m_s: f64) -> AtSpeed {
        let log = speed_m_s.ln();
        let of = |law: usize| self.values[law] + self.values[law + 1] * log;
        let sd = |law: usize| {
            let c = &self.covariance;
            let both = 2.0 * c[law][law + 1] * log + c[law + 1][law + 1] * log * log;
            (c[law][law] + both).sqrt()
        };
        AtSpeed {
            speed_m_s,
            ln: [of(0), of(2)],
            ln_sd: [sd(0), sd(2)],
        }
    }

    /// Standard errors of ln K₀, k, ln A₀, a.
    #[must_use]
    pub fn sd(&self) -> [f64; LAWS] {
        [0, 1, 2, 3].map(|at| self.covariance[at][at].sqrt())
    }

    /// Whether both curves follow the laws, and determine them well: only then do four numbers
    /// and their covariance say all that the curves do.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.follows() && self.is_determined()
    }

    fn is_determined(&self) -> bool {
        let clear = self.undetermined.is_empty() && self.others.is_empty();
        clear && self.largest_ln_sd <= MOST_LN_SD
    }

    fn follows(&self) -> bool {
        let chi_square = self.chi_square;
        chi_square.is_none_or(|found| found.probability >= LEAST_PROBABILITY)
    }

    /// What speaks against taking K and A for power laws.
    #[must_use]
    pub fn doubts(&self) -> Option<String> {
        let mut doubts = Vec::new();
        if !self.follows() {
            doubts.push(
                "The curves do not follow power laws of K and A: these are averages over the speeds measured, and \
                 say little beyond them.",
            );
        }
        if !self.is_determined() {
            doubts.push(
                "The data leave both laws in a valley, along which their errors mean little: add reflected times of \
                 flight, ratios of peaks, or speeds that are known better.",
            );
        }
        if !self.is_sound() {
            doubts.push("So oils are held against whole curves, not against these laws.");
        }
        (!doubts.is_empty()).then(|| doubts.join(" "))
    }
}

impl Gauge {
    /// Fits power laws of K and A to the whole wet curve, with the dry curve and its
    /// parameters, from several starts of A.
    ///
    /// # Errors
    /// Fewer numbers than unknowns, or what is in the way of a fit.
    pub fn power_form(&self) -> Result<PowerForm, GaugeError> {
        let wet = self.wet_by_laws()?;
        let asked = LAWS + self.wet_own(&self.data.speeds_m_s()).len();
        if self.data.value_count() < asked {
            return Err(GaugeError::FewForLaws {
                values: self.data.value_count(),
                asked,
            });
        }
        let mut found = self.descended(&wet)?;
        let best = found.remove(0);
        let others = found.into_iter().filter(|other| {
            let apart = (other.point[LAWS - 2] / best.point[LAWS - 2]).ln().abs();
            other.cost < best.cost + AS_GOOD && apart > SAME
        });
        let mut distinct: Vec<[f64; LAWS]> = Vec::new();
        for other in others.map(|other| in_logs(&other.point[other.point.len() - LAWS..])) {
            if distinct
                .iter()
                .all(|known| (known[2] - other[2]).abs() > SAME)
            {
                distinct.push(other);
            }
        }
        let joint = self.joint(
            &wet,
            &self.data,
            self.dry.clone(),
            &self.start_of_all(&best.point),
        );
        let fit = fit(&joint, &closely()).map_err(GaugeError::Wet)?;
        Ok(self.told(&joint, fit, distinct))
    }

    /// Fits of the wet curve with the dry numbers held, best first.
    fn descended(&self, wet: &CurveProblem) -> Result<Vec<Fit>, GaugeError> {
        let [stiffness, relaxation] = self.dry_contact;
        let common = self.common();
        let mut parameters = self.wet_own(&self.data.speeds_m_s());
        let own = parameters.len();
        parameters.extend_from_slice(&wet.parameters()[common + own..]);
        let held = self.dry_fit.point[..common].iter().copied();
        let supplies: Vec<Supply> = held
            .map(Supply::Fixed)
            .chain((0..own + LAWS).map(Supply::Free))
            .collect();
        let mut found = Vec::new();
        let mut failed = FitError::NothingFree;
        for times in TIMES_DRY.iter().step_by(2) {
            let laws = [stiffness, 0.0, times * relaxation, 0.0];
            let starts = parameters[own..].iter_mut().zip(laws);
            starts.for_each(|(parameter, value)| begin(parameter, value));
            let part = Part {
                problem: wet.clone(),
                supplies: supplies.clone(),
            };
            match fit(&Joint::new(parameters.clone(), vec![part]), &roughly()) {
                Ok(fitted) => found.push(fitted),
                Err(error) => failed = error,
            }
        }
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        match found.is_empty() {
            true => Err(GaugeError::Wet(failed)),
            false => Ok(found),
        }
    }

    /// The wet curve, K and A power laws of speed.
    fn wet_by_laws(&self) -> Result<CurveProblem, GaugeError> {
        let experiment = self.wet.experiment();
        let own = self.wet.numbers().as_slice();
        let mut numbers: Vec<FreeNumber> = own[..own.len() - CONTACT].to_vec();
        for name in ["wet.K:power", "wet.A:power"] {
            numbers.push(FreeNumber::find(experiment, name, None)?);
        }
        let model = Model::new(experiment, FreeNumbers::new(numbers)?)?;
        Ok(CurveProblem::part(
            model.with_accuracy(self.wet.accuracy),
            self.data.clone(),
        ))
    }

    /// Where both curves' parameters start, from the wet curve's own numbers and laws.
    fn start_of_all(&self, wet: &[f64]) -> Vec<f64> {
        self.dry_fit.point.iter().chain(wet).copied().collect()
    }

    /// Both curves: the dry fit's parameters, the wet chain's own, and both laws.
    fn joint(&self, wet: &CurveProblem, data: &Data, dry: CurveProblem, start: &[f64]) -> Joint {
        let count = dry.parameters().len();
        let mut parameters = dry.parameters().to_vec();
        parameters.extend(self.wet_own(&data.speeds_m_s()));
        let laws = wet.parameters().len() - LAWS;
        parameters.extend_from_slice(&wet.parameters()[laws..]);
        for (at, (parameter, value)) in parameters.iter_mut().zip(start).enumerate() {
            match at < count {
                // A prior's start is its own.
                true => parameter.start = *value,
                false => begin(parameter, *value),
            }
        }
        let all = parameters.len();
        let wet_part = Part {
            supplies: (0..self.common())
                .chain(count..all)
                .map(Supply::Free)
                .collect(),
            problem: CurveProblem::part(wet.model().clone(), data.clone()),
        };
        let dry_part = Part {
            problem: dry,
            supplies: (0..count).map(Supply::Free).collect(),
        };
        Joint::new(parameters, vec![dry_part, wet_part])
    }

    fn told(&self, joint: &Joint, fit: Fit, others: Vec<[f64; LAWS]>) -> PowerForm {
        let parameters = joint.parameters();
        let first = parameters.len() - LAWS;
        let covariance = Covariance::new(parameters, &fit);
        let label = |at: usize| joint.residual_label(at);
        let open = Identifiability::new(parameters, &fit, label)
            .confused
            .into_iter();
        let count = self.dry_fit.point.len();
        let own = (count..first).map(|at| OwnNumber {
            parameter: parameters[at].clone(),
            value: fit.point[at],
            standard_error: covariance.sd[at],
        });
        let mut form = PowerForm {
            values: in_logs(&fit.point[first..]),
            covariance: of_logs(&covariance, &fit.point, first),
            largest_ln_sd: f64::INFINITY,
            chi_square: Goodness::new(joint, &fit).chi_square,
            others,
            undetermined: open.map(|confusion| confusion.words).collect(),
            own: own.collect(),
            fit,
        };
        let speeds = self.data.speeds_m_s().into_iter();
        let errors = speeds.flat_map(|speed| form.at(speed).ln_sd);
        // What is not determined at all is no number, which `max` would pass over.
        form.largest_ln_sd = errors.fold(0.0, |most: f64, sd| match sd.is_finite() {
            true => most.max(sd),
            false => f64::INFINITY,
        });
        form
    }

    /// Holds the laws against those that each oil would give; whole curves, as
    /// [`Gauge::verdict`] does, where the laws are not [sound](PowerForm::is_sound).
    ///
    /// An oil's K and A need not be power laws. So its curve is computed at the speeds of
    /// the data, the dry contacts' and the chain's own numbers as fitted, and laws are
    /// fitted to it as they were to the data. If the oil is on the contacts, the laws of
    /// the data scatter about these by the covariance (indirect inference
    /// [GourierouxMonfortRenault1993]), whose four numbers make a chi-square.
    ///
    /// # Errors
    /// Names that the wet model does not know; an oil that fails is told in the verdict.
    pub fn verdict_of_laws(&self, form: &PowerForm, oils: &[Oil]) -> Result<Verdict, GaugeError> {
        if !form.is_sound() {
            return self.verdict(oils);
        }
        let (by_speed, by_laws) = (self.wet_by_speed()?, self.wet_by_laws()?);
        let mut verdict = Verdict {
            matches: Vec::new(),
            failed: Vec::new(),
        };
        for oil in oils {
            match self.laws_against(form, oil, (&by_speed, &by_laws)) {
                Ok(found) => verdict.matches.push(found),
                Err(why) => verdict.failed.push((oil.name.clone(), why)),
            }
        }
        let matches = &mut verdict.matches;
        matches.sort_by(|a, b| a.chi_square.value.total_cmp(&b.chi_square.value));
        Ok(verdict)
    }

    fn laws_against(
        &self,
        form: &PowerForm,
        oil: &Oil,
        (by_speed, by_laws): (&CurveProblem, &CurveProblem),
    ) -> Result<Match, String> {
        let count = self.dry_fit.point.len();
        let fitted = &form.fit.point[..form.fit.point.len() - LAWS];
        let speeds = self.data.speeds_m_s();
        let contacts: Vec<(f64, f64)> = speeds
            .iter()
            .map(|v| oil.contact(self.radius_m, *v))
            .collect();
        let common = fitted[..self.common()]
            .iter()
            .chain(&fitted[count..])
            .copied();
        let stiffness = contacts.iter().map(|contact| contact.0);
        let relaxation = contacts.iter().map(|contact| contact.1);
        let point: Vec<f64> = common
            .chain(stiffness.clone())
            .chain(relaxation.clone())
            .collect();
        let wet = as_computed(by_speed, &self.data, &point)?;
        let dry = as_computed(&self.dry, self.dry.data(), &fitted[..count])?;
        let dry = self.dry.with_data(dry).map_err(|error| error.to_string())?;
        let [k, a] = [through(&speeds, stiffness), through(&speeds, relaxation)];
        let start: Vec<f64> = fitted.iter().copied().chain(k).chain(a).collect();
        let joint = self.joint(by_laws, &wet, dry, &start);
        let fit = fit(&joint, &closely()).map_err(|error| error.to_string())?;
        let expected = self.told(&joint, fit, Vec::new());
        distance(oil, form, &expected)
    }
}

/// Enough to see which start is best: to a tenth of a standard error.
fn roughly() -> Fitting {
    Fitting {
        tolerance: 0.005,
        iterations: 15,
        ..Fitting::default()
    }
}

/// To a thirtieth of a standard error: a hundredth of what would change a verdict.
fn closely() -> Fitting {
    Fitting {
        tolerance: 0.0005,
        iterations: 40,
        ..Fitting::default()
    }
}

/// How far laws are from those that an oil gives, in the errors that these have.
fn distance(oil: &Oil, form: &PowerForm, expected: &PowerForm) -> Result<Match, String> {
    let miss = [0, 1, 2, 3].map(|at| form.values[at] - expected.values[at]);
    let matrix: Vec<Vec<f64>> = expected.covariance.iter().map(|row| row.to_vec()).collect();
    let columns = shifts(&matrix);
    let mut independent = [0.0; LAWS];
    for at in 0..LAWS {
        let known: f64 = (0..at).map(|j| columns[j][at] * independent[j]).sum();
        independent[at] = (miss[at] - known) / columns[at][at];
    }
    let rows = independent.map(|value| Estimate { value, sigma: 1.0 });
    let chi_square = chi_square(&rows, &[0.0; LAWS], 0)
        .filter(|found| found.value.is_finite())
        .ok_or("the data do not determine both laws, so that no distance is finite")?;
    let pulls = miss.iter().zip(expected.sd()).map(|(miss, sd)| miss / sd);
    let farthest = pulls
        .zip(CALLED)
        .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let (size, what) = farthest.unwrap_or((f64::NAN, CALLED[0]));
    Ok(Match {
        oil: oil.name.clone(),
        distance: (chi_square.value / LAWS as f64).sqrt(),
        chi_square,
        farthest: (what.to_owned(), size),
        own: form.own.clone(),
    })
}

/// Data as a model computes them, with the errors of those measured.
fn as_computed(problem: &CurveProblem, measured: &Data, point: &[f64]) -> Result<Data, String> {
    let curve = problem
        .curves(&[point.to_vec()])
        .remove(0)
        .map_err(|error| error.to_string())?;
    let mut data = measured.clone();
    for (row, computed) in data.rows.iter_mut().zip(curve) {
        for (value, computed) in row.values.iter_mut().zip(computed) {
            if let Some(value) = value {
                value.value =
                    computed.ok_or("a pulse that was measured is not seen in its curve")?;
            }
        }
    }
    Ok(data)
}

/// Prefactor and exponent of the power law next to values, in logarithms; a start.
fn through(speeds_m_s: &[f64], values: impl Iterator<Item = f64>) -> [f64; 2] {
    let points: Vec<(f64, f64)> = speeds_m_s
        .iter()
        .map(|v| v.ln())
        .zip(values.map(f64::ln))
        .collect();
    let count = points.len().max(1) as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let spread = mean(&|p| (p.0 - x).powi(2));
    let exponent = match spread > 0.0 {
        true => mean(&|p| (p.0 - x) * (p.1 - y)) / spread,
        false => 0.0,
    };
    [(y - exponent * x).exp(), exponent]
}

/// Starts a law's parameter; a prefactor's scale is its size.
fn begin(parameter: &mut Parameter, value: f64) {
    parameter.start = value;
    if !parameter.unit.is_empty() && value != 0.0 {
        parameter.scale = value.abs();
    }
}

/// K₀, k, A₀, a with the logarithms of prefactors.
fn in_logs(point: &[f64]) -> [f64; LAWS] {
    [point[0].ln(), point[1], point[2].ln(), point[3]]
}

/// The laws' part of a covariance, for logarithms of prefactors.
fn of_logs(covariance: &Covariance, point: &[f64], first: usize) -> [[f64; LAWS]; LAWS] {
    let size = |at: usize| [point[first], 1.0, point[first + 2], 1.0][at];
    let entry = |i: usize, j: usize| match i == j && covariance.sd[first + i].is_infinite() {
        // What the data do not resolve is missing in the matrix.
        true => f64::INFINITY,
        false => covariance.matrix[first + i][first + j] / (size(i) * size(j)),
    };
    [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| entry(i, j)))
}
