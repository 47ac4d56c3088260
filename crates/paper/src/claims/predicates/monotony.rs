//! Predicates on what grows or falls with speed.

use super::{Worst, branches, curves, missing};
use crate::claims::{Claim, Curve, Evidence, Finding, Point, Tally};

/// Between neighbouring speeds every ToF falls by more than the threshold.
pub(super) fn tof_falls(claim: &Claim, evidence: &Evidence) -> Finding {
    let branches = branches(claim);
    let falls: Vec<_> = branches
        .iter()
        .map(|branch| move |p: &Point| -p.tof_s(*branch).ln())
        .collect();
    let quantities: Vec<Quantity<'_>> = falls
        .iter()
        .zip(&branches)
        .map(|(log, branch)| -> Quantity<'_> { (branch.name(), log, &|p| p.accuracy_reached) })
        .collect();
    rises(claim, evidence, &quantities)
}

/// Between neighbouring speeds every peak rises by more than the threshold.
pub(super) fn peaks_rise(claim: &Claim, evidence: &Evidence) -> Finding {
    let accuracy = |p: &Point| p.peak_accuracy;
    let quantities: [Quantity<'_>; 3] = [
        ("sensor peak", &|p| p.sensor_peak_n.ln(), &accuracy),
        ("wall peak", &|p| p.wall_peak_n.ln(), &accuracy),
        ("returning peak", &|p| p.returning_peak_n.ln(), &accuracy),
    ];
    rises(claim, evidence, &quantities)
}

/// A quantity's name, its logarithm and how sure that is.
type Quantity<'a> = (
    &'a str,
    &'a dyn Fn(&Point) -> f64,
    &'a dyn Fn(&Point) -> f64,
);

/// Logarithms rise between neighbouring speeds; the value is the smallest
/// d ln(quantity)/d ln(speed), its accuracy that of both ends over the step in
/// ln(speed).
fn rises(claim: &Claim, evidence: &Evidence, quantities: &[Quantity<'_>]) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for quantity @ (name, ..) in quantities {
            for (step, accuracy, speed) in steps(curve, quantity) {
                tally.margin(step - claim.threshold, accuracy);
                worst.see(step - claim.threshold, step, accuracy, || {
                    format!("{name} of {} above {speed} m/s", curve.case)
                });
            }
        }
    }
    worst.finding(tally)
}

/// Slopes between neighbours with their accuracy and lower speed.
fn steps(curve: &Curve, (_, log, sure): &Quantity<'_>) -> Vec<(f64, f64, f64)> {
    let step = |pair: &[Point]| match pair {
        [low, high] => {
            let speed = (high.speed_m_s / low.speed_m_s).ln();
            let accuracy = (sure(low) + sure(high)) / speed;
            Some(((log(high) - log(low)) / speed, accuracy, low.speed_m_s))
        }
        _ => None,
    };
    curve.points.windows(2).filter_map(step).collect()
}
