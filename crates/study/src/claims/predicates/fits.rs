//! Predicates on power laws.

use super::{Worst, branches, curves, missing};
use crate::claims::{Claim, Curve, Evidence, Finding, Tally, Verdict};

/// R² of the straight line in log–log is at least the threshold, for every
/// case and branch.
pub(super) fn r_squared(claim: &Claim, evidence: &Evidence) -> Finding {
    each_fit(claim, evidence, |curve, branch| {
        let fit = curve.power_law(branch).ok()?;
        Some((fit.r_squared, fit.r_squared - claim.threshold))
    })
}

/// The largest residual of the weighted fit, in standard errors of the
/// paper's points, is at most the threshold, for every case and branch.
pub(super) fn residuals(claim: &Claim, evidence: &Evidence) -> Finding {
    each_fit(claim, evidence, |curve, branch| {
        let fit = curve.weighted_power_law(branch).ok()?;
        let errors = curve.standard_errors_s(branch);
        let tofs = curve.tofs_s(branch);
        let scaled = fit.residuals.iter().zip(&errors).zip(&tofs);
        let largest = scaled.map(|((r, error), tof)| (r.exp_m1() * tof / error).abs());
        let value = largest.fold(0.0, f64::max);
        Some((value, claim.threshold - value))
    })
}

/// What a fit is judged by: the value and its margin.
type Measure<'a> = &'a dyn Fn(&Curve, crate::claims::Branch) -> Option<(f64, f64)>;

fn each_fit(
    claim: &Claim,
    evidence: &Evidence,
    measure: impl Fn(&Curve, crate::claims::Branch) -> Option<(f64, f64)>,
) -> Finding {
    let measure: Measure<'_> = &measure;
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for branch in branches(claim) {
            let Some((value, margin)) = measure(curve, branch) else {
                return Finding::without_numbers("no power law can be fitted");
            };
            // The numbers of a fit are as accurate as the ToFs, of which they
            // are sums; one part in a thousand covers the worst amplification.
            let accuracy = 1e-3 * margin.abs();
            tally.margin(margin, accuracy);
            worst.see(margin, value, value * 1e-3, || {
                format!("{} ToF of {}", branch.name(), curve.case)
            });
        }
    }
    worst.finding(tally)
}

/// The exponent lies within the threshold of the expected value.
pub(super) fn exponent_is(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let expected = claim.expected.first().copied().unwrap_or(f64::NAN);
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for branch in branches(claim) {
            let Ok(fit) = curve.power_law(branch) else {
                return Finding::without_numbers("no power law can be fitted");
            };
            let margin = claim.threshold - (fit.exponent - expected).abs();
            tally.margin(margin, 0.0);
            worst.see(margin, fit.exponent, fit.exponent_error, || {
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
    let mut tally = Tally::default();
    let mut details = Vec::new();
    let (mut value, mut accuracy) = (f64::NAN, f64::NAN);
    for branch in branches(claim) {
        let fits = (one.power_law(branch), other.power_law(branch));
        let (Ok(a), Ok(b)) = fits else {
            return Finding::without_numbers("no power law can be fitted");
        };
        let error = a.exponent_error.hypot(b.exponent_error);
        let difference = b.exponent - a.exponent;
        tally.margin(difference.abs() - claim.threshold * error, 0.0);
        if details.is_empty() {
            (value, accuracy) = (difference, error);
        }
        details.push(format!(
            "{}: {:.4} ± {:.4} against {:.4} ± {:.4}",
            branch.name(),
            a.exponent,
            a.exponent_error,
            b.exponent,
            b.exponent_error
        ));
    }
    let verdict: Verdict = tally.verdict();
    Finding {
        verdict,
        value,
        accuracy,
        detail: details.join("; "),
    }
}
