//! `hertzchain presets`: the experiments that come with the program.

use crate::program::arguments::Presets;
use crate::program::{Failure, format, print};
use hertzchain_experiment::{campaigns, examples, film_presets, preset, presets};

pub(crate) fn run(arguments: &Presets) -> Result<(), Failure> {
    if let Some(name) = &arguments.name {
        let found = preset(name).map_err(|error| Failure::User(error.to_string()))?;
        return print::print(found.text());
    }
    let heads = [
        ("The paper's chains", presets()),
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
