//! A fit as tables (CSV), in SI: what `fit.json` holds, and the samples of a posterior.

use super::alternatives::AlternativeModels;
use super::more::{More, Sampled};
use super::{FitResult, Inferred, TableFit};
use crate::csv::{Cell, Csv, square};
use hertzchain_infer::{
    Comparison, Diagnosis, End, Interval, Observable, Parameter, Posterior, Profile, titled,
};

/// A file's name and what stands in it.
pub(crate) type Table = (&'static str, String);

/// Every table of a fit of a curve.
pub fn tables(fit_result: &FitResult) -> Vec<Table> {
    let mut all = vec![("fit.csv", rows(fit_result))];
    all.extend(of_any(&fit_result.inferred));
    let alternatives = fit_result.alternatives.as_ref();
    all.extend(alternatives.map(|alternatives| ("comparison.csv", comparison(alternatives))));
    all
}

/// Tables that any fit has.
pub fn of_any(fit_result: &Inferred) -> Vec<Table> {
    let parameters = &fit_result.parameters;
    let names: Vec<&str> = parameters.iter().map(|p| p.name.as_str()).collect();
    let titles: Vec<String> = parameters.iter().map(Parameter::title).collect();
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    let covariance = &fit_result.covariance;
    let entry = |i: usize, j: usize| Some(covariance.matrix[i][j]);
    let correlation = |i: usize, j: usize| covariance.correlation(i, j);
    let mut all = vec![
        ("summary.csv", summary(fit_result)),
        ("parameters.csv", self::parameters(fit_result)),
        ("covariance.csv", square(&titles, entry).text()),
        ("correlation.csv", square(&names, correlation).text()),
        ("singular-values.csv", singular_values(fit_result, &names)),
        ("starts.csv", starts(fit_result)),
    ];
    match &fit_result.more {
        More::Nothing => {}
        More::Profiles(found) => {
            all.push(("profiles.csv", profiles(parameters, found)));
            all.push(("intervals.csv", intervals(parameters, found)));
        }
        More::Sampled(sampled) => all.extend(sampled_tables(parameters, sampled)),
    }
    all
}

/// One line a number of the whole fit.
fn summary(fit_result: &Inferred) -> String {
    let (fit, goodness) = (&fit_result.fit, &fit_result.goodness);
    let (chi_square, runs) = (goodness.chi_square, goodness.runs);
    let lines: [(&str, Cell); 12] = [
        ("converged", fit.ending.converged().into()),
        ("cost", fit.cost.into()),
        ("chi_square", chi_square.map(|c| c.value).into()),
        ("freedom", chi_square.map(|c| c.freedom).into()),
        ("probability", chi_square.map(|c| c.probability).into()),
        ("runs", runs.map(|r| r.count).into()),
        ("runs_expected", runs.map(|r| r.expected).into()),
        ("runs_probability_fewer", runs.map(|r| r.probability_fewer).into()),
        ("runs_probability_more", runs.map(|r| r.probability_more).into()),
        ("jacobian_disagreement", fit.jacobian.worst_disagreement().into()),
        ("singular_value_floor", fit_result.identifiability.floor.into()),
        (
            "combinations_determined",
            (fit.ending.converged()).then(|| fit_result.identifiability.determined()).into(),
        ),
    ];
    let line = |(name, value): (&str, Cell)| [name.into(), value];
    Csv::new(["quantity", "value"]).with_all(lines, line).text()
}

fn parameters(fit_result: &Inferred) -> String {
    let titles = "name,unit,value,standard_error,determined,at_bound,limit_68,limit_95,start,lower,upper,scale";
    let line = |(at, parameter): (usize, &Parameter)| -> [Cell; 12] {
        let sd = fit_result.standard_error(at);
        let is_bound = fit_result.fit.is_bound(at);
        let limit = |which: usize| fit_result.limit(at)?.ends[which].closed();
        [
            parameter.name.clone().into(),
            parameter.unit.clone().into(),
            fit_result.fit.point[at].into(),
            (!is_bound).then_some(sd).into(),
            sd.is_finite().into(),
            is_bound.into(),
            limit(0).into(),
            limit(1).into(),
            parameter.start.into(),
            parameter.lower.into(),
            parameter.upper.into(),
            parameter.scale.into(),
        ]
    };
    let table = Csv::new(titles.split(','));
    table.with_all(fit_result.parameters.iter().enumerate(), line).text()
}

/// One line a singular value, with the combination of scaled parameters it belongs to.
fn singular_values(fit_result: &Inferred, names: &[&str]) -> String {
    let found = &fit_result.identifiability;
    let titles = ["singular_value", "determined"].into_iter();
    let line = |(at, value): (usize, &f64)| {
        let cells = [Cell::from(*value), (at < found.determined()).into()].into_iter();
        let direction = found.directions[at].iter();
        cells.chain(direction.map(|share| Cell::from(*share))).collect::<Vec<_>>()
    };
    let table = Csv::new(titles.chain(names.iter().copied()));
    table.with_all(found.singular_values.iter().enumerate(), line).text()
}

/// One line a start: where it came to.
fn starts(fit_result: &Inferred) -> String {
    let titles = ["cost".to_owned(), "iterations".to_owned()].into_iter();
    let named = |word: &'static str| {
        let title = move |p: &Parameter| titled(&format!("{} {word}", p.name), &p.unit);
        fit_result.parameters.iter().map(title)
    };
    let (from, to) = (named("from"), named("to"));
    let table = Csv::new(titles.chain(from).chain(to));
    let line = |start: &hertzchain_infer::Started| {
        let cells = [Cell::from(start.cost), start.iterations.into()].into_iter();
        let points = start.start.iter().chain(&start.point);
        cells.chain(points.map(|value| Cell::from(*value))).collect::<Vec<_>>()
    };
    table.with_all(&fit_result.fit.starts, line).text()
}

/// One line a value of a profile.
fn profiles(parameters: &[Parameter], profiles: &[Profile]) -> String {
    let lines = profiles.iter().flat_map(|profile| {
        let points = profile.values.iter().zip(&profile.rise);
        points.map(move |(value, rise)| (&parameters[profile.parameter], *value, *rise))
    });
    let line = |(of, value, rise): (&Parameter, f64, f64)| -> [Cell; 4] {
        [of.name.clone().into(), of.unit.clone().into(), value.into(), rise.into()]
    };
    Csv::new(["name", "unit", "value", "chi_square_rise"]).with_all(lines, line).text()
}

/// One line an interval of a profile; an end that the data do not give says what
/// stopped the search there.
fn intervals(parameters: &[Parameter], profiles: &[Profile]) -> String {
    let lines = profiles.iter().flat_map(|profile| {
        let of = &parameters[profile.parameter];
        profile.intervals.iter().map(move |interval| (of, interval))
    });
    let line = |(of, interval): (&Parameter, &Interval)| -> [Cell; 7] {
        let (lower, lower_is) = end(interval.lower);
        let (upper, upper_is) = end(interval.upper);
        [
            of.name.clone().into(),
            of.unit.clone().into(),
            interval.level.into(),
            lower.into(),
            lower_is.into(),
            upper.into(),
            upper_is.into(),
        ]
    };
    let titles = "name,unit,chi_square_rise,lower,lower_is,upper,upper_is";
    Csv::new(titles.split(',')).with_all(lines, line).text()
}

fn end(end: End) -> (f64, &'static str) {
    match end {
        End::At(value) => (value, "end"),
        End::Bound(value) => (value, "bound"),
        End::Open(value) => (value, "open beyond"),
        End::ModelFails(value) => (value, "model fails beyond"),
    }
}

/// Summary and samples of a posterior; nothing of a chain that has not converged.
fn sampled_tables(parameters: &[Parameter], sampled: &Sampled) -> Vec<Table> {
    let Ok(posterior) = &sampled.posterior else {
        return Vec::new();
    };
    let count = posterior.samples.first().map_or(0, Vec::len);
    let line =
        |at: usize| posterior.samples.iter().map(move |of| Cell::from(of[at])).collect::<Vec<_>>();
    let samples = Csv::new(parameters.iter().map(Parameter::title)).with_all(0..count, line);
    vec![("posterior.csv", posterior_table(parameters, posterior)), ("samples.csv", samples.text())]
}

fn posterior_table(parameters: &[Parameter], posterior: &Posterior) -> String {
    let titles = "name,unit,mean,sd,median,lower_68,upper_68,lower_95,upper_95,autocorrelation_time,r_hat,effective_samples";
    let line = |(at, found): (usize, &Diagnosis)| -> [Cell; 12] {
        let [lower, upper] = posterior.interval(at, super::SHARE_OF_A_STANDARD_ERROR);
        let [least, most] = posterior.interval(at, 0.95);
        [
            parameters[at].name.clone().into(),
            parameters[at].unit.clone().into(),
            posterior.mean[at].into(),
            posterior.sd(at).into(),
            posterior.quantile(at, 0.5).into(),
            lower.into(),
            upper.into(),
            least.into(),
            most.into(),
            found.time.time.into(),
            found.r_hat.into(),
            found.effective.into(),
        ]
    };
    let table = Csv::new(titles.split(','));
    table.with_all(posterior.diagnoses.iter().enumerate(), line).text()
}

/// One line a model, as it was given; those without a minimum have a chi-square alone.
fn comparison(alternatives: &AlternativeModels) -> String {
    let titles = "model,free,chi_square,freedom,probability,aic,aicc,bic,weight,prediction_error,prediction_error_error";
    let found = alternatives.comparison.as_ref();
    let numbered = alternatives.all.iter().enumerate();
    let evaluated = |at: usize, found: &Comparison| -> [Cell; 7] {
        let criteria = &found.criteria[at];
        [
            criteria.parameters.into(),
            criteria.chi_square.map(|found| found.freedom).into(),
            criteria.chi_square.map(|found| found.probability).into(),
            criteria.aic.into(),
            criteria.aicc.into(),
            criteria.bic.into(),
            found.weights[at].into(),
        ]
    };
    let line = |(at, alternative): (usize, &super::AlternativeModel)| -> [Cell; 11] {
        let none = || [const { Cell::Empty }; 7];
        let [free, freedom, p, aic, aicc, bic, weight] =
            found.map_or_else(none, |found| evaluated(at, found));
        let (name, chi_square) =
            (alternative.name.clone().into(), alternative.fit.chi_square().into());
        let foretells = alternative.foretells.as_ref();
        let (mean, error) = (foretells.map(|f| f.mean).into(), foretells.map(|f| f.error).into());
        [name, free, chi_square, freedom, p, aic, aicc, bic, weight, mean, error]
    };
    let lost = |lost: &super::Unfitted| -> [Cell; 11] {
        let mut cells = [const { Cell::Empty }; 11];
        cells[0] = lost.name.clone().into();
        cells[2] = lost.chi_square.into();
        cells
    };
    let table = Csv::new(titles.split(',')).with_all(numbered, line);
    table.with_all(&alternatives.lost, lost).text()
}

/// One line a measured value.
fn rows(fit_result: &FitResult) -> String {
    let tables = fit_result.tables();
    let several = (tables.len() > 1).then_some("file");
    let titles = "line,speed_m_s,observable,measured,error,fitted,fitted_error,residual".split(',');
    let all = tables.iter().flat_map(|table| {
        let measured = table.curve.measured().zip(table.residuals);
        measured.map(move |line| (table, line))
    });
    let line = |(table, ((at, of), residual)): (&TableFit<'_>, ((usize, Observable), &f64))| {
        let data = &table.curve.data;
        let row = &data.rows[at];
        let (value, curve) = (row.value(of), table.fit_curve);
        let predicted = curve.predicted.get(at).and_then(|row| row[of as usize]);
        let cells: [Cell; 8] = [
            row.line.to_string().into(),
            row.speed_m_s.value.into(),
            of.column().into(),
            value.map(|value| value.value).into(),
            value.map(|value| value.sigma).into(),
            predicted.into(),
            curve.sd.get(at).map(|row| row[of as usize]).into(),
            (*residual).into(),
        ];
        let file = several.map(|_| Cell::from(data.file.clone()));
        cells.into_iter().chain(file).collect::<Vec<_>>()
    };
    Csv::new(titles.chain(several)).with_all(all, line).text()
}
