//! Whole pulses of recordings to parameters.

use super::{open_folder, report, write_inferred};
use crate::fit::pulses::{Pulsed, REPORTED, Shown, fit_result, json, pulses_csv, recorded, shown};
use crate::fit::tables_of_any;
use crate::inference;
use crate::options::FitOptions as Arguments;
use crate::program::{Failure, Folder, digits, heading, lines, print, print_stored, with_notes};
use hertzchain_figures::{Chart, Colour, Figure, Marker, Series};
use hertzchain_infer::Problem;
use serde_json::Value;

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let recorded = recorded(arguments)?;
    let folder = open_folder(arguments)?;
    let fit_result = with_notes(arguments.modelled.threads, || fit_result(recorded, arguments))?;
    print_stored([&fit_result.problem.model], &arguments.modelled.set);
    let mut all = json(&fit_result, arguments);
    let assumed = inference::assumed_model(&arguments.modelled);
    print::result(arguments.json, &mut all, assumed, || text(&fit_result, arguments))?;
    folder.map_or(Ok(()), |folder| write(folder, &fit_result, &all))
}

fn text(pulsed: &Pulsed, arguments: &Arguments) -> String {
    let records = &pulsed.problem.records;
    let noise = records.iter().flat_map(|record| &record.sigma_v);
    let noise_v = noise.fold(0.0, |most: f64, sigma| most.max(*sigma));
    let mut text = format!(
        "{}\n{} shots sample by sample: {} means of samples, each known to {} mV or better\n\n{}\n{}",
        heading(pulsed.problem.model.experiment.title()),
        records.len(),
        pulsed.problem.residual_count(),
        digits(1e3 * noise_v, 2),
        report::values(&pulsed.inferred),
        lines(inference::references(&pulsed.problem.model))
    );
    text += &format!("The model's signals pass the amplifier's filters: {}\n", pulsed.filters());
    text += &report::described(&pulsed.inferred);
    text += &lines(pulsed.unasked(arguments));
    text += &report::determined(&pulsed.inferred, &advice);
    text += &report::more(&pulsed.inferred);
    text += &report::warnings(&pulsed.inferred);
    if !pulsed.refused.is_empty() {
        text += &format!("{} records were left out:\n", pulsed.refused.len());
        let reported = pulsed.refused.iter().take(REPORTED);
        text += &reported.map(|why| format!("  {why}\n")).collect::<String>();
    }
    text
}

/// What pulses do not separate.
fn advice() -> Vec<String> {
    vec![
        "shots at other speeds; K and A of the contacts in place of Y, nu and eta; a prior for \
         what is known, such as --prior wall_gain=1+-0.02"
            .to_owned(),
    ]
}

fn write(mut folder: Folder, pulsed: &Pulsed, all: &Value) -> Result<(), Failure> {
    let shown = shown(pulsed)?;
    folder.write("pulses.csv", pulses_csv(&shown).as_bytes())?;
    folder.figure("pulses", &picture(&shown))?;
    let tables = tables_of_any(all, &pulsed.inferred.more);
    write_inferred(folder, &pulsed.inferred, (all, &tables))
}

/// The slowest and the fastest record with the fit, residuals below each.
fn picture(shown: &[Shown<'_>]) -> Figure {
    let speed = |one: &&Shown<'_>| one.record.speed_m_s.value;
    let first = shown.iter().filter(|one| one.channel == 0);
    let slowest = first.clone().min_by(|a, b| speed(a).total_cmp(&speed(b)));
    let fastest = first.max_by(|a, b| speed(a).total_cmp(&speed(b)));
    let mut figure = Figure::single_column(170.0);
    let one_speed = slowest.map(|s| speed(&s)) == fastest.map(|f| speed(&f));
    for one in slowest.into_iter().chain(fastest.filter(|_| !one_speed)) {
        figure = figure.panel(signal(one)).panel(residuals(one));
    }
    figure
}

fn in_us(times: &[f64]) -> Vec<f64> {
    times.iter().map(|time| 1e6 * time).collect()
}

/// An empty chart over all of a record's time, so that panels below each other line up.
fn over_time(shown: &Shown<'_>, label: &str) -> Chart {
    let times = in_us(&shown.columns[0]);
    let chart = Chart::new("Time after the passing maximum (µs)", label);
    match (times.first(), times.last()) {
        (Some(first), Some(last)) => chart.x_range(*first, *last),
        _ => chart,
    }
}

fn signal(shown: &Shown<'_>) -> Chart {
    let [times, measured, model] = &shown.columns;
    let speed = digits(shown.record.speed_m_s.value, 4);
    over_time(shown, "Signal (V)")
        .title(&format!("{speed} m/s: {}", shown.record.source))
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
    over_time(shown, "Residual (standard errors)").h_line(0.0, "").legend(false).with(
        Series::points("", &in_us(times), &residuals).colour(Colour::BLUE).marker(Marker::Circle),
    )
}
