mod common;
use common::*;
#[test]
fn scratch() {
    let dry = || vec![hertz(), viscoelastic(), cubic()];
    let cases: Vec<(f64, Vec<_>, f64, f64)> = vec![
        (1.0, vec![hertz()], 630.841591, 632.265715),
        (0.5, vec![hertz(), viscoelastic()], 751.270959, 783.036376),
        (0.075, dry(), 1086.942704, 1120.470790),
        (1.23, dry(), 660.261248, 699.493431),
    ];
    for (v, laws, ti, tr) in cases {
        for tol in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11] {
            let now = std::time::Instant::now();
            let (p, o) = shoot(&row(40, v, laws.clone()), tol);
            let el = now.elapsed();
            println!(
                "{v} {tol:e} {:.8} {:.8} err {:.1e} {:.1e} res {:.1e} {:?} {:?}",
                p.tof_incident_s() * 1e6,
                p.tof_reflected_s().unwrap() * 1e6,
                p.tof_incident_s() * 1e6 / ti - 1.,
                p.tof_reflected_s().unwrap() * 1e6 / tr - 1.,
                o.budget.unwrap().relative_residual(),
                o.work,
                el
            );
        }
    }
}
