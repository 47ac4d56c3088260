//! Predicates on wet over dry incident ToFs.

use super::{Worst, missing};
use crate::claims::{Claim, Distance, Evidence, Finding, Ratio, Tally};

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

/// How a speed is drawn along an axis.
type Axis = fn(f64) -> f64;

/// In every case the ratio rises over more than the threshold's share of the
/// range of v.
pub(super) fn mainly_rises(claim: &Claim, evidence: &Evidence) -> Finding {
    rises_along(claim, evidence, |speed_m_s| speed_m_s)
}

/// The same of the range of ln v.
pub(super) fn mainly_rises_log(claim: &Claim, evidence: &Evidence) -> Finding {
    rises_along(claim, evidence, f64::ln)
}

/// A share without turns is exact as long as no step between neighbouring speeds
/// could be one of the other sign.
fn rises_along(claim: &Claim, evidence: &Evidence, axis: Axis) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    let mut steps: Vec<Distance> = Vec::new();
    for case in &claim.cases {
        let ratios = evidence.ratios(case);
        let (Some(first), Some(last)) = (ratios.first(), ratios.last()) else {
            return missing();
        };
        let all = axis(last.speed_m_s) - axis(first.speed_m_s);
        steps.extend(ratios.windows(2).filter_map(distance_from_flat));
        let at: Vec<Placed> = ratios
            .iter()
            .map(|r| Placed {
                at: axis(r.speed_m_s),
                ratio: r.incident,
                unsure: r.accuracy_reached * r.incident,
            })
            .collect();
        let (rising, accuracy) = rising(&at);
        let (value, accuracy) = (rising / all, accuracy / all);
        let margin = value - claim.threshold;
        tally.margin(margin, accuracy);
        worst.see(margin, value, accuracy, || case.clone());
    }
    let in_accuracies = |step: &Distance| step.margin / step.accuracy;
    let nearest = |a: &Distance, b: &Distance| in_accuracies(a).total_cmp(&in_accuracies(b));
    Finding {
        nearest_change: steps.into_iter().min_by(nearest),
        ..worst.finding(tally)
    }
}

/// How far the step between two ratios is from 0.
fn distance_from_flat(pair: &[Ratio]) -> Option<Distance> {
    let (low, high) = (pair.first()?, pair.last()?);
    Some(Distance {
        margin: (high.incident - low.incident).abs(),
        accuracy: step_accuracy(low, high),
    })
}

/// A ratio at its place along an axis, with its absolute accuracy.
#[derive(Clone, Copy)]
struct Placed {
    at: f64,
    ratio: f64,
    unsure: f64,
}

/// Over how much of an axis a ratio rises, and how sure that is. Between a rise
/// and a fall the ratio turns at the vertex of the parabola through three
/// speeds; the parabola through every other speed, four times as wrong, shows how
/// sure that is, and near the ends a quarter of the wider interval; what the
/// accuracies of the three ratios move the vertex by is added. Steps within the
/// accuracy of their ends count half and are as unsure.
fn rising(ratios: &[Placed]) -> (f64, f64) {
    let (mut rising, mut accuracy) = (0.0, 0.0);
    for pair in ratios.windows(2) {
        if let [low, high] = pair {
            let (step, span) = (high.ratio - low.ratio, high.at - low.at);
            let open = step.abs() <= low.unsure + high.unsure;
            rising += span * if open { 0.5 } else { f64::from(step > 0.0) };
            accuracy += if open { 0.5 * span } else { 0.0 };
        }
    }
    for (i, three) in ratios.windows(3).enumerate() {
        let [before, at, after] = three else { continue };
        if let Some(turn) = turn(before, at, after) {
            let wider = i.checked_sub(1).and_then(|left| ratios.get(left));
            let coarse = wider.zip(ratios.get(i + 3));
            let coarse = coarse.and_then(|(left, right)| self::turn(left, at, right));
            let unsure = 0.25 * (at.at - before.at).max(after.at - at.at);
            rising += turn * (at.ratio - before.ratio).signum();
            accuracy += coarse.map_or(unsure, |coarse| (coarse - turn).abs());
            accuracy += turn_accuracy([before, at, after], turn);
        }
    }
    (rising, accuracy)
}

/// Where the parabola through three ratios turns, from the middle one; `None`
/// where they rise or fall throughout.
fn turn(before: &Placed, at: &Placed, after: &Placed) -> Option<f64> {
    let (left, right) = (at.at - before.at, after.at - at.at);
    let rise = (at.ratio - before.ratio) / left;
    let fall = (after.ratio - at.ratio) / right;
    // The parabola's slope is linear between the middles of the intervals.
    let turn = || -0.5 * left + 0.5 * (left + right) * rise / (rise - fall);
    (rise * fall < 0.0).then(turn)
}

/// By how much a turn moves when each ratio in its turn is off by its accuracy;
/// a turn that goes away may have been anywhere in the two intervals.
fn turn_accuracy(three: [&Placed; 3], at_exact: f64) -> f64 {
    let moved = |i: usize| {
        let [before, at, after] = std::array::from_fn(|j| {
            let off = if i == j { three[i].unsure } else { 0.0 };
            Placed {
                ratio: three[j].ratio + off,
                ..*three[j]
            }
        });
        let anywhere = after.at - before.at;
        turn(&before, &at, &after).map_or(anywhere, |turn| (turn - at_exact).abs())
    };
    (0..3).map(moved).sum()
}

/// Absolute accuracy of the difference of two ratios.
fn step_accuracy(low: &Ratio, high: &Ratio) -> f64 {
    low.accuracy_reached * low.incident + high.accuracy_reached * high.incident
}

/// In every case the ratio at the highest speed exceeds the one at the lowest
/// by more than the threshold.
pub(super) fn ends_higher(claim: &Claim, evidence: &Evidence) -> Finding {
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for case in &claim.cases {
        let ratios = evidence.ratios(case);
        let (Some(first), Some(last)) = (ratios.first(), ratios.last()) else {
            return missing();
        };
        let value = last.incident - first.incident;
        let accuracy = step_accuracy(first, last);
        tally.margin(value - claim.threshold, accuracy);
        worst.see(value - claim.threshold, value, accuracy, || {
            format!("{case} from {} to {} m/s", first.speed_m_s, last.speed_m_s)
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
            .map(|r| r.accuracy_reached * r.incident)
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

/// How far ratios reach to both sides of 1: of two oils at the speed where that
/// is most, and of the oil with most of it over its speeds. The number is the smaller
/// of the two; negative where all lie on one side.
pub(super) fn either_way(claim: &Claim, evidence: &Evidence) -> Finding {
    let oils: Vec<Vec<Ratio>> = claim.cases.iter().map(|c| evidence.ratios(c)).collect();
    let Some(first) = oils.first().filter(|_| oils.iter().all(|o| !o.is_empty())) else {
        return missing();
    };
    let at_speed = |r: &Ratio| {
        let same = |other: &&Ratio| other.speed_m_s == r.speed_m_s;
        let row = oils.iter().filter_map(|oil| oil.iter().find(same));
        both_sides(row, || format!("between oils at {} m/s", r.speed_m_s))
    };
    let of_oil = |(case, oil): (&String, &Vec<Ratio>)| {
        both_sides(oil.iter(), || format!("between speeds with {case}"))
    };
    let farther = |a: &(f64, String), b: &(f64, String)| a.0.total_cmp(&b.0);
    let most = [
        first.iter().map(at_speed).max_by(farther),
        claim.cases.iter().zip(&oils).map(of_oil).max_by(farther),
    ];
    let unsure = oils.iter().flatten();
    let unsure = unsure.map(|r| r.accuracy_reached * r.incident);
    let accuracy = unsure.fold(0.0, f64::max);
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for (value, place) in most.into_iter().flatten() {
        tally.margin(value - claim.threshold, accuracy);
        worst.see(value - claim.threshold, value, accuracy, || place);
    }
    worst.finding(tally)
}

/// The smaller of the distances that ratios reach below and above 1.
fn both_sides<'a>(
    ratios: impl Iterator<Item = &'a Ratio>,
    place: impl Fn() -> String,
) -> (f64, String) {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = ratios.fold(ends, |(low, high), r| {
        (low.min(r.incident), high.max(r.incident))
    });
    ((1.0 - low).min(high - 1.0), place())
}
