//! From arguments to a problem of inference.

mod known;
mod reference;
mod unit_changes;
mod warnings;

pub use self::{reference::references, warnings::warnings};
pub(crate) use known::{is_meant, systematic};
pub(crate) use reference::references_json;
pub(crate) use unit_changes::{held_loads, unit_changes};
pub(crate) use warnings::warnings_json;

use crate::failure::{Failure, unread};
use crate::input;
use crate::options::Input;
use crate::options::{
    Assignment, CurveOptions as Measured, ErrorShots, FitOptions, ModelOptions as Modelled,
    ParameterOptions as Freed, Speed, What,
};
use hertzchain_experiment::{Experiment, PathError, Units};
use hertzchain_infer::{
    CurveProblem, Data, DataRow, FEWEST_SHOTS, FreeNumber, FreeNumbers, InferError, Model,
    Observable, Problem, PulseProblem, Scatter, Selection,
};
use hertzchain_measure::records::{peek, text};
use hertzchain_sim::{StudyError, stopped};
use std::fs;
use std::io::Read;
use std::path::Path;

/// A mistake of the user's, reported as it is.
pub fn user(error: impl std::fmt::Display) -> Failure {
    Failure::User(error.to_string())
}

/// Whether a caller still wants the result: what was broken off on the way determines
/// nothing.
///
/// # Errors
/// That it was broken off.
pub(crate) fn check_cancelled() -> Result<(), Failure> {
    match stopped() {
        true => Err(user(StudyError::Stopped)),
        false => Ok(()),
    }
}

/// A measured curve with what is to be used of it: of this case, or of the one that an option names.
///
/// # Errors
/// A table that can't be used.
pub fn data(file: &Path, measured: &Measured, case: Option<&str>) -> Result<Data, Failure> {
    let case = case.map(str::to_owned).or_else(|| measured.case.clone());
    data_of(file, measured, case)
}

/// Whether a file is a table of curves: text whose first line, comments aside, names a column of
/// speeds. What else can be read is a recording, as is text with any other beginning where options
/// of recordings are given: an oscilloscope's preamble.
///
/// # Errors
/// A file that can't be read.
pub fn is_table(file: &Path, with_options_of_recordings: bool) -> Result<bool, Failure> {
    if file.is_dir() {
        return Ok(false);
    }
    let mut begin = Vec::new();
    let copy = peek(file).map_err(unread(file))?;
    let mut opened = fs::File::open(copy).map_err(unread(file))?;
    let probe = opened.by_ref().take(PROBE).read_to_end(&mut begin);
    probe.map_err(unread(file))?;
    let binary = begin.contains(&0) || std::str::from_utf8(&begin).is_err();
    let text = String::from_utf8_lossy(&begin);
    let mut lines = text.lines().map(str::trim);
    let title = lines.find(|line| !line.is_empty() && !line.starts_with('#'));
    let first = title.unwrap_or_default();
    let numbers = first.split([',', ';', '\t']).all(|cell| cell.trim().parse::<f64>().is_ok());
    let times = first.to_ascii_lowercase().contains("time");
    let record = times || with_options_of_recordings;
    Ok(!binary && !numbers && (first.contains(SPEEDS) || !record))
}

/// Bytes that distinguish a table from a recording.
const PROBE: u64 = 4096;

/// The column that makes a table one of curves.
const SPEEDS: &str = "speed_m_s";

/// The same of another case.
pub(crate) fn data_of(
    file: &Path,
    measured: &Measured,
    case: Option<String>,
) -> Result<Data, Failure> {
    let text = text(file).map_err(unread(file))?;
    parsed(&file.display().to_string(), &text, measured, case)
}

/// The same from the text of a table; its name is used in messages.
///
/// # Errors
/// A table that can't be used, by line and column.
pub fn parsed(
    name: &str,
    text: &str,
    measured: &Measured,
    case: Option<String>,
) -> Result<Data, Failure> {
    let selection = Selection {
        case,
        observables: measured.observables.iter().map(|what| (*what).into()).collect(),
        speed_error_m_s: measured.speed_error.map(|error| error.0),
        time_error_s: measured.tof_error.map(|error| error.0),
        ratio_error: measured.ratio_error.map(|error| error.0),
        scatter: match measured.error_shots {
            None => Scatter::AsTold,
            Some(ErrorShots(None)) => Scatter::Known,
            Some(ErrorShots(Some(shots))) => Scatter::Of(shots),
        },
    };
    Data::parse(name, text, &selection).map_err(user)
}

/// What is assumed of data that do not say all: for warnings.
pub(crate) fn assumed(data: &Data, measured: &Measured) -> Option<String> {
    let all = [
        exact_speeds(data, measured),
        few_shots(data),
        uncorrelated(data),
        repeated(data),
        not_there(data, measured),
    ];
    let all: Vec<String> = all.into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// How standard errors are widened that come from few shots.
pub fn widened(data: &Data) -> Option<String> {
    let (rows, [least, most]) = data.widened()?;
    let freedom = match least == most {
        true => format!("{least:.0}"),
        false => format!("{least:.0} to {most:.0}"),
    };
    Some(format!(
        "Errors of {rows} of {} speeds come from the scatter of few shots ({freedom} degrees of freedom) and are \
         widened for that, each by its share of the row",
        data.rows.len()
    ))
}

fn which(data: &Data, lines: &[u64]) -> Option<String> {
    match lines {
        [] => None,
        all if all.len() == data.rows.len() => Some("all lines".to_owned()),
        [one] => Some(format!("line {one}")),
        several => Some(format!("lines {}", listed(several))),
    }
}

fn few_shots(data: &Data) -> Option<String> {
    let which = which(data, &data.lines_of_few_shots())?;
    Some(format!(
        "{}, {which}: errors from the scatter of fewer than {FEWEST_SHOTS} shots are themselves too uncertain to \
         correct for, and are taken as known: intervals are too narrow by an unknown factor. Shoot more, or take \
         errors over many rows (--error-shots known says that they are)",
        data.file
    ))
}

fn repeated(data: &Data) -> Option<String> {
    let same = |pair: &&[DataRow]| {
        (pair[0].speed_m_s, pair[0].values) == (pair[1].speed_m_s, pair[1].values)
    };
    let lines: Vec<u64> = data.rows.windows(2).filter(same).map(|pair| pair[1].line).collect();
    let which = which(data, &lines)?;
    Some(format!(
        "{}, {which}: all numbers are those of another row: what was measured once counts twice, and standard errors \
         come out too small; leave it out",
        data.file
    ))
}

fn uncorrelated(data: &Data) -> Option<String> {
    let which = which(data, &data.lines_without_correlation())?;
    Some(format!(
        "{}, {which}: the errors of incident and reflected times are taken as independent. Both times share the wall's \
         pick, so they usually are not: add a column `tof_correlation`, or `tof_at_mean_speed_correlation` of times at \
         the mean speed, as `hertzchain measure` writes them (0 for independent errors)",
        data.file
    ))
}

/// Numbers that --use names and the table does not have. Of the times that are taken where
/// --use is not given, a table may have one.
fn not_there(data: &Data, measured: &Measured) -> Option<String> {
    if measured.observables == [What::Incident, What::Reflected] {
        return None;
    }
    let wanted = measured.observables.iter().map(|what| Observable::from(*what));
    let missing = wanted.filter(|of| !data.has(*of));
    let missing: Vec<String> = missing.map(|of| format!("`{}`", of.column())).collect();
    (!missing.is_empty()).then(|| {
        format!(
            "{}: --use asks for {}, of which the table has no value: nothing of it is used. Add a column of this title \
             with its errors, as `hertzchain measure` writes them, or leave it out of --use",
            data.file,
            missing.join(" and ")
        )
    })
}

fn exact_speeds(data: &Data, measured: &Measured) -> Option<String> {
    if measured.speed_error == Some(Speed(0.0)) {
        return None;
    }
    let which = which(data, &data.lines_of_exact_speeds())?;
    Some(format!(
        "{}, {which}: speeds without an error, or with one of 0, are taken as exactly known; standard \
         errors are too small if they are not. Add a column `speed_error_m_s` or --speed-error \
         (--speed-error 0 says that they are exact)",
        data.file
    ))
}

/// Numbers with commas, the first dozen of them.
fn listed(lines: &[u64]) -> String {
    let shown = lines.iter().take(LISTED).map(u64::to_string);
    let shown = shown.collect::<Vec<_>>().join(", ");
    match lines.len().saturating_sub(LISTED) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

const LISTED: usize = 12;

/// A model's experiment, in the case of this name if it has one.
pub(crate) fn opened(
    file: Option<&Path>,
    preset: &Option<String>,
    case: &str,
) -> Result<Experiment, Failure> {
    opened_or((file, preset), input::USUAL, case)
}

/// That a model which was not named is the paper's dry chain: the first line of what comes of it.
pub(crate) fn assumed_model(modelled: &Modelled) -> Option<String> {
    let is_named = modelled.model.is_some() || modelled.preset.is_some();
    let options = "--model FILE or --preset NAME";
    (!is_named).then(|| input::assumed_preset("model", "dry chain", input::USUAL, options))
}

/// The same with a preset where neither is named.
pub(crate) fn opened_or(
    (file, preset): (Option<&Path>, &Option<String>),
    usual: &str,
    case: &str,
) -> Result<Experiment, Failure> {
    let input = Input { file: file.map(Path::to_owned), preset: preset.clone() };
    in_case(input::open_or(&input, usual)?, case)
}

/// An experiment as a model, in the case of this name if it has one.
///
/// # Errors
/// A case that has mistakes, or an experiment without units.
pub fn in_case(mut experiment: Experiment, case: &str) -> Result<Experiment, Failure> {
    let cases = experiment.cases();
    match experiment.case(case) {
        Some(chosen) => experiment = chosen?,
        None if case.is_empty() || cases.is_empty() => {}
        None => {
            return Err(Failure::User(format!(
                "{} has no case `{case}`; its cases are {}",
                experiment.name(),
                cases.join(", ")
            )));
        }
    }
    match experiment.units() {
        Units::Si => Ok(experiment),
        Units::Dimensionless => Err(Failure::User(
            "times of flight in s need a model in SI units; this one is dimensionless".to_owned(),
        )),
    }
}

/// The model's experiment, with what is set and in its case.
pub fn experiment(modelled: &Modelled, case: Option<&str>) -> Result<Experiment, Failure> {
    let experiment = opened(modelled.model.as_deref(), &modelled.preset, case.unwrap_or_default())?;
    changed(experiment, &modelled.set)
}

/// An experiment with numbers set, by path or by a short name of `--free`.
///
/// # Errors
/// A name or a value that does not fit.
pub fn changed(mut experiment: Experiment, sets: &[Assignment]) -> Result<Experiment, Failure> {
    for set in sets {
        let changed = match experiment.set_text(&[(&set.name, &set.text)]) {
            Err(PathError::Unknown { .. }) => set_short_name(&experiment, set)?,
            changed => changed,
        };
        experiment = changed.map_err(|error| {
            let why = match &error {
                // What stands in the file was right before: the place is on the command line.
                PathError::Mistakes(mistakes) => {
                    let all = mistakes.findings().iter();
                    all.map(|one| format!("{one}; {}", one.label())).collect::<Vec<_>>().join("\n")
                }
                other => other.to_string(),
            };
            Failure::User(format!("--set {set}: {why}"))
        })?;
    }
    Ok(experiment)
}

/// Sets the number of a short name; a law of the striker's speed becomes constant.
fn set_short_name(
    experiment: &Experiment,
    set: &Assignment,
) -> Result<Result<Experiment, PathError>, Failure> {
    let found = FreeNumber::find(experiment, &set.name, Some(1.0));
    let found = found.map_err(|error| Failure::User(format!("--set {set}: {error}")))?;
    let Some(path) = found.path() else {
        return Err(Failure::User(format!(
            "--set {set}: `{}` is no number of the experiment file: --free alone knows it",
            set.name
        )));
    };
    let text = set.text.as_str();
    Ok(match experiment.get(path) {
        Ok(_) => experiment.set_text(&[(path, text)]),
        Err(_) => experiment
            .set_text(&[(&format!("{path}.prefactor"), text), (&format!("{path}.exponent"), "0")]),
    })
}

/// A model with its free numbers.
pub fn model(
    experiment: &Experiment,
    modelled: &Modelled,
    freed: &Freed,
) -> Result<Model, Failure> {
    needs_free(freed)?;
    let numbers: Result<Vec<_>, _> = numbers(experiment, freed).into_iter().collect();
    of_numbers(experiment, modelled, numbers.map_err(user)?)
}

fn needs_free(freed: &Freed) -> Result<(), Failure> {
    match freed.free.is_empty() {
        true => Err(user("nothing is free: --free names numbers, such as eta,B")),
        false => Ok(()),
    }
}

/// Free numbers of an experiment and systematic errors, in the order of the options.
fn numbers(experiment: &Experiment, freed: &Freed) -> Vec<Result<FreeNumber, InferError>> {
    let number = |name: &String| {
        let plain = name.split(':').next().unwrap_or_default().trim();
        let start = freed.start.iter().find(|start| start.name == plain);
        // The unit is not known before the number is: it is looked at below.
        let start = start.and_then(|start| known::any_number(&start.text));
        FreeNumber::find(experiment, name, start)
    };
    let systematic = |one: &Assignment| {
        let (name, sd) = known::systematic(experiment, one)?;
        FreeNumber::systematic(experiment, &name, sd)
    };
    freed.free.iter().map(number).chain(freed.systematic.iter().map(systematic)).collect()
}

fn of_numbers(
    experiment: &Experiment,
    modelled: &Modelled,
    numbers: Vec<FreeNumber>,
) -> Result<Model, Failure> {
    let numbers = FreeNumbers::new(numbers).map_err(user)?;
    let mut model = Model::new(experiment, numbers)?.with_accuracy(modelled.accuracy.0);
    model.set = input::instruction_set()?;
    Ok(model)
}

/// Data against a model with what is known of its parameters.
pub fn problem(model: Model, data: Data, freed: &Freed) -> Result<CurveProblem, Failure> {
    let mut parameters = model.numbers.parameters(&data.speeds_m_s());
    known::apply(freed, &mut parameters)?;
    CurveProblem::new(model, data, parameters).map_err(user)
}

/// Tables against their models, in which numbers of one name are one parameter. A model that does
/// not know a free number of the others' goes without.
///
/// # Errors
/// Options, data and models that do not fit together.
pub fn joint_problem(
    pairs: &[(Data, Experiment)],
    options: &FitOptions,
) -> Result<CurveProblem, Failure> {
    let (modelled, freed) = (&options.modelled, &options.freed);
    needs_free(freed)?;
    if pairs.len() == 1 && !options.own.is_empty() {
        return Err(user("--own is for several tables (--also): leave it out"));
    }
    if pairs.len() > 1 && !options.against.is_empty() {
        return Err(user(
            "--against compares models of one table, and there are several: leave it out",
        ));
    }
    let experiment = |(data, experiment): &(Data, Experiment)| {
        changed(in_case(experiment.clone(), &data.case)?, &modelled.set)
    };
    let experiments = pairs.iter().map(experiment).collect::<Result<Vec<_>, _>>()?;
    let found: Vec<_> = experiments.iter().map(|one| numbers(one, freed)).collect();
    let mut curves = Vec::new();
    for (((data, _), experiment), own) in pairs.iter().zip(&experiments).zip(&found) {
        let mut known = Vec::new();
        for (at, number) in own.iter().enumerate() {
            match number {
                Ok(number) => known.push(number.clone()),
                Err(InferError::Input(_)) if found.iter().any(|other| other[at].is_ok()) => {}
                Err(error) => return Err(user(error)),
            }
        }
        curves.push((of_numbers(experiment, modelled, known)?, data.clone()));
    }
    let is_free = |name: &&String| {
        let mut numbers = curves.iter().flat_map(|(model, _)| model.numbers.iter());
        numbers.any(|number| number.name() == name.as_str())
    };
    if let Some(name) = options.own.iter().find(|name| !is_free(name)) {
        return Err(user(format!("--own {name}: nothing of this name is free")));
    }
    let problem = CurveProblem::of_curves(curves, &options.own);
    let mut parameters = problem.parameters().to_vec();
    known::apply(freed, &mut parameters)?;
    problem.with_parameters(parameters).map_err(user)
}

/// Recordings against a model with what is known of its parameters.
pub fn pulses(problem: PulseProblem, freed: &Freed) -> Result<PulseProblem, Failure> {
    let mut parameters = problem.parameters().to_vec();
    known::apply(freed, &mut parameters)?;
    problem.with_parameters(parameters).map_err(user)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/mod.rs"]
mod tests;
