//! A fit for people.

use crate::fit::{AlternativeModels, Curves, FitResult, Inferred, Limit, More, Sampled, TableFit};
use crate::inference::{references, widened};
use crate::options::FitOptions as Arguments;
use crate::program::words::{doubt, p_value, rough};
use crate::program::{chi_square_text, digits, estimate, format, heading, lines, misfit, percent};
use hertzchain_infer::{
    Advice, Comparison, End, Goodness, Loss, ModelError, Observable, Parameter, Prior, Profile,
    Runs, Started,
};

/// The solver's error may be this share of the least standard error.
const MOST_SHARE: f64 = 0.1;

pub(super) fn text(fit_result: &FitResult, arguments: &Arguments) -> String {
    let all = fit_result.tables();
    let titles: String = all.iter().map(|table| title(table, all.len() > 1)).collect();
    let mut references: Vec<String> =
        all.iter().flat_map(|table| references(&table.curve.model)).collect();
    references.dedup();
    let mut text = format!("{titles}\n{}\n{}", values(&fit_result.inferred), lines(references));
    text += &described(&fit_result.inferred);
    text += &accuracy(fit_result);
    text += &lines(fit_result.unasked(arguments));
    text += &lines(all.iter().filter_map(|table| widened(&table.curve.data)));
    let advice = fit_result.advice.as_ref();
    text += &determined(&fit_result.inferred, &|| advice.map_or(Vec::new(), Advice::words));
    text += &more(&fit_result.inferred);
    text += &fit_result.alternatives.as_ref().map_or(String::new(), alternatives);
    text += &warnings(&fit_result.inferred);
    let pairs = fit_result.pair_warning();
    text += &pairs.map_or(String::new(), |reported| format!("warning: {reported}.\n"));
    text + &unit(fit_result)
}

/// A table and its model; of several, its share of χ² too.
fn title(table: &TableFit<'_>, of_several: bool) -> String {
    let data = &table.curve.data;
    let case = match data.case.as_str() {
        "" => String::new(),
        case => format!(", {case}"),
    };
    let mut distinct = data.speeds_m_s();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    let speeds = match distinct.len() {
        1 => "1 speed".to_owned(),
        speeds => format!("{speeds} speeds"),
    };
    let share = match of_several {
        true => format!(", χ² = {}", digits(table.chi_square(), 4)),
        false => String::new(),
    };
    format!(
        "{}\n{}{case}: {} values at {speeds}{share}\n",
        heading(table.curve.model.experiment.title()),
        data.file,
        data.value_count(),
    )
}

fn unit(fit_result: &FitResult) -> String {
    fit_result.unit_of_speed.as_ref().map_or(String::new(), |(file, unit)| {
        format!(
            "warning: {file}: speeds look like {unit}, expected m/s (column speed_m_s, all lines): the model has such \
             times of flight at speeds that many times slower\n"
        )
    })
}

pub(super) fn described(inferred: &Inferred) -> String {
    correlations(inferred)
        + &goodness(&inferred.goodness)
        + &robust(inferred)
        + &derivatives(inferred)
}

/// Which loss was robust, and what it makes of the errors.
fn robust(inferred: &Inferred) -> String {
    let loss = inferred.fit.loss;
    if loss == Loss::Squares {
        return String::new();
    }
    format!(
        "Robust loss ({}): {} of {} residuals, those beyond {} standard errors, count by their size; \
         the covariance is {} times that of least squares, but for what priors say\n",
        loss.name(),
        inferred.fit.beyond_loss(),
        inferred.fit.residuals.len(),
        loss.scale(),
        digits(inferred.covariance.loss_factor, 3)
    )
}

fn derivatives(inferred: &Inferred) -> String {
    let worst = inferred.fit.jacobian.worst_disagreement();
    format!("Derivatives by two step sizes agree within {}\n", percent(worst))
}

pub(super) fn warnings(inferred: &Inferred) -> String {
    let doubt = doubt(&inferred.fit.ending);
    let mut text = doubt.map_or(String::new(), |doubt| format!("warning: {doubt}\n"));
    text += &edges(inferred);
    let rough = rough(&inferred.parameters, &inferred.fit.jacobian);
    text += &rough.map_or(String::new(), |reported| format!("warning: {reported}.\n"));
    text += &misfit(&inferred.goodness)
        .map_or(String::new(), |reported| format!("warning: {reported}.\n"));
    if let Err(why) = &inferred.limits {
        text += &format!("No limit of parameters at bounds: {why}\n");
    }
    if inferred.fit.starts.len() > 1 {
        let (agree, all) = (inferred.fit.agreeing_starts(), inferred.fit.starts.len());
        text += &format!("{agree} of {all} starts came to this minimum.\n");
    }
    text + &other_minima(inferred)
}

/// That the best fit is next to where the model can't be computed.
fn edges(inferred: &Inferred) -> String {
    let line = |(at, error): &(usize, ModelError)| {
        format!(
            "warning: the model fails next to this {}: {error}. The fit can't go beyond, and its errors say nothing of \
             that\n",
            inferred.parameters[*at].name
        )
    };
    inferred.fit.jacobian.failing.iter().map(line).collect()
}

/// Other minima that fit as well: errors hold for one of them.
fn other_minima(inferred: &Inferred) -> String {
    let minima = inferred.other_minima();
    if minima.is_empty() {
        return String::new();
    }
    let line = |(start, count): &(&Started, usize)| {
        let values = inferred.parameters.iter().zip(&start.point);
        let values = values.map(|(parameter, value)| {
            format!("{} = {} {}", parameter.name, digits(*value, 6), parameter.unit)
        });
        format!(
            "  {} (χ² {} by {}, {count} starts)\n",
            values.collect::<Vec<_>>().join(", ").trim_end(),
            if start.cost < inferred.fit.cost { "lower" } else { "higher" },
            digits(2.0 * (start.cost - inferred.fit.cost).abs(), 2)
        )
    };
    let lines: String = minima.iter().map(line).collect();
    format!(
        "warning: other starts came to other minima that fit as well; errors and intervals hold for the one above:\n{lines}"
    )
}

pub(super) fn values(inferred: &Inferred) -> String {
    let parameters = inferred.parameters.iter().enumerate();
    let row = |(at, parameter): (usize, &Parameter)| {
        let (value, sd) = (inferred.fit.point[at], inferred.standard_error(at));
        let limit = inferred.limit(at).map(limit).unwrap_or_default();
        let prior = match parameter.prior {
            Prior::Normal { mean, sd } => format!(", prior {}", estimate(parameter, mean, sd)),
            _ => String::new(),
        };
        (parameter.name.clone(), estimate(parameter, value, sd) + &limit + &prior)
    };
    format::pairs(parameters.map(row))
}

/// What the data say of a parameter at its bound.
fn limit(limit: &Limit) -> String {
    let end = |end: End| match end {
        End::At(value) => digits(value, 6),
        End::Bound(value) => format!("its other bound {}", digits(value, 3)),
        End::Open(value) => format!("no limit as far as {}", digits(value, 3)),
        End::ModelFails(value) => {
            format!("no limit up to {}, where the model fails", digits(value, 3))
        }
    };
    let [narrow, wide] = limit.ends.map(end);
    format!(": {} {narrow} (68 %), {wide} (95 %) by profile", limit.side())
}

/// Pairs whose correlation is worth a line.
const REPORTED: f64 = 0.5;

const PAIRS: usize = 6;

fn correlations(inferred: &Inferred) -> String {
    let name = |at: usize| &inferred.parameters[at].name;
    let count = inferred.parameters.len();
    let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
    let known = pairs.filter_map(|(i, j)| Some((i, j, inferred.covariance.correlation(i, j)?)));
    let mut reported: Vec<(usize, usize, f64)> =
        known.filter(|pair| pair.2.abs() >= REPORTED).collect();
    reported.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    let line = |(i, j, value): &(usize, usize, f64)| {
        let value = digits(*value, 3);
        format!("Correlation of {} and {}: {value}\n", name(*i), name(*j))
    };
    let text: String = reported.iter().take(PAIRS).map(line).collect();
    match reported.len().saturating_sub(PAIRS) {
        0 => text,
        more => text + &format!("{more} more correlations of {REPORTED} and above: in fit.json\n"),
    }
}

fn goodness(goodness: &Goodness) -> String {
    let Some(chi_square) = goodness.chi_square else {
        return "ν = 0: as many numbers as parameters\n".to_owned();
    };
    let runs = goodness.runs.map(runs_text);
    let largest = goodness.largest.as_ref();
    let largest =
        largest.map(|of| format!("largest residual: {} σ ({})", digits(of.sigmas, 2), of.label));
    let outliers =
        (goodness.outliers > 0).then(|| format!("{} outliers left out", goodness.outliers));
    let all =
        std::iter::once(chi_square_text(chi_square)).chain(outliers).chain(runs).chain(largest);
    all.collect::<Vec<_>>().join("; ") + "\n"
}

/// The runs test: the probability of a number of runs as unlikely in either direction.
fn runs_text(runs: Runs) -> String {
    let probability = (2.0 * runs.probability_fewer.min(runs.probability_more)).min(1.0);
    let (count, expected) = (runs.count, digits(runs.expected, 3));
    format!("runs test: {} ({count} runs, {expected} expected)", p_value(probability))
}

fn accuracy(fit_result: &FitResult) -> String {
    let rows = fit_result.problem.curves.iter().flat_map(|curve| &curve.data.rows);
    let times = rows.flat_map(|row| row.values.iter().take(2).flatten());
    let relative = times.map(|time| time.sigma / time.value);
    let least = relative.fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return String::new();
    }
    let share = fit_result.accuracy / least;
    let reported = format!(
        "The model's times of flight are right to {:.0e}, {} of the least standard error",
        fit_result.accuracy,
        percent(share)
    );
    match share > MOST_SHARE {
        true => format!("{reported}: ask for more by --accuracy\n"),
        false => format!("{reported}\n"),
    }
}

/// What the data determine and what not, and what would help.
pub(super) fn determined(inferred: &Inferred, advice: &dyn Fn() -> Vec<String>) -> String {
    let found = &inferred.identifiability;
    if !inferred.fit.ending.converged() {
        return "The fit found no minimum: what the data determine is not known where it ended.\n"
            .to_owned();
    }
    let (known, all) = (found.determined(), found.singular_values.len());
    if known == all && inferred.goodness.is_rejected() {
        return String::new();
    }
    if known == all {
        return match all {
            1 => "The data determine it.\n".to_owned(),
            _ => format!("The data determine all {all} combinations of the parameters.\n"),
        };
    }
    let mut text =
        format!("\nThe data determine {known} of {all} combinations of the parameters.\n");
    if inferred.is_closed_by_priors() {
        return text.replace(".\n", ", priors the others.\n");
    }
    for confusion in &found.unidentifiable {
        text += &format!("  Not determined: {}.\n", confusion.words);
    }
    for advice in advice() {
        text += &format!("  What would help: {advice}.\n");
    }
    text
}

pub(super) fn more(inferred: &Inferred) -> String {
    match &inferred.more {
        More::Nothing => String::new(),
        More::Profiles(profiles) => intervals_of_profiles(inferred, profiles),
        More::Sampled(sampled) => sampled_text(inferred, sampled),
    }
}

fn intervals_of_profiles(inferred: &Inferred, profiles: &[Profile]) -> String {
    let end = |end: End| match end {
        End::At(value) => digits(value, 6),
        End::Bound(value) => format!("{} (its bound)", digits(value, 4)),
        End::Open(value) => format!("beyond {}", digits(value, 4)),
        End::ModelFails(value) => format!("{} (where the model fails)", digits(value, 4)),
    };
    let row = |profile: &Profile| {
        let name = inferred.parameters[profile.parameter].title();
        let ends = profile
            .intervals
            .iter()
            .map(|interval| format!("{} to {}", end(interval.lower), end(interval.upper)));
        std::iter::once(name).chain(ends).collect::<Vec<_>>()
    };
    format!("\n{}", format::table(["by profile", "68 %", "95 %"], profiles.iter().map(row)))
}

fn interpolated(error: f64, computed_m_s: &[f64]) -> String {
    let text = format!("curves interpolated, right to {} standard errors", digits(error, 2));
    let speeds: Vec<String> = computed_m_s.iter().map(|speed| digits(*speed, 3)).collect();
    match speeds.is_empty() {
        true => text,
        false => format!("{text}, but computed at {} m/s, where pulses jump", speeds.join(", ")),
    }
}

fn sampled_text(inferred: &Inferred, sampled: &Sampled) -> String {
    let chain = &sampled.chain;
    let how = match &sampled.curves {
        Curves::Computed(None) => "every curve computed".to_owned(),
        Curves::Computed(Some(why)) => format!("every curve computed, as {why}"),
        Curves::Interpolated(error, speeds_m_s) => interpolated(*error, speeds_m_s),
    };
    let text = format!(
        "\nPosterior: {} walkers, {} steps, {} of proposals taken; {how}\n",
        chain.walkers(),
        chain.steps(),
        percent(chain.acceptance())
    );
    let posterior = match &sampled.posterior {
        Err(unconverged) => {
            return text + &format!("No quantiles: {unconverged} (--steps, --resume).\n");
        }
        Ok(posterior) => posterior,
    };
    let interval = |at: usize, share: f64| {
        let [lower, upper] = posterior.interval(at, share);
        format!("{} to {}", digits(lower, 6), digits(upper, 6))
    };
    let row = |(at, parameter): (usize, &Parameter)| {
        let found = &posterior.diagnoses[at];
        vec![
            parameter.title(),
            digits(posterior.quantile(at, 0.5), 6),
            interval(at, 0.682_689_5),
            interval(at, 0.95),
            digits(found.time.time, 3),
            format!("{:.3}", found.r_hat),
            digits(found.effective, 3),
        ]
    };
    let head =
        ["posterior", "median", "68 %", "95 %", "steps correlated", "R-hat", "effective samples"];
    text + &format::table(head, inferred.parameters.iter().enumerate().map(row))
}

fn alternatives(alternatives: &AlternativeModels) -> String {
    let lost = alternatives.lost.iter().map(|lost| {
        format!(
            "{} is far from the data: χ² = {} where it ended ({})\n",
            lost.name,
            digits(lost.chi_square, 4),
            lost.why
        )
    });
    let lost: String = lost.collect();
    let compared = alternatives.comparison.as_ref();
    compared.map_or(String::new(), |found| compared_text(alternatives, found)) + &lost
}

fn compared_text(alternatives: &AlternativeModels, comparison: &Comparison) -> String {
    let row = |&at: &usize| {
        let (alternative, criteria) = (&alternatives.all[at], &comparison.criteria[at]);
        vec![
            alternative.name.clone(),
            criteria.parameters.to_string(),
            digits(criteria.chi_square.map_or(alternative.fit.chi_square(), |of| of.value), 5),
            (criteria.chi_square).map_or("–".to_owned(), |found| found.freedom.to_string()),
            (criteria.chi_square).map_or("–".to_owned(), |found| digits(found.probability, 2)),
            digits(comparison.aicc_above_best[at], 4),
            digits(criteria.bic, 6),
            (alternative.foretells.as_ref())
                .map_or("too few speeds".to_owned(), |f| digits(f.mean, 5)),
        ]
    };
    let head = ["model", "free", "χ²", "ν", "p", "AICc above best", "BIC", "cross-validated score"];
    let table = format::table(head, comparison.order.iter().map(row));
    let without = alternatives.all.iter().filter(|alternative| !alternative.without.is_empty());
    let without = without.map(|alternative| {
        let settings = alternative.without.join(", ");
        format!("{} has no such number: --set {settings} is left out there\n", alternative.name)
    });
    let without: String = without.collect();
    let kept = alternatives.all.iter().flat_map(|alternative| {
        let reported = |kept: &String| format!("{}: {kept}\n", alternative.name);
        alternative.kept.iter().map(reported).collect::<Vec<_>>()
    });
    let kept: String = kept.collect();
    format!("\n{table}{}\n{without}{kept}", comparison.sentence)
}

/// What observables are called where space is short.
pub(super) fn short(of: Observable) -> &'static str {
    match of {
        Observable::Incident => "incident",
        Observable::Reflected => "reflected",
        Observable::WallOverPassing => "wall/incident",
        Observable::ReturningOverPassing => "reflected/incident",
    }
}

#[cfg(test)]
#[path = "tests/report.rs"]
mod tests;
