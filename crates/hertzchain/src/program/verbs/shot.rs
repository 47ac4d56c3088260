//! `hertzchain shot`: one shot.

mod report;
mod traces;

use crate::options::ShotOptions as Arguments;
use crate::program::failure::{self, Failure};
use crate::program::folder::Folder;
use crate::program::notes::with_notes;
use crate::program::print;
use crate::program::words::lines;
use crate::table::named;
use crate::{input, json};
use hertzchain_sim::{Expected, Plan, shoot_checked, shoot_estimated};
use std::path::Path;

/// Expected time in s from which on a shot is announced.
const LONG_S: f64 = 10.0;

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let speed = input::speed(arguments.speed.as_ref(), &experiment)?;
    input::check_times(&arguments.how, &experiment)?;
    let given = arguments.speed.as_ref();
    let planned = Plan::from_experiment(&experiment, speed);
    let (mut plan, warnings) = input::at_speed(given, planned)?;
    input::adjust(&arguments.how, &mut plan);
    input::check_effort(&arguments.how, &plan, experiment.units())?;
    plan.budget = true;
    let folder = open_folder(arguments)?;
    announce(&plan);
    let shot = with_notes(Some(1), || match arguments.how.check {
        true => shoot_checked(&plan),
        false => shoot_estimated(&plan),
    })?;
    let shot = shot.map_err(|error| Failure::of_shot(&experiment, &arguments.how, error))?;
    failure::print_speed_warnings(given, &warnings);
    if arguments.json {
        let mut result = json::shot_of(&experiment, speed, &plan, &shot);
        if let Some(assumed) = input::assumed(&arguments.input) {
            result["assumed_model"] = assumed.into();
        }
        print::print_json(&named(result, experiment.units()))?;
    } else {
        let assumed = lines(input::assumed(&arguments.input).into_iter().collect());
        print::print(&(assumed + &report::text(&experiment, &plan, &shot)))?;
    }
    folder.map_or(Ok(()), |folder| traces::write(folder, arguments, &experiment, &plan, &shot))
}

/// Announces a shot that takes long.
fn announce(plan: &Plan) {
    let expected = Expected::of(plan).ok();
    if let Some(expected) = expected.filter(|expected| expected.time_s > LONG_S) {
        print::note(&format!("This shot takes {expected}; Ctrl-C ends it."));
    }
}

fn open_folder(arguments: &Arguments) -> Result<Option<Folder>, Failure> {
    match (&arguments.out, arguments.animate) {
        (Some(out), _) => Folder::open(out).map(Some),
        (None, true) => Folder::open(Path::new(".")).map(Some),
        (None, false) => Ok(None),
    }
}
