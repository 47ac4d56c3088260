//! `hertzchain design`: what to measure next.

use crate::design::DesignResult;
use crate::options::DesignOptions as Arguments;
use crate::program::{
    Failure, Folder, digits, format, heading, lines, misfit, print, print_assumed, print_stored,
    with_notes,
};
use crate::{design, inference};
use hertzchain_infer::{CurveProblem, Expected, ExpectedErrors, Observable, titled};
use std::path::Path;

const SHOWN: usize = 15;

const FILE: &str = "design.json";

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let file = arguments.data.as_deref().unwrap_or(Path::new(""));
    let data = inference::data(file, &arguments.measured, None)?;
    let speeds = design::speeds(&data, arguments)?;
    let experiment = inference::experiment(&arguments.modelled, Some(&data.case))?;
    let model = inference::model(&experiment, &arguments.modelled, &arguments.freed)?;
    print_assumed(&data, &arguments.measured);
    print_stored([&model], &arguments.modelled.set);
    let problem = inference::problem(model, data, &arguments.freed)?;
    let targets = design::targets(&problem, arguments)?;
    let folder = Folder::asked(arguments.out.as_deref(), &[FILE], arguments.force)?;
    let run_design = with_notes(arguments.modelled.threads, || {
        design::run_design(&problem, &targets, &speeds, arguments)
    })?;
    let mut all = design::json(&problem, &run_design);
    all["options"] = crate::options::recorded(arguments);
    let assumed = inference::assumed_model(&arguments.modelled);
    print::result(arguments.json, &mut all, assumed, || text(&problem, &run_design))?;
    folder.map_or(Ok(()), |mut folder| {
        folder.write(FILE, format!("{all:#}\n").as_bytes())?;
        folder.tables(&design::tables(&all))?;
        folder.finish_and_report()
    })
}

fn text(problem: &CurveProblem, run_design: &DesignResult) -> String {
    let (candidates, found) = (&run_design.candidates, &run_design.design);
    let names = &run_design.names;
    let now = names.iter().zip(&found.before).zip(&run_design.units).map(|((name, sd), unit)| {
        format!("{name} ± {} {unit}", sd_text(*sd)).trim_end().to_owned()
    });
    let now: Vec<String> = now.collect();
    let mut head = vec!["measure next".to_owned()];
    let units = names.iter().zip(&run_design.units);
    head.extend(units.map(|(name, unit)| titled(&format!("{name} ±"), unit)));
    head.push("information (nats)".to_owned());
    let priced = candidates.iter().any(|candidate| candidate.cost != 1.0);
    if priced {
        head.extend(["cost", "information over cost"].map(str::to_owned));
    }
    let row = |expected: &Expected| {
        let name = candidates[expected.candidate].name.clone();
        let after = expected.after.iter().map(|sd| sd_text(*sd));
        std::iter::once(name)
            .chain(after)
            .chain([digits(expected.gain, 3)])
            .chain(priced.then(|| digits(candidates[expected.candidate].cost, 3)))
            .chain(priced.then(|| digits(expected.gain_per_cost, 3)))
            .collect::<Vec<_>>()
    };
    format!(
        "{}Now: {}\n{}\n{}{}\n{}\n{}\n{}\n{}",
        unfit(run_design),
        now.join(", "),
        expected(&run_design.errors),
        lines(inference::references(problem.model())),
        warnings(problem, run_design),
        heading("One measurement more, best first"),
        format::table(&head, found.ranked.iter().take(SHOWN).map(row)),
        heading("A series, each the best after those before it"),
        format::table(&head, found.greedy.iter().map(row))
    )
}

/// Which errors the measurements to come are taken to have.
fn expected(errors: &ExpectedErrors) -> String {
    // No candidate has the wall's ratio.
    let read = |(of, _): &(Observable, f64)| *of != Observable::WallOverPassing;
    let named = Observable::ALL.into_iter().zip(errors.values).filter(read);
    let named = named.map(|(of, error)| format!("{} {}", of.column(), digits(error, 3)));
    let freedom = errors.freedom.values.into_iter().fold(errors.freedom.speed, f64::min);
    let widened = match freedom.is_finite() {
        true => format!("; of {freedom:.0} degrees of freedom at the least, and widened for that"),
        false => String::new(),
    };
    format!(
        "Expected errors (medians of the data's; usual ones where it has none): speed_m_s {}, {}, tof_correlation {}{widened}",
        digits(errors.speed_m_s, 3),
        named.collect::<Vec<_>>().join(", "),
        digits(errors.correlation, 3)
    )
}

/// Before all else: a ranking by a model that the data so far do not follow.
fn unfit(run_design: &DesignResult) -> String {
    misfit(&run_design.goodness)
        .map_or(String::new(), |misfit| format!("warning: {misfit}; nor is its ranking.\n\n"))
}

/// What standard errors of open combinations are worth, and what would close them.
fn warnings(problem: &CurveProblem, run_design: &DesignResult) -> String {
    let undetermined = &run_design.undetermined;
    if undetermined.is_empty() {
        return String::new();
    }
    let open = undetermined.iter().map(|words| format!("  Not determined so far: {words}.\n"));
    let advice = run_design.advice.iter();
    let advice = advice.map(|advice| format!("  What would help: {advice}.\n"));
    let unidentifiable = run_design.unidentifiable(problem).into_iter();
    let unidentifiable = unidentifiable.map(|reported| format!("  {reported}.\n"));
    format!(
        "warning: the data so far leave combinations of the parameters open.\n{}{}{}",
        open.collect::<String>(),
        unidentifiable.collect::<String>(),
        advice.collect::<String>()
    )
}

fn sd_text(sd: f64) -> String {
    match sd.is_finite() {
        true => digits(sd, 3),
        false => "not determined".to_owned(),
    }
}
