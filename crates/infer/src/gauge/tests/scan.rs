use super::*;

fn line(residual: impl Fn(f64) -> Option<f64>) -> Vec<ScanPoint> {
    let place = |at: usize| at_ln(at as f64 * STEP, &residual);
    (0..40).map(place).collect()
}

fn at_ln(ln_a: f64, residual: &impl Fn(f64) -> Option<f64>) -> ScanPoint {
    let residuals = residual(ln_a).map(|r| vec![0.0, r]);
    ScanPoint { ln_a, ln_k: 0.0, residuals }
}

fn walked(residual: impl Fn(f64) -> Option<f64>) -> Vec<ScanPoint> {
    let mut line = line(&residual);
    for _ in 0..HALVINGS {
        let more = halves(&line);
        line.extend(more.iter().map(|(ln_a, _)| at_ln(*ln_a, &residual)));
        line.sort_by(|a, b| a.ln_a.total_cmp(&b.ln_a));
    }
    line
}

fn near(line: &[ScanPoint], ln_a: f64) -> bool {
    let near = |point: &[f64; 2]| (point[1].ln() - ln_a).abs() <= FINEST;
    candidates(line).iter().any(near)
}

/// Two crossings between grid points, one beside a jump that hides its sign, one only
/// touched.
#[test]
fn crossings_between_jumps_and_touched_zeros_are_found() {
    let crossed = walked(|x| Some(100.0 * (x - 0.5) * (x - 2.03)));
    assert!(near(&crossed, 0.5) && near(&crossed, 2.03));
    let hidden = walked(|x| Some(if x < 1.01 { 100.0 * (0.99 - x) } else { 80.0 + x }));
    assert!(near(&hidden, 0.99));
    let touched = walked(|x| Some(1e3 * ((x - 1.37).powi(2) - 1e-5)));
    assert!(near(&touched, 1.37));
    assert!(missing(&touched).is_empty());
}

#[test]
fn where_the_model_has_no_number_the_scan_says_so() {
    let line = walked(|x| (!(1.0..1.5).contains(&x)).then_some(x - 0.3));
    let [span] = missing(&line)[..] else { panic!("one span") };
    // To the finest step.
    assert!((span[0].ln() - 1.0).abs() <= FINEST && (span[1].ln() - 1.5).abs() <= FINEST);
    assert!(near(&line, 0.3));
}
