//! Tables that a user gives: times of flight against speed, and the table of shots.
#![no_main]

use hertzchain_infer::{Data, Selection};
use hertzchain_measure::ShotList;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = Data::parse("table.csv", text, &Selection::default());
    let _ = ShotList::parse(text);
});
