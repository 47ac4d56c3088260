//! `hertzchain shot`: one shot.

mod report;
mod traces;

use crate::input;
use crate::options::{ShotOptions as Arguments, Threads};
use crate::program::{Failure, Folder, failure, lines, print, with_notes};
use crate::shot::PreparedShot;
use crate::table::named;
use hertzchain_sim::{Expected, Plan};
use serde_json::json;
use std::path::Path;

/// Expected time in s from which on a shot is announced.
const LONG_S: f64 = 10.0;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let prepared = PreparedShot::new(&experiment, arguments)?;
    let folder = open_folder(arguments)?;
    announce(&prepared.plan);
    let mut shot = with_notes(Some(Threads(1)), || prepared.run())?;
    shot.assumed_model = input::assumed(&arguments.input);
    failure::print_speed_warnings(arguments.speed.as_ref(), &shot.warnings);
    if arguments.json {
        print::print_json(&named(json!(shot), shot.units))?;
    } else {
        let assumed = lines(shot.assumed_model.clone());
        print::print(&(assumed + &report::text(&experiment, &shot.plan, &shot)))?;
    }
    folder.map_or(Ok(()), |folder| traces::write(folder, arguments, &experiment, &shot))
}

fn announce(plan: &Plan) {
    let expected = Expected::of(plan).ok();
    if let Some(expected) = expected.filter(|expected| expected.time_s > LONG_S) {
        print::note(&format!("This shot takes {expected}; Ctrl-C ends it."));
    }
}

fn open_folder(arguments: &Arguments) -> Result<Option<Folder>, Failure> {
    let (folder, main) = match (&arguments.out, arguments.animate) {
        (Some(out), _) => (out.as_path(), traces::SHOT),
        (None, true) => (Path::new("."), traces::ANIMATION),
        (None, false) => return Ok(None),
    };
    Folder::open(folder, &[main], arguments.force).map(Some)
}
