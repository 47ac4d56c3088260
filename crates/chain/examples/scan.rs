use hertzchain_chain::ensemble::{self, *};
use hertzchain_chain::observe::*;
use hertzchain_chain::wave::*;
#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use hertzchain_chain::*;
fn main() {
    let steps = [0.16, 0.14, 0.12, 0.1, 0.08, 0.06, 0.04];
    let mut worst = vec![[0.0f64; 2]; steps.len()];
    let mut all = vec![vec![]; steps.len()];
    for i in 0..40 {
        let v = 0.075 * (1.23f64 / 0.075).powf(i as f64 / 39.);
        let laws = vec![hertz(), viscoelastic(), cubic()];
        let system = System::new(&row(40, v, laws)).unwrap();
        let go = |tol: f64| {
            let mut p = Passages::new(7, 40, true);
            run(
                &system,
                &DormandPrince { tolerance: tol },
                Limits::until(1.0),
                &mut [&mut p],
            )
            .unwrap();
            let p = p.passage().unwrap();
            (p.tof_incident_s(), p.tof_reflected_s().unwrap())
        };
        let e = go(1e-10);
        print!("v {v:.4}: ");
        for (k, &step) in steps.iter().enumerate() {
            let s = ensemble::Settings {
                step,
                sensors: vec![Sensor::Bead(7), Sensor::Contact(40)],
                durations_s: vec![5e-3],
                end: End::Passed,
                set: InstructionSet::default(),
                whole_chain: false,
                changes: std::env::var("CH").is_ok(),
            };
            let f = fire(&[&system], &s).remove(0).unwrap();
            let p = Passages::from_signals(f.signals[0].clone(), f.signals[1].clone(), f.time_s)
                .passage()
                .unwrap();
            let r = (
                p.tof_incident_s() / e.0 - 1.,
                p.tof_reflected_s().unwrap_or(0.) / e.1 - 1.,
            );
            print!(" {:.0e}/{:.0e}", r.0, r.1);
            worst[k][0] = worst[k][0].max(r.0.abs());
            worst[k][1] = worst[k][1].max(r.1.abs());
            all[k].push(r.1.abs());
        }
        println!();
    }
    println!("worst {worst:?}");
    for a in &mut all {
        a.sort_by(f64::total_cmp);
        print!(" median {:.1e} 90% {:.1e}", a[20], a[36]);
    }
    println!();
}
