//! What needs no computation: of the program itself, of experiments, laws and presets.

use crate::bibliography::Publication;
use crate::laws::nature;
use crate::options::CheckOptions;
use crate::program::arguments::{LawsArguments, Presets, Program};
use crate::program::{Failure, Folder, failure, format, lines, print};
use crate::{describe, input};
use clap::{Command, CommandFactory};
use clap_complete::{Shell, generate};
use clap_mangen::Man;
use hertzchain_chain::laws::{LawInfo, Parameter, Source};
use hertzchain_experiment::{campaigns, examples, film_presets, preset};
use hertzchain_sim::InstructionSet;
use serde_json::json;
use std::path::Path;

/// Prints the version and, if asked for, how this machine computes.
pub(crate) fn version(verbose: bool) -> Result<(), Failure> {
    let mut text = format!("hertzchain {}\n", env!("CARGO_PKG_VERSION"));
    if verbose {
        let sets = InstructionSet::available();
        let names: Vec<&str> = sets.into_iter().map(InstructionSet::name).collect();
        text += &format!(
            "instruction set  {}\navailable here   {}\nto choose        {}=NAME\n",
            input::instruction_set()?.name(),
            names.join(", "),
            input::INSTRUCTION_SET,
        );
    }
    print::print(&text)
}

pub(crate) fn schema() -> Result<(), Failure> {
    print::print_json(&hertzchain_experiment::schema())
}

pub(crate) fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    generate(shell, &mut Program::command(), "hertzchain", &mut script);
    print::print(&String::from_utf8_lossy(&script))
}

/// Prints the manual page, or writes one page a verb.
pub(crate) fn man(out: Option<&Path>) -> Result<(), Failure> {
    let mut program = Program::command();
    program.build();
    let Some(out) = out else {
        return print::print(&String::from_utf8_lossy(&page(program)?));
    };
    // Pages are this version's, and no results of a run.
    let mut folder = Folder::open(out, &[], true)?;
    folder.write("hertzchain.1", &page(program.clone())?)?;
    for verb in program.get_subcommands().filter(|verb| verb.get_name() != "help") {
        let name = format!("hertzchain-{}", verb.get_name());
        let titled = verb.clone().display_name(name.clone());
        folder.write(&format!("{name}.1"), &page(titled)?)?;
    }
    print::print(&format!("Manual pages:\n{}", folder.finish()?))
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    let rendered = Man::new(command).render(&mut page);
    rendered.map_err(|error| Failure::Ours(format!("manual page: {error}")))?;
    Ok(page)
}

pub(crate) fn check(arguments: &CheckOptions) -> Result<(), Failure> {
    if !input::is_named(&arguments.input) {
        return Err(Failure::User("check needs an experiment: FILE or --preset NAME".into()));
    }
    let experiment = input::open(&arguments.input)?;
    let found = describe::check(&experiment, arguments)?;
    if arguments.json {
        let warnings: Vec<String> = found.warnings.iter().map(|w| w.one_line()).collect();
        return print::print_json(&json!({ "groups": found.groups, "warnings": warnings }));
    }
    failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
    print::print(&format::groups(&found.groups, experiment.units()))
}

pub(crate) fn theory(arguments: &CheckOptions) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let found = describe::theory(&experiment, arguments)?;
    let assumed = input::assumed(&arguments.input);
    if arguments.json {
        // A list of groups has no place for these.
        print::warn(assumed);
        failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
        return print::print_json(&json!(found.groups));
    }
    failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
    let text = match found.groups.is_empty() {
        true => "No closed theory fits this chain: no striker, no preload.".to_owned(),
        false => format::groups(&found.groups, experiment.units()),
    };
    print::print(&(lines(assumed) + &text))
}

/// Prints the experiments that come with the program, or one of them.
pub(crate) fn presets(arguments: &Presets) -> Result<(), Failure> {
    if let Some(name) = &arguments.name {
        let found = preset(name).map_err(|error| Failure::User(error.to_string()))?;
        return print::print(found.text());
    }
    let heads = [
        ("The paper's chains", hertzchain_experiment::presets()),
        ("The same with films of its oils", film_presets()),
        ("Examples", examples()),
        ("Campaigns, for `hertzchain campaign --preset NAME`", campaigns()),
    ];
    let mut text = String::new();
    for (head, list) in heads {
        let rows = list.iter().map(|preset| (preset.name, preset.title().to_owned()));
        text += &format!("{}\n{}\n", print::heading(head), format::pairs(rows));
    }
    text += "Print one with `hertzchain presets NAME`, shoot it with `hertzchain shot --preset NAME`.\n";
    print::print(&text)
}

/// Prints contact laws, from the registry.
pub(crate) fn laws(arguments: &LawsArguments) -> Result<(), Failure> {
    let infos = crate::laws::infos(arguments.name.as_deref())?;
    if arguments.json {
        return print::print_json(&crate::laws::json(&infos));
    }
    let texts: Vec<String> = infos.iter().map(|info| as_text(info)).collect();
    print::print(texts.join("\n").trim_end())
}

fn as_text(info: &LawInfo) -> String {
    let gate = if info.gated { "while the contact is closed" } else { "always, also across gaps" };
    let rows = [
        ("equation", info.equation.to_owned()),
        ("kind", nature(info).to_owned()),
        ("acts", gate.to_owned()),
        ("validity", info.validity.to_owned()),
        ("source", source(info)),
    ];
    let parameters = info.parameters.iter().map(|p| (p.name, parameter(p)));
    let rows = format::pairs(rows.into_iter().chain(parameters));
    format!("{}\n{rows}", print::heading(info.name))
}

/// The work that a law is from, and its key in the bibliography.
fn source(info: &LawInfo) -> String {
    let key = format!("[{}]", info.reference);
    match Publication::of_key(info.reference) {
        Some(work) => format!("{} {key}", work.lines().join("\n")),
        None => key,
    }
}

fn default(parameter: &Parameter) -> String {
    match parameter.source {
        Source::Required => "required".to_owned(),
        Source::Materials => "default: from the materials".to_owned(),
        Source::Hertz => "default: the section's elastic_hertz, else the materials".to_owned(),
        Source::Liquid => "default: of [liquid]".to_owned(),
        Source::Default(f64::INFINITY) => "default: of [liquid], else without limit".to_owned(),
        Source::Default(value) => format!("default: {value}"),
    }
}

fn parameter(parameter: &Parameter) -> String {
    let unit = match parameter.unit {
        "1" => "plain number",
        unit => unit,
    };
    format!("{} [{unit}]; {}", parameter.meaning, default(parameter))
}
