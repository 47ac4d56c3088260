//! Predicates on the three pulses of a shot.

use super::{Worst, curves, missing, or_in_part, within};
use crate::claims::{Branch, Claim, Evidence, Finding, Point, SPEED_SCATTER_M_S, Tally};

/// Incoming, wall and returning pulse follow each other, apart in time: each ToF
/// exceeds the threshold times the mean full width at half maximum of its two
/// pulses. A pulse out of order has a negative ToF. Relative errors of the ToF and of
/// the widths add up.
pub(super) fn pulses_separate(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for p in within(claim, curve) {
            let [incoming, wall, returning] = p.widths_s;
            let pairs = [
                (p.tof_incident_s, incoming + wall),
                (p.tof_reflected_s, wall + returning),
            ];
            for (tof, widths) in pairs {
                let value = tof / (0.5 * widths);
                let accuracy = value.abs() * (p.accuracy_reached + p.width_accuracy);
                tally.margin(value - claim.threshold, accuracy);
                let margin = value - claim.threshold;
                worst.see(margin, value, accuracy, || place(&curve.case, p));
            }
        }
    }
    worst.finding(tally)
}

fn place(case: &str, p: &Point) -> String {
    format!("{case} at {} m/s", p.speed_m_s)
}

/// Reflected over incident ToF exceeds the threshold at every speed.
pub(super) fn return_takes_longer(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for p in within(claim, curve) {
            let value = p.tof_reflected_s / p.tof_incident_s;
            let accuracy = 2.0 * value * p.accuracy_reached;
            tally.margin(value - claim.threshold, accuracy);
            worst.see(value - claim.threshold, value, accuracy, || {
                place(&curve.case, p)
            });
        }
    }
    worst.finding(tally)
}

/// A second returning maximum of at least the threshold times the first; in
/// part above the weaker threshold. With r = p₂/p₁, Δr = Δp₂/p₁ + r Δp₁/p₁.
pub(super) fn return_is_split(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let mut points = curves.iter().flat_map(|curve| within(claim, curve));
    let Some(p) = points.next() else {
        return missing();
    };
    let value = p.second_returning_peak_n / p.returning_peak_n;
    let accuracy = p.second_peak_accuracy_n / p.returning_peak_n + value * p.peak_accuracy;
    let above = |threshold: f64| {
        let mut tally = Tally::default();
        tally.margin(value - threshold, accuracy);
        tally
    };
    let (full, weaker) = (above(claim.threshold), claim.partly.map(above));
    Finding {
        verdict: or_in_part(full.verdict(), weaker.map(Tally::verdict)),
        leaning: or_in_part(full.leaning(), weaker.map(Tally::leaning)),
        value,
        accuracy,
        expected: None,
        detail: format!(
            "returning peaks of {:.3} N and {:.3} N at {} m/s",
            p.returning_peak_n, p.second_returning_peak_n, p.speed_m_s
        ),
        nearest_change: None,
    }
}

/// Share of (reflected − incident ToF) that is gone when the gaps behind the pulse
/// close as it meets the wall, above the threshold at every speed; in part above
/// the weaker one. The share is 1 − c/e, with Δ = (Δc + |c/e| Δe)/e. Chains without losses are
/// loosened as well: the detail has their difference.
pub(super) fn closing_gaps_shortens_return(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let points = curves
        .iter()
        .flat_map(|curve| within(claim, curve).into_iter().map(|p| (&curve.case, p)));
    let (mut full, mut weaker, mut worst) = (Tally::default(), Tally::default(), Worst::none());
    let mut most = f64::NEG_INFINITY;
    for (case, p) in points {
        let [open, closed] = p.excess_s;
        let value = 1.0 - closed / open;
        let accuracy = p.excess_accuracy_s * (1.0 + (closed / open).abs()) / open.abs();
        full.margin(value - claim.threshold, accuracy);
        weaker.margin(value - claim.partly.unwrap_or(claim.threshold), accuracy);
        most = most.max(value);
        worst.see(value, value, accuracy, || {
            format!("{}, {}", place(case, p), differences(p, evidence))
        });
    }
    let finding = worst.finding(full);
    Finding {
        verdict: or_in_part(full.verdict(), Some(weaker.verdict())),
        leaning: or_in_part(full.leaning(), Some(weaker.leaning())),
        detail: format!("{}; largest share {most:.4}", finding.detail),
        ..finding
    }
}

/// Reflected less incident ToF of a shot with its gaps, with closed ones, and without
/// losses, in words.
fn differences(p: &Point, evidence: &Evidence) -> String {
    let lossless = evidence.curve("hertz").and_then(|c| c.at(p.speed_m_s));
    let lossless = lossless.map(|p| p.tof_reflected_s - p.tof_incident_s);
    let lossless = lossless.map_or(String::new(), |difference_s| {
        format!(", {:.2} µs without losses", 1e6 * difference_s)
    });
    let [open, closed] = p.excess_s.map(|difference_s| 1e6 * difference_s);
    format!("{open:.2} µs with gaps, {closed:.2} µs with closed ones{lossless}")
}

/// The scatter of the striker's speed makes the reflected ToF scatter more
/// than the incident one: ratio of the two |dT/dv| above the threshold.
pub(super) fn return_scatters_more(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        let [incident, reflected] = Branch::BOTH.map(|branch| {
            let slopes = curve.slopes_s2_m(branch).into_iter();
            slopes.zip(curve.slope_accuracies(branch))
        });
        for (p, (incident, reflected)) in curve.points.iter().zip(incident.zip(reflected)) {
            let ((incident, unsure), (reflected, as_unsure)) = (incident, reflected);
            let value = reflected / incident;
            let accuracy = value.abs() * (unsure + as_unsure);
            tally.margin(value - claim.threshold, accuracy);
            worst.see(value - claim.threshold, value, accuracy, || {
                let us = reflected.abs() * SPEED_SCATTER_M_S * 1e6;
                format!("{}, reflected ToF ± {us:.2} µs", place(&curve.case, p))
            });
        }
    }
    worst.finding(tally)
}

/// The gaps between beads, less the overlaps, exceed the threshold when the
/// returning pulse has passed, and stay below the most that the claim allows.
pub(super) fn gaps_open(claim: &Claim, evidence: &Evidence) -> Finding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let largest = claim.at_most.unwrap_or(f64::INFINITY);
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for curve in curves {
        for p in within(claim, curve) {
            let accuracy = p.loosened_accuracy_m;
            tally.margin(p.loosened_m - claim.threshold, accuracy);
            tally.margin(largest - p.loosened_m, accuracy);
            let margin = (p.loosened_m - claim.threshold).min(largest - p.loosened_m);
            worst.see(margin, p.loosened_m, accuracy, || place(&curve.case, p));
        }
    }
    worst.finding(tally)
}
