//! Curved problems: where covariance and profile part, and what intervals are worth.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::toys::{Curve, decay, normals, spaced};
use hertzchain_infer::{
    Covariance, End, Fit, Fitting, InferError, Interval, Parameter, Profile, Profiling, fit,
    profile,
};
use hertzchain_measure::signal::{Coverage, coverage};

/// Residuals (a − 1)/0.3 and (b − a²)/0.01: a narrow, bent valley in which b = a²,
/// a normal around 1.
fn banana(a: f64, b: f64) -> Curve<impl Fn(&[f64], f64) -> f64 + Sync + Clone> {
    Curve {
        parameters: vec![Parameter::new("a", "", a), Parameter::new("b", "", b)],
        x: vec![0.0, 1.0],
        y: vec![1.0, 0.0],
        sigma: vec![0.3, 0.01],
        model: |p: &[f64], x: f64| if x == 0.0 { p[0] } else { p[1] - p[0] * p[0] },
    }
}

fn profiled<F: Fn(&[f64], f64) -> f64 + Sync>(data: &Curve<F>) -> (Fit, Covariance, Vec<Profile>) {
    let found = fit(data, &Fitting::default()).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    let all: Vec<usize> = (0..data.parameters.len()).collect();
    let profiles = profile(data, &found, &covariance, &all, &Profiling::default()).unwrap();
    (found, covariance, profiles)
}

#[test]
fn a_bent_valley_is_followed_to_its_bottom() {
    let found = fit(&banana(-1.2, 5.0), &Fitting::default()).unwrap();
    assert!(found.ending.converged(), "{}", found.ending);
    // χ²/2 within 1e-9: 4e-5 standard errors, of 0.3 and 0.6.
    assert!((found.point[0] - 1.0).abs() < 2e-5 && (found.point[1] - 1.0).abs() < 4e-5);
}

#[test]
fn profiles_follow_a_bent_valley_where_the_covariance_does_not() {
    let (_, covariance, profiles) = profiled(&banana(0.8, 0.7));
    let ends = |interval: &Interval| [interval.lower, interval.upper].map(|e| e.closed().unwrap());
    for interval in &profiles[1].intervals {
        let z = interval.level.sqrt();
        let [lower, upper] = ends(interval);
        // Least over a of ((a − 1)/0.3)² + ((b − a²)/0.01)²: the valley's own
        // width adds 0.01²/(2 · 0.6) to b, which is 1e-4 at most, and ends are
        // found to 1e-3 of z, times db/dz up to 0.95.
        assert!((lower - (1.0 - 0.3 * z).powi(2)).abs() < 1.2e-3, "{lower}");
        assert!((upper - (1.0 + 0.3 * z).powi(2)).abs() < 1.2e-3, "{upper}");
        // The covariance's are 1 ± 0.6 z: too low by 0.09 z² on both sides.
        let symmetric = [1.0 - covariance.sd[1] * z, 1.0 + covariance.sd[1] * z];
        assert!(lower - symmetric[0] > 0.08 * z * z && upper - symmetric[1] > 0.08 * z * z);
    }
    // a itself is linear along the valley. Ends as found.
    let [lower, upper] = ends(&profiles[0].intervals[0]);
    assert!((lower - 0.7).abs() < 4e-4 && (upper - 1.3).abs() < 4e-4);
}

#[test]
fn jacobian_by_two_step_sizes_tells_how_far_it_is_right() {
    let data = banana(0.8, 0.7);
    let found = fit(&data, &Fitting::default()).unwrap();
    // ∂/∂a of the second residual: 2a/0.01; of the first −1/0.3. A parabola's
    // central differences are exact; rounding over the step.
    assert!((found.jacobian.columns[0][1] / (2.0 * found.point[0] / 0.01) - 1.0).abs() < 1e-9);
    assert!((found.jacobian.columns[0][0] + 1.0 / 0.3).abs() < 1e-8);
    assert!(found.jacobian.worst_disagreement() < 1e-8);
    let bent = Curve::drawn(
        vec![Parameter::new("a", "", 1.0), Parameter::new("k", "", 0.7)],
        &spaced(0.0, 4.0, 12),
        0.05,
        &[1.0, 0.7],
        1,
        decay,
    );
    let found = fit(&bent, &Fitting::default()).unwrap();
    let k = found.point[1];
    for (i, x) in bent.x.iter().enumerate() {
        let exact = found.point[0] * x * (-k * x).exp() / 0.05;
        let error = (found.jacobian.columns[1][i] - exact).abs();
        // Steps of 0.007: disagreement (k x h)²/2, extrapolation leaves its square.
        assert!(error < 1e-6 * 20.0, "{i} {error}");
    }
    let reported = found.jacobian.disagreement[1];
    assert!((1e-6..1e-2).contains(&reported), "{reported}");
}

/// Coverage of both kinds of intervals of both parameters of a decay.
fn covered(sets: u64) -> Vec<(&'static str, Coverage)> {
    let truth = [1.0, 0.7];
    let mut pulls = [Vec::new(), Vec::new()];
    let mut held = [[Vec::new(), Vec::new()], [Vec::new(), Vec::new()]];
    let levels = [1.0, 1.959_963_984_540_054_f64.powi(2)];
    for seed in 0..sets {
        let free = vec![Parameter::new("a", "", 1.3), Parameter::new("k", "", 0.5)];
        let data = Curve::drawn(free, &spaced(0.0, 4.0, 12), 0.05, &truth, seed, decay);
        let (found, covariance, profiles) = profiled(&data);
        for (k, profile) in profiles.iter().enumerate() {
            pulls[k].push((found.point[k] - truth[k]) / covariance.sd[k]);
            for (level, interval) in profile.intervals.iter().enumerate() {
                let [lower, upper] = [interval.lower, interval.upper].map(|e| e.closed().unwrap());
                let inside = lower <= truth[k] && truth[k] <= upper;
                held[k][level].push(if inside { 0.0 } else { f64::NAN });
            }
        }
    }
    let mut all = Vec::new();
    for k in 0..2 {
        for (level, held) in levels.iter().zip(&held[k]) {
            all.push(("covariance", coverage(&pulls[k], level.sqrt()).unwrap()));
            all.push(("profile", coverage(held, level.sqrt()).unwrap()));
        }
    }
    all
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    for (kind, found) in covered(600) {
        let off = (found.share - found.expected) / found.chance;
        // Chance: binomial, of eight shares; 3.5 deviations are met once in 270
        // such tests, and the seeds are fixed.
        assert!(
            off.abs() < 3.5,
            "{kind}: {:.3} of {:.3} ± {:.3}",
            found.share,
            found.expected,
            found.chance
        );
    }
}

#[test]
fn intervals_that_the_data_leave_open_are_reported_open() {
    // One number for a product: a may be anything as long as b makes up for it
    // within its bounds.
    let data = Curve {
        parameters: vec![
            Parameter::new("a", "", 2.0).within(0.5, 10.0),
            Parameter::new("b", "", 1.0).within(0.1, 40.0),
        ],
        x: vec![0.0, 0.0, 1.0],
        y: vec![2.0, 2.1, 0.2],
        sigma: vec![0.1, 0.1, 10.0],
        model: |p: &[f64], x: f64| if x == 0.0 { p[0] * p[1] } else { 0.1 * p[0] },
    };
    let (_, covariance, profiles) = profiled(&data);
    assert!(covariance.sd[0] > 10.0);
    let interval = profiles[0].intervals[0];
    assert_eq!((interval.lower, interval.upper), (End::Bound(0.5), End::Bound(10.0)));
    // b ends where a meets its bounds: 2.05/10 and 2.05/0.5, and χ² of b alone
    // beyond: one standard error of the product, 0.07, over a.
    let interval = profiles[1].intervals[0];
    let [lower, upper] = [interval.lower, interval.upper].map(|e| e.closed().unwrap());
    // The third residual is worth up to (1/10)² in χ²: half of it in z, times
    // 0.07/a; ends as found.
    assert!((lower - (2.05 - 0.0707) / 10.0).abs() < 1e-3, "{lower}");
    assert!((upper - (2.05 + 0.0707) / 0.5).abs() < 2e-2, "{upper}");
}

#[test]
fn a_profile_that_meets_a_better_fit_says_so() {
    // Two minima, the start in the shallower one.
    let narrow = Curve {
        parameters: vec![Parameter::new("a", "", 2.8), Parameter::new("b", "", 0.1)],
        x: vec![0.0, 1.0, 2.0],
        y: vec![0.0, 0.0, 0.0],
        sigma: vec![1.0, 1.0, 1.0],
        model: |p: &[f64], x: f64| match x {
            0.0 => 0.4 * (p[0] * p[0] - 9.0),
            1.0 => 0.2 * (p[0] + 3.0),
            _ => p[1],
        },
    };
    let found = fit(&narrow, &Fitting::default()).unwrap();
    assert!(found.point[0] > 2.0);
    let covariance = Covariance::new(&narrow.parameters, &found);
    let how = Profiling { levels: vec![20.0], ..Profiling::default() };
    let error = profile(&narrow, &found, &covariance, &[0], &how).unwrap_err();
    assert!(matches!(error, InferError::BetterFit { by, .. } if by > 0.1), "{error}");
    // Several starts find it at once.
    let several = Fitting { starts: 8, seed: 1, ..Fitting::default() };
    let mut spread = narrow;
    spread.parameters[0] = spread.parameters[0].clone().within(-6.0, 6.0);
    let best = fit(&spread, &several).unwrap();
    // χ²/2 within 1e-9.
    assert!((best.point[0] + 3.0).abs() < 1e-4);
    let agreeing = best.agreeing_starts();
    assert!((1..8).contains(&agreeing), "{agreeing}");
    // The shallower one, near 3, costs (0.2 · 6)² = 1.44 less what a little of the way back
    // gains: it fits as well, and is reported once however many starts came to it.
    let sd = Covariance::new(&spread.parameters, &best).sd;
    let others = best.other_minima(&sd);
    let [(other, count)] = others[..] else { panic!("{others:?}") };
    assert!((2.8..3.0).contains(&other.point[0]), "{other:?}");
    let rise = 2.0 * (other.cost - best.cost);
    assert!((1.3..1.44).contains(&rise), "{rise}");
    assert_eq!(count + agreeing, best.starts.len());
    // Where nothing is known of the parameters, none is another.
    assert!(best.other_minima(&[f64::INFINITY; 2]).is_empty());
}

#[test]
fn sigmas_that_depend_on_parameters_pay_for_their_width() {
    // Normal numbers of unknown mean and σ: the likelihood's maximum is their
    // mean and √(mean square deviation).
    struct Width(Vec<Parameter>, Vec<f64>);
    impl hertzchain_infer::Problem for Width {
        fn parameters(&self) -> &[Parameter] {
            &self.0
        }
        fn residual_count(&self) -> usize {
            self.1.len()
        }
        fn residuals(
            &self,
            points: &[Vec<f64>],
        ) -> Vec<Result<hertzchain_infer::Residuals, hertzchain_infer::ModelError>> {
            let at = |p: &Vec<f64>| {
                Ok(hertzchain_infer::Residuals {
                    standardised: self.1.iter().map(|y| (y - p[0]) / p[1]).collect(),
                    ln_sigmas: vec![p[1].ln(); self.1.len()],
                })
            };
            points.iter().map(at).collect()
        }
    }
    let y: Vec<f64> = normals(7, 40).iter().map(|e| 3.0 + 0.5 * e).collect();
    let free =
        vec![Parameter::new("mean", "", 1.0), Parameter::new("width", "", 2.0).within(1e-3, 1e3)];
    let found = fit(&Width(free, y.clone()), &Fitting::default()).unwrap();
    let mean = y.iter().sum::<f64>() / 40.0;
    let square = y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / 40.0;
    assert!(found.ending.converged(), "{}", found.ending);
    // 4e-5 standard errors of 0.08 and 0.06; differences' (h/σ)² leave 1e-6 of the width.
    assert!((found.point[0] - mean).abs() < 1e-5);
    assert!((found.point[1] - square.sqrt()).abs() < 1e-5, "{:?}", found.point);
}
