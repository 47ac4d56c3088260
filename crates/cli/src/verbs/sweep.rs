//! `hertzchain sweep`: times of flight against speed.

use crate::arguments::{How, Sweep as Arguments};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::format::{self, Style, digits};
use crate::{input, json, pictures, print};
use hertzchain_experiment::Experiment;
use hertzchain_signal::{FitError, PowerLaw};
use hertzchain_study::{Plan, Point, Settings, Sweep, parse_speeds, sweep};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::ThreadPoolBuilder;
use serde_json::json;

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let speeds = parse_speeds(&arguments.speeds).map_err(|e| Failure::User(e.to_string()))?;
    let experiment = input::open(&arguments.input)?;
    let (plan, _) = adjusted(&experiment, &arguments.how)?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let threads = arguments.threads.map_or(0, std::num::NonZeroUsize::get);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Failure::Ours(format!("threads: {error}")))?;
    let bar = bar(speeds.len() as u64);
    let settings = Settings {
        adjust: &|plan| input::adjust(&arguments.how, plan),
        checked: arguments.how.check,
        progress: &|| bar.inc(1),
    };
    let swept = pool.install(|| sweep(&experiment, &speeds, &settings));
    bar.finish_and_clear();
    show(arguments, &experiment, &plan, &swept)?;
    folder.map_or(Ok(()), |folder| write(folder, &experiment, &swept))?;
    judge(&swept)
}

/// A plan at the experiment's own speed, to refuse options before any work.
fn adjusted(experiment: &Experiment, how: &How) -> Result<(Plan, usize), Failure> {
    if experiment.speed_m_s().is_none() {
        return Err(Failure::User(
            "a sweep over speeds needs a chain with a striker".into(),
        ));
    }
    let (mut plan, warnings) = Plan::from_experiment(experiment, None)?;
    input::adjust(how, &mut plan);
    input::check_step(how, &plan)?;
    Ok((plan, warnings.len()))
}

/// Drawn on a terminal only.
fn bar(shots: u64) -> ProgressBar {
    let bar = ProgressBar::new(shots);
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} shots, {eta} left");
    style.into_iter().for_each(|style| bar.set_style(style));
    bar
}

/// Every speed failed: the sweep did.
fn judge(swept: &Sweep) -> Result<(), Failure> {
    let failed = swept
        .points
        .iter()
        .filter_map(|point| Some((point, point.shot.as_ref().err()?)));
    let lines: Vec<String> = failed
        .map(|(point, error)| format!("{} m/s: {error}", point.speed_m_s))
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
        return print::print_json(&json!({
            "experiment": experiment.name(),
            "points": swept.points.iter().map(json::point).collect::<serde_json::Value>(),
            "power_law_incident": json::fit(&swept.incident),
            "power_law_reflected": json::fit(&swept.reflected),
        }));
    }
    let mut warnings: Vec<&String> = swept.points.iter().flat_map(|p| &p.warnings).collect();
    warnings.dedup();
    warnings
        .iter()
        .for_each(|warning| eprintln!("warning: {warning}"));
    let style = Style::of_accuracy(plan.accuracy, experiment.units());
    let rows: Vec<Vec<String>> = swept.points.iter().map(|point| row(style, point)).collect();
    let head = [
        "speed",
        "incident ToF",
        "reflected ToF",
        "sensor peak",
        "wall peak",
        "rebound",
    ];
    let mut text = format!("{}\n{}", experiment.title(), format::table(&head, &rows));
    text += &fit_line("incident", &swept.incident);
    text += &fit_line("reflected", &swept.reflected);
    print::print(&text)
}

fn row(style: Style, point: &Point) -> Vec<String> {
    let brief = Style { digits: 5, ..style };
    let speed = brief.quantity(point.speed_m_s, "m/s");
    let Ok(shot) = &point.shot else {
        return vec![speed, "no shot".to_owned()];
    };
    let missing = || "–".to_owned();
    let time = |time: Option<f64>| time.map_or_else(missing, |t| style.quantity(t, "s"));
    let seen = shot.passage.as_ref().ok();
    let force = |force: Option<f64>| force.map_or_else(missing, |f| brief.quantity(f, "N"));
    vec![
        speed,
        time(shot.flight.map(|flight| flight.incident_s)),
        time(shot.flight.and_then(|flight| flight.reflected_s)),
        force(seen.map(|seen| seen.incident.value)),
        force(seen.map(|seen| seen.wall.value)),
        shot.rebound
            .map_or_else(missing, |rebound| brief.quantity(rebound.end_m_s, "m/s")),
    ]
}

fn fit_line(name: &str, fit: &Result<PowerLaw, FitError>) -> String {
    match fit {
        Err(error) => format!("{name}: no power law: {error}\n"),
        Ok(law) => format!(
            "{name}: ToF = ({} ± {}) µs · (v/(1 m/s))^({} ± {}), R² = {}, largest deviation {} %\n",
            digits(1e6 * law.prefactor, 7),
            digits(1e6 * law.prefactor_error, 2),
            digits(law.exponent, 7),
            digits(law.exponent_error, 2),
            digits(law.r_squared, 8),
            digits(100.0 * law.largest_deviation(), 2),
        ),
    }
}

fn write(mut folder: Folder, experiment: &Experiment, swept: &Sweep) -> Result<(), Failure> {
    folder.write("sweep.csv", csv(swept).as_bytes())?;
    folder.figure("sweep", &pictures::sweep(experiment.title(), swept))?;
    eprint!("Written:\n{}", folder.list());
    Ok(())
}

fn csv(swept: &Sweep) -> String {
    let mut text = String::from(
        "speed_m_s,tof_incident_s,tof_reflected_s,sensor_peak_n,wall_peak_n,returning_peak_n,\
         striker_rebound_m_s,accuracy_reached\n",
    );
    for point in &swept.points {
        let Ok(shot) = &point.shot else { continue };
        let seen = shot.passage.as_ref().ok();
        let cells = [
            Some(point.speed_m_s),
            shot.flight.map(|flight| flight.incident_s),
            shot.flight.and_then(|flight| flight.reflected_s),
            seen.map(|seen| seen.incident.value),
            seen.map(|seen| seen.wall.value),
            seen.and_then(|seen| Some(seen.reflected?.value)),
            shot.rebound.map(|rebound| rebound.end_m_s),
            shot.accuracy_reached,
        ];
        let cells = cells.map(|cell| cell.map_or(String::new(), |value| value.to_string()));
        text += &format!("{}\n", cells.join(","));
    }
    text
}
