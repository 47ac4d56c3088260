//! What an ensemble costs without Python: for every line on standard input, all
//! shots are planned and computed once, and the seconds printed.
//!
//! `bench/python/overhead.py` runs it beside the same ensemble from Python:
//!
//! ```text
//! throughput dry 8192                               # at as many speeds
//! throughput dry 8192 damping_cubic.coefficient     # each with this number of its own
//! throughput dry 4096 damping_cubic.coefficient 64  # 64 speeds by 64 such numbers
//! ```

use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::{Control, InstructionSet, Plan, run_plans};
use rayon::prelude::*;
use std::error::Error;
use std::io::{Write, stdin, stdout};
use std::time::Instant;

/// Plans in memory at a time.
const PIECE: usize = 1024;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "dry".to_owned());
    let count: usize = arguments.next().map_or(Ok(4096), |text| text.parse())?;
    let dry = preset(&name)?;
    let number = arguments.next();
    let columns: Option<usize> = arguments.next().map(|text| text.parse()).transpose()?;
    let speeds = count / columns.unwrap_or(1);
    let speed = |at: usize| {
        let row = at / columns.unwrap_or(1);
        0.1 * 12.0_f64.powf(row as f64 / (speeds.max(2) - 1) as f64)
    };
    let rows: Vec<usize> = (0..count).collect();
    let own = |at: usize| -> Result<Experiment, String> {
        let Some(name) = &number else {
            return Ok(dry.clone());
        };
        let usual = dry.get(name).map_err(|error| error.to_string())?;
        let (place, of) = columns.map_or((at, count), |columns| (at % columns, columns));
        let value = usual * (1.0 + 0.1 * place as f64 / of as f64);
        let changed = dry.set(&[(name.as_str(), value)]);
        changed.map_err(|error| error.to_string())
    };
    let plan = |at: usize| -> Result<Plan, String> {
        let planned = Plan::from_experiment(&own(at)?, Some(speed(at)));
        let (plan, _) = planned.map_err(|error| error.to_string())?;
        Ok(plan.for_flights())
    };
    for _line in stdin().lines() {
        let begun = Instant::now();
        let mut sum_s = 0.0;
        for part in rows.chunks(PIECE) {
            let plans: Result<Vec<Plan>, String> = part.par_iter().map(|at| plan(*at)).collect();
            for shot in run_plans(
                &plans?,
                Control::PerShot { checked: false },
                InstructionSet::default(),
                &|| {},
            ) {
                sum_s += shot?.flight.map_or(0.0, |flight| flight.incident_s);
            }
        }
        println!("{} {sum_s:e}", begun.elapsed().as_secs_f64());
        stdout().flush()?;
    }
    Ok(())
}
