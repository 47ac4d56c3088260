//! `hertzchain gauge`: which oil is on the contacts.

mod pictures;
mod report;

use crate::gauge::{self, GaugeResult};
use crate::inference;
use crate::options::GaugeOptions as Arguments;
use crate::program::{Failure, Folder, failure, print, print_assumed, with_notes};
use std::path::Path;

const FILE: &str = "gauge.json";

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let [wet_file, dry_file] =
        [&arguments.wet, &arguments.dry].map(|file| file.as_deref().unwrap_or(Path::new("")));
    let wet = inference::data(wet_file, &arguments.measured, arguments.wet_case.as_deref())?;
    let dry = inference::data(dry_file, &arguments.measured, arguments.dry_case.as_deref())?;
    for data in [&wet, &dry] {
        print_assumed(data, &arguments.measured);
    }
    let oils = gauge::all_oils(arguments.oils.as_deref())?;
    let [wet_model, dry_model] = gauge::models(arguments, [&wet.case, &dry.case])?;
    failure::print_improbable([&wet_model, &dry_model]);
    let assumed = gauge::assumed_models(
        arguments.model.is_some() || arguments.preset.is_some(),
        arguments.dry_model.is_some() || arguments.dry_preset.is_some(),
    );
    let folder = Folder::asked(arguments.out.as_deref(), &[FILE], arguments.force)?;
    let chains = [&wet_model, &dry_model];
    let run_gauge =
        with_notes(arguments.threads, || gauge::gauge([wet, dry], chains, oils, arguments))?;
    let mut all = gauge::json(&run_gauge);
    all["options"] = crate::options::recorded(arguments);
    print::result(arguments.json, &mut all, assumed, || report::text(&run_gauge))?;
    folder.map_or(Ok(()), |folder| write(folder, &run_gauge, &all))
}

fn write(
    mut folder: Folder,
    run_gauge: &GaugeResult,
    all: &serde_json::Value,
) -> Result<(), Failure> {
    folder.write(FILE, format!("{all:#}\n").as_bytes())?;
    folder.tables(&gauge::tables(run_gauge, all))?;
    if run_gauge.rows.iter().any(|row| row.contact.is_ok()) {
        folder.figure("contacts", &pictures::contacts(run_gauge))?;
    }
    folder.finish_and_report()
}
