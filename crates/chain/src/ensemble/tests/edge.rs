use super::super::weights::Schedule;
use super::*;

/// Velocity and position that the method gives to a force of samples, with
/// an edge corrected for at a step, and the exact ones.
fn move_by(force: impl Fn(f64) -> f64, edge: Edge, at: usize) -> [f64; 2] {
    let schedule = Schedule::new();
    let weights = schedule.steady();
    let (mut x, mut v) = (0.0, 0.0);
    let mut used = [0.0; USED];
    for n in 0..at + 40 {
        used.rotate_right(1);
        used[0] = force(n as f64);
        let sum = |w: &[f64; USED]| -> f64 { w.iter().zip(&used).map(|(w, a)| w * a).sum() };
        (x, v) = (x + v + sum(&weights.position), v + sum(&weights.velocity));
        if let Some(lacking) = n.checked_sub(at).and_then(|age| edge.lacking.get(age)) {
            v += lacking[0];
            x += lacking[1];
        }
    }
    [v, x]
}

#[test]
fn a_force_that_ends_between_steps_is_integrated_exactly() {
    let leading = Leading::new(|s: f64| 0.3 + s.sqrt() * (0.7 + 0.1 * s));
    let schedule = Schedule::new();
    let edge = Edge::ending(&leading, 0.35, (schedule.steady(), 0.0));
    let end = 30.35;
    // Begins smoothly and is level near its end: only the end is sharp.
    let rise = |t: f64| 1.0 - (-(t / 12.0).powi(4)).exp();
    let force = |t: f64| {
        if t < end { leading.force(end - t) * rise(t) } else { 0.0 }
    };
    let [v, x] = move_by(force, edge, 30);
    let fine = 200_000;
    let (mut once, mut twice) = (0.0, 0.0);
    for i in 0..fine {
        // Midpoints in a variable that is fine near the end.
        let u = (i as f64 + 0.5) / fine as f64;
        let (s, ds) = (end * u * u, 2.0 * end * u / fine as f64);
        once += force(end - s) * ds;
        twice += force(end - s) * ds * (70.0 - end + s);
    }
    assert!((v / once - 1.0).abs() < 1e-5, "{v} {once}");
    assert!((x / twice - 1.0).abs() < 1e-5, "{x} {twice}");
}
