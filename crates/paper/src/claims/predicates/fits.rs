//! Predicates on power laws.

use super::{Worst, branches, curves, missing, or_in_part};
use crate::claims::{Branch, Claim, Curve, Evidence, Finding, Tally};
use hertzchain_measure::signal::PowerLaw;

/// R² of the straight line in log–log is at least the threshold, for every
/// case and branch; in part if it is at least the weaker one.
pub(super) fn r_squared(claim: &Claim, evidence: &Evidence) -> Finding {
    let finding = r_squared_above(claim.threshold, claim, evidence);
    let weaker = claim
        .partly
        .map(|least| r_squared_above(least, claim, evidence));
    let weaker = weaker.as_ref();
    Finding {
        verdict: or_in_part(finding.verdict, weaker.map(|weaker| weaker.verdict)),
        leaning: or_in_part(finding.leaning, weaker.map(|weaker| weaker.leaning)),
        ..finding
    }
}

fn r_squared_above(least: f64, claim: &Claim, evidence: &Evidence) -> Finding {
    each_fit(claim, evidence, &|curve, branch| {
        let fit = curve.power_law(branch).ok()?;
        let accuracy = r_squared_accuracy(curve, branch, &fit);
        Some((fit.r_squared, fit.r_squared - least, accuracy))
    })
}

/// Accuracy of R² = 1 − S/S₀, where S and S₀ are the sums of squares of N residuals
/// and of ln T about its mean: errors of at most a in ln T change √S and √S₀ by
/// at most a√N, so Δ = (2 √S a√N + a² N)/S₀ + (S/S₀) 2 a√N/√S₀.
fn r_squared_accuracy(curve: &Curve, branch: Branch, fit: &PowerLaw) -> f64 {
    let logs: Vec<f64> = curve.tofs_s(branch).iter().map(|tof| tof.ln()).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let all: f64 = logs.iter().map(|log| (log - mean).powi(2)).sum();
    let left: f64 = fit.residuals.iter().map(|r| r * r).sum();
    let off = accuracy(curve) * (logs.len() as f64).sqrt();
    (2.0 * left.sqrt() * off + off * off) / all + left / all * 2.0 * off / all.sqrt()
}

/// Accuracy of ToFs over the root mean square of a fit's residuals: by which
/// fraction, at most, they change the root of the residuals' sum of squares.
fn of_residual(curve: &Curve, fit: &PowerLaw) -> f64 {
    let sum: f64 = fit.residuals.iter().map(|r| r * r).sum();
    accuracy(curve) * (fit.residuals.len() as f64 / sum).sqrt()
}

/// The largest residual of the weighted fit, in standard errors of the
/// paper's points, is at most the threshold, for every case and branch. With
/// value r/s, a residual is as wrong as its ToF and the fit, 2 ΔT/T, and a
/// standard error as the slope that it comes from: Δ = 2 (ΔT/T)/s + (r/s) Δs/s.
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
        let slopes = curve.slope_accuracies(branch).into_iter();
        let unsure = slopes.fold(0.0, f64::max);
        let accuracy = 2.0 * accuracy(curve) / finest + value * unsure;
        Some((value, claim.threshold - value, accuracy))
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

/// What a fit is evaluated by: the value, its margin and their accuracy.
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
/// combined standard error, in every branch. With value d/s, the exponents are
/// as wrong as the ToFs, which lie between about ±1 in ln v, and the standard error
/// as the residuals that it comes from. The accuracy is the distance to the worst
/// of these towards the threshold: d/s − (d − Δd)/(s + Δs), or (d + Δd)/(s − Δs) − d/s.
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
        let difference = (b.exponent - a.exponent).abs();
        let value = difference / error;
        let of_exponents = accuracy(one) + accuracy(other);
        let of_error = |curve, fit: &PowerLaw| fit.exponent_error * of_residual(curve, fit);
        let of_error = of_error(one, &a).hypot(of_error(other, &b));
        let accuracy = match value > claim.threshold {
            true => value - (difference - of_exponents) / (error + of_error),
            false => (difference + of_exponents) / (error - of_error).max(0.0) - value,
        };
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
