//! `hertzchain fit`: times of flight, or whole pulses, to parameters.

mod pictures;
mod pulses;
mod report;

use crate::fit::{self, FitResult, Inferred, More};
use crate::inference;
use crate::options::{FitOptions as Arguments, Method, ModelOptions};
use crate::program::{Failure, Folder, print, print_assumed, print_stored, with_notes};
use hertzchain_experiment::Experiment;
use hertzchain_infer::{CurveProblem, Data, Problem, Surrogate};
use std::path::Path;

const FIT: &str = "fit.json";

/// Of some methods, or of data of one kind, only.
const OPTIONAL: &[&str] = &[
    "fit.csv",
    "fit",
    "comparison.csv",
    "pulses.csv",
    "pulses",
    "profiles.csv",
    "intervals.csv",
    "profiles",
    "posterior.csv",
    "samples.csv",
    "corner",
    fit::CHAIN,
];

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let table = match &arguments.data[..] {
        [one] if inference::is_table(one, arguments.recorded.describes_files())? => one,
        _ => return pulses::run(arguments),
    };
    let problem = inference::joint_problem(&pairs(table, arguments)?, arguments)?;
    for curve in &problem.curves {
        print_assumed(&curve.data, &arguments.measured);
    }
    let models = problem.curves.iter().map(|curve| &curve.model);
    print_stored(models, &arguments.modelled.set);
    pace(&problem, arguments);
    let folder = open_folder(arguments)?;
    let fit_result =
        with_notes(arguments.modelled.threads, || fit::fit_result(problem, arguments))?;
    let mut all = fit::json(&fit_result, arguments);
    let assumed = inference::assumed_model(&arguments.modelled);
    let text = || report::text(&fit_result, arguments);
    print::result(arguments.json, &mut all, assumed, text)?;
    folder.map_or(Ok(()), |folder| write(folder, &fit_result, &all))
}

fn open_folder(arguments: &Arguments) -> Result<Option<Folder>, Failure> {
    let resumes = arguments.resume && arguments.method == Method::Posterior;
    let replace = arguments.force || resumes;
    let folder = Folder::asked(arguments.out.as_deref(), &[FIT, fit::CHAIN], replace)?;
    Ok(folder.map(|folder| folder.with_optional(OPTIONAL)))
}

/// DATA and further tables, each with its model.
fn pairs(table: &Path, arguments: &Arguments) -> Result<Vec<(Data, Experiment)>, Failure> {
    let (measured, modelled) = (&arguments.measured, &arguments.modelled);
    let model = |modelled: &ModelOptions| {
        inference::opened(modelled.model.as_deref(), &modelled.preset, "")
    };
    let mut all = vec![(inference::data(table, measured, None)?, model(modelled)?)];
    for also in &arguments.also {
        let data = inference::data_of(&also.data, measured, also.case.clone())?;
        all.push((data, model(&modelled.of_other(&also.model))?));
    }
    Ok(all)
}

/// Warns of a posterior that takes its time.
fn pace(problem: &CurveProblem, arguments: &Arguments) {
    let count = problem.parameters().len();
    let most = Surrogate::MOST_PARAMETERS;
    if arguments.method == Method::Posterior && !arguments.direct && count > most {
        print::warn([format!(
            "{count} parameters are free, and curves are interpolated for up to {most}: \
             every curve of the posterior is computed, a hundred times as slowly; fix some \
             parameters, or use --method profile"
        )]);
    }
}

fn write(
    mut folder: Folder,
    fit_result: &FitResult,
    all: &serde_json::Value,
) -> Result<(), Failure> {
    let tables = fit_result.tables();
    for (at, table) in tables.iter().enumerate() {
        let name = if at == 0 { "fit".to_owned() } else { format!("fit-{}", at + 1) };
        let mut title = table.curve.model.experiment.title().to_owned();
        if tables.len() > 1 {
            let file = Path::new(&table.curve.data.file).file_name().unwrap_or_default();
            title = format!("{}: {title}", file.to_string_lossy());
        }
        folder.figure(&name, &pictures::fit(table, &fit_result.inferred, &title))?;
    }
    let tables = fit::tables(fit_result, all);
    write_inferred(folder, &fit_result.inferred, (all, &tables))
}

/// Files that any fit has, the last ones.
fn write_inferred(
    mut folder: Folder,
    inferred: &Inferred,
    (all, tables): (&serde_json::Value, &[(&'static str, String)]),
) -> Result<(), Failure> {
    folder.write(FIT, format!("{all:#}\n").as_bytes())?;
    folder.tables(tables)?;
    folder.figure("singular-values", &pictures::singular_values(inferred))?;
    match &inferred.more {
        More::Nothing => {}
        More::Profiles(profiles) => {
            folder.figure("profiles", &pictures::profiles(inferred, profiles))?;
        }
        More::Sampled(sampled) => {
            folder.write(fit::CHAIN, &fit::saved(&sampled.chain)?)?;
            if let Ok(posterior) = &sampled.posterior {
                folder.figure("corner", &pictures::corner(inferred, posterior))?;
            }
        }
    }
    let out = folder.path().to_owned();
    folder.finish_and_report()?;
    fit::finished(&out);
    Ok(())
}
