//! `hertzchain sweep`: times of flight against speed.

mod fits;
pub(crate) mod reported;
pub(crate) mod shard;

use crate::json::SweepView;
use crate::options::check_speeds;
use crate::options::{self, SimulationOptions as Asked, SweepOptions as Arguments};
use crate::program::failure::{self, Failure};
use crate::program::folder::Folder;
use crate::program::format::Style;
use crate::program::print;
use crate::{input, missing, table};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_sim::{
    Batch, BatchOptions, BatchResult, BatchShot, Calibration, ErrorControl, Plan, Shard,
    StudyError, parse_speeds,
};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::ThreadPoolBuilder;

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let speeds = parse_speeds(&arguments.speeds).map_err(|e| Failure::User(e.to_string()))?;
    let experiment = input::open(&arguments.input)?;
    check_speeds("--speeds", &arguments.speeds, experiment.units())?;
    let plan = adjusted(&experiment, &arguments.how)?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let threads = arguments.threads.map_or(0, |threads| threads.0);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Failure::Ours(format!("threads: {error}")))?;
    let bar = bar(speeds.len() as u64);
    let batch = Batch::new(&experiment, speeds, options(arguments, &plan)?)?;
    if let Some(shard) = arguments.shard {
        let done = pool.install(|| shard::run(arguments, &batch, shard, &|| bar.inc(1)));
        bar.finish_and_clear();
        return done;
    }
    let swept = pool.install(|| Swept::of(&batch, &|| bar.inc(1)));
    bar.finish_and_clear();
    show(arguments, &experiment, &plan, &swept)?;
    folder.map_or(Ok(()), |folder| reported::write(folder, &swept.result))?;
    report_failed(&swept, experiment.units())
}

/// A batch with all of its shots.
struct Swept {
    points: Vec<BatchShot>,
    result: BatchResult,
    calibration: Option<Calibration>,
}

impl Swept {
    fn of(batch: &Batch, progress: &(dyn Fn() + Sync)) -> Self {
        let mut points = Vec::new();
        // Of a hundred thousand shots of a thousand beads these alone would take 0.8 GB.
        let take = |mut point: BatchShot| {
            if let Ok(shot) = &mut point.shot {
                shot.velocity_m_s = Vec::new();
            }
            points.push(point);
        };
        let (result, calibration) = batch.run_each(Shard::WHOLE, progress, take);
        Self { points, result, calibration }
    }
}

/// How shots are computed, as data.
fn options(arguments: &Arguments, plan: &Plan) -> Result<BatchOptions, Failure> {
    Ok(BatchOptions {
        accuracy: plan.accuracy,
        solver: plan.solver,
        duration_s: plan.duration_s,
        pick: plan.pick,
        rebound: arguments.rebound,
        checked: arguments.how.check,
        error_control: match arguments.error_control {
            options::ErrorControl::PerShot => ErrorControl::PerShot,
            options::ErrorControl::Calibrated => ErrorControl::Calibrated,
        },
        set: input::instruction_set()?,
    })
}

/// A plan at the experiment's own speed, to refuse options before any work.
fn adjusted(experiment: &Experiment, how: &Asked) -> Result<Plan, Failure> {
    experiment.needs_striker("a sweep over speeds needs a chain with a striker")?;
    input::check_times(how, experiment)?;
    let (mut plan, _warnings) = Plan::from_experiment(experiment, None)?;
    input::adjust(how, &mut plan);
    input::check_effort(how, &plan, experiment.units())?;
    Ok(plan)
}

/// Drawn on a terminal only.
fn bar(shots: u64) -> ProgressBar {
    let bar = ProgressBar::new(shots);
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} shots, {eta} left");
    style.into_iter().for_each(|style| bar.set_style(style));
    bar
}

/// Every speed failed: the sweep did.
fn report_failed(swept: &Swept, units: Units) -> Result<(), Failure> {
    let style = Style { digits: 16, units };
    let failed = swept.points.iter().filter_map(|point| Some((point, point.shot.as_ref().err()?)));
    let of_speed = |error: &StudyError| match error {
        StudyError::Mistakes(mistakes) => failure::of_speed(mistakes),
        _ => None,
    };
    let lines: Vec<String> = failed
        .map(|(point, error)| {
            let why = of_speed(error).unwrap_or_else(|| error.to_string());
            format!("{}: {why}", style.quantity(point.speed_m_s, "m/s"))
        })
        .collect();
    for line in &lines {
        print::note(&format!("warning: no shot at {line}"));
    }
    match lines.len() == swept.points.len() {
        true => Err(Failure::User("no speed gave a shot".into())),
        false => Ok(()),
    }
}

fn show(
    arguments: &Arguments,
    experiment: &Experiment,
    plan: &Plan,
    swept: &Swept,
) -> Result<(), Failure> {
    if arguments.json {
        let made = (&swept.result, swept.calibration.as_ref());
        let mut view = SweepView::new(experiment, plan, &swept.points, made);
        if let Some(assumed) = input::assumed(&arguments.input) {
            view.outline["assumed_model"] = assumed.into();
        }
        return match experiment.units() {
            Units::Si => print::stream_json(&view),
            units => {
                let whole = serde_json::to_value(&view);
                let whole = whole.map_err(|error| Failure::Ours(format!("JSON: {error}")))?;
                print::print_json(&table::named(whole, units))
            }
        };
    }
    if let Some(assumed) = input::assumed(&arguments.input) {
        print::print(&assumed)?;
    }
    print_warnings(experiment, swept);
    let part = &swept.result;
    if part.rows.flights().is_empty() && !reported::nothing(part) {
        let why = no_flight(swept, plan, experiment.units());
        return print::print(&(reported::rows(part) + &why));
    }
    reported::show(part)
}

/// Why no speed has a time of flight.
fn no_flight(swept: &Swept, plan: &Plan, units: Units) -> String {
    let first = swept.points.iter().find_map(|point| point.shot.as_ref().ok());
    match first.map(|shot| &shot.passage) {
        Some(Err(reason)) => {
            let reason = missing::reason(&plan.chain.far, units, reason);
            format!("No times of flight: {reason}.\n")
        }
        _ => "No times of flight: what they are picked by was not seen.\n".to_owned(),
    }
}

/// The first warnings stand for those of their kind at other speeds.
fn print_warnings(experiment: &Experiment, swept: &Swept) {
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
        1 => print::note("warning: the same goes for another speed; --json has all warnings"),
        n => print::note(&format!(
            "warning: the same goes for {n} other speeds; --json has all warnings"
        )),
    }
}
