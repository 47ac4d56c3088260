//! A fit as JSON, in SI.

use super::alternatives::{AlternativeModel, AlternativeModels, Unfitted};
use super::more::{Curves, More};
use super::{FitResult, Inferred, Limit, TableFit};
use crate::inference::{
    assumed, held_loads, references_json, unit_changes, warnings_json, widened,
};
use crate::options::FitOptions as Arguments;
use hertzchain_infer::{
    Advice, Data, End, MeasuredCurve, Observable, Parameter, Profile, Prospect,
};
use serde_json::{Value, json};

/// Everything, to be read by programs and to be repeated.
pub fn json(fit_result: &FitResult, arguments: &Arguments) -> Value {
    let data = fit_result.problem.data();
    let mut own = json!({
        "data": { "file": data.file, "case": data.case, "rows": data.rows.len(), "values": data.value_count() },
        "model": fit_result.problem.model().experiment.name(),
        "model_accuracy": fit_result.accuracy,
        "assumed": assumed(data, &arguments.measured),
        "kept": unit_changes(fit_result.problem.model(), &arguments.modelled.set),
        "held_loads": held_loads(fit_result.problem.model()),
        "references": references_json(fit_result.problem.model()),
        "warnings": warnings_json(fit_result.problem.curves.iter().map(|it| &it.model.experiment)),
        "widened": widened(data),
        "instruction_set": fit_result.problem.model().set.name(),
        "fingerprint": fit_result.problem.fingerprint().to_string(),
        "would_separate": fit_result.advice.as_ref().map_or(Vec::new(), Advice::words),
        "several_pairs": fit_result.pair_warning(),
        "unasked": fit_result.unasked(arguments),
        "prospects": fit_result.advice.as_ref().map(prospects),
        "comparison": fit_result.alternatives.as_ref().map(comparison),
    });
    let tables = fit_result.tables();
    if tables.len() > 1 {
        let all = tables.iter().filter_map(|table| assumed(&table.curve.data, &arguments.measured));
        own["assumed"] = all.reduce(|all, one| format!("{all}; {one}")).into();
        let named = |name: fn(&MeasuredCurve) -> &str| {
            tables.iter().map(|table| name(table.curve)).collect::<Vec<_>>().join(", ")
        };
        let sum = |count: fn(&Data) -> usize| {
            tables.iter().map(|of| count(&of.curve.data)).sum::<usize>()
        };
        own["model"] = named(|curve| curve.model.experiment.name()).into();
        own["data"]["file"] = named(|curve| &curve.data.file).into();
        own["data"]["rows"] = sum(|data| data.rows.len()).into();
        own["data"]["values"] = sum(Data::value_count).into();
        own["tables"] = tables.iter().map(table).collect();
    }
    joined(own, inferred(&fit_result.inferred, arguments))
}

/// A table of several that were fitted together.
fn table(of: &TableFit<'_>) -> Value {
    let (data, model) = (&of.curve.data, &of.curve.model);
    json!({
        "file": data.file,
        "case": data.case,
        "model": model.experiment.name(),
        "free": model.numbers.iter().map(|number| number.name()).collect::<Value>(),
        "rows": data.rows.len(),
        "values": data.value_count(),
        "chi_square": of.chi_square(),
    })
}

fn prospects(advice: &Advice) -> Value {
    let finite = |x: f64| x.is_finite().then_some(x);
    let one = |prospect: &Prospect| {
        json!({
            "measure": prospect.measure,
            "determined": prospect.determined,
            "worst_relative_standard_error": finite(prospect.worst),
            "standard_errors": prospect.sd.iter().map(|sd| finite(*sd)).collect::<Vec<_>>(),
        })
    };
    std::iter::once(&advice.now).chain(&advice.prospects).map(one).collect()
}

/// The entries of two objects in one.
pub fn joined(mut one: Value, other: Value) -> Value {
    if let (Value::Object(one), Value::Object(other)) = (&mut one, other) {
        one.extend(other);
    }
    one
}

/// What any fit determines.
pub fn inferred(inferred: &Inferred, arguments: &Arguments) -> Value {
    let (fit, goodness) = (&inferred.fit, &inferred.goodness);
    let correlation = |i: usize, j: usize| inferred.covariance.correlation(i, j);
    let row = |i: usize| (0..fit.point.len()).map(|j| correlation(i, j)).collect::<Vec<_>>();
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "options": crate::options::recorded(arguments),
        "free": arguments.freed.free,
        "seed": arguments.seed,
        "robust": arguments.robust,
        "robust_loss": arguments.robust.then(|| json!({
            "name": fit.loss.name(), "scale": fit.loss.scale(), "residuals_beyond": fit.beyond_loss(),
            "covariance_factor": inferred.covariance.loss_factor,
        })),
        "parameters": parameters(inferred),
        "covariance": inferred.covariance.matrix,
        "correlation": (0..fit.point.len()).map(row).collect::<Value>(),
        "converged": fit.ending.converged(),
        "starts_agreeing": fit.agreeing_starts(),
        "starts": fit.starts.iter().map(|start| json!({
            "from": start.start, "to": start.point, "cost": start.cost, "iterations": start.iterations,
        })).collect::<Value>(),
        "other_minima": inferred.other_minima().iter().map(|(start, starts)| json!({
            "point": start.point, "chi_square_rise": 2.0 * (start.cost - fit.cost), "starts": starts,
        })).collect::<Value>(),
        "model_fails_beside": fit.jacobian.failing.iter().map(|(at, why)| json!({
            "name": inferred.parameters[*at].name, "why": why.to_string(),
        })).collect::<Value>(),
        "evaluations": fit.evaluations,
        "cost": fit.cost,
        "chi_square": goodness.chi_square.map(|c| json!({
            "value": c.value, "freedom": c.freedom, "probability": c.probability,
        })),
        "follows_data": !goodness.is_rejected(),
        "largest_residual": goodness.largest.as_ref().map(|found| json!({
            "what": found.label, "standard_errors": found.sigmas,
        })),
        "runs": goodness.runs,
        "jacobian_disagreement": fit.jacobian.disagreement,
        "singular_values": inferred.identifiability.singular_values,
        "directions": inferred.identifiability.directions,
        "singular_value_floor": inferred.identifiability.floor,
        "not_determined": inferred.identifiability.unidentifiable.iter().map(|c| json!({
            "words": c.words, "change": c.change,
        })).collect::<Value>(),
        "profiles": profiles(inferred),
        "posterior": posterior(inferred),
    })
}

fn parameters(inferred: &Inferred) -> Value {
    let one = |(at, parameter): (usize, &Parameter)| {
        let sd = inferred.standard_error(at);
        let is_bound = inferred.fit.is_bound(at);
        let mut all = json!(parameter);
        all["value"] = inferred.fit.point[at].into();
        all["standard_error"] = (!is_bound).then_some(sd).into();
        all["limit"] = json!(inferred.limit(at).map(Limit::json));
        all["determined"] = sd.is_finite().into();
        all["at_bound"] = is_bound.into();
        all
    };
    inferred.parameters.iter().enumerate().map(one).collect()
}

fn end(end: End) -> Value {
    match end {
        End::At(value) => json!(value),
        End::Bound(value) => json!({ "bound": value }),
        End::Open(value) => json!({ "beyond": value }),
        End::ModelFails(value) => json!({ "model_fails_beyond": value }),
    }
}

fn profiles(inferred: &Inferred) -> Value {
    let More::Profiles(profiles) = &inferred.more else {
        return Value::Null;
    };
    let one = |profile: &Profile| {
        json!({
            "name": inferred.parameters[profile.parameter].name,
            "values": profile.values,
            "chi_square_rise": profile.rise,
            "intervals": profile.intervals.iter().map(|interval| json!({
                "rise": interval.level, "lower": end(interval.lower), "upper": end(interval.upper),
            })).collect::<Value>(),
        })
    };
    profiles.iter().map(one).collect()
}

fn posterior(inferred: &Inferred) -> Value {
    let More::Sampled(sampled) = &inferred.more else {
        return Value::Null;
    };
    let (error, why, computed) = match &sampled.curves {
        Curves::Interpolated(error, speeds_m_s) => (Some(error), None, Some(speeds_m_s)),
        Curves::Computed(why) => (None, why.as_ref(), None),
    };
    let mut all = json!({
        "walkers": sampled.chain.walkers(),
        "steps": sampled.chain.steps(),
        "acceptance": sampled.chain.acceptance(),
        "surrogate_error": error,
        "no_surrogate": why,
        "computed_speeds_m_s": computed,
    });
    match &sampled.posterior {
        Err(unconverged) => all["unconverged"] = json!(unconverged.to_string()),
        Ok(posterior) => {
            let names = sampled.chain.names().iter().enumerate();
            all["parameters"] = names
                .map(|(at, name)| {
                    let found = &posterior.diagnoses[at];
                    json!({
                        "name": name,
                        "mean": posterior.mean[at],
                        "sd": posterior.sd(at),
                        "median": posterior.quantile(at, 0.5),
                        "interval_68": posterior.interval(at, super::SHARE_OF_A_STANDARD_ERROR),
                        "interval_95": posterior.interval(at, 0.95),
                        "autocorrelation_time": found.time.time,
                        "r_hat": found.r_hat,
                        "effective_samples": found.effective,
                    })
                })
                .collect();
        }
    }
    all
}

fn comparison(alternatives: &AlternativeModels) -> Value {
    let found = alternatives.comparison.as_ref();
    json!({
        "models": found.map(|_| models(alternatives)),
        "favoured": found.and_then(|found| found.favoured).map(|at| &alternatives.all[at].name),
        "sentence": found.map(|found| &found.sentence),
        "without_minimum": without_minimum(alternatives),
    })
}

pub(super) fn without_minimum(alternatives: &AlternativeModels) -> Vec<Value> {
    let one = |lost: &Unfitted| json!({ "model": lost.name, "chi_square": lost.chi_square, "why": lost.why });
    alternatives.lost.iter().map(one).collect()
}

/// Models, with what was found where there are several.
pub(super) fn models(alternatives: &AlternativeModels) -> Vec<Value> {
    let finite = |x: f64| x.is_finite().then_some(x);
    let one = |(at, alternative): (usize, &AlternativeModel)| {
        let found = alternatives.comparison.as_ref();
        let criteria = found.map(|found| &found.criteria[at]);
        let chi_square = criteria.and_then(|criteria| criteria.chi_square);
        json!({
            "model": alternative.name,
            "point": alternative.fit.point,
            "settings_left_out": alternative.without,
            "kept": alternative.kept,
            "chi_square": chi_square.map_or(alternative.fit.chi_square(), |found| found.value),
            "freedom": chi_square.map(|found| found.freedom),
            "probability": chi_square.map(|found| found.probability),
            "aic": criteria.map(|criteria| criteria.aic),
            "aicc": criteria.and_then(|criteria| finite(criteria.aicc)),
            "bic": criteria.map(|criteria| criteria.bic),
            "weight": found.map(|found| found.weights[at]),
            "cross_validation": alternative.foretells.as_ref().map(|found| json!({
                "mean": found.mean, "error": found.error,
            })),
        })
    };
    alternatives.all.iter().enumerate().map(one).collect()
}

/// Every measured value beside the fitted one with its standard error.
pub fn rows_json(fit_result: &FitResult) -> Value {
    let tables = fit_result.tables();
    tables.iter().flat_map(|table| rows_of(table, tables.len() > 1)).collect()
}

fn rows_of(table: &TableFit<'_>, with_file: bool) -> Vec<Value> {
    let data = &table.curve.data;
    let one = |((at, of), residual): ((usize, Observable), &f64)| {
        let row = &data.rows[at];
        let value = row.value(of);
        let predicted = table.fit_curve.predicted.get(at);
        let sd = table.fit_curve.sd.get(at).map(|row| row[of as usize]);
        let mut all = json!({
            "line": row.line,
            "speed_m_s": row.speed_m_s.value,
            "speed_error_m_s": row.speed_m_s.sigma,
            "observable": of.column(),
            "measured": value.map(|value| value.value),
            "error": value.map(|value| value.sigma),
            "fitted": predicted.and_then(|row| row[of as usize]),
            "fitted_error": sd.filter(|sd| sd.is_finite()),
            "residual": residual,
        });
        if with_file {
            all["file"] = data.file.clone().into();
        }
        all
    };
    table.curve.measured().zip(table.residuals).map(one).collect()
}
