//! Predicates on how pulses fade.

use super::{Worst, missing, within};
use crate::claims::{Claim, Evidence, Finding, Point, Tally};

/// Wall over sensor peak and returning over incoming peak, each divided by
/// the same of the dry chain, lie below the threshold at every speed. Its accuracy
/// is that of the four peaks, whose relative errors add up.
pub(super) fn attenuates_more(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(dry) = evidence.curve("dry") else {
        return missing();
    };
    let left = |p: &Point| {
        [
            ("wall", p.wall_peak_n / p.sensor_peak_n),
            ("return", p.returning_peak_n / p.sensor_peak_n),
        ]
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for case in &claim.cases {
        let Some(wet) = evidence.curve(case) else {
            return missing();
        };
        for p in within(claim, wet) {
            let Some(d) = dry.at(p.speed_m_s) else {
                continue;
            };
            for ((name, wet_left), (_, dry_left)) in left(p).into_iter().zip(left(d)) {
                let value = wet_left / dry_left;
                let accuracy = 2.0 * value * (p.peak_accuracy + d.peak_accuracy);
                tally.margin(claim.threshold - value, accuracy);
                worst.see(claim.threshold - value, value, accuracy, || {
                    format!("{name} of {case} at {} m/s", p.speed_m_s)
                });
            }
        }
    }
    worst.finding(tally)
}
