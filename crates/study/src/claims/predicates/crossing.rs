//! Predicates on where a wet over dry ratio passes 1.

use super::missing;
use crate::claims::{Claim, Evidence, Finding, Ratio, Tally, Verdict};

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

/// The ratios of a claim's first case.
fn ratios(claim: &Claim, evidence: &Evidence) -> Vec<Ratio> {
    let case = claim.cases.first();
    case.map_or(Vec::new(), |case| evidence.ratios(case))
}

/// The ratio passes 1 once, upward. The number is that of upward passages less
/// twice that of downward ones, which is 1 in no other case; not decidable
/// where a ratio is 1 within its accuracy.
pub(super) fn once_upward(claim: &Claim, evidence: &Evidence) -> Finding {
    let ratios = ratios(claim, evidence);
    let (Some(first), Some(last), Some(expected)) =
        (ratios.first(), ratios.last(), claim.expected.first())
    else {
        return missing();
    };
    let (up, down) = crossings(&ratios);
    let value = up.len() as f64 - 2.0 * down.len() as f64;
    let open = |r: &Ratio| (r.incident - 1.0).abs() <= r.accuracy_reached * r.incident;
    let mut tally = Tally::default();
    tally.margin(claim.threshold - (value - expected).abs(), 0.0);
    Finding {
        verdict: match ratios.iter().any(open) {
            true => Verdict::NotDecidable,
            false => tally.verdict(),
        },
        value,
        accuracy: 0.0,
        expected: Some(*expected),
        detail: format!(
            "{} upward and {} downward; from {:.5} at {} m/s to {:.5} at {} m/s",
            up.len(),
            down.len(),
            first.incident,
            first.speed_m_s,
            last.incident,
            last.speed_m_s
        ),
    }
}

/// The upward passage of 1 that is nearest to the printed speed lies within the
/// threshold of it; fails without one.
pub(super) fn at_speed(claim: &Claim, evidence: &Evidence) -> Finding {
    let ratios = ratios(claim, evidence);
    let (false, Some(expected)) = (ratios.is_empty(), claim.expected.first()) else {
        return missing();
    };
    let (up, _) = crossings(&ratios);
    let off = |speed: f64| (speed - expected).abs();
    let nearest = up.iter().min_by(|a, b| off(a.0).total_cmp(&off(b.0)));
    let Some(&(value, accuracy)) = nearest else {
        return Finding {
            verdict: Verdict::Fails,
            value: f64::NAN,
            accuracy: f64::NAN,
            expected: Some(*expected),
            detail: "no upward passage of 1".to_owned(),
        };
    };
    let mut tally = Tally::default();
    tally.margin(claim.threshold - off(value), accuracy);
    Finding {
        verdict: tally.verdict(),
        value,
        accuracy,
        expected: Some(*expected),
        detail: format!("the nearest of {} upward passages", up.len()),
    }
}
