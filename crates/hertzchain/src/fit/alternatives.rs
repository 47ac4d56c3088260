//! Other models of the same data.

use super::{best_fit, finer, fit_settings};
use crate::failure::Failure;
use crate::inference::{self, check_cancelled, is_meant, unit_changes, user};
use crate::options::{
    Accuracy, Against, Assignment, FitOptions as Arguments, ParameterOptions as Freed,
};
use hertzchain_experiment::{Experiment, PathError};
use hertzchain_infer::{
    Compared, Comparison, CrossValidation, CurveProblem, Fit, Folding, FreeNumber, Problem,
    compare, cross_validate, same_number,
};

/// A model that was fitted to the same data.
pub struct AlternativeModel {
    /// Its name, with what is free.
    pub name: String,
    /// Its fit.
    pub fit: Fit,
    /// How well it foretells what it has not seen; `None` where so few speeds are left that they
    /// would not determine it.
    pub foretells: Option<CrossValidation>,
    /// What is set in the fit's own model, and is not there in this one.
    pub without: Vec<String>,
    /// Numbers of this one that are kept while their unit changes.
    pub kept: Vec<String>,
}

/// A model that found no minimum.
pub struct Unfitted {
    /// Its name, with what is free.
    pub name: String,
    /// How far from the data it ended.
    pub chi_square: f64,
    /// Why it ended there.
    pub why: String,
}

/// All models, the fit's own first, and what the data say of them.
pub struct AlternativeModels {
    /// Models.
    pub all: Vec<AlternativeModel>,
    /// Models that found no minimum, and so are out of the comparison.
    pub lost: Vec<Unfitted>,
    /// Their comparison, if at least two are left.
    pub comparison: Option<Comparison>,
}

/// Fits the other models to the same data, if any are asked for.
pub(super) fn alternatives(
    (problem, kept): (&CurveProblem, &dyn Problem),
    own: &Fit,
    arguments: &Arguments,
) -> Result<Option<AlternativeModels>, Failure> {
    if arguments.against.is_empty() {
        return Ok(None);
    }
    let name =
        format!("{} ({})", problem.model().experiment.name(), arguments.freed.free.join(", "));
    let mut all = vec![alternative(name, (problem, kept), own.clone(), arguments.seed)?];
    let mut lost = Vec::new();
    for against in &arguments.against {
        match other(against, problem, arguments)? {
            Ok(alternative) => all.push(alternative),
            Err(without) => lost.push(without),
        }
    }
    let compared: Vec<Compared<'_>> = all
        .iter()
        .map(|alternative| Compared {
            name: &alternative.name,
            fit: &alternative.fit,
            cross_validation: alternative.foretells.as_ref(),
        })
        .collect();
    let comparison = match compared.len() {
        1 => None,
        _ => Some(compare(&compared).map_err(user)?),
    };
    Ok(Some(AlternativeModels { all, lost, comparison }))
}

fn other(
    against: &Against,
    problem: &CurveProblem,
    arguments: &Arguments,
) -> Result<Result<AlternativeModel, Unfitted>, Failure> {
    let name = format!("{} ({})", against.model, against.free.join(", "));
    let of_rival = |failure| match failure {
        Failure::User(why) => Failure::User(format!("--against {name}: {why}")),
        other => other,
    };
    let (of_other, without) = other_problem(against, problem, arguments).map_err(of_rival)?;
    let reported = unit_changes(of_other.model(), &arguments.modelled.set);
    let (of_other, fit) =
        best_fit(of_other, 0, &fit_settings(arguments), finer).map_err(of_rival)?;
    if !fit.ending.converged() {
        return Ok(Err(Unfitted {
            chi_square: fit.chi_square(),
            why: fit.ending.to_string(),
            name,
        }));
    }
    let alternative = alternative(name.clone(), (&of_other, &of_other), fit, arguments.seed);
    let alternative = alternative.map_err(of_rival)?;
    Ok(Ok(AlternativeModel { without, kept: reported, ..alternative }))
}

/// The same data against another model, in which everything is set and known that is
/// in the fit's own, as far as it has such numbers; and settings that it has not.
fn other_problem(
    against: &Against,
    problem: &CurveProblem,
    arguments: &Arguments,
) -> Result<(CurveProblem, Vec<String>), Failure> {
    let mut modelled = arguments.modelled.of_other(&against.model);
    // A model far from the data is steep there: its noise would hide the minimum.
    modelled.accuracy = Accuracy(modelled.accuracy.0.min(ALTERNATIVES_ACCURACY));
    let data = problem.data().clone();
    let sets = std::mem::take(&mut modelled.set);
    let plain = inference::experiment(&modelled, Some(&data.case))?;
    let (experiment, without) = set_where_known(plain, &sets)?;
    let own = &problem.model().experiment;
    let freed = renamed(&arguments.freed, own, &against.free, &experiment);
    let model = inference::model(&experiment, &modelled, &freed)?;
    let parameters = model.numbers.parameters(&data.speeds_m_s());
    let is_there = |one: &Assignment| {
        let mut names = parameters.iter().map(|p| &p.name);
        names.any(|name| is_meant(&one.name, name)).then(|| one.clone())
    };
    let of_other = inference::problem(model, data, &freed.each(is_there))?;
    Ok((of_other, without))
}

/// The experiment with those numbers set that it has, and the settings left out.
fn set_where_known(
    mut experiment: Experiment,
    sets: &[Assignment],
) -> Result<(Experiment, Vec<String>), Failure> {
    let mut without = Vec::new();
    for set in sets {
        let is_unknown = matches!(experiment.place(&set.name), Err(PathError::Unknown { .. }));
        match is_unknown && FreeNumber::find(&experiment, &set.name, Some(1.0)).is_err() {
            true => without.push(set.to_string()),
            false => experiment = inference::changed(experiment, std::slice::from_ref(set))?,
        }
    }
    Ok((experiment, without))
}

/// What is known of numbers, by the names that a rival frees them by.
fn renamed(known: &Freed, own: &Experiment, free: &[String], alternative: &Experiment) -> Freed {
    let name = |given: &Assignment| {
        let of_own = known.free.iter().map(|name| plain(name));
        let number = of_own.filter(|number| is_of(&given.name, number));
        let number = number.max_by_key(|number| number.len())?;
        let of_rival = free.iter().map(|name| plain(name));
        let mut same = of_rival
            .filter(|other| *other == number || same_number((own, number), (alternative, other)));
        Some(format!("{}{}", same.next()?, &given.name[number.len()..]))
    };
    let freed = Freed { free: free.to_vec(), ..known.clone() };
    freed.each(|given| Some(Assignment { name: name(given)?, text: given.text.clone() }))
}

/// A number's name without how it depends on speed.
fn plain(name: &str) -> &str {
    name.split(':').next().unwrap_or_default().trim()
}

/// Whether a name is that of a number or of one of its parameters.
fn is_of(name: &str, number: &str) -> bool {
    let rest = name.strip_prefix(number);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '@']))
}

/// Relative accuracy of other models' times of flight.
const ALTERNATIVES_ACCURACY: f64 = 1e-6;

fn alternative(
    name: String,
    (problem, kept): (&CurveProblem, &dyn Problem),
    fit: Fit,
    seed: u64,
) -> Result<AlternativeModel, Failure> {
    // What was measured at one speed is left out together.
    let groups = problem.measured().into_iter().map(|(_, row, _)| row).collect();
    let how = Folding { groups, parts: Some(PARTS.min(problem.data().rows.len())), seed };
    let foretells = enough(problem.data().rows.len(), fit.point.len())
        .then(|| cross_validate(kept, &fit, &how))
        .transpose();
    check_cancelled()?;
    let foretells = foretells.map_err(|error| Failure::User(format!("{name}: {error}")))?;
    Ok(AlternativeModel { name, fit, foretells, without: Vec::new(), kept: Vec::new() })
}

/// Whether more speeds are left than numbers are free when the largest part is left out. A
/// speed's two times share the error of its speed, so that they count as one.
fn enough(speeds: usize, free: usize) -> bool {
    let parts = PARTS.min(speeds).max(1);
    speeds - speeds.div_ceil(parts) > free
}

/// Parts into which rows are dealt for cross-validation.
const PARTS: usize = 5;

#[cfg(test)]
#[path = "tests/alternatives.rs"]
mod tests;
