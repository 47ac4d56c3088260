//! The same problem by SciPy and emcee, in a throw-away Python environment.

#[path = "../../measure/tests/records/common/python.rs"]
mod python;

use crate::toys::{Curve, decay, normals, spaced};
use hertzchain_infer::{
    Chain, Covariance, Fitting, Loss, Parameter, Posterior, Requirements, Sampling, fit,
};
use hertzchain_measure::signal::power_law_both_errors;
use python::Python;
use std::collections::HashMap;
use std::path::Path;

static PYTHON: Python = Python::new(
    "python-for-infer",
    &["numpy", "scipy", "emcee"],
    "fits and posteriors are NOT compared with other programs now",
);

type Decay = Curve<fn(&[f64], f64) -> f64>;

/// A decay with an outlier, so that losses differ.
fn data() -> Decay {
    let free = vec![Parameter::new("a", "", 1.3), Parameter::new("k", "", 0.5)];
    let mut data: Decay = Curve::drawn(free, &spaced(0.0, 4.0, 12), 0.05, &[1.0, 0.7], 9, decay);
    data.y[8] += 0.3;
    data
}

fn others(data: &Decay) -> Option<HashMap<String, Vec<f64>>> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("infer-peers");
    std::fs::create_dir_all(&folder).unwrap();
    let [x, x_sigma, y, y_sigma] = law();
    let law = serde_json::json!({"x": x, "x_sigma": x_sigma, "y": y, "y_sigma": y_sigma});
    let text = serde_json::json!({"x": data.x, "y": data.y, "sigma": data.sigma, "law": law});
    let text = text.to_string();
    std::fs::write(folder.join("data.json"), text).unwrap();
    let printed = PYTHON.run(&folder, include_str!("peers.py"))?;
    Some(serde_json::from_str(&printed).unwrap())
}

/// Times of flight in s as v^−0.2 against speeds in m/s, both with errors: in the paper's
/// range, at five times its errors, so that those of speeds matter.
fn law() -> [Vec<f64>; 4] {
    let speeds: Vec<f64> = spaced(-2.5, 0.2, 12).iter().map(|ln| ln.exp()).collect();
    let (of_speed, of_time) = (normals(11, 12), normals(12, 12));
    let x_sigma = vec![0.0034; 12];
    let measured = |at: usize| speeds[at] + x_sigma[at] * of_speed[at];
    let x: Vec<f64> = (0..12).map(measured).collect();
    let times = speeds.iter().map(|v| 6.5e-4 * v.powf(-0.2));
    let y: Vec<f64> = times.zip(of_time).map(|(time, e)| time + 5.5e-7 * e).collect();
    [x, x_sigma, y, vec![5.5e-7; 12]]
}

#[test]
fn a_power_law_with_errors_in_both_is_that_of_scipy() {
    let data = data();
    let Some(others) = others(&data) else { return };
    let [x, x_sigma, y, y_sigma] = law();
    let ours = power_law_both_errors(&x, &x_sigma, &y, &y_sigma).unwrap();
    let theirs = &others["law"];
    let (prefactor, exponent) = (theirs[3] * theirs[0], theirs[4]);
    // Both stop at relative changes of 1e-15 to 1e-13; their minimum is flat over 1e-7
    // standard errors in double precision.
    assert!((ours.prefactor - theirs[0]).abs() < 1e-6 * prefactor);
    assert!((ours.exponent - theirs[1]).abs() < 1e-6 * exponent);
    assert!((ours.chi_square.unwrap().value / theirs[2] - 1.0).abs() < 1e-9);
    // With the true abscissas eliminated, the full problem's covariance has York's weights
    // at the adjusted abscissas: the same but for where both stopped.
    for (ours, theirs) in [(ours.prefactor_error, prefactor), (ours.exponent_error, exponent)] {
        assert!((ours / theirs - 1.0).abs() < 1e-5, "{ours} {theirs}");
    }
}

fn posterior(data: &Decay) -> (Posterior, f64) {
    let found = fit(data, &Fitting::default()).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    // Stretch moves alone, as emcee's default.
    let how = Sampling { differential_share: 0.0, ensembles: 1, seed: 4, ..Sampling::default() };
    let mut chain = Chain::start(data, &found, &covariance, &how).unwrap();
    chain.advance(data, 6250).unwrap();
    let posterior = chain.posterior(&Requirements::default()).unwrap();
    (posterior, chain.acceptance())
}

#[test]
fn fits_and_posteriors_are_those_of_scipy_and_emcee() {
    let data = data();
    let Some(others) = others(&data) else { return };
    let scale = 1.5;
    let losses = [
        ("linear", Loss::Squares),
        ("soft_l1", Loss::SoftL1 { scale }),
        ("huber", Loss::Huber { scale }),
        ("cauchy", Loss::Cauchy { scale }),
    ];
    let width = others["covariance"][0].sqrt().min(others["covariance"][3].sqrt());
    for (name, loss) in losses {
        let how = Fitting { loss, ..Fitting::default() };
        let found = fit(&data, &how).unwrap();
        assert!(found.ending.converged(), "{name}: {}", found.ending);
        for (ours, theirs) in found.point.iter().zip(&others[name]) {
            // χ²/2 within 1e-9 is 4e-5 standard errors; both programs'.
            assert!((ours - theirs).abs() < 1e-4 * width, "{name} {ours} {theirs}");
        }
        // The same cost, to that tolerance.
        assert!((found.cost - others[name][2]).abs() < 2e-9, "{name}");
    }
    let found = fit(&data, &Fitting::default()).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    for (ours, theirs) in covariance.matrix.iter().flatten().zip(&others["covariance"]) {
        // Slopes at points 4e-5 standard errors apart, and extrapolated differences.
        assert!((ours / theirs - 1.0).abs() < 1e-4);
    }
    bounded(data, &others["bounded"], width);
}

fn bounded(mut data: Decay, theirs: &[f64], width: f64) {
    for (parameter, upper) in data.parameters.iter_mut().zip([0.9, 3.0]) {
        *parameter = Parameter::new(&parameter.name, "", 0.5).within(0.0, upper);
    }
    let found = fit(&data, &Fitting::default()).unwrap();
    // SciPy stays inside its bounds by its own tolerance.
    assert!((found.point[0] - theirs[0]).abs() < 1e-6 && found.is_bound(0));
    assert!((found.point[1] - theirs[1]).abs() < 1e-4 * width);
}

#[test]
fn chains_have_the_moments_and_the_memory_of_emcees() {
    let data = data();
    let Some(others) = others(&data) else { return };
    let (ours, acceptance) = posterior(&data);
    let moments = others["mean"].iter().zip(&others["sd"]);
    for (k, (mean, sd)) in moments.enumerate() {
        // Ours has n effective samples, some 160,000/30, emcee's half of them:
        // standard errors √(3/n) of a mean's and less of a deviation's difference.
        let chance = 4.0 * (3.0 / ours.diagnoses[k].effective).sqrt();
        assert!((ours.mean[k] - mean).abs() < chance * *sd);
        assert!((ours.sd(k) / sd - 1.0).abs() < chance);
        // A τ of some 30 is uncertain by √(20 τ/samples), 6 % in both; emcee takes
        // each walker's mean off, which shortens sums over 5 τ by 10 τ/5500, 5 %.
        let ratio = ours.diagnoses[k].time.time / others["time"][k];
        assert!((ratio - 1.0).abs() < 0.05 + 4.0 * 0.085, "{ratio}");
    }
    // 100,000 decisions, correlated: chance is near 0.002.
    assert!((acceptance - others["acceptance"][0]).abs() < 0.01);
}
