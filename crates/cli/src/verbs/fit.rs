//! `hertzchain fit`: times of flight to parameters.

mod pictures;
mod report;
mod uncertainty;

use crate::failure::Failure;
use crate::folder::Folder;
use crate::print;
use hertzchain_verbs::arguments::infer::Fit as Arguments;
use hertzchain_verbs::fit::{self, Fitted, More};
use hertzchain_verbs::inference;

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let data = inference::data(&arguments.data, &arguments.measured)?;
    let experiment = inference::experiment(&arguments.modelled, Some(&data.case))?;
    let model = inference::model(&experiment, &arguments.modelled, &arguments.freed)?;
    let problem = inference::problem(model, data, &arguments.freed)?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let pool = inference::pool(arguments.modelled.threads)?;
    let fitted = pool.install(|| fit::fitted(problem, arguments))?;
    let all = fit::json(&fitted, arguments);
    match arguments.json {
        true => print::print_json(&all)?,
        false => print::print(&report::text(&fitted))?,
    }
    folder.map_or(Ok(()), |folder| write(folder, &fitted, &all))
}

fn write(mut folder: Folder, fitted: &Fitted, all: &serde_json::Value) -> Result<(), Failure> {
    folder.write("fit.json", format!("{all:#}\n").as_bytes())?;
    folder.write("fit.csv", fit::rows_csv(fitted).as_bytes())?;
    folder.write("parameters.csv", fit::parameters_csv(fitted).as_bytes())?;
    folder.figure("fit", &pictures::fit(fitted))?;
    folder.figure("singular-values", &uncertainty::singular_values(fitted))?;
    match &fitted.more {
        More::Nothing => {}
        More::Profiles(profiles) => {
            folder.write(
                "profiles.csv",
                fit::profiles_csv(fitted, profiles).as_bytes(),
            )?;
            folder.figure("profiles", &uncertainty::profiles(fitted, profiles))?;
        }
        More::Sampled(sampled) => {
            let chain = serde_json::to_vec(&sampled.chain);
            let chain = chain.map_err(|error| Failure::Ours(error.to_string()))?;
            folder.write(fit::CHAIN, &chain)?;
            if let Ok(posterior) = &sampled.posterior {
                folder.figure("corner", &uncertainty::corner(fitted, posterior))?;
            }
        }
    }
    eprint!("Written:\n{}", folder.list());
    Ok(())
}
