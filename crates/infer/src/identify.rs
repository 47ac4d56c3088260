//! Which combinations of parameters the data determine, and which not.

use crate::least_squares::{EXTRAPOLATED, ROUNDING};
use crate::linear::{Svd, combine, norm, svd};
use crate::problem::short;
use crate::{Binding, Fit, Jacobian, Parameter};

/// Singular values of the Jacobian of the data, each parameter in units of its size, which is its
/// scale, or its value at the best fit where that is larger. Priors do not enter.
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// Largest first: a combination as long as one size changes all residuals together by so many σ.
    pub singular_values: Vec<f64>,
    /// Singular values up to here are zero within the error of the derivatives.
    pub floor: f64,
    /// Unit directions, in units of the sizes, one for each singular value.
    pub directions: Vec<Vec<f64>>,
    /// Directions that the data do not determine, worst first.
    pub unidentifiable: Vec<UnidentifiableDirection>,
    /// The parameters' sizes, in whose units the directions are.
    pub sizes: Vec<f64>,
}

/// A combination of parameters that hardly changes the data.
#[derive(Clone, Debug, PartialEq)]
pub struct UnidentifiableDirection {
    /// Change of each parameter, in its unit: the largest is one percent of its size.
    pub change: Vec<f64>,
    /// Change of each residual of the data thereby, in σ.
    pub effect: Vec<f64>,
    /// Standard error of the combination, in units of the sizes; infinite if its effect is zero
    /// within the error of the derivatives.
    pub standard_error: f64,
    /// All this in a sentence.
    pub words: String,
}

/// Standard error, in units of sizes, from which a combination counts as undetermined: its size is
/// then not even known to a factor of about two, and a linear analysis means nothing any more.
const UNDETERMINED: f64 = 1.0;
/// Parts of a combination below this share of the largest are not named.
const NAMED: f64 = 0.02;
/// Component of a unit direction that moves a parameter.
pub(crate) const MOVED: f64 = 1e-4;

impl Identifiability {
    /// At a fit's optimum. `label` names a residual, as in
    /// [`Problem::residual_label`](crate::Problem::residual_label).
    pub fn new(parameters: &[Parameter], fit: &Fit, label: impl Fn(usize) -> String) -> Self {
        let parameters = &sized(parameters, &fit.point);
        let (found, floor) = Scaled::of(parameters, &fit.jacobian).decomposed();
        let pairs = found.values.iter().zip(&found.right).rev();
        let weak = pairs.filter(|(value, _)| is_weak(**value, floor));
        let unidentifiable = weak
            .map(|(value, direction)| {
                let error = if *value <= floor { f64::INFINITY } else { value.recip() };
                unidentifiable(parameters, fit, (direction, error), &label)
            })
            .collect();
        Self {
            singular_values: found.values,
            floor,
            directions: found.right,
            unidentifiable,
            sizes: parameters.iter().map(|p| p.scale).collect(),
        }
    }

    /// How many combinations the data determine.
    pub fn determined(&self) -> usize {
        self.singular_values.len() - self.unidentifiable.len()
    }

    /// Whether a parameter is not identifiable: an unidentifiable direction moves it, and its
    /// standard error (priors counted in) is as large as its size.
    pub fn leaves_open(&self, parameter: usize, sd: f64) -> bool {
        let weak = self.singular_values.iter().zip(&self.directions);
        let mut weak = weak.filter(|(value, _)| is_weak(**value, self.floor));
        let moves = weak.any(|(_, direction)| direction[parameter].abs() > MOVED);
        sd.is_infinite() || moves && sd >= UNDETERMINED * self.sizes[parameter]
    }
}

/// Parameters whose scales are their sizes at a point.
pub(crate) fn sized(parameters: &[Parameter], point: &[f64]) -> Vec<Parameter> {
    let pairs = parameters.iter().zip(point);
    let size = |(of, value): (&Parameter, &f64)| Parameter {
        scale: of.scale.max(value.abs()),
        ..of.clone()
    };
    pairs.map(size).collect()
}

/// Orthonormal changes of the residuals, priors' behind the data's, by those combinations of
/// the parameters that data and priors determine; a parameter at a bound is none.
pub(crate) fn directions_at(parameters: &[Parameter], fit: &Fit) -> Vec<Vec<f64>> {
    directions(&sized(parameters, &fit.point), &fit.jacobian, &fit.binding)
}

/// The same, of parameters in their sizes.
pub(crate) fn directions(
    sized: &[Parameter],
    jacobian: &Jacobian,
    binding: &[Binding],
) -> Vec<Vec<f64>> {
    let mut scaled = Scaled::with_priors(sized, jacobian);
    for held in binding {
        scaled.columns[held.parameter].fill(0.0);
        scaled.errors[held.parameter] = 0.0;
    }
    let (found, floor) = scaled.decomposed();
    let known = found.values.iter().zip(found.left);
    let known = known.filter(|(value, _)| !is_weak(**value, floor));
    known.map(|(_, left)| left).collect()
}

/// Whether a singular value leaves its combination open.
pub(crate) fn is_weak(value: f64, floor: f64) -> bool {
    value * UNDETERMINED <= 1.0 || value <= floor
}

/// A Jacobian of data in units of the parameters' sizes, and how wrong its columns may be.
#[derive(Clone, Debug)]
pub(crate) struct Scaled {
    columns: Vec<Vec<f64>>,
    errors: Vec<f64>,
}

/// What rows of a Jacobian determine.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Determined {
    /// How many combinations.
    pub count: usize,
    /// Standard error of the one that is known worst, in units of the sizes;
    /// infinite if nothing is known of it.
    pub worst: f64,
    /// Standard errors of the parameters, in units of their sizes.
    pub sd: Vec<f64>,
}

impl Scaled {
    pub(crate) fn of(parameters: &[Parameter], jacobian: &Jacobian) -> Self {
        let column = |(column, of): (&Vec<f64>, &Parameter)| -> Vec<f64> {
            let data = column.iter().take(jacobian.data_rows);
            data.map(|x| x * of.scale).collect()
        };
        let pairs = jacobian.columns.iter().zip(parameters);
        let columns: Vec<Vec<f64>> = pairs.map(column).collect();
        let errors = (columns.iter().zip(&jacobian.disagreement))
            .map(|(column, d)| norm(column) * (ROUNDING + EXTRAPOLATED * d))
            .collect();
        Self { columns, errors }
    }

    /// With the priors' rows, too.
    pub(crate) fn with_priors(parameters: &[Parameter], jacobian: &Jacobian) -> Self {
        let rows = jacobian.columns.first().map_or(0, Vec::len);
        let whole = Jacobian { data_rows: rows, ..jacobian.clone() };
        Self::of(parameters, &whole)
    }

    /// Of rows in 1/(unit of θ), whose columns may be wrong by `doubts`; none if that is empty.
    pub(crate) fn of_rows(parameters: &[Parameter], rows: &[Vec<f64>], doubts: &[f64]) -> Self {
        let sizes = parameters.iter().map(|p| p.scale).enumerate();
        let column = |(k, size): (usize, f64)| rows.iter().map(|row| row[k] * size).collect();
        let columns: Vec<Vec<f64>> = sizes.clone().map(column).collect();
        let doubt = |k: usize| doubts.get(k).copied().unwrap_or(0.0);
        let errors = sizes.zip(&columns);
        let errors = errors.map(|((k, size), column)| doubt(k) * size + ROUNDING * norm(column));
        Self { errors: errors.collect(), columns }
    }

    /// Together with the rows of another.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let columns = self.columns.iter().zip(&other.columns);
        let errors = self.errors.iter().zip(&other.errors);
        Self {
            columns: columns.map(|(a, b)| [&a[..], b].concat()).collect(),
            errors: errors.map(|(a, b)| a.hypot(*b)).collect(),
        }
    }

    /// Singular values, and up to where they cannot be distinguished from 0.
    pub(crate) fn decomposed(&self) -> (Svd, f64) {
        (svd(&self.columns), norm(&self.errors))
    }

    pub(crate) fn determined(&self) -> Determined {
        let (found, floor) = self.decomposed();
        let known = |value: f64| match value <= floor {
            true => f64::INFINITY,
            false => value.recip(),
        };
        let pairs = || found.values.iter().zip(&found.right);
        let part = |value: f64, share: f64| match share.abs() > MOVED {
            true => (share * known(value)).powi(2),
            false => 0.0,
        };
        let variance = |k: usize| pairs().map(|(value, v)| part(*value, v[k])).sum::<f64>();
        let weak = found.values.iter().filter(|value| is_weak(**value, floor));
        Determined {
            count: found.values.len() - weak.count(),
            worst: found.values.last().map_or(0.0, |least| known(*least)),
            sd: (0..self.columns.len()).map(|k| variance(k).sqrt()).collect(),
        }
    }
}

fn unidentifiable(
    parameters: &[Parameter],
    fit: &Fit,
    (direction, standard_error): (&[f64], f64),
    label: &impl Fn(usize) -> String,
) -> UnidentifiableDirection {
    let change = of_one_percent(parameters, direction);
    let mut effect = combine(&fit.jacobian.columns, &change);
    effect.truncate(fit.jacobian.data_rows);
    let numbered = effect.iter().map(|x| x.abs()).enumerate();
    let (row, most) = numbered.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
    let known = match standard_error.is_finite() {
        true => format!("so it is known to {:.0} % only", 100.0 * standard_error),
        false => "zero within the error of the derivatives".to_owned(),
    };
    let words = format!(
        "{} changes no measured number by more than {most:.1e} of its standard deviation ({}), {known}",
        changes(parameters, fit, &change),
        label(row)
    );
    UnidentifiableDirection { change, effect, standard_error, words }
}

/// A direction, in units of sizes, as changes of parameters in words.
pub(crate) fn in_words(sized: &[Parameter], fit: &Fit, direction: &[f64]) -> String {
    changes(sized, fit, &of_one_percent(sized, direction))
}

/// A direction, in units of sizes, as changes of parameters in their units: the largest is one
/// percent upward of its size.
fn of_one_percent(sized: &[Parameter], direction: &[f64]) -> Vec<f64> {
    let largest = direction.iter().max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let percent = largest.map_or(0.0, |largest| 0.01 / largest);
    direction.iter().zip(sized).map(|(d, p)| percent * d * p.scale).collect()
}

/// Changes in percent of sizes, the largest first; a size that is far from the value is named.
fn changes(parameters: &[Parameter], fit: &Fit, change: &[f64]) -> String {
    let percent = |k: usize| 100.0 * change[k] / parameters[k].scale;
    let mut order: Vec<usize> = (0..change.len()).collect();
    order.retain(|k| percent(*k).abs() >= NAMED);
    order.sort_by(|i, j| percent(*j).abs().total_cmp(&percent(*i).abs()));
    let part = |k: &usize| {
        let way = if change[*k] > 0.0 { "up" } else { "down" };
        let Parameter { name, unit, scale, .. } = &parameters[*k];
        let of = match fit.point[*k].abs() < 0.5 * scale {
            true => format!(" of {} {unit}", short(*scale)).trim_end().to_owned(),
            false => String::new(),
        };
        format!("{name} {way} {:.2} %{of}", percent(*k).abs())
    };
    order.iter().map(part).collect::<Vec<_>>().join(" with ")
}
