//! Predicates on where a wet over dry ratio passes 1.

use super::missing;
use crate::claims::{Claim, Distance, Evidence, Finding, Ratio, Tally, Verdict};

/// Speed at which a ratio passes 1 and how sure it is: linear in ln v between
/// the two speeds around it. Δv/v is the error of the ratios over their slope in
/// ln v, and what the chord may leave out.
fn crossing(low: &Ratio, high: &Ratio) -> (f64, f64) {
    let (before, after) = (low.incident - 1.0, high.incident - 1.0);
    let span = (high.speed_m_s / low.speed_m_s).ln();
    let part = before / (before - after);
    let speed = low.speed_m_s * (part * span).exp();
    let slope = (after - before) / span;
    let from_tofs = unsure(low).max(unsure(high)) / slope.abs();
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

/// An upward passage counts 1, a downward one −2: the sum is 1 for one upward
/// passage alone.
const UPWARD: f64 = 1.0;
const DOWNWARD: f64 = -2.0;

/// Upward passages less twice the downward ones.
fn count(ratios: &[Ratio]) -> f64 {
    let (up, down) = crossings(ratios);
    up.len() as f64 * UPWARD + down.len() as f64 * DOWNWARD
}

/// Absolute accuracy of a ratio of two ToFs.
fn unsure(ratio: &Ratio) -> f64 {
    ratio.accuracy_reached * ratio.incident
}

/// Whether a ratio is 1 within its accuracy.
fn is_open(ratio: &Ratio) -> bool {
    (ratio.incident - 1.0).abs() <= unsure(ratio)
}

/// The smallest or largest count when every ratio that is 1 within its accuracy
/// may lie below or above it: of all ways to end below and above 1, the best
/// is carried from ratio to ratio.
fn extreme_count(ratios: &[Ratio], pick: fn(f64, f64) -> f64) -> f64 {
    // What is impossible is not a number, which `pick` passes over.
    let possible = |r: &Ratio, below: bool| match is_open(r) || (r.incident < 1.0) == below {
        true => 0.0,
        false => f64::NAN,
    };
    let sides = |r: &Ratio| (possible(r, true), possible(r, false));
    let mut all = ratios.iter().map(sides);
    let first = all.next().unwrap_or_default();
    let (below, above) = all.fold(first, |(was_below, was_above), (below, above)| {
        (
            below + pick(was_below, was_above + DOWNWARD),
            above + pick(was_above, was_below + UPWARD),
        )
    });
    pick(below, above)
}

/// By how much the count may be wrong. 0 when no ratio is so near to 1 that its
/// side matters, for then the count is that of the exact ratios.
fn count_accuracy(ratios: &[Ratio]) -> f64 {
    let value = count(ratios);
    let (least, most) = (
        extreme_count(ratios, f64::min),
        extreme_count(ratios, f64::max),
    );
    (value - least).max(most - value)
}

/// The ratio that is nearest to 1, by its accuracies.
fn nearest_to_1(ratios: &[Ratio]) -> Option<&Ratio> {
    let by_accuracy = |r: &&Ratio| (r.incident - 1.0).abs() / unsure(r);
    let near = |a: &&Ratio, b: &&Ratio| by_accuracy(a).total_cmp(&by_accuracy(b));
    ratios.iter().min_by(near)
}

/// The ratio passes 1 once, upward. The number is that of upward passages less
/// twice that of downward ones, which is 1 in no other case; not decidable where
/// ratios that are 1 within their accuracy could change it. A passage is one
/// between neighbouring speeds.
pub(super) fn once_upward(claim: &Claim, evidence: &Evidence) -> Finding {
    let ratios = ratios(claim, evidence);
    let (Some(nearest), Some(expected)) = (nearest_to_1(&ratios), claim.expected.first()) else {
        return missing();
    };
    let (value, accuracy) = (count(&ratios), count_accuracy(&ratios));
    let mut tally = Tally::default();
    tally.margin(claim.threshold - (value - expected).abs(), accuracy);
    Finding {
        verdict: tally.verdict(),
        leaning: tally.leaning(),
        value,
        accuracy,
        expected: Some(*expected),
        detail: passages(&ratios, nearest),
        nearest_change: Some(Distance {
            margin: (nearest.incident - 1.0).abs(),
            accuracy: unsure(nearest),
        }),
    }
}

/// What passes 1, and what comes nearest to it, in words.
fn passages(ratios: &[Ratio], nearest: &Ratio) -> String {
    let (up, down) = crossings(ratios);
    let end = |r: Option<&Ratio>| {
        r.map_or(String::new(), |r| {
            format!("{:.5} at {} m/s", r.incident, r.speed_m_s)
        })
    };
    format!(
        "{} upward and {} downward; from {} to {}; the ratio nearest to 1 is off by {:.1e} ± {:.0e}, at {} m/s",
        up.len(),
        down.len(),
        end(ratios.first()),
        end(ratios.last()),
        (nearest.incident - 1.0).abs(),
        unsure(nearest),
        nearest.speed_m_s
    )
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
        return nowhere(*expected, ratios.iter().any(is_open));
    };
    let mut tally = Tally::default();
    tally.margin(claim.threshold - off(value), accuracy);
    Finding {
        verdict: tally.verdict(),
        leaning: tally.leaning(),
        value,
        accuracy,
        expected: Some(*expected),
        detail: format!("the nearest of {} upward passages", up.len()),
        nearest_change: None,
    }
}

/// The answer without a passage, which a ratio of 1 within its accuracy may hide.
fn nowhere(expected: f64, open: bool) -> Finding {
    Finding {
        verdict: if open {
            Verdict::NotDecidable
        } else {
            Verdict::Fails
        },
        leaning: Verdict::Fails,
        expected: Some(expected),
        ..Finding::without_numbers("no upward passage of 1")
    }
}
