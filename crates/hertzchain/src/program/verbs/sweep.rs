//! `hertzchain sweep`: times of flight against speed.

mod fits;
pub(crate) mod reported;
pub(crate) mod shard;

use crate::options::SweepOptions as Arguments;
use crate::program::{Counter, Failure, Folder, Style, failure, print};
use crate::sweep::{self, SweepResult};
use crate::{input, missing, table};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_paper::reproduce::ReproduceProgress;
use hertzchain_sim::{BatchShot, StudyError};
use serde_json::json;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let speeds = sweep::speeds(&experiment, arguments)?;
    // A shard is recognised by its name, and computed only once.
    let replace = arguments.force || arguments.shard.is_some();
    let folder = Folder::asked(arguments.out.as_deref(), &[reported::SWEEP], replace)?;
    let counter = Counter::new("shots", speeds.len() as u64);
    let batch = sweep::batch(&experiment, speeds, arguments)?;
    if let Some(shard) = arguments.shard {
        let pool = sweep::pool(arguments.threads)?;
        let done = pool.install(|| shard::run(arguments, &batch, shard, &|| counter.advance()));
        counter.finish();
        return done;
    }
    let swept = sweep::computed(&experiment, arguments, &batch, &|| counter.advance())?;
    counter.finish();
    show(arguments, &experiment, &swept)?;
    folder.map_or(Ok(()), |folder| reported::write(folder, &swept.result))?;
    report_failed(&swept, experiment.units())
}

/// Every speed failed: the sweep did.
fn report_failed(swept: &SweepResult, units: Units) -> Result<(), Failure> {
    let style = Style { digits: 16, units };
    let failed = swept.points.iter().filter_map(|point| Some((point, point.shot.as_ref().err()?)));
    let line = |(point, error): (&BatchShot, &StudyError)| {
        let speed = style.quantity(point.speed_m_s, "m/s");
        format!("no shot at {speed}: {}", failure::why(error))
    };
    let lines: Vec<String> = failed.map(line).collect();
    print::warn(&lines);
    match lines.len() == swept.points.len() {
        true => Err(Failure::User("no speed gave a shot".into())),
        false => Ok(()),
    }
}

fn show(
    arguments: &Arguments,
    experiment: &Experiment,
    swept: &SweepResult,
) -> Result<(), Failure> {
    if arguments.json {
        return match experiment.units() {
            Units::Si => print::stream_json(swept),
            units => print::print_json(&table::named(json!(swept), units)),
        };
    }
    if let Some(assumed) = &swept.summary.assumed_model {
        print::print(assumed)?;
    }
    print_warnings(experiment, swept);
    let part = &swept.result;
    if part.rows.flights().is_empty() && !reported::nothing(part) {
        return print::print(&(reported::rows(part) + &no_flight(swept)));
    }
    reported::show(part)
}

/// Why no speed has a time of flight.
fn no_flight(swept: &SweepResult) -> String {
    let first = swept.points.iter().find_map(|point| point.shot.as_ref().ok());
    match first.map(|shot| &shot.passage) {
        Some(Err(reason)) => {
            let reason = missing::reason(&swept.plan.chain.far, swept.result.units, reason);
            format!("No times of flight: {reason}.\n")
        }
        _ => "No times of flight: what they are picked by was not seen.\n".to_owned(),
    }
}

/// The first warnings stand for those of their kind at other speeds.
fn print_warnings(experiment: &Experiment, swept: &SweepResult) {
    let mut warned = (swept.points.iter()).filter(|point| !point.warnings.is_empty());
    let Some(first) = warned.next() else {
        return;
    };
    if let Ok((_, warnings)) = experiment.chain(Some(first.speed_m_s)) {
        let style = Style { digits: 16, units: experiment.units() };
        let speed = style.quantity(first.speed_m_s, "m/s");
        failure::print_option_warnings(&format!("--speeds, {speed}"), &warnings);
    }
    match warned.count() {
        0 => {}
        1 => print::warn(["the same goes for another speed; --json has all warnings"]),
        n => print::warn([format!("the same goes for {n} other speeds; --json has all warnings")]),
    }
}
