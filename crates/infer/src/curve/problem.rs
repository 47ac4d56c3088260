//! Measured curves against a model's.

use super::contacts::three_for_two;
use super::model::{Model, Predicted, Speeds};
use super::stencil::Stencil;
use super::whiten::{Errors, whiten};
use crate::data::{Data, DataRow, Observable};
use crate::problem::{ModelError, Problem, Residuals, Response};
use crate::{InferError, Parameter};
use hertzchain_sim::{Fingerprint, Inputs};

/// Relative distance of the speeds around each row's, where there are too
/// few rows to determine a slope.
const ASIDE: f64 = 0.02;

/// Times of flight and ratios of peaks against those of a model.
///
/// Residuals are measured − predicted, made independent within each row:
/// errors of the speed move all that was measured at it together, by the
/// slope of the model's own curve.
#[derive(Clone, Debug)]
pub struct CurveProblem {
    model: Model,
    data: Data,
    parameters: Vec<Parameter>,
    speeds: Speeds,
    stencils: Vec<Stencil>,
    labels: Vec<String>,
}

impl CurveProblem {
    /// A model against data. `parameters` are the model's own, perhaps with other
    /// starts, bounds and priors.
    ///
    /// # Errors
    /// No parameter, one that cannot be free, or fewer numbers than unknowns.
    pub fn new(model: Model, data: Data, parameters: Vec<Parameter>) -> Result<Self, InferError> {
        if parameters.is_empty() {
            return InferError::input("no parameter is free: name some, such as eta,B");
        }
        parameters.iter().try_for_each(Parameter::check)?;
        let names: Vec<&str> = parameters.iter().map(|p| p.name.as_str()).collect();
        if data.value_count() < parameters.len() {
            let advice = three_for_two(&model).unwrap_or_else(|| {
                "free fewer, or add speeds or reflected times of flight".to_owned()
            });
            return InferError::input(format!(
                "{} has {} measured values for {} free parameters ({}): {advice}",
                data.file,
                data.value_count(),
                parameters.len(),
                names.join(", ")
            ));
        }
        Ok(Self::unchecked(model, data, parameters))
    }

    /// Part of a [`Joint`](super::Joint): other parts, or fixed values, may determine
    /// what these data do not.
    pub fn part(model: Model, data: Data) -> Self {
        let parameters = model.numbers().parameters(&data.speeds_m_s());
        Self::unchecked(model, data, parameters)
    }

    /// The same problem with other starts, bounds, scales and priors.
    pub(super) fn with_parameters(mut self, parameters: Vec<Parameter>) -> Self {
        self.parameters = parameters;
        self
    }

    fn unchecked(model: Model, data: Data, parameters: Vec<Parameter>) -> Self {
        let (speeds, stencils) = curve_speeds(&data.speeds_m_s());
        let labels = data.rows.iter().flat_map(row_labels).collect();
        Self { model, data, parameters, speeds, stencils, labels }
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The data.
    pub fn data(&self) -> &Data {
        &self.data
    }

    /// Of everything that residuals follow from: the experiment as it is
    /// understood, its free numbers, the data, accuracy and instruction set, this
    /// build of the program; not where the data lie.
    pub fn fingerprint(&self) -> Fingerprint {
        let rows = self.model.inputs("curve problem", &self.parameters);
        let row = |inputs: Inputs, row: &DataRow| inputs.text("row", &format!("{row:?}"));
        self.data.rows.iter().fold(rows, row).fingerprint()
    }

    /// The same problem with curves of another relative accuracy.
    pub fn with_accuracy(mut self, accuracy: f64) -> Self {
        self.model = self.model.with_accuracy(accuracy);
        self
    }

    /// The same problem with other measured values at the same speeds, such as
    /// those of a simulated repetition.
    ///
    /// # Errors
    /// No parameter, one that cannot be free, or fewer numbers than unknowns.
    pub fn with_data(&self, data: Data) -> Result<Self, InferError> {
        Self::new(self.model.clone(), data, self.parameters.clone())
    }

    /// Predictions at the data's speeds, one set of rows a point.
    pub fn curves(&self, points: &[Vec<f64>]) -> Vec<Result<Vec<Predicted>, ModelError>> {
        let speeds = Speeds::of_rows(&self.data.speeds_m_s());
        self.model.curves(points, &speeds)
    }

    /// Predictions at all speeds that residuals need, slopes among them.
    pub(super) fn all_curves(
        &self,
        points: &[Vec<f64>],
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        self.model.curves(points, &self.speeds)
    }

    /// Speeds in m/s at which residuals need predictions.
    pub(super) fn all_speeds_m_s(&self) -> Vec<f64> {
        self.speeds.at.iter().map(|(_, speed)| *speed).collect()
    }

    /// Predictions at some of these speeds, by number.
    pub(super) fn curves_at(
        &self,
        points: &[Vec<f64>],
        which: &[usize],
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        let speeds = Speeds {
            at: which.iter().map(|at| self.speeds.at[*at]).collect(),
            rows: self.speeds.rows,
        };
        self.model.curves(points, &speeds)
    }

    /// By how many of its row's errors one curve differs from another at each of these speeds;
    /// infinite where only one has a prediction.
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
    pub fn measured(&self) -> Vec<(usize, Observable)> {
        let rows = self.data.rows.iter().enumerate();
        rows.flat_map(|(at, row)| row.observables().map(move |of| (at, of))).collect()
    }

    /// Residuals of a predicted curve.
    pub(crate) fn residuals_of(&self, curve: &[Predicted]) -> Result<Residuals, ModelError> {
        let mut residuals = Residuals::default();
        for (row, measured) in self.data.rows.iter().enumerate() {
            for (standardised, ln_sigma) in self.row(row, measured, curve)? {
                residuals.standardised.push(standardised);
                residuals.ln_sigmas.push(ln_sigma);
            }
        }
        Ok(residuals)
    }

    /// Residuals of a row, independent and standardised, with ln σ.
    fn row(
        &self,
        row: usize,
        measured: &DataRow,
        curve: &[Predicted],
    ) -> Result<Vec<(f64, f64)>, ModelError> {
        let (misses, errors) = self.misses(row, measured, curve)?;
        Ok(whiten(&misses, &errors))
    }

    /// What each number of a row, larger by one unit, changes the row's residuals by.
    fn row_responses(
        &self,
        row: usize,
        measured: &DataRow,
        curve: &[Predicted],
    ) -> Result<Vec<Vec<f64>>, ModelError> {
        let (misses, errors) = self.misses(row, measured, curve)?;
        let unit = |at: usize| {
            let one: Vec<f64> = (0..misses.len()).map(|k| f64::from(u8::from(k == at))).collect();
            whiten(&one, &errors).into_iter().map(|(change, _)| change).collect()
        };
        Ok((0..misses.len()).map(unit).collect())
    }

    /// What a row's numbers miss the model by, and their errors.
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
            let Some(value) = measured.value(of) else {
                continue;
            };
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
        Ok((misses, errors.widened()))
    }
}

/// Speeds to compute, and for each row what its slope is made of: the rows' own
/// speeds, or each with two around it where they are too few.
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

fn row_labels(row: &DataRow) -> Vec<String> {
    // Four digits distinguish rows for a reader.
    let speed: f64 = format!("{:.3e}", row.speed_m_s.value).parse().unwrap_or(row.speed_m_s.value);
    let label = |of: Observable| format!("line {}, {speed} m/s, {}", row.line, of.name());
    row.observables().map(label).collect()
}

impl Problem for CurveProblem {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn residual_count(&self) -> usize {
        self.data.value_count()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let curves = self.all_curves(points);
        curves.into_iter().map(|curve| self.residuals_of(&curve?)).collect()
    }

    fn responses(&self, point: &[f64]) -> Result<Option<Vec<Response>>, ModelError> {
        let mut curves = self.all_curves(&[point.to_vec()]);
        let curve = curves.pop().unwrap_or_else(|| Err(ModelError::default()))?;
        let mut all = Vec::new();
        for (row, measured) in self.data.rows.iter().enumerate() {
            let first = all.len();
            let own = self.row_responses(row, measured, &curve)?;
            all.extend(own.into_iter().map(|changes| -> Response {
                changes.into_iter().enumerate().map(|(k, change)| (first + k, change)).collect()
            }));
        }
        Ok(Some(all))
    }

    fn residual_label(&self, index: usize) -> String {
        self.labels.get(index).cloned().unwrap_or_default()
    }
}
