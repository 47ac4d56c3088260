//! From arguments to an experiment and a plan.

use crate::arguments::{How, Input, Pick, Solver};
use crate::failure::Failure;
use hertzchain_experiment::{Experiment, OpenError, preset};
use hertzchain_study as study;
use hertzchain_study::Plan;
use std::path::Path;

/// The preset that is used when no experiment is named.
const USUAL: &str = "dry";

/// Opens the file or the preset.
pub fn open(input: &Input) -> Result<Experiment, Failure> {
    match (&input.file, &input.preset) {
        (Some(file), _) => open_file(file),
        (None, name) => {
            preset(name.as_deref().unwrap_or(USUAL)).map_err(|e| Failure::User(e.to_string()))
        }
    }
}

fn open_file(file: &Path) -> Result<Experiment, Failure> {
    Experiment::open(file).map_err(|error| match error {
        OpenError::Mistakes(mistakes) => mistakes.into(),
        OpenError::Unreadable { .. } => {
            let meant = file
                .to_str()
                .filter(|name| !file.exists() && preset(name).is_ok());
            let hint = meant.map_or(String::new(), |name| {
                format!("; did you mean --preset {name}?")
            });
            Failure::User(format!("{error}{hint}"))
        }
    })
}

/// Puts what the command line says in place of what the experiment says.
pub fn adjust(how: &How, plan: &mut Plan) {
    plan.accuracy = how.accuracy.unwrap_or(plan.accuracy);
    plan.duration_s = how.duration.or(plan.duration_s);
    if let Some(pick) = how.pick {
        plan.pick = match pick {
            Pick::Peak => study::Pick::Peak,
            Pick::Flank10 => study::Pick::Flank(0.1),
            Pick::Flank50 => study::Pick::Flank(0.5),
            Pick::CrossCorrelation => study::Pick::CrossCorrelation,
        };
    }
    plan.solver = match (how.solver, plan.solver) {
        (Some(Solver::Adaptive), _) => study::Solver::Adaptive,
        (Some(Solver::Rk4), _) => study::Solver::Rk4 { step_s: how.step },
        (Some(Solver::Verlet), _) => study::Solver::Verlet { step_s: how.step },
        (None, study::Solver::Rk4 { step_s }) => study::Solver::Rk4 {
            step_s: how.step.or(step_s),
        },
        (None, study::Solver::Verlet { step_s }) => study::Solver::Verlet {
            step_s: how.step.or(step_s),
        },
        (None, study::Solver::Adaptive) => study::Solver::Adaptive,
    };
}

/// Refuses a step for a solver that chooses its own.
pub fn check_step(how: &How, plan: &Plan) -> Result<(), Failure> {
    match (how.step, plan.solver) {
        (Some(_), study::Solver::Adaptive) => Err(Failure::User(
            "the adaptive solver chooses its own steps; --step needs --solver rk4 or verlet".into(),
        )),
        _ => Ok(()),
    }
}
