//! `hertzchain explore`: the page on which a row's wave is seen.

use crate::explorer::Library;
use crate::input;
use crate::program::arguments::Explore;
use crate::program::{Failure, print};
use hertzchain_explore::{Settings, serve};
use std::sync::Arc;

pub(crate) fn run(arguments: &Explore) -> Result<(), Failure> {
    let experiment =
        input::is_named(&arguments.input).then(|| input::open(&arguments.input)).transpose()?;
    let settings = Settings {
        port: arguments.port,
        experiment: experiment.map(|experiment| experiment.text().to_owned()),
    };
    let opened = |address: &str| {
        print::note(&format!("the explorer is at {address} until Ctrl-C"));
        if !arguments.no_browser
            && let Err(error) = hertzchain_explore::open(address)
        {
            print::warn([format!("no browser opened ({error}): open this address")]);
        }
    };
    serve(settings, Arc::new(Library), opened).map_err(|error| Failure::User(error.to_string()))
}
