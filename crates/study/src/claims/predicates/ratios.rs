//! Predicates on wet over dry incident ToFs.

use super::{Worst, missing};
use crate::claims::{Claim, Evidence, Finding, Ratio, Tally, Verdict};

/// Every ratio at the claim's speeds lies below the threshold.
pub(super) fn below(claim: &Claim, evidence: &Evidence) -> Finding {
    side(claim, evidence, -1.0)
}

/// Every ratio at the claim's speeds lies above the threshold.
pub(super) fn above(claim: &Claim, evidence: &Evidence) -> Finding {
    side(claim, evidence, 1.0)
}

fn side(claim: &Claim, evidence: &Evidence, sign: f64) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for case in &claim.cases {
        let ratios = evidence.ratios(case);
        if ratios.is_empty() {
            return missing();
        }
        let inside = |r: &&Ratio| (claim.from_m_s..=claim.to_m_s).contains(&r.speed_m_s);
        for r in ratios.iter().filter(inside) {
            let margin = sign * (r.incident - claim.threshold);
            let accuracy = r.accuracy_reached * r.incident;
            tally.margin(margin, accuracy);
            worst.see(margin, r.incident, accuracy, || {
                format!("{case} at {} m/s", r.speed_m_s)
            });
        }
    }
    worst.finding(tally)
}

/// Speed at which a ratio passes 1 and how sure it is: linear in ln v between
/// the two speeds around it.
fn crossing(low: &Ratio, high: &Ratio) -> (f64, f64) {
    let (before, after) = (low.incident - 1.0, high.incident - 1.0);
    let span = (high.speed_m_s / low.speed_m_s).ln();
    let part = before / (before - after);
    let speed = low.speed_m_s * (part * span).exp();
    let slope = (after - before) / span;
    let from_tofs = low.accuracy_reached.max(high.accuracy_reached) / slope.abs();
    // A smooth curve leaves its chord by at most an eighth of the change of
    // slope over the interval; slopes here change by less than themselves.
    let from_chord = part * (1.0 - part) * span;
    (speed, speed * (from_tofs + 0.5 * from_chord))
}

/// Speeds of crossings with their accuracy.
type Crossings = Vec<(f64, f64)>;

/// All crossings of 1, the upward ones first.
fn crossings(ratios: &[Ratio]) -> (Crossings, Crossings) {
    let (mut up, mut down) = (Vec::new(), Vec::new());
    for pair in ratios.windows(2) {
        if let [low, high] = pair {
            match (low.incident < 1.0, high.incident < 1.0) {
                (true, false) => up.push(crossing(low, high)),
                (false, true) => down.push(crossing(low, high)),
                _ => {}
            }
        }
    }
    (up, down)
}

/// The ratio crosses 1 once, upward, within the threshold of the printed
/// speed; once upward elsewhere holds in part.
pub(super) fn crosses(claim: &Claim, evidence: &Evidence) -> Finding {
    let ratios = claim
        .cases
        .first()
        .map_or(Vec::new(), |case| evidence.ratios(case));
    let Some(expected) = claim.expected.first() else {
        return missing();
    };
    if ratios.is_empty() {
        return missing();
    }
    let (up, down) = crossings(&ratios);
    let Some(&(value, accuracy)) = up.first() else {
        let ends = [ratios.first(), ratios.last()].map(|r| r.map_or(f64::NAN, |r| r.incident));
        return Finding {
            verdict: Verdict::Fails,
            value: f64::NAN,
            accuracy: f64::NAN,
            detail: format!("no upward crossing; from {:.5} to {:.5}", ends[0], ends[1]),
        };
    };
    let mut tally = Tally::default();
    tally.margin(claim.threshold - (value - expected).abs(), accuracy);
    let once = up.len() == 1 && down.is_empty();
    let verdict = match (tally.verdict(), once) {
        (Verdict::Holds, false) | (Verdict::Fails, true) => Verdict::InPart,
        (verdict, _) => verdict,
    };
    let detail = format!("{} upward and {} downward crossings", up.len(), down.len());
    Finding {
        verdict,
        value,
        accuracy,
        detail,
    }
}

/// In every case the ratio rises over more than the threshold's share of the
/// range of ln v, and ends above where it began.
pub(super) fn mainly_rises(claim: &Claim, evidence: &Evidence) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for case in &claim.cases {
        let ratios = evidence.ratios(case);
        let (Some(first), Some(last)) = (ratios.first(), ratios.last()) else {
            return missing();
        };
        let span = |pair: &[Ratio]| match pair {
            [low, high] if high.incident > low.incident => (high.speed_m_s / low.speed_m_s).ln(),
            _ => 0.0,
        };
        let rising: f64 = ratios.windows(2).map(span).sum();
        let value = rising / (last.speed_m_s / first.speed_m_s).ln();
        let ends = last.incident - first.incident;
        let met = value > claim.threshold && ends > first.accuracy_reached;
        tally.answer(met);
        let margin = if met { value } else { value - 1.0 };
        worst.see(margin, value, 0.0, || {
            format!("{case}, from end to end {ends:+.5}")
        });
    }
    worst.finding(tally)
}

/// Every case has a speed range in which the ratio falls from a maximum by
/// more than the threshold.
pub(super) fn has_dips(claim: &Claim, evidence: &Evidence) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for case in &claim.cases {
        let ratios = evidence.ratios(case);
        if ratios.is_empty() {
            return missing();
        }
        let accuracy = ratios
            .iter()
            .map(|r| r.accuracy_reached)
            .fold(0.0, f64::max);
        // Negative where the ratio rises throughout: the smallest rise.
        let (mut highest, mut fall, mut at) = (f64::NAN, f64::NEG_INFINITY, f64::NAN);
        for r in &ratios {
            if highest - r.incident > fall {
                (fall, at) = (highest - r.incident, r.speed_m_s);
            }
            highest = r.incident.max(highest);
        }
        tally.margin(fall - claim.threshold, 2.0 * accuracy);
        worst.see(fall - claim.threshold, fall, 2.0 * accuracy, || {
            format!("{case} at {at} m/s")
        });
    }
    worst.finding(tally)
}
