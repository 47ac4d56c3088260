//! Which combinations of parameters the data determine, and which not.

use crate::least_squares::{EXTRAPOLATED, ROUNDING};
use crate::linear::{combine, svd};
use crate::{Fit, Parameter};

/// Singular values of the Jacobian of the data, each parameter in units of its
/// scale, and what they mean. Priors do not enter: it is the data that are asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// Largest first: a combination as long as one scale changes all residuals
    /// together by so many σ.
    pub singular_values: Vec<f64>,
    /// Singular values up to here cannot be told from 0 by the derivatives.
    pub floor: f64,
    /// Unit directions, in units of the scales, one for each singular value.
    pub directions: Vec<Vec<f64>>,
    /// Combinations that the data do not determine, worst first.
    pub confused: Vec<Confusion>,
}

/// A combination of parameters that the data cannot tell from none.
#[derive(Clone, Debug, PartialEq)]
pub struct Confusion {
    /// Change of each parameter, in its unit, in proportion to each other: the
    /// largest is one percent of its value.
    pub change: Vec<f64>,
    /// Change of each residual of the data thereby, in σ.
    pub effect: Vec<f64>,
    /// Standard error of the combination, in units of the scales; infinite if
    /// the derivatives cannot tell its effect from none at all.
    pub standard_error: f64,
    /// All this in a sentence.
    pub words: String,
}

/// Standard error, in units of scales, from which a combination counts as
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
        let jacobian = &fit.jacobian;
        let columns: Vec<Vec<f64>> = (jacobian.columns.iter().zip(parameters))
            .map(|(column, parameter)| {
                let data = column.iter().take(jacobian.data_rows);
                data.map(|x| x * parameter.scale).collect()
            })
            .collect();
        let found = svd(&columns);
        let errors = (columns.iter().zip(&jacobian.disagreement))
            .map(|(column, d)| crate::linear::norm(column) * (ROUNDING + EXTRAPOLATED * d));
        let floor = errors.map(|e| e * e).sum::<f64>().sqrt();
        let weak = |value: &f64| value * UNDETERMINED <= 1.0 || *value <= floor;
        let pairs = found.values.iter().zip(&found.right).rev();
        let confused = pairs
            .filter(|(value, _)| weak(value))
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
        }
    }

    /// How many combinations the data determine.
    #[must_use]
    pub fn determined(&self) -> usize {
        self.singular_values.len() - self.confused.len()
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
    let share = |k: usize| in_units[k] / whole(parameters, fit, k);
    let largest = (0..in_units.len()).max_by(|i, j| share(*i).abs().total_cmp(&share(*j).abs()));
    // One percent upward of the parameter that changes most.
    let size = largest.map_or(0.0, |k| 0.01 / share(k));
    let change: Vec<f64> = in_units.iter().map(|x| x * size).collect();
    let mut effect = combine(&fit.jacobian.columns, &change);
    effect.truncate(fit.jacobian.data_rows);
    Confusion {
        words: words(parameters, fit, &change, (&effect, standard_error), label),
        change,
        effect,
        standard_error,
    }
}

/// What percents of a parameter are of: its value, or its scale where that is 0.
fn whole(parameters: &[Parameter], fit: &Fit, k: usize) -> f64 {
    match fit.point[k].abs() {
        0.0 => parameters[k].scale,
        size => size,
    }
}

fn words(
    parameters: &[Parameter],
    fit: &Fit,
    change: &[f64],
    (effect, standard_error): (&[f64], f64),
    label: &impl Fn(usize) -> String,
) -> String {
    let percent = |k: usize| 100.0 * change[k] / whole(parameters, fit, k);
    let mut order: Vec<usize> = (0..change.len()).collect();
    order.retain(|k| percent(*k).abs() >= NAMED);
    order.sort_by(|i, j| percent(*j).abs().total_cmp(&percent(*i).abs()));
    let part = |k: &usize| {
        let way = if change[*k] > 0.0 { "up" } else { "down" };
        format!("{} {way} {:.2} %", parameters[*k].name, percent(*k).abs())
    };
    let parts: Vec<String> = order.iter().map(part).collect();
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
        parts.join(" with "),
        most.abs(),
        label(row)
    )
}
