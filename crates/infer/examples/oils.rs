//! Which oil the gauge says it is, over many trials: a table of `docs/inferring.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-infer --example oils -- 25  # trials an oil
//! ```
//!
//! The three oils of the paper and a fourth that is in no table (the motor oil
//! with its Young modulus 5 % up), dry and wet curves measured at the paper's
//! noise.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Truth, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::gauge::{Chains, Gauge, known_oils};
use hertzchain_infer::{Data, Observable};
use std::collections::BTreeMap;
use std::error::Error;

/// Speeds of each curve.
const SPEEDS: usize = 12;

fn main() -> Result<(), Box<dyn Error>> {
    let trials = std::env::args()
        .nth(1)
        .map_or(Ok(25), |text| text.parse())?;
    let both = [Observable::Incident, Observable::Reflected];
    for (what, used) in [
        ("both times", &both[..]),
        ("incident times alone", &both[..1]),
    ] {
        println!("\n{what}, {SPEEDS} speeds, {trials} trials");
        table(trials, used)?;
    }
    Ok(())
}

fn table(trials: u64, used: &[Observable]) -> Result<(), Box<dyn Error>> {
    let (dry_model, wet_model) = (preset("dry")?, preset("pump")?);
    let unknown = preset("motor")?.set(&[("motor-oil.young_modulus", 1.05 * 193e9)])?;
    let free = ["aisi316.eta".to_owned(), "dry.B".to_owned()];
    let dry = Truth::of(&dry_model, &speeds_m_s(SPEEDS));
    let oils = known_oils()?;
    let truths = [
        ("motor", preset("motor")?),
        ("gear", preset("gear")?),
        ("pump", preset("pump")?),
        ("unknown", unknown),
    ];
    for (name, experiment) in truths {
        let wet = Truth::of(&experiment, &speeds_m_s(SPEEDS));
        let mut said: BTreeMap<String, u64> = BTreeMap::new();
        for seed in 0..trials {
            let chains = Chains {
                dry: &dry_model,
                wet: &wet_model,
                free: &free,
                own: &[],
                accuracy: 1e-5,
            };
            let data = |truth: &Truth, seed: u64| -> Data { truth.measured(seed).only(used) };
            let gauge = Gauge::new(&chains, data(&dry, seed), data(&wet, 10_000 + seed))?;
            let verdict = gauge.verdict(&oils)?;
            let names: Vec<&str> = verdict.allowed().map(|found| found.oil.as_str()).collect();
            let names = if names.is_empty() {
                "none of these".to_owned()
            } else {
                names.join(" or ")
            };
            *said.entry(names).or_default() += 1;
        }
        println!("| {name} | {said:?} |");
    }
    Ok(())
}
