//! Several curves, one set of parameters.

use super::contacts::three_for_two;
use super::model::{Model, Predicted, Speeds};
use super::problem::MeasuredCurve;
use crate::data::{Data, Observable};
use crate::problem::{ModelError, Problem, Residuals, Response};
use crate::{InferError, Parameter, Prior};
use hertzchain_sim::Fingerprint;

/// Where a parameter of one curve's model comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Supply {
    /// A parameter of the problem, by its place.
    Free(usize),
    /// A fixed value in its unit.
    Fixed(f64),
}

/// A curve against its model, or several with parameters in common, such as a dry and a wet one
/// of the same beads.
#[derive(Clone, Debug)]
pub struct CurveProblem {
    parameters: Vec<Parameter>,
    /// The curves, at least one.
    pub curves: Vec<MeasuredCurve>,
}

impl CurveProblem {
    /// A model against data. `parameters` are the model's own, perhaps with other
    /// starts, bounds and priors.
    ///
    /// # Errors
    /// No parameter, one that cannot be free, or fewer numbers than unknowns.
    pub fn new(model: Model, data: Data, parameters: Vec<Parameter>) -> Result<Self, InferError> {
        Self::unchecked(parameters, vec![MeasuredCurve::new(model, data)]).checked()
    }

    /// Models against data, whose parameters are the same where they have the same name; those of
    /// the numbers that `own` names are each curve's own, with its number from 1 behind the name:
    /// `preload#2`.
    pub fn of_curves(curves: Vec<(Model, Data)>, own: &[String]) -> Self {
        let mut all: Vec<Parameter> = Vec::new();
        let several = curves.len() > 1;
        let mut supply = |parameter: Parameter| {
            let known = all.iter().position(|known| known.name == parameter.name);
            Supply::Free(known.unwrap_or_else(|| {
                all.push(parameter);
                all.len() - 1
            }))
        };
        let curve = |(at, (model, data)): (usize, (Model, Data))| {
            let speeds = data.speeds_m_s();
            let supplies = model.numbers.iter().flat_map(|number| {
                let name = number.name();
                let is_own = several && own.iter().any(|own| own == name);
                number.parameters(&speeds).into_iter().map(move |parameter| match is_own {
                    true => Parameter {
                        name: format!("{name}#{}{}", at + 1, &parameter.name[name.len()..]),
                        ..parameter
                    },
                    false => parameter,
                })
            });
            let supplies = supplies.map(&mut supply).collect();
            MeasuredCurve::new(model, data).supplied(supplies)
        };
        let curves = curves.into_iter().enumerate().map(curve).collect();
        Self::unchecked(all, curves)
    }

    /// Curves that share parameters, whatever these are.
    pub(crate) fn unchecked(parameters: Vec<Parameter>, curves: Vec<MeasuredCurve>) -> Self {
        Self { parameters, curves }
    }

    fn checked(self) -> Result<Self, InferError> {
        if self.parameters.is_empty() || self.curves.is_empty() {
            return InferError::input("no parameter is free: name some, such as eta,B");
        }
        self.parameters.iter().try_for_each(Parameter::check)?;
        // What has a prior needs no measured number.
        let free: Vec<&str> = self
            .parameters
            .iter()
            .filter(|p| p.prior == Prior::Flat)
            .map(|p| p.name.as_str())
            .collect();
        let count = self.residual_count();
        if count < free.len() {
            let advice = three_for_two(self.model()).unwrap_or_else(|| {
                "free fewer, or add speeds or reflected times of flight".to_owned()
            });
            return InferError::input(format!(
                "{} has {count} measured values for {} free parameters ({}): {advice}",
                self.data().file,
                free.len(),
                free.join(", ")
            ));
        }
        Ok(self)
    }

    /// The same problem with other starts, bounds, scales and priors.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_parameters(self, parameters: Vec<Parameter>) -> Result<Self, InferError> {
        Self::unchecked(parameters, self.curves).checked()
    }

    /// The model of the first curve.
    pub fn model(&self) -> &Model {
        &self.curves[0].model
    }

    /// The data of the first curve.
    pub fn data(&self) -> &Data {
        &self.curves[0].data
    }

    /// Of everything that residuals follow from: experiments as they are
    /// understood, their free numbers, the data, accuracy and instruction set, this
    /// build of the program; not where the data lie.
    pub fn fingerprint(&self) -> Fingerprint {
        let of = |curve: &MeasuredCurve| curve.fingerprint(&self.parameters);
        match &self.curves[..] {
            [only] => of(only),
            all => {
                Fingerprint::of("curve problems", &all.iter().map(of).collect::<Vec<Fingerprint>>())
            }
        }
    }

    /// The same problem with curves of another relative accuracy.
    pub fn with_accuracy(self, accuracy: f64) -> Self {
        let curves = self.curves.into_iter().map(|curve| curve.with_accuracy(accuracy));
        Self { curves: curves.collect(), ..self }
    }

    /// The same problem with other measured values at the same speeds, one set of data a curve.
    pub(crate) fn with_data(
        &self,
        data: impl IntoIterator<Item = Data>,
    ) -> Result<Self, InferError> {
        let curves = self.curves.iter().zip(data).map(|(curve, data)| curve.with_data(data));
        Self::unchecked(self.parameters.clone(), curves.collect()).checked()
    }

    /// Predictions at all speeds that residuals need, slopes among them, curve after curve.
    pub(super) fn all_curves(
        &self,
        points: &[Vec<f64>],
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        self.curves_with(points, |_| true)
    }

    /// Predictions at some of these speeds, by number.
    pub(super) fn curves_with(
        &self,
        points: &[Vec<f64>],
        wanted: impl Fn(usize) -> bool,
    ) -> Vec<Result<Vec<Predicted>, ModelError>> {
        let mut all: Vec<Result<Vec<Predicted>, ModelError>> = vec![Ok(Vec::new()); points.len()];
        let mut number = 0..;
        for curve in &self.curves {
            let Speeds { at, rows } = curve.speeds();
            let own = at.iter().zip(number.by_ref());
            let at = own.filter(|(_, number)| wanted(*number)).map(|(at, _)| *at).collect();
            let found = curve.predicted_at(points, &Speeds { at, rows: *rows });
            for (sum, found) in all.iter_mut().zip(found) {
                match (&mut *sum, found) {
                    (Ok(sum), Ok(found)) => sum.extend(found),
                    (Ok(_), Err(error)) => *sum = Err(error),
                    (Err(_), _) => {}
                }
            }
        }
        all
    }

    /// Speeds in m/s at which residuals need predictions.
    pub(super) fn all_speeds_m_s(&self) -> Vec<f64> {
        let all = self.curves.iter().flat_map(|curve| &curve.speeds().at);
        all.map(|(_, speed)| *speed).collect()
    }

    /// Curves with their parts of what was predicted for all.
    fn parts<'a>(
        &'a self,
        mut predicted: &'a [Predicted],
    ) -> impl Iterator<Item = (&'a MeasuredCurve, &'a [Predicted])> {
        self.curves.iter().map(move |curve| {
            let (own, rest) = predicted.split_at(curve.speeds().at.len().min(predicted.len()));
            predicted = rest;
            (curve, own)
        })
    }

    /// By how many of its row's errors predictions differ at each speed; infinite without one.
    pub(super) fn differences(&self, one: &[Predicted], other: &[Predicted]) -> Vec<f64> {
        let pairs = self.parts(one).zip(self.parts(other));
        pairs.flat_map(|((curve, one), (_, other))| curve.differences(one, other)).collect()
    }

    /// Which curve, row and observable each residual belongs to.
    pub fn measured(&self) -> Vec<(usize, usize, Observable)> {
        let all = self.curves.iter().enumerate();
        let own = |(at, curve): (usize, &MeasuredCurve)| -> Vec<(usize, usize, Observable)> {
            curve.measured().map(|(row, of)| (at, row, of)).collect()
        };
        all.flat_map(own).collect()
    }

    pub(crate) fn residuals_of(&self, predicted: &[Predicted]) -> Result<Residuals, ModelError> {
        let mut residuals = Residuals::default();
        for (curve, own) in self.parts(predicted) {
            curve.residuals_of(own, &mut residuals)?;
        }
        Ok(residuals)
    }
}

impl Problem for CurveProblem {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn residual_count(&self) -> usize {
        self.curves.iter().map(|curve| curve.data.value_count()).sum()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let curves = self.all_curves(points);
        curves.into_iter().map(|curve| self.residuals_of(&curve?)).collect()
    }

    fn responses(&self, point: &[f64]) -> Result<Option<Vec<Response>>, ModelError> {
        let predicted = self.all_curves(&[point.to_vec()]).remove(0)?;
        let mut all = Vec::new();
        for (curve, own) in self.parts(&predicted) {
            curve.responses(own, &mut all)?;
        }
        Ok(Some(all))
    }

    fn freedoms(&self, point: &[f64]) -> Result<Option<Vec<f64>>, ModelError> {
        if self.curves.iter().all(|curve| curve.data.widened().is_none()) {
            return Ok(None);
        }
        let predicted = self.all_curves(&[point.to_vec()]).remove(0)?;
        let mut all = Vec::new();
        for (curve, own) in self.parts(&predicted) {
            curve.freedoms(own, &mut all)?;
        }
        Ok(Some(all))
    }

    fn residual_label(&self, index: usize) -> String {
        let named = |curve: &MeasuredCurve, label: &String| match self.curves.len() {
            1 => label.clone(),
            _ => format!("{}, {label}", curve.data.file),
        };
        let all =
            self.curves.iter().flat_map(|curve| curve.labels().iter().map(move |l| (curve, l)));
        all.skip(index).map(|(curve, label)| named(curve, label)).next().unwrap_or_default()
    }
}
