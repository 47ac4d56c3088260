//! Predicates on printed constants.

use super::{Worst, missing};
use crate::claims::{Claim, Evidence, Finding, Tally, Verdict};

/// The dynamic viscosity of every case, in Pa s, lies within the threshold of
/// the printed one.
pub(super) fn dynamic_viscosity(claim: &Claim, evidence: &Evidence) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for (case, expected) in claim.cases.iter().zip(&claim.expected) {
        let Some(oil) = evidence.oil(case) else {
            return missing();
        };
        let value = oil.dynamic_viscosity_pa_s();
        let margin = claim.threshold - (value - expected).abs();
        tally.margin(margin, 0.0);
        worst.see(margin, value, 0.0, || format!("{case}, printed {expected}"));
    }
    worst.finding(tally)
}

/// The first case's dynamic viscosity over the second's lies within the
/// threshold of the printed ratio.
pub(super) fn viscosity_ratio(claim: &Claim, evidence: &Evidence) -> Finding {
    let oil = |i: usize| evidence.oil(claim.cases.get(i)?);
    match (oil(0), oil(1)) {
        (Some(a), Some(b)) => near(
            claim,
            a.dynamic_viscosity_pa_s() / b.dynamic_viscosity_pa_s(),
        ),
        _ => missing(),
    }
}

/// η/Y in s lies within the threshold of the printed value.
pub(super) fn relaxation_time(claim: &Claim, evidence: &Evidence) -> Finding {
    near(claim, evidence.viscosity_over_modulus_s)
}

/// η/Y lies within a factor of the expected one; the threshold is its
/// decimal logarithm.
pub(super) fn relaxation_order(claim: &Claim, evidence: &Evidence) -> Finding {
    let expected = claim.expected.first().copied().unwrap_or(f64::NAN);
    let value = evidence.viscosity_over_modulus_s / expected;
    let mut tally = Tally::default();
    tally.margin(claim.threshold - value.log10().abs(), 0.0);
    plain(tally.verdict(), value)
}

fn near(claim: &Claim, value: f64) -> Finding {
    let expected = claim.expected.first().copied().unwrap_or(f64::NAN);
    let mut tally = Tally::default();
    tally.margin(claim.threshold - (value - expected).abs(), 0.0);
    plain(tally.verdict(), value)
}

fn plain(verdict: Verdict, value: f64) -> Finding {
    Finding {
        verdict,
        value,
        accuracy: 0.0,
        detail: "from the printed constants alone".to_owned(),
    }
}
