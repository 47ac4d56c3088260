//! What an ensemble costs without Python: for every line on standard input, all
//! shots are planned and computed once, and the seconds printed.
//!
//! `bench/python/overhead.py` runs it beside the same ensemble from Python.

use hertzchain_experiment::preset;
use hertzchain_study::{InstructionSet, Plan, shoot_all};
use rayon::prelude::*;
use std::error::Error;
use std::io::{Write, stdin, stdout};
use std::time::Instant;

/// Shots that are in memory as chains at a time.
const TOGETHER: usize = 4096;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "dry".to_owned());
    let count: usize = arguments.next().map_or(Ok(4096), |text| text.parse())?;
    let dry = preset(&name)?;
    let speed = |at: usize| 0.1 * 12.0_f64.powf(at as f64 / (count.max(2) - 1) as f64);
    let speeds: Vec<f64> = (0..count).map(speed).collect();
    for _line in stdin().lines() {
        let begun = Instant::now();
        let mut sum_s = 0.0;
        for part in speeds.chunks(TOGETHER) {
            let planned = part
                .par_iter()
                .map(|speed| Plan::from_experiment(&dry, Some(*speed)));
            let plans: Result<Vec<_>, _> = planned.collect();
            let plans: Vec<Plan> = plans?
                .into_iter()
                .map(|(plan, _)| plan.for_flights())
                .collect();
            for shot in shoot_all(&plans, InstructionSet::default(), false, &|| {}) {
                sum_s += shot?.flight.map_or(0.0, |flight| flight.incident_s);
            }
        }
        println!("{} {sum_s:e}", begun.elapsed().as_secs_f64());
        stdout().flush()?;
    }
    Ok(())
}
