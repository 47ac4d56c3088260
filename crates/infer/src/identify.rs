//! Which combinations of parameters the data determine, and which not.

use crate::least_squares::{EXTRAPOLATED, ROUNDING};
use crate::linear::{Svd, combine, norm, svd};
use crate::{Binding, Fit, Jacobian, Parameter};

/// Singular values of the Jacobian of the data, each parameter in units of its
/// size, and what they mean: its scale, or its value at the best fit where that is
/// larger, as it is after a start far too low. Priors do not enter: it is the data that are asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// Largest first: a combination as long as one size changes all residuals
    /// together by so many σ.
    pub singular_values: Vec<f64>,
    /// Singular values up to here cannot be told from 0 by the derivatives.
    pub floor: f64,
    /// Unit directions, in units of the sizes, one for each singular value.
    pub directions: Vec<Vec<f64>>,
    /// Combinations that the data do not determine, worst first.
    pub confused: Vec<Confusion>,
    /// The parameters' sizes, in whose units the directions are.
    pub sizes: Vec<f64>,
}

/// A combination of parameters that the data cannot tell from none.
#[derive(Clone, Debug, PartialEq)]
pub struct Confusion {
    /// Change of each parameter, in its unit, in proportion to each other: the
    /// largest is one percent of its value.
    pub change: Vec<f64>,
    /// Change of each residual of the data thereby, in σ.
    pub effect: Vec<f64>,
    /// Standard error of the combination, in units of the sizes; infinite if
    /// the derivatives cannot tell its effect from none at all.
    pub standard_error: f64,
    /// All this in a sentence.
    pub words: String,
}

/// Standard error, in units of sizes, from which a combination counts as
/// undetermined: its size is then not even known to a factor of about two, and a
/// linear analysis means nothing any more.
pub const UNDETERMINED: f64 = 1.0;
/// Parts of a combination below this share of the largest are not named.
const NAMED: f64 = 0.02;

impl Identifiability {
    /// At a fit's optimum. `label` names a residual, as in
    /// [`Problem::residual_label`](crate::Problem::residual_label).
    #[must_use]
    pub fn new(parameters: &[Parameter], fit: &Fit, label: impl Fn(usize) -> String) -> Self {
        let parameters = &sized(parameters, &fit.point);
        let scaled = Scaled::of(parameters, &fit.jacobian);
        let (found, floor) = scaled.taken_apart();
        let pairs = found.values.iter().zip(&found.right).rev();
        let confused = pairs
            .filter(|(value, _)| is_weak(**value, floor))
            .map(|(value, direction)| {
                let error = if *value <= floor {
                    f64::INFINITY
                } else {
                    value.recip()
                };
                confusion(parameters, fit, (direction, error), &label)
            })
            .collect();
        Self {
            singular_values: found.values,
            floor,
            directions: found.right,
            confused,
            sizes: parameters.iter().map(|p| p.scale).collect(),
        }
    }

    /// How many combinations the data determine.
    #[must_use]
    pub fn determined(&self) -> usize {
        self.singular_values.len() - self.confused.len()
    }

    /// Whether a parameter's value means nothing: a combination that the data leave
    /// open moves it, and within a standard error (what priors tell counted in) it
    /// may be off by its whole size.
    #[must_use]
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
    let (found, floor) = scaled.taken_apart();
    let known = found.values.iter().zip(found.left);
    let known = known.filter(|(value, _)| !is_weak(**value, floor));
    known.map(|(_, left)| left).collect()
}

/// Component of a unit direction that moves a parameter.
pub(crate) const MOVED: f64 = 1e-4;

/// Whether a singular value leaves its combination open.
pub(crate) fn is_weak(value: f64, floor: f64) -> bool {
    value * UNDETERMINED <= 1.0 || value <= floor
}

/// A Jacobian of data in units of the parameters' sizes, and how wrong its
/// columns may be.
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
        Self::doubting(parameters, jacobian, EXTRAPOLATED)
    }

    /// The same, columns wrong by so large a share of the disagreement of both step sizes.
    pub(crate) fn doubting(parameters: &[Parameter], jacobian: &Jacobian, share: f64) -> Self {
        let column = |(column, of): (&Vec<f64>, &Parameter)| -> Vec<f64> {
            let data = column.iter().take(jacobian.data_rows);
            data.map(|x| x * of.scale).collect()
        };
        let pairs = jacobian.columns.iter().zip(parameters);
        let columns: Vec<Vec<f64>> = pairs.map(column).collect();
        let errors = (columns.iter().zip(&jacobian.disagreement))
            .map(|(column, d)| norm(column) * (ROUNDING + share * d))
            .collect();
        Self { columns, errors }
    }

    /// With the priors' rows, too.
    pub(crate) fn with_priors(parameters: &[Parameter], jacobian: &Jacobian) -> Self {
        let rows = jacobian.columns.first().map_or(0, Vec::len);
        let whole = Jacobian {
            data_rows: rows,
            ..jacobian.clone()
        };
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
        Self {
            errors: errors.collect(),
            columns,
        }
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

    /// Singular values, and up to where they cannot be told from 0.
    pub(crate) fn taken_apart(&self) -> (Svd, f64) {
        (svd(&self.columns), norm(&self.errors))
    }

    pub(crate) fn determined(&self) -> Determined {
        let (found, floor) = self.taken_apart();
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
            sd: (0..self.columns.len())
                .map(|k| variance(k).sqrt())
                .collect(),
        }
    }
}

fn confusion(
    parameters: &[Parameter],
    fit: &Fit,
    (direction, standard_error): (&[f64], f64),
    label: &impl Fn(usize) -> String,
) -> Confusion {
    let in_units = direction.iter().zip(parameters).map(|(d, p)| d * p.scale);
    let in_units: Vec<f64> = in_units.collect();
    let change = of_one_percent(parameters, fit, &in_units);
    let mut effect = combine(&fit.jacobian.columns, &change);
    effect.truncate(fit.jacobian.data_rows);
    Confusion {
        words: words(parameters, fit, &change, (&effect, standard_error), label),
        change,
        effect,
        standard_error,
    }
}

/// What percents of a parameter are of: its value, or its size where that is 0.
fn whole(parameters: &[Parameter], fit: &Fit, k: usize) -> f64 {
    match fit.point[k].abs() {
        0.0 => parameters[k].scale,
        size => size,
    }
}

/// A direction, in units of sizes, as changes of parameters: the largest is one percent of
/// its value.
pub(crate) fn in_words(sized: &[Parameter], fit: &Fit, direction: &[f64]) -> String {
    let in_units: Vec<f64> = direction
        .iter()
        .zip(sized)
        .map(|(d, p)| d * p.scale)
        .collect();
    changes(sized, fit, &of_one_percent(sized, fit, &in_units))
}

/// The same change of parameters in their units, so large that the largest is one percent
/// upward of its value.
fn of_one_percent(parameters: &[Parameter], fit: &Fit, change: &[f64]) -> Vec<f64> {
    let share = |k: usize| change[k] / whole(parameters, fit, k);
    let largest = (0..change.len()).max_by(|i, j| share(*i).abs().total_cmp(&share(*j).abs()));
    let size = largest.map_or(0.0, |k| 0.01 / share(k));
    change.iter().map(|x| x * size).collect()
}

/// Changes in percent, the largest first.
fn changes(parameters: &[Parameter], fit: &Fit, change: &[f64]) -> String {
    let percent = |k: usize| 100.0 * change[k] / whole(parameters, fit, k);
    let mut order: Vec<usize> = (0..change.len()).collect();
    order.retain(|k| percent(*k).abs() >= NAMED);
    order.sort_by(|i, j| percent(*j).abs().total_cmp(&percent(*i).abs()));
    let part = |k: &usize| {
        let way = if change[*k] > 0.0 { "up" } else { "down" };
        format!("{} {way} {:.2} %", parameters[*k].name, percent(*k).abs())
    };
    order.iter().map(part).collect::<Vec<_>>().join(" with ")
}

fn words(
    parameters: &[Parameter],
    fit: &Fit,
    change: &[f64],
    (effect, standard_error): (&[f64], f64),
    label: &impl Fn(usize) -> String,
) -> String {
    let numbered = effect.iter().copied().enumerate();
    let most = numbered.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let (row, most) = most.unwrap_or((0, 0.0));
    let known = if standard_error.is_finite() {
        format!("so it is known to {:.0} % only", 100.0 * standard_error)
    } else {
        "as far as the derivatives tell, nothing at all".to_owned()
    };
    format!(
        "{} changes no measured number by more than {:.1e} of its standard deviation ({}), {known}",
        changes(parameters, fit, change),
        most.abs(),
        label(row)
    )
}
