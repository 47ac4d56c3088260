//! Predicates that need measured points.

use super::Worst;
use crate::claims::{Branch, Claim, Evidence, Finding, Measured, Tally};

/// Measured ratios of the sensor's peak to the wall's lie within the threshold
/// times their standard error of the model's; not decidable without measured points.
pub(super) fn peaks(claim: &Claim, evidence: &Evidence) -> Finding {
    overlap(claim, evidence, &[Measured::SensorOverWall])
}

/// The same of measured times of flight.
pub(super) fn tofs(claim: &Claim, evidence: &Evidence) -> Finding {
    let [incident, reflected] = Branch::BOTH.map(Measured::Tof);
    overlap(claim, evidence, &[incident, reflected])
}

/// The same of measured wet over dry incident times of flight.
pub(super) fn ratios(claim: &Claim, evidence: &Evidence) -> Finding {
    overlap(claim, evidence, &[Measured::Ratio])
}

/// The measured points' errors are in their standard errors: the accuracy is
/// that of the model.
fn overlap(claim: &Claim, evidence: &Evidence, of: &[Measured]) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for point in evidence.digitised.iter().filter(|p| of.contains(&p.what)) {
        let Some((model, unsure)) = model(evidence, point.what, &point.case, point.speed_m_s)
        else {
            continue;
        };
        let value = (model - point.value).abs() / point.standard_error;
        let accuracy = unsure / point.standard_error;
        tally.margin(claim.threshold - value, accuracy);
        worst.see(claim.threshold - value, value, accuracy, || {
            format!("{} at {} m/s", point.case, point.speed_m_s)
        });
    }
    match tally.counts() {
        (_, 0) => Finding::without_numbers("the paper prints no digitised point to compare with"),
        _ => worst.finding(tally),
    }
}

/// What the model has in the place of a measured point, with its absolute accuracy:
/// relative errors of the two numbers of a ratio add up.
fn model(evidence: &Evidence, what: Measured, case: &str, speed_m_s: f64) -> Option<(f64, f64)> {
    let p = evidence.curve(case)?.at(speed_m_s)?;
    Some(match what {
        Measured::SensorOverWall => {
            let ratio = p.sensor_peak_n / p.wall_peak_n;
            (ratio, 2.0 * p.peak_accuracy * ratio)
        }
        Measured::Tof(branch) => (p.tof_s(branch), p.tof_accuracy_s(branch)),
        Measured::Ratio => {
            let dry = evidence.curve("dry")?.at(speed_m_s)?;
            let ratio = p.tof_incident_s / dry.tof_incident_s;
            (ratio, ratio * (p.accuracy_reached + dry.accuracy_reached))
        }
    })
}
