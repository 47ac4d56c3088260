//! Predicates on wet over dry incident ToFs, and on where they pass 1.

use super::missing;
use crate::claims::evidence::TofRatio;
use crate::claims::finding::{ClaimFinding, ClaimVerdict, Comparisons, Distance};
use crate::claims::{Claim, Evidence};

/// Every ratio at the claim's speeds lies on this side of the threshold.
pub(super) fn side(claim: &Claim, evidence: &Evidence, sign: f64) -> ClaimFinding {
    each_case(claim, evidence, |comparisons, case, ratios| {
        let inside = |r: &&TofRatio| (claim.from_m_s..=claim.to_m_s).contains(&r.speed_m_s);
        for r in ratios.iter().filter(inside) {
            let margin = sign * (r.incident - claim.threshold);
            let place = || format!("{case} at {} m/s", r.speed_m_s);
            comparisons.add(margin, r.incident, r.accuracy(), place);
        }
    })
}

/// Compares the ratios of every case of a claim.
fn each_case(
    claim: &Claim,
    evidence: &Evidence,
    mut compare: impl FnMut(&mut Comparisons, &str, &[TofRatio]),
) -> ClaimFinding {
    let mut comparisons = Comparisons::default();
    for case in &claim.cases {
        let ratios = evidence.ratios(case);
        if ratios.is_empty() {
            return missing();
        }
        compare(&mut comparisons, case, &ratios);
    }
    comparisons.finding()
}

/// In every case the ratio rises over more than the threshold's share of the range along an axis of
/// speeds. A share without turns is exact as long as no step between neighbouring speeds could be
/// one of the other sign.
pub(super) fn mainly_rises(
    claim: &Claim,
    evidence: &Evidence,
    axis: fn(f64) -> f64,
) -> ClaimFinding {
    let mut steps: Vec<Distance> = Vec::new();
    let finding = each_case(claim, evidence, |comparisons, case, ratios| {
        let place = |r: &TofRatio| axis(r.speed_m_s);
        let all = ratios.last().map_or(0.0, place) - ratios.first().map_or(0.0, place);
        steps.extend(ratios.windows(2).map(|pair| Distance {
            margin: (pair[1].incident - pair[0].incident).abs(),
            accuracy: step_accuracy(&pair[0], &pair[1]),
        }));
        let placed = |r| Placed { at: place(r), ratio: r.incident, unsure: r.accuracy() };
        let (rising, accuracy) = rising(&ratios.iter().map(placed).collect::<Vec<_>>());
        let (value, accuracy) = (rising / all, accuracy / all);
        comparisons.add(value - claim.threshold, value, accuracy, || case.to_owned());
    });
    let in_accuracies = |step: &Distance| step.margin / step.accuracy;
    let nearest = |a: &Distance, b: &Distance| in_accuracies(a).total_cmp(&in_accuracies(b));
    ClaimFinding { nearest_change: steps.into_iter().min_by(nearest), ..finding }
}

/// A ratio at its place along an axis, with its absolute accuracy.
#[derive(Clone, Copy)]
struct Placed {
    at: f64,
    ratio: f64,
    unsure: f64,
}

/// Over how much of an axis a ratio rises, and how sure that is. Between a rise and a fall the
/// ratio turns at the vertex of the parabola through three speeds; the parabola through every other
/// speed, four times as wrong, shows how sure that is, and near the ends a quarter of the wider
/// interval; what the accuracies of the three ratios move the vertex by is added. Steps within the
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

/// Where the parabola through three ratios turns, from the middle one, if it does.
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
            Placed { ratio: three[j].ratio + off, ..*three[j] }
        });
        let anywhere = after.at - before.at;
        turn(&before, &at, &after).map_or(anywhere, |turn| (turn - at_exact).abs())
    };
    (0..3).map(moved).sum()
}

fn step_accuracy(low: &TofRatio, high: &TofRatio) -> f64 {
    low.accuracy() + high.accuracy()
}

/// In every case the ratio rises from lowest to highest speed by more than the threshold.
pub(super) fn ends_higher(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_case(claim, evidence, |comparisons, case, ratios| {
        if let (Some(first), Some(last)) = (ratios.first(), ratios.last()) {
            let value = last.incident - first.incident;
            let accuracy = step_accuracy(first, last);
            comparisons.add(value - claim.threshold, value, accuracy, || {
                format!("{case} from {} to {} m/s", first.speed_m_s, last.speed_m_s)
            });
        }
    })
}

/// In every case the ratio falls somewhere from a maximum by more than the threshold.
pub(super) fn has_dips(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_case(claim, evidence, |comparisons, case, ratios| {
        let accuracy = ratios.iter().map(|r| r.accuracy()).fold(0.0, f64::max);
        // Negative where the ratio rises throughout: the smallest rise.
        let (mut highest, mut fall, mut at) = (f64::NAN, f64::NEG_INFINITY, f64::NAN);
        for r in ratios {
            if highest - r.incident > fall {
                (fall, at) = (highest - r.incident, r.speed_m_s);
            }
            highest = r.incident.max(highest);
        }
        let place = || format!("{case} at {at} m/s");
        comparisons.add(fall - claim.threshold, fall, 2.0 * accuracy, place);
    })
}

/// How far ratios reach to both sides of 1: of two oils at the speed where that
/// is most, and of the oil with most of it over its speeds. The number is the smaller
/// of the two; negative where all lie on one side.
pub(super) fn either_way(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let oils: Vec<Vec<TofRatio>> = claim.cases.iter().map(|c| evidence.ratios(c)).collect();
    let Some(first) = oils.first().filter(|_| oils.iter().all(|o| !o.is_empty())) else {
        return missing();
    };
    let at_speed = |r: &TofRatio| {
        let same = |other: &&TofRatio| other.speed_m_s == r.speed_m_s;
        let row = oils.iter().filter_map(|oil| oil.iter().find(same));
        both_sides(row, || format!("between oils at {} m/s", r.speed_m_s))
    };
    let of_oil = |(case, oil): (&String, &Vec<TofRatio>)| {
        both_sides(oil.iter(), || format!("between speeds with {case}"))
    };
    let farther = |a: &(f64, String), b: &(f64, String)| a.0.total_cmp(&b.0);
    let most = [
        first.iter().map(at_speed).max_by(farther),
        claim.cases.iter().zip(&oils).map(of_oil).max_by(farther),
    ];
    let unsure = oils.iter().flatten();
    let unsure = unsure.map(|r| r.accuracy());
    let accuracy = unsure.fold(0.0, f64::max);
    let mut comparisons = Comparisons::default();
    for (value, place) in most.into_iter().flatten() {
        comparisons.add(value - claim.threshold, value, accuracy, || place);
    }
    comparisons.finding()
}

/// The smaller of the distances that ratios reach below and above 1.
fn both_sides<'a>(
    ratios: impl Iterator<Item = &'a TofRatio>,
    place: impl Fn() -> String,
) -> (f64, String) {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) =
        ratios.fold(ends, |(low, high), r| (low.min(r.incident), high.max(r.incident)));
    ((1.0 - low).min(high - 1.0), place())
}

/// Speed at which a ratio passes 1, and its accuracy: linear in ln v between the two speeds around
/// it. Δv/v is the error of the ratios over their slope in ln v, and what the chord may leave out.
fn crossing(low: &TofRatio, high: &TofRatio) -> (f64, f64) {
    let (before, after) = (low.incident - 1.0, high.incident - 1.0);
    let span = (high.speed_m_s / low.speed_m_s).ln();
    let part = before / (before - after);
    let speed = low.speed_m_s * (part * span).exp();
    let slope = (after - before) / span;
    let from_tofs = low.accuracy().max(high.accuracy()) / slope.abs();
    // A smooth curve leaves its chord by at most an eighth of the change of
    // slope over the interval; slopes here change by less than themselves.
    let from_chord = part * (1.0 - part) * span;
    (speed, speed * (from_tofs + 0.5 * from_chord))
}

type Crossings = Vec<(f64, f64)>;

/// All crossings of 1, the upward ones first.
fn crossings(ratios: &[TofRatio]) -> (Crossings, Crossings) {
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

/// Counts of passages: the sum is 1 for one upward passage alone.
const UPWARD: f64 = 1.0;
const DOWNWARD: f64 = -2.0;

/// Whether a ratio is 1 within its accuracy.
fn is_open(ratio: &TofRatio) -> bool {
    (ratio.incident - 1.0).abs() <= ratio.accuracy()
}

/// The smallest or largest count when every ratio that is 1 within its accuracy may lie below or
/// above it: of all ways to end below and above 1, the best is carried from ratio to ratio.
fn extreme_count(ratios: &[TofRatio], pick: fn(f64, f64) -> f64) -> f64 {
    // What is impossible is not a number, which `pick` passes over.
    let possible = |r: &TofRatio, below: bool| match is_open(r) || (r.incident < 1.0) == below {
        true => 0.0,
        false => f64::NAN,
    };
    let sides = |r: &TofRatio| (possible(r, true), possible(r, false));
    let mut all = ratios.iter().map(sides);
    let first = all.next().unwrap_or_default();
    let (below, above) = all.fold(first, |(was_below, was_above), (below, above)| {
        (below + pick(was_below, was_above + DOWNWARD), above + pick(was_above, was_below + UPWARD))
    });
    pick(below, above)
}

/// The ratio passes 1 once, upward. The number is that of upward passages less twice that of
/// downward ones, which is 1 in no other case; not decidable where ratios that are 1 within their
/// accuracy could change it. A passage is one between neighbouring speeds.
pub(super) fn crosses_once_upward(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let ratios = claim.cases.first().map_or(Vec::new(), |case| evidence.ratios(case));
    let by_accuracy = |r: &&TofRatio| (r.incident - 1.0).abs() / r.accuracy();
    let nearest = ratios.iter().min_by(|a, b| by_accuracy(a).total_cmp(&by_accuracy(b)));
    let (Some(nearest), Some(expected)) = (nearest, claim.expected.first()) else {
        return missing();
    };
    let (up, down) = crossings(&ratios);
    let value = up.len() as f64 * UPWARD + down.len() as f64 * DOWNWARD;
    // 0 when no ratio is so near to 1 that its side matters.
    let (least, most) = (extreme_count(&ratios, f64::min), extreme_count(&ratios, f64::max));
    let accuracy = (value - least).max(most - value);
    let margin = claim.threshold - (value - expected).abs();
    let end = |r: Option<&TofRatio>| {
        r.map_or(String::new(), |r| format!("{:.5} at {} m/s", r.incident, r.speed_m_s))
    };
    let detail = format!(
        "{} upward and {} downward; from {} to {}; the ratio nearest to 1 is off by {:.1e} ± {:.0e}, at {} m/s",
        up.len(),
        down.len(),
        end(ratios.first()),
        end(ratios.last()),
        (nearest.incident - 1.0).abs(),
        nearest.accuracy(),
        nearest.speed_m_s
    );
    ClaimFinding {
        expected: Some(*expected),
        nearest_change: Some(Distance {
            margin: (nearest.incident - 1.0).abs(),
            accuracy: nearest.accuracy(),
        }),
        ..ClaimFinding::of_one(margin, value, accuracy, detail)
    }
}

/// The upward passage of 1 nearest to the printed speed lies within the threshold of it.
pub(super) fn crosses_at_speed(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let ratios = claim.cases.first().map_or(Vec::new(), |case| evidence.ratios(case));
    let (false, Some(expected)) = (ratios.is_empty(), claim.expected.first()) else {
        return missing();
    };
    let (up, _) = crossings(&ratios);
    let off = |speed: f64| (speed - expected).abs();
    let nearest = up.iter().min_by(|a, b| off(a.0).total_cmp(&off(b.0)));
    let Some(&(value, accuracy)) = nearest else {
        // A ratio of 1 within its accuracy may hide a passage.
        let verdict = match ratios.iter().any(is_open) {
            true => ClaimVerdict::NotDecidable,
            false => ClaimVerdict::Fails,
        };
        return ClaimFinding {
            verdict,
            leaning: ClaimVerdict::Fails,
            expected: Some(*expected),
            ..ClaimFinding::without_numbers("no upward passage of 1")
        };
    };
    let detail = format!("the nearest of {} upward passages", up.len());
    ClaimFinding {
        expected: Some(*expected),
        ..ClaimFinding::of_one(claim.threshold - off(value), value, accuracy, detail)
    }
}
