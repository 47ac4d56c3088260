//! `hertzchain sweep`: times of flight against speed.

mod fits;
pub(crate) mod shard;
pub(crate) mod told;

use crate::arguments::{self, Sweep as Arguments};
use crate::failure::{self, Failure};
use crate::folder::Folder;
use crate::format::Style;
use crate::print;
use hertzchain::arguments::How as Asked;
use hertzchain::given::check_speeds;
use hertzchain::{input, json, missing, table};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_sim::{
    How, Judges, Part, Plan, PointError, Rows, Run, Settings, Shard, Sweep, parse_speeds, sweep,
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
    let threads = arguments.threads.unwrap_or(0);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Failure::Ours(format!("threads: {error}")))?;
    let bar = bar(speeds.len() as u64);
    let how = how(arguments, &plan)?;
    if let Some(shard) = arguments.shard {
        let run = Run::new(&experiment, speeds, how).map_err(shard::refused)?;
        let done = pool.install(|| shard::run(arguments, &run, shard, &|| bar.inc(1)));
        bar.finish_and_clear();
        return done;
    }
    let settings = Settings {
        adjust: &|plan| adjust(arguments, plan),
        checked: how.checked,
        judges: how.judges,
        set: how.set,
        progress: &|| bar.inc(1),
    };
    let swept = pool.install(|| sweep(&experiment, &speeds, &settings));
    bar.finish_and_clear();
    let run = Run::new(&experiment, speeds, how).map_err(shard::refused)?;
    let part = Part {
        tuned: swept.tuned.map(|tuned| tuned.to_string()),
        rows: Rows::of(&swept.points),
        ..run.empty(Shard::WHOLE)
    };
    show(arguments, &experiment, &plan, (&swept, &part))?;
    folder.map_or(Ok(()), |folder| told::write(folder, &part))?;
    judge(&swept, experiment.units())
}

/// How shots are computed, as data.
fn how(arguments: &Arguments, plan: &Plan) -> Result<How, Failure> {
    Ok(How {
        accuracy: plan.accuracy,
        solver: plan.solver,
        duration_s: plan.duration_s,
        pick: plan.pick,
        rebound: arguments.rebound,
        checked: arguments.how.check,
        judges: match arguments.judges {
            arguments::Judges::Each => Judges::Each,
            arguments::Judges::Pilots => Judges::Pilots,
        },
        set: input::instruction_set()?,
    })
}

/// Shots for times of flight alone, unless the striker is to be followed.
fn adjust(arguments: &Arguments, plan: &mut Plan) {
    input::adjust(&arguments.how, plan);
    plan.rebound = arguments.rebound;
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
fn judge(swept: &Sweep, units: Units) -> Result<(), Failure> {
    let style = Style { digits: 16, units };
    let failed = swept
        .points
        .iter()
        .filter_map(|point| Some((point, point.shot.as_ref().err()?)));
    let told = |error: &PointError| match error {
        PointError::Mistakes(mistakes) => failure::of_speed(mistakes),
        PointError::Number(_) | PointError::Study(_) => None,
    };
    let lines: Vec<String> = failed
        .map(|(point, error)| {
            let why = told(error).unwrap_or_else(|| error.to_string());
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
    (swept, part): (&Sweep, &Part),
) -> Result<(), Failure> {
    if arguments.json {
        let mut results = json::sweep(experiment, plan, swept);
        if let Some(assumed) = input::assumed(&arguments.input) {
            results["assumed_model"] = assumed.into();
        }
        return print::print_json(&table::named(results, experiment.units()));
    }
    if let Some(assumed) = input::assumed(&arguments.input) {
        print::print(&assumed)?;
    }
    print_warnings(experiment, swept);
    if part.rows.flights().is_empty() && !told::nothing(part) {
        let why = no_flight(swept, plan, experiment.units());
        return print::print(&(told::rows(part) + &why));
    }
    told::show(part)
}

/// Why no speed has a time of flight.
fn no_flight(swept: &Sweep, plan: &Plan, units: Units) -> String {
    let first = swept
        .points
        .iter()
        .find_map(|point| point.shot.as_ref().ok());
    match first.map(|shot| &shot.passage) {
        Some(Err(reason)) => {
            let reason = missing::reason(&plan.chain.far, units, reason);
            format!("No times of flight: {reason}.\n")
        }
        _ => "No times of flight: what they are picked by was not seen.\n".to_owned(),
    }
}

/// The first warnings stand for those of their kind at other speeds.
fn print_warnings(experiment: &Experiment, swept: &Sweep) {
    let mut warned = (swept.points.iter()).filter(|point| !point.warnings.is_empty());
    let Some(first) = warned.next() else {
        return;
    };
    if let Ok((_, warnings)) = experiment.chain(Some(first.speed_m_s)) {
        let style = Style {
            digits: 16,
            units: experiment.units(),
        };
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
