//! `hertzchain sweep`: times of flight against speed.

mod fits;

use crate::arguments::{self, Sweep as Arguments};
use crate::failure::{self, Failure};
use crate::folder::Folder;
use crate::format::{self, Style};
use crate::print::heading;
use crate::{pictures, print};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_study::{
    Judges, Plan, Point, PointError, Settings, Shot, Sweep, parse_speeds, sweep,
};
use hertzchain_verbs::arguments::How;
use hertzchain_verbs::given::check_speeds;
use hertzchain_verbs::table::cell;
use hertzchain_verbs::{input, json, missing, table};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::ThreadPoolBuilder;

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let speeds = parse_speeds(&arguments.speeds).map_err(|e| Failure::User(e.to_string()))?;
    let experiment = input::open(&arguments.input)?;
    check_speeds("--speeds", &arguments.speeds, experiment.units())?;
    let plan = adjusted(&experiment, &arguments.how)?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let threads = arguments.threads.unwrap_or(0);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Failure::Ours(format!("threads: {error}")))?;
    let bar = bar(speeds.len() as u64);
    let settings = Settings {
        adjust: &|plan| adjust(arguments, plan),
        checked: arguments.how.check,
        judges: match arguments.judges {
            arguments::Judges::Each => Judges::Each,
            arguments::Judges::Pilots => Judges::Pilots,
        },
        set: input::instruction_set()?,
        progress: &|| bar.inc(1),
    };
    let swept = pool.install(|| sweep(&experiment, &speeds, &settings));
    bar.finish_and_clear();
    show(arguments, &experiment, &plan, &swept)?;
    folder.map_or(Ok(()), |folder| write(folder, &experiment, &swept))?;
    judge(&swept, experiment.units())
}

/// Shots for times of flight alone, unless the striker is to be followed.
fn adjust(arguments: &Arguments, plan: &mut Plan) {
    input::adjust(&arguments.how, plan);
    plan.rebound = arguments.rebound;
}

/// A plan at the experiment's own speed, to refuse options before any work.
fn adjusted(experiment: &Experiment, how: &How) -> Result<Plan, Failure> {
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
        PointError::Study(_) => None,
    };
    let lines: Vec<String> = failed
        .map(|(point, error)| {
            let why = told(error).unwrap_or_else(|| error.to_string());
            format!("{}: {why}", style.quantity(point.speed_m_s, "m/s"))
        })
        .collect();
    for line in &lines {
        eprintln!("warning: no shot at {line}");
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
    swept: &Sweep,
) -> Result<(), Failure> {
    if arguments.json {
        return print::print_json(&json::sweep(experiment, plan, swept));
    }
    print_warnings(experiment, swept);
    if swept.points.iter().all(|point| point.shot.is_err()) {
        // Nothing but dashes; why there are no shots is told instead.
        return Ok(());
    }
    let reached = swept
        .points
        .iter()
        .filter_map(|point| ok(point)?.accuracy_reached);
    let style = Style::of_accuracy(reached.fold(plan.accuracy, f64::max), experiment.units());
    let mut text = format!("{}\n{}", heading(experiment.title()), rows(style, swept));
    if swept.flights().is_empty() {
        // No fits either, for the same reason.
        text += &no_flight(swept, plan, experiment.units());
        return print::print(&text);
    }
    text += &fits::lines(swept, experiment.units());
    if let Some(tuned) = &swept.tuned {
        text += &format!("Times of flight: {tuned}\n");
    }
    print::print(&text)
}

/// Why no speed has a time of flight.
fn no_flight(swept: &Sweep, plan: &Plan, units: Units) -> String {
    let first = swept.points.iter().find_map(ok);
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
        1 => eprintln!("warning: the same goes for another speed; --json has all warnings"),
        n => eprintln!("warning: the same goes for {n} other speeds; --json has all warnings"),
    }
}

/// What a column is called, its unit, the size of the unit, and its numbers.
type Column = (&'static str, &'static str, f64, fn(&Point) -> Option<f64>);

const COLUMNS: [Column; 6] = [
    ("speed", "m/s", 1.0, |point| Some(point.speed_m_s)),
    ("incident ToF", "µs", 1e-6, |point| {
        Some(ok(point)?.flight?.incident_s)
    }),
    ("reflected ToF", "µs", 1e-6, |point| {
        ok(point)?.flight?.reflected_s
    }),
    ("sensor peak", "N", 1.0, |point| sensor_peak(ok(point)?)),
    ("wall peak", "N", 1.0, |point| {
        Some(ok(point)?.passage.as_ref().ok()?.wall.value)
    }),
    ("rebound", "m/s", 1.0, |point| ok(point)?.rebound?.end_m_s),
];

/// Whether a column has anything to tell.
fn told(column: &Column, swept: &Sweep) -> bool {
    swept.points.iter().any(|point| (column.3)(point).is_some())
}

/// The incident pulse's, or the largest where none is seen to pass.
fn sensor_peak(shot: &Shot) -> Option<f64> {
    let largest = || {
        shot.sensor_maxima
            .iter()
            .map(|peak| peak.value)
            .reduce(f64::max)
    };
    let passage = shot.passage.as_ref().ok();
    passage.map(|seen| seen.incident.value).or_else(largest)
}

fn ok(point: &Point) -> Option<&Shot> {
    point.shot.as_ref().ok()
}

fn rows(style: Style, swept: &Sweep) -> String {
    let si = style.units == Units::Si;
    let column = |(name, unit, size, of): &Column| {
        let size = if si { *size } else { 1.0 };
        let values: Vec<Option<f64>> = swept.points.iter().map(|p| Some(of(p)? / size)).collect();
        let digits = if name.ends_with("ToF") {
            style.digits + 1
        } else {
            5
        };
        let head = if si {
            format!("{name} ({unit})")
        } else {
            (*name).to_owned()
        };
        (head, format::column(&values, digits))
    };
    let (mut head, mut columns): (Vec<String>, Vec<Vec<String>>) = COLUMNS
        .iter()
        .filter(|column| told(column, swept))
        .map(column)
        .unzip();
    let reached = |point: &Point| ok(point)?.accuracy_reached;
    if swept.points.iter().any(|point| reached(point).is_some()) {
        let cell = |point| reached(point).map_or_else(String::new, |a| format!("{a:.0e}"));
        head.push("accuracy reached".to_owned());
        columns.push(swept.points.iter().map(cell).collect());
    }
    let row = |i: usize| columns.iter().map(|column| column[i].clone()).collect();
    let rows: Vec<Vec<String>> = (0..swept.points.len()).map(row).collect();
    format::table(&head, &rows)
}

fn write(mut folder: Folder, experiment: &Experiment, swept: &Sweep) -> Result<(), Failure> {
    folder.write("sweep.csv", csv(swept, experiment.units()).as_bytes())?;
    folder.figure("sweep", &pictures::sweep(experiment, swept))?;
    eprint!("Written:\n{}", folder.list());
    Ok(())
}

/// Columns of the file.
const NAMES: [&str; 8] = [
    "speed_m_s",
    "tof_incident_s",
    "tof_reflected_s",
    "sensor_peak_n",
    "wall_peak_n",
    "returning_peak_n",
    "striker_rebound_m_s",
    "accuracy_reached",
];

fn csv(swept: &Sweep, units: Units) -> String {
    let names = match units {
        Units::Si => NAMES,
        Units::Dimensionless => NAMES.map(table::without_unit),
    };
    let mut text = format!("{}\n", names.join(","));
    for point in &swept.points {
        let Ok(shot) = &point.shot else { continue };
        let seen = shot.passage.as_ref().ok();
        let cells = [
            Some(point.speed_m_s),
            shot.flight.map(|flight| flight.incident_s),
            shot.flight.and_then(|flight| flight.reflected_s),
            sensor_peak(shot),
            seen.map(|seen| seen.wall.value),
            seen.and_then(|seen| Some(seen.reflected?.value)),
            shot.rebound.and_then(|rebound| rebound.end_m_s),
            shot.accuracy_reached,
        ];
        let cells = cells.map(|value| value.map_or(String::new(), cell));
        text += &format!("{}\n", cells.join(","));
    }
    text
}
