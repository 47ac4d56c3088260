use hertzchain_chain::ensemble::{self, *};
#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use hertzchain_chain::*;
#[allow(dead_code)]
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
    let name = std::env::args().nth(1).unwrap_or("avx512".into());
    let reps: usize = std::env::args()
        .nth(2)
        .unwrap_or("300".into())
        .parse()
        .unwrap();
    let step: f64 = std::env::args()
        .nth(3)
        .unwrap_or("0.15".into())
        .parse()
        .unwrap();
    for (n, laws) in [
        ("hertz", vec![hertz()]),
        ("visco", vec![hertz(), viscoelastic()]),
        ("dry", vec![hertz(), viscoelastic(), cubic()]),
    ] {
        let mut sys = vec![];
        for i in 0..1024 {
            sys.push(System::new(&row(40, 0.5 * (1. + 0.0002 * i as f64), laws.clone())).unwrap());
        }
        let refs: Vec<&System> = sys.iter().collect();
        let set = InstructionSet::named(&name).unwrap();
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
        for _ in 0..reps {
            let t0 = std::time::Instant::now();
            let r = fire(&refs[..64], &s);
            let e = t0.elapsed().as_secs_f64() * 16.;
            best = best.min(e);
            steps = r
                .iter()
                .map(|r| r.as_ref().unwrap().work.steps)
                .sum::<u64>()
                * 16;
        }
        println!(
            "{n} {} step {step}: {:.1} us/shot = {:.0}/s, {:.3} ns per bead-step",
            set.name(),
            best / 1024. * 1e6,
            1024. / best,
            best / steps as f64 / 42. * 1e9
        );
    }
}
