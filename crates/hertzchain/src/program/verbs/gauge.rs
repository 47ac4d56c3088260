//! `hertzchain gauge`: which oil is on the contacts.

mod pictures;

use crate::gauge::{self, GaugeResult};
use crate::inference::{self, references};
use crate::options::GaugeOptions as Arguments;
use crate::program::{
    Failure, Folder, chi_square_text, digits, estimate, failure, format, heading, lines, misfit,
    percent, print, print_assumed, with_error, with_notes,
};
use hertzchain_infer::gauge::{Contact, NEVER, Pair, WetRow, is_determined};
use hertzchain_infer::{
    Covariance, CurveProblem, Fit, Identifiability, Parameter, Problem, titled,
};
use hertzchain_measure::signal::ChiSquare;
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
    let folder = Folder::asked(arguments.out.as_deref(), &[FILE], arguments.force)?
        .map(|folder| folder.with_optional(&["film.csv", "oils.csv", "failed.csv", "contacts"]));
    let chains = [&wet_model, &dry_model];
    let run_gauge =
        with_notes(arguments.threads, || gauge::gauge([wet, dry], chains, oils, arguments))?;
    let mut all = gauge::json(&run_gauge);
    all["options"] = crate::options::recorded(arguments);
    print::result(arguments.json, &mut all, assumed, || text(&run_gauge))?;
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

fn text(run_gauge: &GaugeResult) -> String {
    let doubts = doubts(run_gauge);
    let mut text = doubts.clone();
    let (dry_model, wet_model) = (run_gauge.gauge.dry.model(), &run_gauge.gauge.wet);
    text += &format!(
        "{}\n{}{}\n",
        heading("Dry contacts"),
        dry(run_gauge),
        lines(references(dry_model))
    );
    text += &format!(
        "{}\n{}{}",
        heading("Wet contacts"),
        contacts(run_gauge),
        lines(references(wet_model))
    );
    text += &match &run_gauge.film {
        Some(film) => format!("\n{}\n{}", heading("Film"), joint_numbers(film)),
        None => oils(run_gauge),
    };
    text += &format!("{}\n", run_gauge.sentence());
    // Tables may be longer than a screen: who sees the verdict alone is reported, too.
    match doubts.is_empty() {
        true => text,
        false => text + "warning: see the first lines.\n",
    }
}

/// What K and A rest on, and the known oils.
fn oils(run_gauge: &GaugeResult) -> String {
    let mut text = String::new();
    if let Some(add) = run_gauge.gauge.to_add() {
        text += &format!(
            "One number a speed determines one combination of K and A. To determine both, {add}.\n"
        );
    }
    text += &held_numbers(run_gauge);
    text +=
        &run_gauge.gauge.ambiguous(&run_gauge.rows).map_or(String::new(), |why| format!("{why}\n"));
    text += &format!("\n{}\n{}", heading("Known oils"), matches(run_gauge));
    for (oil, why) in &run_gauge.verdict.failed {
        text += &format!("{oil} can't be computed: {why}\n");
    }
    text
}

/// Before all else: what speaks against believing what is below.
fn doubts(run_gauge: &GaugeResult) -> String {
    let dry = misfit(&run_gauge.gauge.dry_goodness())
        .map(|reported| format!("of the dry curve, on which all below rests, {reported}."));
    let all = dry.into_iter().chain(run_gauge.doubts());
    let lines: String = all.map(|doubt| format!("warning: {doubt}\n")).collect();
    match lines.is_empty() {
        true => lines,
        false => lines + "\n",
    }
}

fn dry(run_gauge: &GaugeResult) -> String {
    let gauge = &run_gauge.gauge;
    let parameters = gauge.dry.parameters().iter().enumerate();
    let rows = parameters.map(|(at, parameter)| {
        let (value, sd) = (gauge.dry_fit.point[at], gauge.dry_covariance.sd[at]);
        (parameter.name.clone(), estimate(parameter, value, sd))
    });
    let chi_square = gauge.dry_goodness().chi_square;
    let chi_square = chi_square.map_or(String::new(), |found| chi_square_text(found) + "\n");
    format::pairs(rows) + &chi_square
}

/// All numbers of both curves, and what they leave open.
fn joint_numbers((problem, fit, found): &(CurveProblem, Fit, Option<ChiSquare>)) -> String {
    let sd = Covariance::new(problem.parameters(), fit).sd;
    let values = problem.parameters().iter().zip(fit.point.iter().zip(&sd));
    let rows = values.map(|(of, (value, sd))| (of.name.clone(), estimate(of, *value, *sd)));
    let label = |at: usize| problem.residual_label(at);
    let identified = Identifiability::new(problem.parameters(), fit, label);
    let open =
        identified.unidentifiable.into_iter().map(|one| format!("not determined: {}", one.words));
    let chi_square = found.map(|of| format!("wet curve: {}", chi_square_text(of)));
    format::pairs(rows) + &lines(open.chain(chi_square))
}

/// K in GN/m^1.5 and A in ns, with their errors.
fn shown(pair: &Pair) -> [String; 2] {
    let [(k, k_sd), (a, a_sd)] = pair.estimates();
    [reported(1e-9 * k, 1e-9 * k_sd), reported(1e9 * a, 1e9 * a_sd)]
}

/// A positive number with its error, if it is known.
fn reported(value: f64, sd: f64) -> String {
    if !is_determined(value, sd) {
        return "not determined".to_owned();
    }
    let (value, sd) = with_error(value, sd);
    format!("{value} ± {sd}")
}

/// A line for each pair that a row allows.
fn pairs(contact: &Contact) -> Vec<[String; 3]> {
    let line = |pair: &Pair, words: &str| {
        let [k, a] = shown(pair);
        [k, a, words.to_owned()]
    };
    if let Some(combination) = &contact.combination {
        let words = format!(
            "K·(A/{} ns)^{}",
            digits(1e9 * combination.reference_s, 4),
            digits(combination.exponent, 3)
        );
        let [k, _] = shown(&contact.first);
        return vec![[k, "–".to_owned(), words]];
    }
    // None before the others, where nothing determines which.
    let (all, first) = match contact.is_known() {
        true => (std::iter::once(&contact.first).chain(&contact.others).collect(), ""),
        false => (contact.pairs(), "either"),
    };
    let words = std::iter::once(first).chain(std::iter::repeat("or"));
    all.into_iter().zip(words).map(|(pair, words)| line(pair, words)).collect()
}

fn of_film(number: &Parameter, value: f64, sd: f64) -> String {
    match is_determined(value, sd) {
        true => estimate(&Parameter { unit: String::new(), ..number.clone() }, value, sd),
        false => "not determined".to_owned(),
    }
}

fn contacts(run_gauge: &GaugeResult) -> String {
    let film = run_gauge.gauge.film_number();
    let lines = |row: &WetRow| -> Vec<Vec<String>> {
        let speed = digits(row.speed_m_s, 4);
        let lines = match &row.contact {
            Ok(contact) => match &film {
                None => pairs(contact),
                Some(film) => {
                    let [(value, sd), _] = contact.first.estimates();
                    vec![[of_film(film, value, sd), String::new(), String::new()]]
                }
            },
            Err(why) => vec![["–".to_owned(), "–".to_owned(), why.clone()]],
        };
        let speeds = std::iter::once(speed).chain(std::iter::repeat(String::new()));
        let whole = speeds.zip(lines);
        whole.map(|(speed, line)| std::iter::once(speed).chain(line).collect()).collect()
    };
    let rows: Vec<Vec<String>> = run_gauge.rows.iter().flat_map(lines).collect();
    let film = film.map(|of| titled(&of.name, &of.unit));
    let first = film.as_deref().unwrap_or("K (GN/m^1.5)");
    let second = if film.is_some() { "" } else { "A (ns)" };
    let head = ["v (m/s)", first, second, ""];
    let filled = (2..=3).rfind(|at| rows.iter().any(|row| !row[*at].is_empty()));
    let shown = filled.map_or(2, |last| last + 1);
    format::table(&head[..shown], rows.iter().map(|row| &row[..shown]))
}

/// What K and A take for granted.
fn held_numbers(run_gauge: &GaugeResult) -> String {
    let own = run_gauge.gauge.wet_own(&[]);
    let each = own.iter().map(|parameter| {
        format!("{} = {} {}", parameter.name, digits(parameter.start, 4), parameter.unit)
    });
    let each: Vec<String> = each.collect();
    match each.is_empty() {
        true => String::new(),
        false => format!(
            "K and A hold for {}, as the wet model has it; their errors know of no other. The oils below are \
             each taken at their best.\n",
            each.join(", ")
        ),
    }
}

/// How often chance alone gives as much; what is never is not reported to its digits.
fn by_chance(probability: f64) -> String {
    match probability < NEVER {
        true => format!("below {:.0e} %", 100.0 * NEVER),
        false => percent(probability),
    }
}

fn matches(run_gauge: &GaugeResult) -> String {
    let own = run_gauge.gauge.wet_own(&[]);
    let rows = run_gauge.verdict.matches.iter().map(|found| {
        let mut row = vec![
            found.oil.clone(),
            digits(found.distance, 3),
            by_chance(found.chi_square.probability),
            if found.fits() { "possible" } else { "rejected" }.to_owned(),
        ];
        // One column a number that is the same at all speeds.
        let found = found.own.iter().take(own.len());
        row.extend(found.map(|own| estimate(&own.parameter, own.value, own.standard_error)));
        row
    });
    let head = ["oil", "distance (standard errors)", "as far by chance", "verdict"];
    let own = own.iter().map(|parameter| parameter.name.as_str());
    format::table(head.into_iter().chain(own), rows)
}
