//! Predicates on printed constants.

use super::missing;
use crate::claims::{Claim, Evidence, Finding, Tally};

/// The first case's dynamic viscosity, in Pa s, lies within the threshold of the
/// printed one.
pub(super) fn dynamic_viscosity(claim: &Claim, evidence: &Evidence) -> Finding {
    let oil = claim.cases.first().and_then(|case| evidence.oil(case));
    oil.map_or_else(missing, |oil| near(claim, oil.dynamic_viscosity_pa_s()))
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

/// The larger dynamic viscosity of two cases is less than the threshold times
/// the smaller.
pub(super) fn viscosities_similar(claim: &Claim, evidence: &Evidence) -> Finding {
    let oil = |i: usize| Some(evidence.oil(claim.cases.get(i)?)?.dynamic_viscosity_pa_s());
    let (Some(a), Some(b)) = (oil(0), oil(1)) else {
        return missing();
    };
    let value = a.max(b) / a.min(b);
    of_constants(value, claim.threshold - value, None)
}

/// η/Y in s lies within the threshold of the printed value.
pub(super) fn relaxation_time(claim: &Claim, evidence: &Evidence) -> Finding {
    near(claim, evidence.viscosity_over_modulus_s)
}

/// The decimal logarithm of η/Y in s lies within the threshold of the expected
/// one.
pub(super) fn relaxation_order(claim: &Claim, evidence: &Evidence) -> Finding {
    near(claim, evidence.viscosity_over_modulus_s.log10())
}

/// Operations behind a value: two conversions of units and a product each for
/// two liquids, their ratio, a logarithm and the difference from what is printed.
const ROUNDED: f64 = 10.0;

/// Nothing is computed here but arithmetic on printed constants: the value is
/// wrong by what double precision rounds, n ε |x|.
fn near(claim: &Claim, value: f64) -> Finding {
    let expected = claim.expected.first().copied().unwrap_or(f64::NAN);
    let margin = claim.threshold - (value - expected).abs();
    of_constants(value, margin, Some(expected))
}

fn of_constants(value: f64, margin: f64, expected: Option<f64>) -> Finding {
    let accuracy = ROUNDED * f64::EPSILON * value.abs();
    let mut tally = Tally::default();
    tally.margin(margin, accuracy);
    Finding {
        verdict: tally.verdict(),
        leaning: tally.leaning(),
        value,
        accuracy,
        expected,
        detail: "from the printed constants alone".to_owned(),
        nearest_change: None,
    }
}
