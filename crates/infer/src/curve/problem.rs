//! A measured curve against a model's.

use super::joint::Supply;
use super::model::{Model, Predicted, Speeds};
use super::stencil::Stencil;
use super::whiten::{Errors, whiten};
use crate::Parameter;
use crate::data::{Data, DataRow, Observable};
use crate::linear::unit;
use crate::problem::{ModelError, Residuals, Response};
use hertzchain_sim::Fingerprint;

/// Relative distance of speeds around each row's, where too few rows determine a slope.
const ASIDE: f64 = 0.02;

/// Times of flight and ratios of peaks with a model whose parameters are those of a
/// [`CurveProblem`](super::CurveProblem).
///
/// Residuals are measured − predicted, made independent within each row: errors of the speed move
/// all that was measured at it together, by the slope of the model's own curve.
#[derive(Clone, Debug)]
pub struct MeasuredCurve {
    /// The model.
    pub model: Model,
    /// The data.
    pub data: Data,
    /// Where each of the model's parameters comes from.
    pub(crate) supplies: Vec<Supply>,
    speeds: Speeds,
    stencils: Vec<Stencil>,
    labels: Vec<String>,
}

impl MeasuredCurve {
    /// Data and a model whose parameters are the problem's first, in their order.
    pub fn new(model: Model, data: Data) -> Self {
        let count = model.numbers.parameters(&data.speeds_m_s()).len();
        let (speeds, stencils) = curve_speeds(&data.speeds_m_s());
        let labels = data.rows.iter().flat_map(|row| {
            // Four digits distinguish rows for a reader.
            let speed = row.speed_m_s.value;
            let speed: f64 = format!("{speed:.3e}").parse().unwrap_or(speed);
            let label =
                move |of: Observable| format!("line {}, {speed} m/s, {}", row.line, of.name());
            row.observables().map(label)
        });
        let labels = labels.collect();
        Self {
            model,
            data,
            supplies: (0..count).map(Supply::Free).collect(),
            speeds,
            stencils,
            labels,
        }
    }

    /// The same with the model's parameters from elsewhere.
    pub(crate) fn supplied(self, supplies: Vec<Supply>) -> Self {
        Self { supplies, ..self }
    }

    /// The model's parameters at a point of the problem.
    pub(super) fn own(&self, point: &[f64]) -> Vec<f64> {
        let value = |supply: &Supply| match supply {
            Supply::Fixed(value) => *value,
            Supply::Free(at) => point.get(*at).copied().unwrap_or(f64::NAN),
        };
        self.supplies.iter().map(value).collect()
    }

    /// Of all that its residuals follow from in a problem with these parameters.
    pub(super) fn fingerprint(&self, parameters: &[Parameter]) -> Fingerprint {
        let model = self.model.inputs(parameters);
        Fingerprint::of("curve problem", &(model, &self.supplies, &self.data.rows))
    }

    pub(super) fn with_accuracy(self, accuracy: f64) -> Self {
        Self { model: self.model.with_accuracy(accuracy), ..self }
    }

    /// The largest relative error of its times of flight at a point of the problem.
    ///
    /// # Errors
    /// What is in the way of a shot.
    pub fn accuracy_reached(&self, point: &[f64]) -> Result<f64, ModelError> {
        let speeds = Speeds::of_rows(&self.data.speeds_m_s());
        self.model.accuracy_reached(&self.own(point), &speeds)
    }

    pub(crate) fn with_data(&self, data: Data) -> Self {
        Self::new(self.model.clone(), data).supplied(self.supplies.clone())
    }

    /// Predictions at some speeds, one set of rows a point of the problem.
    pub(super) fn predicted_at(
        &self,
        points: &[Vec<f64>],
        speeds: &Speeds,
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        let own: Vec<Vec<f64>> = points.iter().map(|point| self.own(point)).collect();
        self.model.curves(&own, speeds)
    }

    /// Speeds at which residuals need predictions, those of slopes among them.
    pub(super) fn speeds(&self) -> &Speeds {
        &self.speeds
    }

    /// By how many of its row's errors curves differ at each speed; infinite where one has none.
    pub(super) fn differences(&self, one: &[Predicted], other: &[Predicted]) -> Vec<f64> {
        let at = |(speed, (row, _)): (usize, &(usize, f64))| {
            let row = &self.data.rows[*row];
            let of = |of: Observable| {
                let [a, b] = [one, other].map(|curve| curve[speed][of.index()]);
                match (a, b, row.value(of)) {
                    (Some(a), Some(b), Some(measured)) => (a - b).abs() / measured.sigma,
                    _ => f64::INFINITY,
                }
            };
            row.observables().map(of).fold(0.0, f64::max)
        };
        self.speeds.at.iter().enumerate().map(at).collect()
    }

    /// Which row and observable each residual belongs to.
    pub fn measured(&self) -> impl Iterator<Item = (usize, Observable)> + '_ {
        let rows = self.data.rows.iter().enumerate();
        rows.flat_map(|(at, row)| row.observables().map(move |of| (at, of)))
    }

    /// What its residuals belong to, as messages name it.
    pub(crate) fn labels(&self) -> &[String] {
        &self.labels
    }

    pub(super) fn residuals_of(
        &self,
        curve: &[Predicted],
        residuals: &mut Residuals,
    ) -> Result<(), ModelError> {
        for (row, measured) in self.data.rows.iter().enumerate() {
            let (misses, errors) = self.misses(row, measured, curve)?;
            let errors = errors.widened();
            for (standardised, ln_sigma) in whiten(&misses, &errors) {
                residuals.standardised.push(standardised);
                residuals.ln_sigmas.push(ln_sigma);
            }
        }
        Ok(())
    }

    /// What each measured number, larger by one unit, changes the residuals of its row by.
    pub(super) fn responses(
        &self,
        curve: &[Predicted],
        all: &mut Vec<Response>,
    ) -> Result<(), ModelError> {
        for (row, measured) in self.data.rows.iter().enumerate() {
            let (misses, errors) = self.misses(row, measured, curve)?;
            let errors = errors.widened();
            let (first, count) = (all.len(), misses.len());
            all.extend((0..count).map(|at| {
                let changes = whiten(&unit(count, at), &errors).into_iter().enumerate();
                changes.map(|(k, (change, _))| (first + k, change)).collect::<Response>()
            }));
        }
        Ok(())
    }

    /// Degrees of freedom of each residual's σ.
    pub(super) fn freedoms(
        &self,
        curve: &[Predicted],
        all: &mut Vec<f64>,
    ) -> Result<(), ModelError> {
        for (row, measured) in self.data.rows.iter().enumerate() {
            all.extend(self.misses(row, measured, curve)?.1.freedoms());
        }
        Ok(())
    }

    /// What a row's numbers miss the model by, and their errors as they were given.
    fn misses(
        &self,
        row: usize,
        measured: &DataRow,
        curve: &[Predicted],
    ) -> Result<(Vec<f64>, Errors), ModelError> {
        let stencil = &self.stencils[row];
        let own = stencil.own();
        let mut misses = Vec::new();
        let mut errors = Errors::new(measured.freedom.speed, measured.correlation());
        for of in measured.observables() {
            let Some(value) = measured.value(of) else { continue };
            let none = || {
                let (name, speed) = (of.name(), measured.speed_m_s.value);
                ModelError(format!("at {speed} m/s: the model has no {name}"))
            };
            let at = |speed: usize| curve.get(speed)?[of.index()];
            let predicted = at(own).ok_or_else(none)?;
            let relative = measured.speed_m_s.sigma / measured.speed_m_s.value;
            let slope = match relative {
                0.0 => 0.0,
                _ => stencil.slope(at).ok_or_else(none)?,
            };
            misses.push(value.value - predicted);
            let moved = slope * predicted * relative;
            errors.push(value.sigma, measured.freedom.values[of.index()], moved);
        }
        Ok((misses, errors))
    }
}

/// Speeds to compute: the rows', or three a row where these are too few; and stencils of slopes.
fn curve_speeds(speeds_m_s: &[f64]) -> (Speeds, Vec<Stencil>) {
    let rows = 0..speeds_m_s.len();
    let own: Option<Vec<Stencil>> = rows.map(|row| Stencil::new(speeds_m_s, row)).collect();
    if let Some(stencils) = own {
        return (Speeds::of_rows(speeds_m_s), stencils);
    }
    let around = |(row, speed): (usize, &f64)| {
        [1.0 - ASIDE, 1.0, 1.0 + ASIDE].map(|factor| (row, factor * speed))
    };
    let at: Vec<(usize, f64)> = speeds_m_s.iter().enumerate().flat_map(around).collect();
    let rows = speeds_m_s.len();
    let stencils = (0..rows).map(|row| Stencil::around(ASIDE, 3 * row));
    (Speeds { at, rows }, stencils.collect())
}
