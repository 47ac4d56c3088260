//! `hertzchain presets`: the experiments that come with the program.

use crate::program::arguments::Presets;
use crate::program::failure::Failure;
use crate::program::{format, print};
use hertzchain_experiment::{Preset, campaigns, examples, preset, presets};

/// Runs the verb.
pub(crate) fn run(arguments: &Presets) -> Result<(), Failure> {
    if let Some(name) = &arguments.name {
        let found = preset(name).map_err(|error| Failure::User(error.to_string()))?;
        return print::print(found.text());
    }
    let heads = [
        ("The paper's chains", presets()),
        ("Examples", examples()),
        ("Campaigns, for `hertzchain campaign --preset NAME`", campaigns()),
    ];
    let mut text = String::new();
    for (head, list) in heads {
        text += &format!("{}\n{}\n", print::heading(head), listed(list));
    }
    text += "Print one with `hertzchain presets NAME`, shoot it with `hertzchain shot --preset NAME`.\n";
    print::print(&text)
}

fn listed(list: &[Preset]) -> String {
    let row = |preset: &Preset| (preset.name.to_owned(), preset.title().to_owned());
    format::pairs(&list.iter().map(row).collect::<Vec<_>>())
}
