//! A fit as tables (CSV), in SI: views of `fit.json`, and the samples of a posterior.

use super::alternatives::AlternativeModels;
use super::{FitResult, More, results};
use crate::csv::{Column, Table, columns, list, quantities, square, table, view};
use hertzchain_infer::titled;
use serde_json::{Value, json};

/// Numbers of the whole fit.
const SUMMARY: &str = "converged,cost,chi_square=chi_square/value,freedom=chi_square/freedom,\
     probability=chi_square/probability,runs=runs/count,runs_expected=runs/expected,\
     runs_probability_fewer=runs/probability_fewer,runs_probability_more=runs/probability_more,\
     jacobian_disagreement=worst_disagreement,singular_value_floor,combinations_determined";

const PARAMETERS: &str = "name,unit,value,standard_error,determined,at_bound,limit_68=limit/percent_68,\
     limit_95=limit/percent_95,start,lower,upper,scale";

const POSTERIOR: &str = "name,unit,mean,sd,median,lower_68=interval_68/0,upper_68=interval_68/1,\
     lower_95=interval_95/0,upper_95=interval_95/1,autocorrelation_time,r_hat,effective_samples";

const COMPARISON: &str = "model,free,chi_square,freedom,probability,aic,aicc,bic,weight,\
     prediction_error=cross_validation/mean,prediction_error_error=cross_validation/error";

/// Every table of a fit of a curve, whose JSON is `found`.
pub fn tables(fit_result: &FitResult, found: &Value) -> Vec<Table> {
    let rows = results::rows_json(fit_result);
    let several = if fit_result.curves.len() > 1 { ",file" } else { "" };
    let titles = "line,speed_m_s,observable,measured,error,fitted,fitted_error,residual".to_owned();
    let mut all = vec![("fit.csv", view(list(&rows), &columns(&(titles + several))))];
    all.extend(tables_of_any(found, &fit_result.inferred.more));
    let alternatives = fit_result.alternatives.as_ref();
    all.extend(alternatives.map(|alternatives| ("comparison.csv", comparison(alternatives))));
    all
}

/// Tables that any fit has, whose JSON is `found`.
pub(crate) fn tables_of_any(found: &Value, more: &More) -> Vec<Table> {
    let parameters = list(&found["parameters"]);
    let text = |of: &Value, key: &str| of[key].as_str().unwrap_or_default().to_owned();
    let names: Vec<String> = parameters.iter().map(|of| text(of, "name")).collect();
    let title = |of: &Value| titled(&text(of, "name"), &text(of, "unit"));
    let titles: Vec<String> = parameters.iter().map(title).collect();
    let with_unit = |name: &Value, mut line: Value| {
        let parameter = parameters.iter().find(|of| of["name"] == *name);
        line["name"] = name.clone();
        line["unit"] = parameter.map_or(Value::Null, |of| of["unit"].clone());
        line
    };
    let mut all = vec![
        ("summary.csv", summary(found)),
        ("parameters.csv", view(parameters, &columns(PARAMETERS))),
        ("covariance.csv", square(&titles, &found["covariance"])),
        ("correlation.csv", square(&names, &found["correlation"])),
        ("singular-values.csv", singular_values(found, &names)),
        ("starts.csv", starts(found, parameters)),
    ];
    match more {
        More::Nothing => {}
        More::Profiles(_) => all.extend(profiles(list(&found["profiles"]), &with_unit)),
        More::Sampled(sampled) => {
            // Nothing of a chain that has not converged.
            let Ok(posterior) = &sampled.posterior else { return all };
            let lines = list(&found["posterior"]["parameters"]).iter();
            let lines: Vec<Value> =
                lines.map(|line| with_unit(&line["name"], line.clone())).collect();
            let count = posterior.samples.first().map_or(0, Vec::len);
            let sample = |at: usize| posterior.samples.iter().map(move |of| of[at].into());
            all.push(("posterior.csv", view(&lines, &columns(POSTERIOR))));
            all.push(("samples.csv", table(titles, (0..count).map(sample))));
        }
    }
    all
}

fn summary(found: &Value) -> String {
    let mut all = found.clone();
    let disagreements = list(&found["jacobian_disagreement"]).iter().filter_map(Value::as_f64);
    all["worst_disagreement"] = disagreements.fold(0.0, f64::max).into();
    if found["converged"] == true {
        all["combinations_determined"] = determined(found).into();
    }
    quantities(&all, &columns(SUMMARY))
}

/// How many combinations of the parameters the data determine.
fn determined(found: &Value) -> usize {
    list(&found["singular_values"]).len() - list(&found["not_determined"]).len()
}

/// One line a singular value, with the combination of scaled parameters it belongs to.
fn singular_values(found: &Value, names: &[String]) -> String {
    let titles = ["singular_value", "determined"].into_iter();
    let pairs = list(&found["singular_values"]).iter().zip(list(&found["directions"]));
    let lines = pairs.enumerate().map(|(at, (value, direction))| {
        let cells = [value.clone(), (at < determined(found)).into()];
        cells.into_iter().chain(list(direction).iter().cloned())
    });
    table(titles.chain(names.iter().map(String::as_str)), lines)
}

/// One line a start: where it came to.
fn starts(found: &Value, parameters: &[Value]) -> String {
    let of_all = |key: &'static str| {
        parameters.iter().enumerate().map(move |(at, of)| -> Column {
            let [name, unit] = ["name", "unit"].map(|key| of[key].as_str().unwrap_or_default());
            (titled(&format!("{name} {key}"), unit), format!("/{key}/{at}"))
        })
    };
    let shown = columns("cost,iterations").into_iter().chain(of_all("from")).chain(of_all("to"));
    view(list(&found["starts"]), &shown.collect::<Vec<_>>())
}

/// One line a value of a profile, and one line an interval: an end that the data do not give says
/// what stopped the search there.
fn profiles(profiles: &[Value], with_unit: &dyn Fn(&Value, Value) -> Value) -> [Table; 2] {
    let points = profiles.iter().flat_map(|of| {
        let points = list(&of["values"]).iter().zip(list(&of["chi_square_rise"]));
        points.map(|(value, rise)| with_unit(&of["name"], json!({ "value": value, "rise": rise })))
    });
    let intervals = profiles.iter().flat_map(|of| {
        list(&of["intervals"]).iter().map(|one| {
            let [lower, upper] = ["lower", "upper"].map(|end| self::end(&one[end]));
            let line = json!({ "rise": one["rise"], "lower": lower, "upper": upper });
            with_unit(&of["name"], line)
        })
    });
    let (points, intervals): (Vec<Value>, Vec<Value>) = (points.collect(), intervals.collect());
    let of_intervals = "name,unit,chi_square_rise=rise,lower=lower/0,lower_is=lower/1,upper=upper/0,upper_is=upper/1";
    [
        ("profiles.csv", view(&points, &columns("name,unit,value,chi_square_rise=rise"))),
        ("intervals.csv", view(&intervals, &columns(of_intervals))),
    ]
}

/// Where an interval ends, and what that is.
fn end(of: &Value) -> (&Value, &'static str) {
    let special = of.as_object().and_then(|of| of.iter().next());
    special.map_or((of, "end"), |(what, value)| match what.as_str() {
        "bound" => (value, "bound"),
        "beyond" => (value, "open beyond"),
        _ => (value, "model fails beyond"),
    })
}

/// One line a model, as it was given; those without a minimum have a chi-square alone.
fn comparison(alternatives: &AlternativeModels) -> String {
    let mut lines = results::models(alternatives);
    if let Some(found) = &alternatives.comparison {
        for (line, criteria) in lines.iter_mut().zip(&found.criteria) {
            line["free"] = criteria.parameters.into();
        }
    }
    lines.extend(results::without_minimum(alternatives));
    view(&lines, &columns(COMPARISON))
}
