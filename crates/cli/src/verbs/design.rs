//! `hertzchain design`: what to measure next.

use crate::arguments::infer::Design as Arguments;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::format::{self, digits};
use crate::inference::{self, user};
use crate::print::{self, heading};
use crate::table::cell;
use hertzchain_infer::{
    Candidate, CurveProblem, Design, Expected, ExpectedErrors, Fitting, Problem, design, fit,
    usual_ways,
};
use hertzchain_study::parse_speeds;
use serde_json::{Value, json};

/// Candidates that anybody reads.
const SHOWN: usize = 15;

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let data = inference::data(&arguments.data, &arguments.measured)?;
    let speeds = match &arguments.speeds {
        Some(speeds) => parse_speeds(speeds).map_err(user)?,
        None => usual_speeds(&data.speeds_m_s()),
    };
    let experiment = inference::experiment(&arguments.modelled, Some(&data.case))?;
    let model = inference::model(&experiment, &arguments.modelled, &arguments.freed)?;
    let problem = inference::problem(model, data, &arguments.freed)?;
    let targets = targets(&problem, arguments)?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let pool = inference::pool(arguments.modelled.threads)?;
    let (candidates, found) = pool.install(|| designed(&problem, &targets, &speeds, arguments))?;
    let all = json(&problem, &candidates, &found);
    match arguments.json {
        true => print::print_json(&all)?,
        false => print::print(&text(&problem, &candidates, &found))?,
    }
    folder.map_or(Ok(()), |mut folder| {
        folder.write("design.json", format!("{all:#}\n").as_bytes())?;
        folder.write("design.csv", csv(&problem, &candidates, &found).as_bytes())?;
        eprint!("Written:\n{}", folder.list());
        Ok(())
    })
}

/// A few speeds over the range of the data and a little beyond.
fn usual_speeds(speeds: &[f64]) -> Vec<f64> {
    let first = speeds.first().copied().unwrap_or(0.1) * 0.8;
    let last = speeds.last().copied().unwrap_or(1.0) * 1.25;
    let steps = 7;
    let speed = |at: i32| first * (last / first).powf(f64::from(at) / f64::from(steps));
    // Three digits are as near as a striker is set.
    let rounded = |speed: f64| format!("{speed:.3}").parse().unwrap_or(speed);
    (0..=steps).map(|at| rounded(speed(at))).collect()
}

/// Places of the named parameters; all of them where none is named.
fn targets(problem: &CurveProblem, arguments: &Arguments) -> Result<Vec<usize>, Failure> {
    let names: Vec<&str> = problem
        .parameters()
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    if arguments.target.is_empty() {
        return Ok((0..names.len()).collect());
    }
    let place = |target: &String| {
        let at = names.iter().position(|name| name == target);
        at.ok_or_else(|| {
            Failure::User(format!(
                "--target {target} is not free; free are {}",
                names.join(", ")
            ))
        })
    };
    arguments.target.iter().map(place).collect()
}

fn designed(
    problem: &CurveProblem,
    targets: &[usize],
    speeds: &[f64],
    arguments: &Arguments,
) -> Result<(Vec<Candidate>, Design), Failure> {
    let fit = fit(problem, &Fitting::default()).map_err(user)?;
    let ways = usual_ways(problem.model().experiment()).map_err(user)?;
    let errors = ExpectedErrors::like(problem.data());
    let candidates = problem
        .candidates(&fit, &ways, speeds, &errors)
        .map_err(user)?;
    let picks = arguments.picks;
    let found = design(problem.parameters(), &fit, &candidates, targets, picks).map_err(user)?;
    Ok((candidates, found))
}

fn text(problem: &CurveProblem, candidates: &[Candidate], found: &Design) -> String {
    let names: Vec<&str> = found
        .targets
        .iter()
        .map(|at| problem.parameters()[*at].name.as_str())
        .collect();
    let now = names
        .iter()
        .zip(&found.before)
        .map(|(name, sd)| format!("{name} ± {}", sd_text(*sd)));
    let now: Vec<String> = now.collect();
    let mut head = vec!["measure next".to_owned()];
    head.extend(names.iter().map(|name| format!("{name} ±")));
    head.push("information (nats)".to_owned());
    let row = |expected: &Expected| {
        let name = candidates[expected.candidate].name.clone();
        let after = expected.after.iter().map(|sd| sd_text(*sd));
        std::iter::once(name)
            .chain(after)
            .chain([digits(expected.gain, 3)])
            .collect::<Vec<_>>()
    };
    let best: Vec<Vec<String>> = found.ranked.iter().take(SHOWN).map(row).collect();
    let greedy: Vec<Vec<String>> = found.greedy.iter().map(row).collect();
    format!(
        "Now: {}\n\n{}\n{}\n{}\n{}",
        now.join(", "),
        heading("One measurement more, best first"),
        format::table(&head, &best),
        heading("A series, each the best after those before it"),
        format::table(&head, &greedy)
    )
}

fn sd_text(sd: f64) -> String {
    match sd.is_finite() {
        true => digits(sd, 3),
        false => "not determined".to_owned(),
    }
}

fn json(problem: &CurveProblem, candidates: &[Candidate], found: &Design) -> Value {
    let finite = |x: f64| x.is_finite().then_some(x);
    let one = |expected: &Expected| {
        json!({
            "measure": candidates[expected.candidate].name,
            "standard_errors": expected.after.iter().map(|sd| finite(*sd)).collect::<Vec<_>>(),
            "information_nats": expected.gain,
        })
    };
    json!({
        "parameters": found.targets.iter().map(|at| problem.parameters()[*at].name.clone()).collect::<Vec<_>>(),
        "standard_errors_now": found.before.iter().map(|sd| finite(*sd)).collect::<Vec<_>>(),
        "ranked": found.ranked.iter().map(one).collect::<Value>(),
        "series": found.greedy.iter().map(one).collect::<Value>(),
    })
}

fn csv(problem: &CurveProblem, candidates: &[Candidate], found: &Design) -> String {
    let names = found
        .targets
        .iter()
        .map(|at| format!(",{}_error", problem.parameters()[*at].name));
    let mut text = format!("measure{},information_nats\n", names.collect::<String>());
    for expected in &found.ranked {
        let after = expected.after.iter().map(|sd| match sd.is_finite() {
            true => format!(",{}", cell(*sd)),
            false => ",".to_owned(),
        });
        let name = &candidates[expected.candidate].name;
        text += &format!(
            "\"{name}\"{},{}\n",
            after.collect::<String>(),
            cell(expected.gain)
        );
    }
    text
}
