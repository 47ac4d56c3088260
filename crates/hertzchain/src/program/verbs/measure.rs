//! `hertzchain measure`: records of a rig to times of flight.

mod pictures;
pub(super) mod summary;

use crate::measure::{self, MeasureResult};
use crate::options::MeasureOptions as Arguments;
use crate::program::{Counter, Failure, Folder, failure, print, require_free};
use hertzchain_figures::Figure;
use hertzchain_measure::records::{without_controls, write_whole};
use hertzchain_measure::{
    Curves, Example, Measurement, Note, Options, Shot, laws_csv, ratios_csv, speeds_csv,
    write_shots,
};
use std::path::Path;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let most_flagged = if arguments.report.is_some() { MOST_FLAGGED } else { 0 };
    let rig = measure::rig(arguments)?;
    failure::print_improbable(&rig);
    let options = Options { most_flagged, ..measure::options(arguments, rig.as_ref())? };
    let replace = arguments.force;
    let folder = Folder::asked(arguments.out.as_deref(), &[MEASURED, SHOTS], replace)?
        .map(|folder| folder.with_optional(OPTIONAL));
    let report = arguments.report.as_deref();
    report.map_or(Ok(()), |path| require_free(path, "--report", replace))?;
    let counter = Counter::new("records", 0);
    let found = measure::measure_watched(&arguments.records, arguments, &options, &counter);
    counter.finish();
    let MeasureResult { shots: measured, curves } = found?;
    list_notes(&measured);
    note_low_pass(&measured, &options, arguments.picking.low_pass.map(|corner| corner.0));
    match arguments.json {
        true => print::print_with(|out| measure::write_json(&measured, &curves, out))?,
        false => print::print(&summary::text(&measured, &curves, &arguments.reference))?,
    }
    if let Some(path) = report {
        write_page(path, &measured, &curves)?;
    }
    if let Some(folder) = folder {
        write(folder, &measured, (&curves, &arguments.reference))?;
    }
    measure::evaluate(&measured)
}

/// Everything, in the output folder.
pub(super) const MEASURED: &str = "measured.json";

const SHOTS: &str = "shots.csv";

/// Of records with times, speeds or a reference only.
const OPTIONAL: &[&str] =
    &["speeds.csv", "power-laws.csv", "ratios.csv", "signals", "times-of-flight", "ratios"];

/// Most lines about the table of shots, which may be of other recordings.
const MOST_LINES: usize = 20;

/// What is to be known of records beside their times.
fn list_notes(measured: &Measurement) {
    for refused in &measured.refused {
        print::note(&format!("refused: {refused}"));
    }
    for line in measured.unmatched.iter().take(MOST_LINES) {
        print::note(&format!("--shots: {line}"));
    }
    if let more @ 1.. = measured.unmatched.len().saturating_sub(MOST_LINES) {
        print::note(&format!("--shots: … and {more} more; measured.json has all"));
    }
    for Note { text, files } in &measured.notes {
        let first = files.first().map(|file| file.display().to_string());
        let more = match files.len() {
            0 | 1 => String::new(),
            files => format!(" and {} more", files - 1),
        };
        print::note(&format!("note: {}{more}: {text}", first.unwrap_or_default()));
    }
}

/// Notes whether maxima are those before the amplifier's low-pass, unless the user left it as it is
/// by a corner of 0, or notes on files that state it say so.
fn note_low_pass(measured: &Measurement, options: &Options, asked_hz: Option<f64>) {
    match (options.measuring.bandwidth.and(measured.bandwidth), asked_hz) {
        (Some(bandwidth), _) => {
            print::note(&format!("note: maxima are corrected for the amplifier's {bandwidth}"));
        }
        (None, None) if measured.bandwidth.is_none() => print::note(
            "note: times are not corrected for the amplifier's low-pass: its corner is not stated \
             (--low-pass, --rig)",
        ),
        _ => {}
    }
}

fn write(
    mut folder: Folder,
    measured: &Measurement,
    (curves, reference): (&Curves, &str),
) -> Result<(), Failure> {
    tables(&mut folder, measured, curves)?;
    if let Some(figure) = pictures::signals(&measured.examples) {
        folder.figure("signals", &figure)?;
    }
    if !curves.cases.is_empty() {
        folder.figure("times-of-flight", &pictures::times(curves))?;
    }
    if has_ratios(curves) {
        folder.figure("ratios", &pictures::ratios(curves, reference))?;
    }
    folder.finish_and_report()
}

pub(super) fn tables(
    folder: &mut Folder,
    measured: &Measurement,
    curves: &Curves,
) -> Result<(), Failure> {
    folder.write_with(SHOTS, |out| write_shots(&measured.shots, curves, out))?;
    folder.write_with(MEASURED, |out| measure::write_json(measured, curves, out))?;
    if !(curves.cases.is_empty() && curves.unmeasured.is_empty()) {
        folder.write("speeds.csv", speeds_csv(curves).as_bytes())?;
    }
    if !curves.cases.is_empty() {
        folder.write("power-laws.csv", laws_csv(curves).as_bytes())?;
    }
    if has_ratios(curves) {
        folder.write("ratios.csv", ratios_csv(curves).as_bytes())?;
    }
    Ok(())
}

fn has_ratios(curves: &Curves) -> bool {
    curves.ratios.iter().any(|wet| !wet.incident.is_empty())
}

const MOST_FLAGGED: usize = 500;

const HEAD: &str = "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\">\
<title>Flagged shots</title>\n<style>body{font-family:sans-serif;max-width:60em;margin:auto}\
img{width:100%}h2{font-size:1em;margin-top:2em}</style>\n";

/// Writes the page: one HTML file, without anything beside it.
fn write_page(path: &Path, measured: &Measurement, curves: &Curves) -> Result<(), Failure> {
    let page = page(measured, curves.keep_dubious);
    write_whole(path, |out| out.write_all(page.as_bytes()))
        .map_err(|error| Failure::User(format!("cannot write {}: {error}", path.display())))
}

fn page(measured: &Measurement, keep_dubious: bool) -> String {
    let flagged = measured.shots.iter().filter(|shot| !shot.flags().is_empty()).count();
    let (shown, all) = (measured.flagged.len(), measured.shots.len());
    let mut page = format!("{HEAD}<h1>{flagged} of {all} shots are flagged</h1>\n");
    if shown < flagged {
        page += &format!("<p>The first {shown} are shown.</p>\n");
    }
    for refused in &measured.refused {
        page += &format!("<p>refused: {}</p>\n", escaped(&refused.to_string()));
    }
    measured.flagged.iter().for_each(|example| page += &section(example, keep_dubious));
    page + "</html>\n"
}

fn section(example: &Example, keep_dubious: bool) -> String {
    let Shot { source, .. } = &example.shot;
    let counted = match example.shot.reasons(keep_dubious) {
        none if none.is_empty() => "counts".to_owned(),
        codes => format!("does not count: {}", codes.join(", ")),
    };
    let figure = Figure::double_column(63.0).panel(pictures::signal(example));
    format!(
        "<h2>{}</h2>\n<p>{}; {counted}</p>\n<img alt=\"\" src=\"data:image/svg+xml,{}\">\n",
        escaped(source),
        escaped(&example.shot.flags()),
        in_address(&figure.svg())
    )
}

fn escaped(text: &str) -> String {
    without_controls(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A picture as a part of an address.
fn in_address(svg: &str) -> String {
    let mut address = String::with_capacity(svg.len() + svg.len() / 4);
    for letter in svg.chars() {
        match letter {
            '%' | '#' | '"' | '<' | '>' | '\n' | '\r' | '\t' => {
                address += &format!("%{:02X}", u32::from(letter));
            }
            plain => address.push(plain),
        }
    }
    address
}
