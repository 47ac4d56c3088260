//! Predicates that need measured points.

use super::Worst;
use crate::claims::{Claim, Evidence, Finding, Tally};

/// Measured peak ratios lie within the threshold times their standard error
/// of the model's; not decidable without measured points. The errors of the two
/// computed peaks add up; the measured ones are in the standard error.
pub(super) fn overlaps_data(claim: &Claim, evidence: &Evidence) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for peak in &evidence.digitised {
        let Some(p) = evidence
            .curve(&peak.case)
            .and_then(|curve| curve.at(peak.speed_m_s))
        else {
            continue;
        };
        let model = p.sensor_peak_n / p.wall_peak_n;
        let value = (model - peak.sensor_over_wall).abs() / peak.standard_error;
        let accuracy = 2.0 * p.peak_accuracy * model / peak.standard_error;
        tally.margin(claim.threshold - value, accuracy);
        worst.see(claim.threshold - value, value, accuracy, || {
            format!("{} at {} m/s", peak.case, peak.speed_m_s)
        });
    }
    match tally.counts() {
        (_, 0) => Finding::without_numbers("the paper prints no digitised point to compare with"),
        _ => worst.finding(tally),
    }
}
