//! From arguments to an experiment and a plan.

use crate::failure::Failure;
use crate::options::{Given, Input, SimulationOptions as How};
use crate::quantity::Style;
use hertzchain_chain::System;
use hertzchain_experiment::{Experiment, Mistakes, OpenError, Units, longest_duration_s, preset};
use hertzchain_measure::records::text;
use hertzchain_sim::{InstructionSet, Method, Plan};
use std::path::Path;

/// The preset that is used when no experiment is named.
pub(crate) const USUAL: &str = "dry";

/// Opens the file or the preset; the paper's dry chain where neither is named.
pub(crate) fn open(input: &Input) -> Result<Experiment, Failure> {
    open_or(input, USUAL)
}

/// The same with another preset where neither is named.
pub(crate) fn open_or(input: &Input, usual: &str) -> Result<Experiment, Failure> {
    match (&input.file, &input.preset) {
        (Some(file), _) => open_file(file),
        (None, name) => {
            preset(name.as_deref().unwrap_or(usual)).map_err(|e| Failure::User(e.to_string()))
        }
    }
}

pub(crate) fn is_named(input: &Input) -> bool {
    input.file.is_some() || input.preset.is_some()
}

/// That an experiment which was not named is the paper's dry chain: the first line of what
/// comes of it.
pub(crate) fn assumed(input: &Input) -> Option<String> {
    (!is_named(input))
        .then(|| assumed_preset("experiment", "dry chain", USUAL, "FILE or --preset NAME"))
}

/// That something which was not named is a chain of the paper.
pub(crate) fn assumed_preset(what: &str, chain: &str, preset: &str, options: &str) -> String {
    format!(
        "No {what} is named: the paper's {chain} is assumed (preset {preset}; name one by {options})"
    )
}

/// Whether a path can be of an experiment file. A folder is none, and may be called as a preset whose
/// results it has.
pub(crate) fn is_file(path: &Path) -> bool {
    path.exists() && !path.is_dir()
}

fn open_file(file: &Path) -> Result<Experiment, Failure> {
    if file == Path::new("-") {
        let read = text(file).map_err(|error| format!("standard input can't be read: {error}"));
        let text = read.map_err(Failure::User)?;
        return Ok(Experiment::from_text("standard input", &text)?);
    }
    Experiment::open(file).map_err(|error| match error {
        OpenError::Mistakes(mistakes) => mistakes.into(),
        OpenError::Unreadable { .. } => {
            let meant = file.to_str().filter(|name| !is_file(file) && preset(name).is_ok());
            let hint =
                meant.map_or(String::new(), |name| format!("; did you mean --preset {name}?"));
            Failure::User(format!("{error}{hint}"))
        }
    })
}

/// The speed asked for, if it suits the experiment's units.
pub(crate) fn speed(
    given: Option<&Given>,
    experiment: &Experiment,
) -> Result<Option<f64>, Failure> {
    given.map_or(Ok(()), |given| given.check("--speed", experiment.units()))?;
    Ok(given.map(Given::value))
}

/// What an experiment gives at a speed; a speed of the command line that does
/// not do is reported as such.
pub(crate) fn at_speed<T>(
    given: Option<&Given>,
    result: Result<T, Mistakes>,
) -> Result<T, Failure> {
    result.map_err(|mistakes| match given {
        Some(given) => Failure::at_option(&option(given), mistakes),
        None => mistakes.into(),
    })
}

/// The option by which a speed was given.
pub(crate) fn option(given: &Given) -> String {
    format!("--speed {}", given.text())
}

/// Refuses times that do not suit the experiment's units.
pub(crate) fn check_times(how: &How, experiment: &Experiment) -> Result<(), Failure> {
    for (option, given) in [("--step", &how.step), ("--duration", &how.duration)] {
        if let Some(given) = given {
            given.check(option, experiment.units())?;
        }
    }
    Ok(())
}

/// The environment variable that chooses vector instructions.
pub(crate) const INSTRUCTION_SET: &str = "HERTZCHAIN_INSTRUCTION_SET";

/// Vector instructions: the best this machine has, or those asked for.
pub fn instruction_set() -> Result<InstructionSet, Failure> {
    let Some(name) = std::env::var_os(INSTRUCTION_SET).filter(|name| !name.is_empty()) else {
        return Ok(InstructionSet::default());
    };
    let name = name.to_string_lossy();
    InstructionSet::named(&name).ok_or_else(|| {
        let sets = InstructionSet::available();
        let names: Vec<&str> = sets.into_iter().map(InstructionSet::name).collect();
        Failure::User(format!(
            "{INSTRUCTION_SET} is `{name}`, which is none of this machine's sets, as they are written: {}",
            names.join(", ")
        ))
    })
}

/// Puts what the command line says in place of what the experiment says.
pub(crate) fn adjust(how: &How, plan: &mut Plan) {
    plan.accuracy = how.accuracy.map_or(plan.accuracy, |accuracy| accuracy.0);
    let step = how.step.as_ref().map(Given::value);
    let duration = how.duration.as_ref().map(Given::value);
    plan.duration_s = duration.or(plan.duration_s);
    plan.pick = how.pick.map_or(plan.pick, Into::into);
    // A step in the file is that of the file's solver.
    plan.step_s = if how.solver.is_some() { step } else { step.or(plan.step_s) };
    plan.method = how.solver.map_or(plan.method, Into::into);
}

/// Refuses a step for a solver that chooses its own, and a duration without end.
pub(crate) fn check_effort(how: &How, plan: &Plan, units: Units) -> Result<(), Failure> {
    if how.step.is_some() && plan.method == Method::Adaptive {
        return Err(Failure::User(
            "the adaptive solver chooses its own steps; --step needs --solver rk4 or verlet".into(),
        ));
    }
    let longest_s = System::new(&plan.chain).map_or(f64::INFINITY, |it| longest_duration_s(&it));
    match how.duration.as_ref().filter(|given| given.value() > longest_s) {
        Some(given) => Err(Failure::User(format!(
            "--duration {}: expected at most {}: contacts take some ten steps each, and a billion steps take hours",
            given.text(),
            Style { digits: 3, units }.quantity(longest_s, "s")
        ))),
        None => Ok(()),
    }
}
