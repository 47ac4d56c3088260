use super::*;

/// Integrates x″ = a(t) with the schedule, corrected at the end.
fn integrate(acceleration: impl Fn(f64) -> f64, steps: usize) -> (f64, f64, f64) {
    let schedule = Schedule::new();
    let (mut x, mut v) = (0.0, 0.0);
    let mut used = [0.0; USED];
    for n in 0..steps {
        used.rotate_right(1);
        used[0] = acceleration(schedule.time(n));
        let w = schedule.row(n);
        let sum =
            |weights: &[f64; USED]| -> f64 { weights.iter().zip(&used).map(|(w, a)| w * a).sum() };
        (x, v) = (x + w.drift * v + sum(&w.position), v + sum(&w.velocity));
    }
    (schedule.time(steps), x, v)
}

#[test]
fn polynomials_of_the_methods_order_are_integrated_exactly() {
    for power in 0..EARLIER as i32 {
        let (t, x, v) = integrate(|t| (0.1 * t).powi(power), 80);
        let scale = 0.1_f64.powi(power);
        let p = f64::from(power);
        // The first steps use fewer accelerations: exact only up to what
        // they leave, (1e-3)² of a step.
        assert!((v / (scale * t.powf(p + 1.0) / (p + 1.0)) - 1.0).abs() < 1e-9, "{power}");
        let exact = scale * t.powf(p + 2.0) / (p + 1.0) / (p + 2.0);
        assert!((x / exact - 1.0).abs() < 1e-9, "{power}");
    }
}

#[test]
fn steady_weights_are_those_of_adams() {
    let schedule = Schedule::new();
    let row = schedule.row(10_000);
    // Corrector of order 5: its newest weight.
    assert!((row.residual[0] - 251.0 / 720.0).abs() < 1e-12);
    let sum: f64 = row.velocity.iter().sum();
    assert!((sum - 1.0).abs() < 1e-12);
}
