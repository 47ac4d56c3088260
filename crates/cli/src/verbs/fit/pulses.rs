//! Whole pulses of recordings to parameters.

use super::{Inferred, best, more, report, results, write_inferred};
use crate::arguments::infer::Fit as Arguments;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::format::digits;
use crate::inference::{self, user};
use crate::print::{self, heading};
use crate::table::cell;
use crate::verbs::measure::{files, list};
use hertzchain_experiment::{Amplifier as Numbers, Experiment};
use hertzchain_figures::{Chart, Colour, Figure, Legend, Marker, Series};
use hertzchain_infer::{
    Covariance, Goodness, Identifiability, Problem, PulseProblem, Pulses, Respond,
};
use hertzchain_measure::ShotList;
use hertzchain_measure::records::{ReadOptions, Record, read};
use hertzchain_rig::Amplifier;
use hertzchain_signal::Estimate;
use serde_json::{Value, json};

/// A fit of recordings.
struct Pulsed {
    problem: PulseProblem,
    inferred: Inferred,
    /// What was left out, and why.
    refused: Vec<String>,
}

/// Runs the verb on recordings.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let case = arguments.measured.case.as_deref();
    let experiment = inference::experiment(&arguments.modelled, case)?;
    let model = inference::model(&experiment, &arguments.modelled, &arguments.freed)?;
    let (records, refused) = records(&experiment, arguments)?;
    let records = spread(records, arguments.recorded.most_shots);
    let respond = respond(&experiment.campaign().amplifier);
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let pool = inference::pool(arguments.modelled.threads)?;
    let fitted = pool.install(|| {
        let problem = PulseProblem::new(model, records, respond);
        let problem = problem.map_err(|error| none_left(&error, &refused))?;
        let problem = inference::pulses(problem, &arguments.freed)?;
        fitted(problem, refused, arguments)
    })?;
    let all = results::joined(
        json(&fitted),
        results::inferred(&fitted.inferred, arguments),
    );
    match arguments.json {
        true => print::print_json(&all)?,
        false => print::print(&text(&fitted))?,
    }
    folder.map_or(Ok(()), |folder| write(folder, &fitted, &all))
}

/// An error, and what was refused before it.
fn none_left(error: &dyn std::fmt::Display, refused: &[String]) -> Failure {
    let lines: Vec<String> = refused
        .iter()
        .take(TOLD)
        .map(|r| format!("\n  {r}"))
        .collect();
    Failure::User(format!("{error}{}", lines.concat()))
}

/// Refused records that are told one by one.
const TOLD: usize = 5;

/// Every record that can be fitted, and why others can't.
fn records(
    experiment: &Experiment,
    arguments: &Arguments,
) -> Result<(Vec<Pulses>, Vec<String>), Failure> {
    let recorded = &arguments.recorded;
    let told = recorded.shots.as_deref().map(list).transpose()?;
    let reading = ReadOptions {
        rate_hz: recorded.rate,
        channels: recorded.channel.clone(),
        ..ReadOptions::default()
    };
    let (mut good, mut refused) = (Vec::new(), Vec::new());
    for file in files(&arguments.data, recorded.shots.as_deref())? {
        for record in read(&file, &reading) {
            let record = match record {
                Ok(record) => record,
                Err(error) => {
                    refused.push(error.to_string());
                    continue;
                }
            };
            let asked = arguments.measured.case.as_ref();
            if asked.is_some_and(|case| record.case.as_ref().is_some_and(|own| own != case)) {
                continue;
            }
            let speed = speed(&record, told.as_ref(), experiment, arguments);
            let volts: Vec<Vec<f64>> = record.channels.iter().map(|c| c.samples.volts()).collect();
            let speeds = (speed, record.programmed_speed_m_s);
            match Pulses::of(&record.source, speeds, record.interval_s, &volts) {
                Ok(pulses) => good.push(pulses),
                Err(error) => refused.push(error.to_string()),
            }
        }
    }
    Ok((good, refused))
}

/// The speed of a record's striker: as the table of shots says, or the record;
/// its error as either says, or the command line, or the model's photogate.
fn speed(
    record: &Record,
    told: Option<&ShotList>,
    experiment: &Experiment,
    arguments: &Arguments,
) -> Option<Estimate> {
    let listed = told.and_then(|list| list.speed(&record.file, record.shot));
    let (value, error) = listed.or(Some((record.speed_m_s?, record.speed_error_m_s)))?;
    let usual = experiment.campaign().photogate.error_m_s;
    Some(Estimate {
        value,
        sigma: error.or(arguments.measured.speed_error).unwrap_or(usual),
    })
}

/// At most so many, spread evenly.
fn spread(records: Vec<Pulses>, most: usize) -> Vec<Pulses> {
    let count = records.len();
    let kept = |at: &usize| at * most / count.max(1) != (at + 1) * most / count.max(1);
    let all = records.into_iter().enumerate();
    all.filter(|(at, _)| count <= most || kept(at))
        .map(|(_, r)| r)
        .collect()
}

/// The amplifier's filters.
fn respond(numbers: &Numbers) -> Respond {
    let plain = Numbers {
        sensitivity_c_n: 1.0,
        wall_sensitivity_c_n: 1.0,
        gain_v_c: 1.0,
        ..*numbers
    };
    Respond::new(move |signal, interval_s| {
        let mut amplifier = Amplifier::new(&plain, interval_s);
        signal
            .iter()
            .map(|force| amplifier.next(*force, 0.0))
            .collect()
    })
}

fn fitted(
    problem: PulseProblem,
    refused: Vec<String>,
    arguments: &Arguments,
) -> Result<Pulsed, Failure> {
    let fit = best(&problem, arguments)?;
    let parameters = problem.parameters();
    let covariance = Covariance::new(parameters, &fit);
    let label = |at: usize| problem.residual_label(at);
    let inferred = Inferred {
        parameters: parameters.to_vec(),
        identifiability: Identifiability::new(parameters, &fit, label),
        goodness: Goodness::beside(problem.nuisance_count(), parameters, &fit),
        more: more::more_of(&problem, (&fit, &covariance), None, arguments)?,
        covariance,
        fit,
    };
    Ok(Pulsed {
        problem,
        inferred,
        refused,
    })
}

/// Everything that is to be said.
fn text(fitted: &Pulsed) -> String {
    let records = fitted.problem.records();
    let noise = records.iter().flat_map(|record| &record.sigma_v);
    let noise_v = noise.fold(0.0, |most: f64, sigma| most.max(*sigma));
    let mut text = format!(
        "{}\n{} shots sample by sample: {} means of samples, each known to {} mV or better\n\n{}\n",
        heading(fitted.problem.model().experiment().title()),
        records.len(),
        fitted.problem.residual_count(),
        digits(1e3 * noise_v, 2),
        report::values(&fitted.inferred)
    );
    text += &report::described(&fitted.inferred, &fitted.problem);
    text += &report::determined(&fitted.inferred, &advice);
    text += &report::more(&fitted.inferred);
    text += &report::beware(&fitted.inferred);
    if !fitted.refused.is_empty() {
        text += &format!("{} records were left out:\n", fitted.refused.len());
        let told = fitted.refused.iter().take(TOLD);
        text += &told.map(|why| format!("  {why}\n")).collect::<String>();
    }
    text
}

/// What pulses do not tell apart.
fn advice() -> Vec<String> {
    vec![
        "shots at other speeds; K and A of the contacts in place of Y, nu and eta; a prior for \
         what is known, such as --prior wall_gain=1+-0.02"
            .to_owned(),
    ]
}

fn json(fitted: &Pulsed) -> Value {
    let records = fitted.problem.records().iter();
    json!({
        "model": fitted.problem.model().experiment().name(),
        "residuals": fitted.problem.residual_count(),
        "fitted_to_single_records": fitted.problem.nuisance_count(),
        "records": records.map(|record| json!({
            "source": record.source,
            "speed_m_s": record.speed_m_s.value,
            "speed_error_m_s": record.speed_m_s.sigma,
            "samples_in_a_mean": record.width,
            "error_of_means_v": record.sigma_v,
        })).collect::<Value>(),
        "left_out": fitted.refused,
    })
}

fn write(mut folder: Folder, fitted: &Pulsed, all: &Value) -> Result<(), Failure> {
    let shown = shown(fitted)?;
    folder.write("pulses.csv", pulses_csv(&shown).as_bytes())?;
    folder.figure("pulses", &picture(fitted, &shown))?;
    write_inferred(&mut folder, &fitted.inferred, all)?;
    eprint!("Written:\n{}", folder.list());
    Ok(())
}

/// A record's channel as it was measured and as the fit has it.
struct Shown<'a> {
    record: &'a Pulses,
    channel: usize,
    /// Times in s, measured and fitted voltages.
    columns: [Vec<f64>; 3],
}

/// All records at the best fit.
fn shown(fitted: &Pulsed) -> Result<Vec<Shown<'_>>, Failure> {
    let records = fitted.problem.records().iter().enumerate();
    let all = records.flat_map(|(at, record)| {
        (0..record.means_v.len()).map(move |channel| {
            let point = &fitted.inferred.fit.point;
            let columns = fitted.problem.picture(point, at, channel).map_err(user)?;
            Ok(Shown {
                record,
                channel,
                columns,
            })
        })
    });
    all.collect()
}

fn pulses_csv(shown: &[Shown<'_>]) -> String {
    let mut text = "source,channel,time_s,measured_V,error_V,fitted_V\n".to_owned();
    for Shown {
        record,
        channel,
        columns: [times, measured, model],
    } in shown
    {
        let source = record.source.replace('"', "\"\"");
        for (at, time) in times.iter().enumerate() {
            let cells = [*time, measured[at], record.sigma_v[*channel], model[at]].map(cell);
            text += &format!("\"{source}\",{},{}\n", channel + 1, cells.join(","));
        }
    }
    text
}

/// The slowest and the fastest record with the fit, residuals below each.
fn picture(fitted: &Pulsed, shown: &[Shown<'_>]) -> Figure {
    let speed = |one: &&Shown<'_>| one.record.speed_m_s.value;
    let first = shown.iter().filter(|one| one.channel == 0);
    let slowest = first.clone().min_by(|a, b| speed(a).total_cmp(&speed(b)));
    let fastest = first.max_by(|a, b| speed(a).total_cmp(&speed(b)));
    let mut figure = Figure::single_column(170.0);
    let one_speed = slowest.map(|s| speed(&s)) == fastest.map(|f| speed(&f));
    for one in slowest.into_iter().chain(fastest.filter(|_| !one_speed)) {
        figure = figure.panel(signal(fitted, one)).panel(residuals(one));
    }
    figure
}

fn in_us(times: &[f64]) -> Vec<f64> {
    times.iter().map(|time| 1e6 * time).collect()
}

fn signal(fitted: &Pulsed, shown: &Shown<'_>) -> Chart {
    let [times, measured, model] = &shown.columns;
    let title = fitted.problem.model().experiment().title();
    let speed = digits(shown.record.speed_m_s.value, 4);
    Chart::new("Time after the passing maximum (µs)", "Signal (V)")
        .title(&format!("{title}: {speed} m/s"))
        .with(
            Series::points("measured", &in_us(times), measured)
                .colour(Colour::BLUE)
                .marker(Marker::Circle),
        )
        .with(Series::line("fit", &in_us(times), model).colour(Colour::VERMILION))
}

fn residuals(shown: &Shown<'_>) -> Chart {
    let [times, measured, model] = &shown.columns;
    let sigma = shown.record.sigma_v[shown.channel];
    let pairs = measured.iter().zip(model);
    let residuals: Vec<f64> = pairs.map(|(a, b)| (a - b) / sigma).collect();
    Chart::new(
        "Time after the passing maximum (µs)",
        "Residual (standard errors)",
    )
    .h_line(0.0, "")
    .legend(Legend::Off)
    .with(Series::line("", &in_us(times), &residuals).colour(Colour::BLUE))
}
