//! The order of every solver, on a smooth problem and on impact.

use crate::common::*;
use hertzchain_chain::wave::{Control, Limits, Method, run};
use hertzchain_chain::*;

/// The default pair with a fixed step, so that its order can be seen.
fn fixed_pair(step_s: f64) -> Method {
    Method { control: Control::Fixed { step_s }, ..Method::dormand_prince(1.0) }
}

/// The pair of order 8 with a fixed step.
fn fixed_high_pair(step_s: f64) -> Method {
    Method { control: Control::Fixed { step_s }, ..Method::prince_dormand(1.0) }
}

/// A preloaded Hertz ring in which no contact ever opens.
fn smooth() -> Chain {
    let initial = (1..=8).map(|bead| Initial {
        bead,
        displacement_m: 0.0,
        velocity_m_s: 0.2 * (std::f64::consts::TAU * bead as f64 / 8.0).sin(),
    });
    Chain {
        start: Start::Free,
        far: FarEnd::Periodic { force_n: 1.0 },
        initial: initial.collect(),
        ..unit_row(8, 1.0, FarEnd::Free)
    }
}

/// Largest error of a velocity at the end against a tight run, in units of v0.
fn error(chain: &Chain, method: &Method, duration: f64, exact: &[f64]) -> f64 {
    let system = System::new(chain).unwrap();
    let outcome = run(&system, method, Limits::until(duration), &mut []).unwrap();
    outcome.velocity_m_s.iter().zip(exact).map(|(v, e)| (v - e).abs()).fold(0.0, f64::max)
}

/// Slope of log error against log step over two halvings.
fn order(chain: &Chain, duration: f64, step: f64, method: impl Fn(f64) -> Method) -> f64 {
    let exact = run_for(chain, 1e-13, duration).velocity_m_s;
    let coarse = error(chain, &method(step), duration, &exact);
    let fine = error(chain, &method(step / 4.0), duration, &exact);
    (coarse / fine).log2() / 2.0
}

/// Least-squares slope over eight halvings: where contacts open and close
/// inside steps, two steps alone may be lucky or not.
fn mean_order(chain: &Chain, duration: f64, method: &dyn Fn(f64) -> Method) -> f64 {
    let exact = run_for(chain, 1e-13, duration).velocity_m_s;
    let at = |halving: i32| {
        let step = 1e-6 * 0.5_f64.powi(halving);
        (f64::from(-halving), error(chain, &method(step), duration, &exact).log2())
    };
    let points: Vec<(f64, f64)> = (0..=8).map(at).collect();
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / 9.0;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2))
}

#[test]
fn every_method_has_its_order_where_nothing_opens() {
    let chain = smooth();
    let order = |step, method: &dyn Fn(f64) -> Method| order(&chain, 8.0, step, method);
    let rk4 = order(0.1, &|step_s| Method::rk4(step_s));
    let verlet = order(0.1, &|step_s| Method::verlet(step_s));
    let pair = order(0.1, &|step| fixed_pair(step));
    // Steps are finite: observed orders are near the nominal ones.
    assert!((rk4 - 4.0).abs() < 0.2, "RK4: {rk4}");
    assert!((verlet - 2.0).abs() < 0.2, "Verlet: {verlet}");
    // The pair's error constants of order 5 are so small that those of order
    // 6 still show.
    assert!((4.8..6.2).contains(&pair), "Dormand–Prince: {pair}");
    let high = order(0.5, &|step| fixed_high_pair(step));
    assert!((7.5..9.0).contains(&high), "Prince–Dormand: {high}");
}

#[test]
fn fixed_steps_lose_order_on_impact_and_located_changes_keep_the_accuracy() {
    let laws = || vec![hertz(), viscoelastic(), cubic()];
    let chain = Chain { far: FarEnd::Free, ..row(8, 0.5, laws()) };
    let duration = 2e-4;
    let order = |method: &dyn Fn(f64) -> Method| mean_order(&chain, duration, method);
    let rk4 = order(&|step_s| Method::rk4(step_s));
    let verlet = order(&|step_s| Method::verlet(step_s));
    let pair = order(&|step| fixed_pair(step));
    // A force that jumps inside a step leaves order 1, whatever the nominal
    // one; half an order is how much slopes scatter.
    for (name, order) in [("RK4", rk4), ("Verlet", verlet), ("Dormand–Prince", pair)] {
        assert!((order - 1.0).abs() < 0.5, "{name}: {order}");
    }
    let exact = run_for(&chain, 1e-13, duration).velocity_m_s;
    for tolerance in [1e-5, 1e-7, 1e-9] {
        let error = error(&chain, &Method::dormand_prince(tolerance), duration, &exact) / 0.5;
        // Some hundred steps, each wrong by up to the tolerance, few of them one-sided.
        assert!(error < 30.0 * tolerance, "{tolerance:e}: {error:e}");
    }
}

#[test]
fn error_falls_with_the_tolerance_on_the_papers_chain() {
    let chain = row(40, 0.5, vec![hertz(), viscoelastic(), cubic()]);
    let exact = reference("rig/dry_0.5", "tof_reflected_s");
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let tof = shoot(&chain, tolerance).0.tof_reflected_s().unwrap();
        // Three times the tolerance is what study promises for an accuracy.
        assert!((tof / exact - 1.0).abs() < 3.0 * tolerance, "{tolerance:e}");
    }
}

#[test]
fn peak_times_of_order_8_are_right_between_its_long_steps() {
    let chain = row(40, 0.5, vec![hertz(), viscoelastic(), cubic()]);
    let [incident, reflected] =
        ["tof_incident_s", "tof_reflected_s"].map(|quantity| reference("rig/dry_0.5", quantity));
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let passage = shoot_with(&chain, &Method::prince_dormand(tolerance)).0;
        close(passage.tof_incident_s(), incident, tolerance);
        close(passage.tof_reflected_s().unwrap(), reflected, tolerance);
    }
}

/// Force passes of the paper's shots at given tolerances. A method that needs
/// more fails here without a clock; one that needs fewer may lower them.
#[test]
fn force_passes_per_shot_are_no_more_than_pinned() {
    let dry = || vec![hertz(), viscoelastic(), cubic()];
    type Scheme = fn(f64) -> Method;
    let (five, eight): (Scheme, Scheme) = (Method::dormand_prince, Method::prince_dormand);
    let pinned = [
        (vec![hertz()], five, 1e-6, 7_400),
        (vec![hertz(), viscoelastic()], five, 1e-6, 6_900),
        (dry(), five, 1e-4, 3_400),
        (dry(), five, 1e-6, 7_000),
        (dry(), five, 1e-8, 16_800),
        (vec![hertz()], eight, 1e-8, 17_400),
        (dry(), eight, 1e-8, 15_600),
    ];
    for (laws, scheme, tolerance, most) in pinned {
        let system = System::new(&row(40, 0.5, laws)).unwrap();
        let mut passages = observe::Passages::new(7, 40, true);
        let method = scheme(tolerance);
        let outcome = run(&system, &method, Limits::until(1.0), &mut [&mut passages]).unwrap();
        let passes = outcome.work.force_passes;
        assert!(passes <= most && passes > most / 2, "{tolerance:e}: {passes}, pinned {most}");
    }
}

#[test]
fn a_tolerance_below_rounding_is_refused() {
    let system = System::new(&row(5, 0.5, vec![hertz()])).unwrap();
    let method = Method::dormand_prince(1e-22);
    let error = run(&system, &method, Limits::until(1e-3), &mut []).unwrap_err().to_string();
    assert!(error.contains("cannot be reached") && error.contains("5e-15"), "{error}");
}

/// A dashpot a hundred million times too strong in one contact only.
#[test]
fn a_shot_that_cannot_be_computed_names_the_time_and_the_contact() {
    let stiff = laws::law(laws::DampingLinear { coefficient_n_s_m: 1e10 });
    let mut chain = row(5, 0.5, vec![hertz()]);
    chain.sections = vec![
        Section { contacts: 0..=2, laws: vec![hertz()], material: None },
        Section { contacts: 3..=3, laws: vec![hertz(), stiff], material: None },
        Section { contacts: 4..=5, laws: vec![hertz()], material: None },
    ];
    let system = System::new(&chain).unwrap();
    let limits = Limits { force_passes: Some(20_000), ..Limits::until(1e-3) };
    let error = run(&system, &Method::dormand_prince(1e-9), limits, &mut []).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("gave up at t = ") || text.contains("cannot reach"), "{text}");
    assert!(text.contains("contact 3") || text.contains("contact 4"), "{text}");
}
