//! `hertzchain sweep`: times of flight against speed.

use crate::options::SweepOptions as Arguments;
use crate::program::format::r_squared;
use crate::program::{
    Counter, Failure, Folder, Style, digits, failure, format, heading, lines, pictures, print,
    with_error,
};
use crate::sweep::{self, SweepResult};
use crate::{csv, input, missing, table};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty};
use hertzchain_paper::reproduce::ReproduceProgress;
use hertzchain_sim::{
    Batch, BatchResult, BatchShot, COLUMNS, Column, Rows, Shard, Shot, StudyError,
};
use serde_json::json;
use std::collections::HashSet;
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let speeds = sweep::speeds(&experiment, arguments)?;
    // A shard is recognised by its name, and computed only once.
    let replace = arguments.force || arguments.shard.is_some();
    let folder = Folder::asked(arguments.out.as_deref(), &[SWEEP], replace)?
        .map(|folder| folder.with_optional(&["sweep"]));
    let counter = Counter::new("shots", speeds.len() as u64);
    let batch = sweep::batch(&experiment, speeds, arguments)?;
    if let Some(shard) = arguments.shard {
        let pool = sweep::pool(arguments.threads)?;
        let done = pool.install(|| run_shard(arguments, &batch, shard, &|| counter.advance()));
        counter.finish();
        return done;
    }
    let mut swept = sweep::computed(&experiment, arguments, &batch, &|| counter.advance())?;
    swept.summary.assumed_model = input::assumed(&arguments.input);
    counter.finish();
    show(arguments, &experiment, &swept)?;
    folder.map_or(Ok(()), |folder| write(folder, &swept.result))?;
    report_failed(&swept, experiment.units())
}

/// Shots whose duration ends before the search for their pulses.
fn short(swept: &SweepResult) -> Option<String> {
    let shots = swept.points.iter().filter_map(|point| point.shot.as_ref().ok());
    let is_short = |shot: &&Shot| {
        let searched = shot.passage.as_ref().map(|passage| passage.search_ends_s);
        swept.plan.duration_s.is_some() && searched.is_ok_and(|until_s| shot.duration_s < until_s)
    };
    let count = shots.filter(is_short).count();
    (count > 0).then(|| {
        format!(
            "{count} of {} shots end before the search for their pulses is over; a longer `duration` goes on",
            swept.points.len()
        )
    })
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
    print::warn(short(swept));
    let part = &swept.result;
    if part.rows.flights().is_empty() && !nothing(part) {
        return print::print(&(rows(part) + &no_flight(swept)));
    }
    print_table(part)
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

/// The table in the output folder.
pub(super) const SWEEP: &str = "sweep.csv";

/// What a column is called, its unit, the size of the unit, and which it is.
type Shown = (&'static str, &'static str, f64, Column);

const SHOWN: [Shown; 10] = [
    ("speed", "m/s", 1.0, Column::Speed),
    ("incident ToF", "µs", 1e-6, Column::Incident),
    ("reflected ToF", "µs", 1e-6, Column::Reflected),
    ("sensor peak", "N", 1.0, Column::SensorPeak),
    ("wall peak", "N", 1.0, Column::WallPeak),
    ("rebound", "m/s", 1.0, Column::Rebound),
    ("competing maximum", "µs", 1e-6, Column::CompetingTime),
    ("competing peak", "N", 1.0, Column::CompetingPeak),
    ("reflected, competing", "µs", 1e-6, Column::CompetingReflectedTime),
    ("its peak", "N", 1.0, Column::CompetingReflectedPeak),
];

pub(super) fn nothing(part: &BatchResult) -> bool {
    part.rows.failed.len() == part.rows.len()
}

/// Prints the table with its power laws; nothing where no speed has a shot,
/// which is reported instead.
pub(super) fn print_table(part: &BatchResult) -> Result<(), Failure> {
    if nothing(part) {
        return Ok(());
    }
    let mut text = rows(part) + &law_texts(part);
    if part.error_control.starts_with("calibrated") {
        text += &format!("Error control: {}\n", part.error_control);
    }
    print::print(&text)
}

fn rows(part: &BatchResult) -> String {
    let reached = part.rows.column(Column::Accuracy).iter().copied();
    // A number that is none is never the larger one.
    let style = Style::of_accuracy(reached.fold(part.accuracy, f64::max), part.units);
    format!("{}\n{}", heading(&part.title), table_lines(style, &part.rows))
}

fn reported(rows: &Rows, column: Column) -> bool {
    rows.column(column).iter().any(|value| !value.is_nan())
}

fn table_lines(style: Style, rows: &Rows) -> String {
    let si = style.units == Units::Si;
    let column = |(name, unit, size, of): &Shown| {
        let size = if si { *size } else { 1.0 };
        let values = rows.column(*of).iter();
        let values: Vec<Option<f64>> =
            values.map(|value| (!value.is_nan()).then(|| value / size)).collect();
        let digits = if name.ends_with("ToF") { style.digits + 1 } else { 5 };
        let head = if si { format!("{name} ({unit})") } else { (*name).to_owned() };
        (head, format::column(&values, digits))
    };
    let shown = SHOWN.iter().filter(|shown| reported(rows, shown.3));
    let (mut head, mut columns): (Vec<String>, Vec<Vec<String>>) = shown.map(column).unzip();
    if reported(rows, Column::Accuracy) {
        let text = |reached: &f64| match reached.is_nan() {
            true => String::new(),
            false => format!("{reached:.0e}"),
        };
        head.push("accuracy reached".to_owned());
        columns.push(rows.column(Column::Accuracy).iter().map(text).collect());
    }
    let row = |i: usize| columns.iter().map(move |column| &column[i]).collect::<Vec<_>>();
    format::table(head, (0..rows.len()).map(row))
}

pub(super) fn write(mut folder: Folder, part: &BatchResult) -> Result<(), Failure> {
    folder.write(SWEEP, table_csv(part).as_bytes())?;
    // Times of flight are all that it shows.
    if !part.rows.flights().is_empty() {
        folder.figure("sweep", &pictures::sweep(part))?;
    }
    folder.finish_and_report()
}

/// Shots that are none have no line.
fn table_csv(part: &BatchResult) -> String {
    let titles = COLUMNS.iter().map(|name| match part.units {
        Units::Si => name,
        Units::Dimensionless => table::without_unit(name),
    });
    let failed: HashSet<usize> = part.rows.failed.iter().map(|failed| failed.place).collect();
    let places = (0..part.rows.len()).filter(|place| !failed.contains(place));
    let line = |place: usize| part.rows.columns.iter().map(move |column| column[place].into());
    csv::table(titles, places.map(line))
}

/// A line for the incident and one for the reflected times of flight.
fn law_texts(part: &BatchResult) -> String {
    let named = [("incident", Column::Incident), ("reflected", Column::Reflected)];
    let lines = named.map(|(name, column)| {
        let (fit, uncertainty) = part.rows.law(column, part.accuracy);
        law_text(name, &fit, uncertainty, part.units)
    });
    lines.concat()
}

fn law_text(
    name: &str,
    fit: &Result<PowerLaw, FitError>,
    uncertainty: Result<Uncertainty, FitError>,
    units: Units,
) -> String {
    let law = match fit {
        Err(error) => return format!("{name}: no power law: {}\n", missing::law(error)),
        Ok(law) => law,
    };
    let (size, unit, speed) = match units {
        Units::Si => (1e-6, " µs", "(v/(1 m/s))"),
        Units::Dimensionless => (1.0, "", "v"),
    };
    // Standard errors, but not less than what the accuracies of the times of flight alone leave open;
    // only these where two speeds determine no others, and a standard error is not a number.
    let least = uncertainty.ok();
    let least = least.map_or([0.0; 2], |it| [law.prefactor * it.prefactor_relative, it.exponent]);
    let (prefactor, prefactor_error) =
        with_error(law.prefactor / size, least[0].max(law.prefactor_error) / size);
    let (exponent, exponent_error) = with_error(law.exponent, least[1].max(law.exponent_error));
    if law.residuals.len() == 2 {
        return format!(
            "{name}: ToF = {prefactor}{unit} · {speed}^({exponent}), through two speeds, which determine no errors\n",
        );
    }
    format!(
        "{name}: ToF = ({prefactor} ± {prefactor_error}){unit} · {speed}^({exponent} ± {exponent_error}), \
         R² = {}, largest deviation {} %\n",
        r_squared(law.r_squared),
        digits(100.0 * law.largest_deviation(), 2),
    )
}

/// Computes a part into the folder, unless it is there.
fn run_shard(
    arguments: &Arguments,
    batch: &Batch,
    shard: Shard,
    progress: &(dyn Fn() + Sync),
) -> Result<(), Failure> {
    let folder = arguments.out.as_deref().unwrap_or(Path::new("."));
    let begun = Instant::now();
    let done = batch.run_into(folder, shard, progress)?;
    report_warnings(&done.result);
    let shots = done.result.rows.len();
    let what = match done.stored {
        true => "there already".to_owned(),
        false => format!("computed in {:.1} s", begun.elapsed().as_secs_f64()),
    };
    let assumed = lines(input::assumed(&arguments.input));
    print::print(&format!(
        "{assumed}Shard {shard} of {}\n{shots} shots, {what}: {}\n",
        done.result.about,
        done.path.display()
    ))
}

/// Warnings and failed shots, on the error stream.
pub(super) fn report_warnings(part: &BatchResult) {
    let speed = |place: usize| {
        let at = place / part.shard.of();
        part.rows.column(Column::Speed).get(at).copied().unwrap_or(f64::NAN)
    };
    if let Some(warnings) = &part.rows.warnings {
        print::warn(&warnings.lines);
        match warnings.shots {
            0 | 1 => {}
            shots => print::warn([format!("there are warnings at {shots} speeds")]),
        }
    }
    for failed in &part.rows.failed {
        let place = speed(failed.place);
        print::warn([format!("no shot at {place}: {}", failed.why)]);
    }
}

#[cfg(test)]
#[path = "sweep/tests/fits.rs"]
mod tests;
