use hertzchain_rig::claims::*;
use hertzchain_study::reproduce::Silent;
fn main() {
    let mut d = Design::about(hertzchain_experiment::preset("paper").unwrap());
    let a: Vec<String> = std::env::args().collect();
    d.speeds = a[1].parse().unwrap();
    let n: usize = a[2].parse().unwrap();
    d.rigs.truncate(n);
    let t = std::time::Instant::now();
    let e = observe(&d, &Silent).unwrap();
    eprintln!("{:.1} s", t.elapsed().as_secs_f64());
    let c = RigClaims::judge(&d, &e).unwrap();
    println!("{}", c.markdown());
    std::fs::write("/tmp/hz/rig/series.csv", series_csv(&e)).unwrap();
}
