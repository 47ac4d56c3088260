//! Predicates on the striker.

use super::{Worst, curves, missing, within};
use crate::claims::{Claim, Evidence, Finding, Tally};

/// At the claim's speeds the striker's velocity, at first separation and at
/// the end of the shot, is above the threshold: it does not come back.
pub(super) fn no_rebound(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for p in within(claim, curve) {
            let moments = [
                ("first separation", p.striker_separation_m_s),
                ("end of the shot", p.striker_rebound_m_s),
            ];
            for (moment, value) in moments.into_iter().filter(|(_, value)| !value.is_nan()) {
                let accuracy = p.striker_accuracy_m_s;
                tally.margin(value - claim.threshold, accuracy);
                worst.see(value - claim.threshold, value, accuracy, || {
                    format!("{} at {} m/s, {moment}", curve.case, p.speed_m_s)
                });
            }
        }
    }
    worst.finding(tally)
}
