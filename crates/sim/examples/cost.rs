//! What the parts of a campaign cost here: `cargo run --release --example cost -p hertzchain-rig`.
#![allow(clippy::print_stdout, reason = "an example talks")]

use hertzchain_sim::rig::{Bench, Plan, Purpose, RandomStream, Window, shoot};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let plan = Plan::new(&hertzchain_experiment::preset("paper")?, None)?;
    for at in [0, 30, 59, 90, 150, 239] {
        let series = &plan.series[at];
        let experiment = &plan.case(series).experiment;
        let campaign = experiment.campaign();
        let random = |purpose| RandomStream::new(plan.seed, series.number, purpose);
        let mut bench = Bench::assemble(experiment, &mut random(Purpose::Assembly))?;
        println!("{}: open after laying {}", series.name, open(&bench.gaps_m()));
        let (begun, mut longest_s, mut steps) = (Instant::now(), 0.0f64, 0);
        for _ in 0..campaign.taps {
            let rest = bench.tap(campaign.tap_speed_m_s)?;
            longest_s = longest_s.max(rest.time_s);
            steps += rest.steps;
        }
        let a_tap_s = begun.elapsed().as_secs_f64() / campaign.taps as f64;
        let gaps_m = bench.gaps_m();
        println!(
            "  tap {:.2} ms, {} steps, rest after up to {:.1} ms, then {} open, {:.2e} m",
            1e3 * a_tap_s,
            steps / campaign.taps as u64,
            1e3 * longest_s,
            open(&gaps_m),
            gaps_m.iter().sum::<f64>()
        );
        let window = Window::new(&campaign.recorder, -0.005, &mut random(Purpose::Shot(0)));
        let mut trace = window.trace();
        let begun = Instant::now();
        let shot = shoot(&mut bench, 7, series.programmed_m_s, &mut trace)?;
        println!(
            "  shot {:.2} ms: ToF {:.3} {:.3} us, rest after {:.1} ms, rebound {:.4}, open {} sum {:.2e} m, peaks {:.1?} N",
            1e3 * begun.elapsed().as_secs_f64(),
            1e6 * shot.incident_s,
            1e6 * shot.reflected_s,
            1e3 * shot.rest_s,
            shot.rebound_m_s,
            open(&shot.gaps_after_m),
            shot.gaps_after_m.iter().sum::<f64>(),
            shot.peaks_n,
        );
        let begun = Instant::now();
        let (amplifier, recorder) = (&campaign.amplifier, &campaign.recorder);
        let record = window.record(trace, amplifier, recorder, &mut random(Purpose::Noise(0)));
        println!(
            "  record {:.2} ms, {} samples",
            1e3 * begun.elapsed().as_secs_f64(),
            record.samples.len()
        );
    }
    Ok(())
}

fn open(gaps_m: &[f64]) -> usize {
    gaps_m.iter().filter(|gap| **gap > 0.0).count()
}
