//! A fit as JSON and tables, in SI.

use super::Fitted;
use crate::arguments::infer::Fit as Arguments;
use crate::table::cell;
use hertzchain_infer::{Observable, Parameter, Prior, Problem};
use serde_json::{Value, json};

/// Everything, to be read by programs and to be repeated.
pub fn json(fitted: &Fitted, arguments: &Arguments) -> Value {
    let (fit, goodness) = (&fitted.fit, &fitted.goodness);
    let data = fitted.problem.data();
    json!({
        "data": { "file": data.file, "case": data.case, "rows": data.rows.len(), "values": data.value_count() },
        "model": fitted.problem.model().experiment().name(),
        "free": arguments.freed.free,
        "seed": arguments.seed,
        "robust": arguments.robust,
        "parameters": parameters(fitted),
        "covariance": fitted.covariance.matrix,
        "correlation": correlations(fitted),
        "converged": fit.ending.converged(),
        "starts_agreeing": fit.agreeing_starts(),
        "starts": fit.starts.iter().map(|start| json!({
            "from": start.start, "to": start.point, "cost": start.cost, "iterations": start.iterations,
        })).collect::<Value>(),
        "evaluations": fit.evaluations,
        "cost": fit.cost,
        "chi_square": goodness.chi_square.map(|c| json!({
            "value": c.value, "freedom": c.freedom, "probability": c.probability,
        })),
        "runs": goodness.runs.map(|r| json!({
            "count": r.count, "expected": r.expected,
            "probability_fewer": r.probability_fewer, "probability_more": r.probability_more,
        })),
        "jacobian_disagreement": fit.jacobian.disagreement,
        "model_accuracy": fitted.accuracy,
    })
}

fn parameters(fitted: &Fitted) -> Value {
    let parameters = fitted.problem.parameters().iter().enumerate();
    let one = |(at, parameter): (usize, &Parameter)| {
        let finite = |x: f64| x.is_finite().then_some(x);
        json!({
            "name": parameter.name,
            "unit": parameter.unit,
            "value": fitted.fit.point[at],
            "standard_error": finite(fitted.covariance.sd[at]),
            "at_bound": fitted.fit.is_bound(at),
            "start": parameter.start,
            "lower": finite(parameter.lower),
            "upper": finite(parameter.upper),
            "scale": parameter.scale,
            "prior": prior(parameter.prior),
        })
    };
    parameters.map(one).collect()
}

fn prior(prior: Prior) -> Value {
    match prior {
        Prior::Flat => Value::Null,
        Prior::Normal { mean, sd } => json!({ "mean": mean, "sd": sd }),
        Prior::LogNormal { median, ln_sd } => json!({ "median": median, "ln_sd": ln_sd }),
    }
}

fn correlations(fitted: &Fitted) -> Value {
    let count = fitted.fit.point.len();
    let row = |i: usize| (0..count).map(move |j| fitted.covariance.correlation(i, j));
    (0..count)
        .map(|i| row(i).collect::<Vec<_>>())
        .collect::<Vec<_>>()
        .into()
}

/// One line a parameter.
pub fn parameters_csv(fitted: &Fitted) -> String {
    let mut text = "name,unit,value,standard_error\n".to_owned();
    for (at, parameter) in fitted.problem.parameters().iter().enumerate() {
        let sd = fitted.covariance.sd[at];
        let sd = if sd.is_finite() {
            cell(sd)
        } else {
            String::new()
        };
        let value = cell(fitted.fit.point[at]);
        text += &format!("{},{},{value},{sd}\n", parameter.name, parameter.unit);
    }
    text
}

/// One line a measured value.
pub fn rows_csv(fitted: &Fitted) -> String {
    let mut text = "line,speed_m_s,observable,measured,error,fitted,residual\n".to_owned();
    let measured = fitted.problem.measured();
    for ((row, of), residual) in measured.into_iter().zip(&fitted.fit.residuals) {
        text += &row_line(fitted, (row, of), *residual);
    }
    text
}

fn row_line(fitted: &Fitted, (at, of): (usize, Observable), residual: f64) -> String {
    let row = &fitted.problem.data().rows[at];
    let measured = row.value(of);
    let predicted = fitted
        .curve
        .predicted
        .get(at)
        .and_then(|row| row[of as usize]);
    let cells = [
        measured.map(|m| m.value),
        measured.map(|m| m.sigma),
        predicted,
        Some(residual),
    ];
    let cells = cells.map(|value| value.map_or(String::new(), cell));
    let speed = cell(row.speed_m_s.value);
    format!("{},{speed},{},{}\n", row.line, of.column(), cells.join(","))
}
