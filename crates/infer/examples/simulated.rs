//! A measurement that never was, as a table for `fit`, `gauge` and `design`: the data of
//! the examples in `docs/explanation/inference.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-infer --example simulated -- dry > dry.csv     # a preset
//! cargo run --release -p hertzchain-infer --example simulated -- pump 2 > wet.csv  # other noise
//! ```
//!
//! 25 speeds from 0.075 to 1.23 m/s, in equal ratios, at the paper's noise: 20 shots a speed,
//! speeds ±0.003 m/s and times ±0.5 µs a shot. Standard errors are those of the means, known.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Truth, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_measure::signal::Estimate;
use std::error::Error;

/// Speeds of the table.
const SPEEDS: usize = 25;

const TITLES: &str = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,\
                      tof_reflected_s,tof_reflected_s_error";

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or_else(|| "dry".to_owned());
    let seed = words.next().map_or(Ok(1), |word| word.parse())?;
    let experiment = preset(&name)?;
    println!("{TITLES}");
    for row in Truth::of(&experiment, &speeds_m_s(SPEEDS)).measured(seed).rows {
        let cells = [Some(row.speed_m_s), row.values[0], row.values[1]].map(cells);
        println!("{}", cells.join(","));
    }
    Ok(())
}

/// A value and its standard error, empty where nothing was seen.
fn cells(of: Option<Estimate>) -> String {
    of.map_or(",".to_owned(), |of| format!("{:e},{:e}", of.value, of.sigma))
}
