use hertzchain_chain::ensemble::{self, *};
use hertzchain_chain::wave::*;
#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use hertzchain_chain::*;
fn main() {
    let v = 0.1074;
    let laws = vec![hertz(), viscoelastic(), cubic()];
    let system = System::new(&row(40, v, laws)).unwrap();
    let step = 0.12;
    for k in 1..40 {
        let t = k as f64 * 6e-5;
        let s = ensemble::Settings {
            step,
            sensors: vec![Sensor::Bead(7), Sensor::Contact(40)],
            durations_s: vec![t],
            end: End::Duration,
            set: InstructionSet::default(),
            whole_chain: false,
            changes: std::env::var("CH").is_ok(),
        };
        let f = fire(&[&system], &s).remove(0).unwrap();
        let o = run(
            &system,
            &DormandPrince { tolerance: 1e-11 },
            Limits::until(f.time_s),
            &mut [],
        )
        .unwrap();
        let mut e: Vec<(f64, usize)> = f
            .velocity_m_s
            .iter()
            .zip(&o.velocity_m_s)
            .enumerate()
            .map(|(i, (a, b))| ((a - b) / v, i))
            .collect();
        e.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
        print!("t {:.3e}: ", f.time_s);
        for (d, i) in &e[..5] {
            print!(" b{i} {d:.1e} (v {:.1e})", o.velocity_m_s[*i] / v);
        }
        println!();
    }
}
