//! A fit for people.

use super::Fitted;
use crate::format::{self, digits};
use crate::inference::words::{doubt, estimate, percent};
use crate::print::heading;
use hertzchain_infer::{Goodness, Observable, Problem};

/// The solver's error may be this share of the least standard error.
const MOST_SHARE: f64 = 0.1;

/// Everything that is to be said.
pub fn text(fitted: &Fitted) -> String {
    let data = fitted.problem.data();
    let case = match data.case.as_str() {
        "" => String::new(),
        case => format!(", {case}"),
    };
    let title = fitted.problem.model().experiment().title();
    let mut text = format!(
        "{}\n{}{case}: {} values at {} speeds\n\n{}\n",
        heading(title),
        data.file,
        data.value_count(),
        data.rows.len(),
        values(fitted)
    );
    text += &correlations(fitted);
    text += &goodness(&fitted.goodness, &fitted.problem);
    text += &accuracy(fitted);
    text += &doubt(&fitted.fit.ending).map_or(String::new(), |doubt| format!("Beware: {doubt}\n"));
    if fitted.fit.starts.len() > 1 {
        let (agree, all) = (fitted.fit.agreeing_starts(), fitted.fit.starts.len());
        text += &format!("{agree} of {all} starts came to this minimum.\n");
    }
    text
}

fn values(fitted: &Fitted) -> String {
    let parameters = fitted.problem.parameters().iter().enumerate();
    let row = |(at, parameter): (usize, &hertzchain_infer::Parameter)| {
        let (value, sd) = (fitted.fit.point[at], fitted.covariance.sd[at]);
        (parameter.name.clone(), estimate(parameter, value, sd))
    };
    format::pairs(&parameters.map(row).collect::<Vec<_>>())
}

/// Pairs whose correlation is worth a line.
const TOLD: f64 = 0.5;

fn correlations(fitted: &Fitted) -> String {
    let parameters = fitted.problem.parameters();
    let mut text = String::new();
    for (i, one) in parameters.iter().enumerate() {
        for (j, other) in parameters.iter().enumerate().skip(i + 1) {
            let Some(value) = fitted.covariance.correlation(i, j) else {
                continue;
            };
            if value.abs() >= TOLD {
                let value = digits(value, 3);
                text += &format!("Correlation of {} and {}: {value}\n", one.name, other.name);
            }
        }
    }
    text
}

/// Chi-square, runs and the worst residual.
fn goodness(goodness: &Goodness, problem: &dyn Problem) -> String {
    let mut text = String::new();
    if let Some(c) = goodness.chi_square {
        text += &format!(
            "Chi-square {} with {} degrees of freedom: as much or more in {} of repetitions\n",
            digits(c.value, 4),
            c.freedom,
            percent(c.probability)
        );
    }
    if let Some(runs) = goodness.runs {
        text += &format!(
            "{} runs of equal sign, {} expected: as few or fewer in {} of repetitions\n",
            runs.count,
            digits(runs.expected, 3),
            percent(runs.probability_fewer)
        );
    }
    if let Some((at, residual)) = goodness.farthest {
        let label = problem.residual_label(at);
        text += &format!(
            "Farthest: {label}, by {} standard errors\n",
            digits(residual, 2)
        );
    }
    text
}

/// The model's own error against the data's.
fn accuracy(fitted: &Fitted) -> String {
    let rows = fitted.problem.data().rows.iter();
    let times = rows.flat_map(|row| row.values.iter().take(2).flatten());
    let relative = times.map(|time| time.sigma / time.value);
    let least = relative.fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return String::new();
    }
    let share = fitted.accuracy / least;
    let told = format!(
        "The model's times of flight are right to {:.0e}, {} of the least standard error",
        fitted.accuracy,
        percent(share)
    );
    match share > MOST_SHARE {
        true => format!("{told}: ask for more by --accuracy\n"),
        false => format!("{told}\n"),
    }
}

/// What observables are called where space is short.
pub fn short(of: Observable) -> &'static str {
    match of {
        Observable::Incident => "incident",
        Observable::Reflected => "reflected",
        Observable::WallOverPassing => "wall/passing",
        Observable::ReturningOverPassing => "returning/passing",
    }
}
