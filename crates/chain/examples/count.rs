use hertzchain_chain::ensemble::{self, *};
use hertzchain_chain::observe::*;
use hertzchain_chain::wave::*;
#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use hertzchain_chain::*;
fn cpu() -> f64 {
    std::fs::read_to_string("/proc/self/schedstat")
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse::<f64>()
        .unwrap()
        * 1e-9
}
fn main() {
    for (laws, v) in [
        (vec![hertz()], 0.5),
        (vec![hertz(), viscoelastic()], 0.5),
        (vec![hertz(), viscoelastic(), cubic()], 0.5),
        (vec![hertz(), viscoelastic(), cubic()], 0.075),
        (vec![hertz(), viscoelastic(), cubic()], 1.23),
    ] {
        let chain = row(40, v, laws.clone());
        let system = System::new(&chain).unwrap();
        let go = |tol: f64| {
            let mut p = Passages::new(7, 40, true);
            run(
                &system,
                &DormandPrince { tolerance: tol },
                Limits::until(5e-3),
                &mut [&mut p],
            )
            .unwrap();
            let p = p.passage().unwrap();
            (p.tof_incident_s(), p.tof_reflected_s().unwrap())
        };
        let e = go(1e-12);
        println!("exact {:?} tau {:e}", e, system.scales().time_s);
        for step in [
            0.21, 0.2, 0.19, 0.18, 0.17, 0.16, 0.14, 0.12, 0.1, 0.08, 0.06, 0.04, 0.02, 0.01,
        ] {
            for end in [End::Passed] {
                let s = ensemble::Settings {
                    step,
                    sensors: vec![Sensor::Bead(7), Sensor::Contact(40)],
                    durations_s: vec![5e-3],
                    end,
                    set: InstructionSet::default(),
                    whole_chain: false,
                    changes: std::env::var("CH").is_ok(),
                };
                match &fire(&[&system], &s)[0] {
                    Ok(f) => {
                        let p = Passages::from_signals(
                            f.signals[0].clone(),
                            f.signals[1].clone(),
                            f.time_s,
                        );
                        match p.passage() {
                            Ok(p) => print!(
                                "  {step}: {:.0e} {:.0e} n{} c{:.0e} ",
                                p.tof_incident_s() / e.0 - 1.,
                                p.tof_reflected_s().unwrap_or(0.) / e.1 - 1.,
                                f.work.steps,
                                f.correction
                            ),
                            Err(e) => print!(" {step} {e}"),
                        }
                    }
                    Err(e) => print!(" {step}: {e}"),
                }
            }
        }
        println!();
        if true {
            continue;
        }
        let mut sys = vec![];
        for i in 0..1024 {
            sys.push(System::new(&row(40, v * (1. + 0.0002 * i as f64), laws.clone())).unwrap());
        }
        let t0 = cpu();
        for _ in 0..200 {
            std::hint::black_box(System::new(&chain).unwrap());
        }
        let t1 = cpu();
        println!("System::new {:.1} us", (t1 - t0) / 200. * 1e6);
        let refs: Vec<&System> = sys.iter().collect();
        for set in InstructionSet::available() {
            for step in [0.1] {
                let s = ensemble::Settings {
                    step,
                    sensors: vec![Sensor::Bead(7), Sensor::Contact(40)],
                    durations_s: vec![5e-3; 1024],
                    end: End::Passed,
                    set,
                    whole_chain: false,
                    changes: std::env::var("CH").is_ok(),
                };
                let mut best: f64 = 1e9;
                let mut steps = 0;
                for _ in 0..12 {
                    let t0 = cpu();
                    let r = fire(&refs, &s);
                    let e = cpu() - t0;
                    best = best.min(e);
                    steps = r
                        .iter()
                        .map(|r| r.as_ref().unwrap().work.steps)
                        .sum::<u64>();
                }
                println!(
                    "{} step {step}: {:.1} us/shot = {:.0}/s, {:.3} ns per bead-step",
                    set.name(),
                    best / 1024. * 1e6,
                    1024. / best,
                    best / steps as f64 / 42. * 1e9
                );
            }
            let s = ensemble::Settings {
                step: 0.1,
                sensors: vec![Sensor::Bead(7), Sensor::Contact(40)],
                durations_s: vec![5e-3; 1],
                end: End::Passed,
                set,
                whole_chain: false,
                changes: std::env::var("CH").is_ok(),
            };
            let t0 = cpu();
            for _ in 0..200 {
                std::hint::black_box(fire(&[&system], &s));
            }
            println!("   one lane {:.1} us", (cpu() - t0) / 200. * 1e6);
        }
    }
}
