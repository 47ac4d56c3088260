//! Pictures of what was inferred.

use hertzchain_figures::Figure;
use hertzchain_figures::inference::{Corner, ProfileCurve, SingularValues, profile_figure};

/// Numbers between −1 and 1 that look like noise.
fn noise(count: u32, seed: f64) -> Vec<f64> {
    let number = |i: u32| (f64::from(i) * 12.9898 + seed).sin() * 43_758.547;
    (0..count).map(|i| 2.0 * number(i).rem_euclid(1.0) - 1.0).collect()
}

pub(crate) fn corner() -> Figure {
    let normal = |seed: f64| -> Vec<f64> {
        let sums: Vec<Vec<f64>> = (0..6).map(|k| noise(6000, seed + 10.0 * f64::from(k))).collect();
        let sum = |i: usize| sums.iter().map(|s| s[i]).sum::<f64>() / 2.0_f64.sqrt();
        (0..6000).map(sum).collect()
    };
    let (a, b, c) = (normal(1.3), normal(2.7), normal(5.1));
    let eta: Vec<f64> = a.iter().map(|a| 3.2e4 * (1.0 + 0.06 * a)).collect();
    let cubic = a.iter().zip(&b).map(|(a, b)| 77.0 - 9.0 * a + 1.5 * a * a + 3.0 * b);
    let young = b.iter().zip(&c).map(|(b, c)| 213.0 + 0.8 * b + 1.1 * c);
    let samples = [eta, cubic.collect(), young.collect()];
    let labels = [r"$\eta$ (Pa s)", r"$B$ (kg s/m$^2$)", "$Y$ (GPa)"].map(String::from);
    let marks = [3.2e4, 77.0, 213.0];
    let covariance = [
        vec![1920.0_f64.powi(2), -1920.0 * 9.0, 0.0],
        vec![-1920.0 * 9.0, 90.0, 2.4],
        vec![0.0, 2.4, 1.85],
    ];
    Corner { labels: &labels, samples: &samples, marks: &marks, covariance: &covariance }.figure()
}

pub(crate) fn profiles() -> Figure {
    let levels = [(1.0, "68 %"), (3.841, "95 %")];
    let root: Vec<f64> = (-8..=8).map(|i| 0.27 * f64::from(i)).collect();
    let rise: Vec<f64> = root.iter().map(|z| z * z).collect();
    let straight: Vec<f64> = root.iter().map(|z| 3.2e4 + 1800.0 * z).collect();
    let bent: Vec<f64> = root.iter().map(|z| 77.0 * (1.0 + 0.16 * z).powi(2)).collect();
    let curve = |label, values, best, error| ProfileCurve {
        label,
        values,
        rise: &rise,
        best,
        standard_error: Some(error),
        levels: &levels,
    };
    profile_figure(&[
        curve(r"$\eta$ (Pa s)", &straight, 3.2e4, 1800.0),
        curve(r"$B$ (kg s/m$^2$)", &bent, 77.0, 0.32 * 77.0),
    ])
}

pub(crate) fn singular_values() -> Figure {
    let names = ["Y", "nu", "eta", "B"].map(String::from);
    let directions = [
        vec![0.81, 0.35, 0.41, 0.24],
        vec![-0.4, -0.1, 0.52, 0.75],
        vec![0.2, 0.12, -0.74, 0.63],
        vec![-0.36, 0.93, 0.05, 0.0],
    ];
    SingularValues {
        names: &names,
        values: &[2.1e3, 160.0, 3.1, 0.0],
        directions: &directions,
        floor: 2e-4,
    }
    .figure()
}
