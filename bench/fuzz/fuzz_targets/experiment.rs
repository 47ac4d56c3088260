//! An experiment file: read, its mistakes reported, its chain made and described.
#![no_main]

use hertzchain_experiment::Experiment;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| match Experiment::from_text("fuzz.toml", text) {
    Ok(experiment) => {
        let text = experiment.canonical_text();
        let again = Experiment::from_text("fuzz.toml", experiment.text());
        assert_eq!(again.map(|same| same.canonical_text()).ok(), Some(text));
        let _ = experiment.chain(None);
    }
    Err(mistakes) => drop(mistakes.to_string()),
});
