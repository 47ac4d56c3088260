//! Predicates on power laws.

use super::{Worst, branches, curves, missing};
use crate::claims::{Branch, Claim, Curve, Evidence, Finding, Tally, Verdict};

/// R² of the straight line in log–log is at least the threshold, for every
/// case and branch; in part if it is at least the weaker one.
pub(super) fn r_squared(claim: &Claim, evidence: &Evidence) -> Finding {
    let finding = r_squared_above(claim.threshold, claim, evidence);
    let weaker = |least| r_squared_above(least, claim, evidence).verdict == Verdict::Holds;
    match finding.verdict {
        Verdict::Fails if claim.partly.is_some_and(weaker) => Finding {
            verdict: Verdict::InPart,
            ..finding
        },
        _ => finding,
    }
}

fn r_squared_above(least: f64, claim: &Claim, evidence: &Evidence) -> Finding {
    each_fit(claim, evidence, &|curve, branch| {
        let fit = curve.power_law(branch).ok()?;
        let left = 1.0 - fit.r_squared;
        let sum: f64 = fit.residuals.iter().map(|r| r * r).sum();
        // 1 − R² is the residuals' sum of squares over that of ln T; to first
        // order an error of every ToF moves it by twice its share of a residual.
        let of_residual = accuracy(curve) * (fit.residuals.len() as f64 / sum).sqrt();
        let accuracy = 2.0 * left * of_residual;
        Some((fit.r_squared, fit.r_squared - least, accuracy))
    })
}

/// The largest residual of the weighted fit, in standard errors of the
/// paper's points, is at most the threshold, for every case and branch.
pub(super) fn residuals(claim: &Claim, evidence: &Evidence) -> Finding {
    each_fit(claim, evidence, &|curve, branch| {
        let fit = curve.weighted_power_law(branch).ok()?;
        let errors = curve.standard_errors_s(branch);
        let tofs = curve.tofs_s(branch);
        let relative: Vec<f64> = errors
            .iter()
            .zip(&tofs)
            .map(|(error, tof)| error / tof)
            .collect();
        let scaled = fit.residuals.iter().zip(&relative);
        let value = scaled
            .map(|(r, error)| (r.exp_m1() / error).abs())
            .fold(0.0, f64::max);
        let finest = relative.iter().copied().fold(f64::INFINITY, f64::min);
        Some((
            value,
            claim.threshold - value,
            2.0 * accuracy(curve) / finest,
        ))
    })
}

/// Relative accuracy of a curve's ToFs.
fn accuracy(curve: &Curve) -> f64 {
    curve
        .points
        .iter()
        .map(|p| p.accuracy_reached)
        .fold(0.0, f64::max)
}

/// What a fit is judged by: the value, its margin and their accuracy.
type Measure<'a> = &'a dyn Fn(&Curve, Branch) -> Option<(f64, f64, f64)>;

fn each_fit(claim: &Claim, evidence: &Evidence, measure: Measure<'_>) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for branch in branches(claim) {
            let Some((value, margin, accuracy)) = measure(curve, branch) else {
                return Finding::without_numbers("no power law can be fitted");
            };
            tally.margin(margin, accuracy);
            worst.see(margin, value, accuracy, || {
                format!("{} ToF of {}", branch.name(), curve.case)
            });
        }
    }
    worst.finding(tally)
}

/// The exponents of two cases differ by more than the threshold times their
/// combined standard error, in every branch.
pub(super) fn exponents_differ(claim: &Claim, evidence: &Evidence) -> Finding {
    let curves = curves(claim, evidence).unwrap_or_default();
    let [one, other] = curves[..] else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for branch in branches(claim) {
        let fits = (one.power_law(branch), other.power_law(branch));
        let (Ok(a), Ok(b)) = fits else {
            return Finding::without_numbers("no power law can be fitted");
        };
        let error = a.exponent_error.hypot(b.exponent_error);
        let value = (b.exponent - a.exponent).abs() / error;
        // Errors of ToFs are spread over ln v between about ±1.
        let accuracy = (accuracy(one) + accuracy(other)) / error;
        tally.margin(value - claim.threshold, accuracy);
        worst.see(value - claim.threshold, value, accuracy, || {
            format!(
                "{}, {:.4} ± {:.4} against {:.4} ± {:.4}",
                branch.name(),
                a.exponent,
                a.exponent_error,
                b.exponent,
                b.exponent_error
            )
        });
    }
    worst.finding(tally)
}
