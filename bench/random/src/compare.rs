//! What a run said beside the reference.

use crate::arrival::{Arrival, Margin, PULSES, Signals, largest};
use crate::motion::Maximum;
use crate::program::Answer;
use crate::reference::{Reference, nearest};

/// Heights of maxima are this many times as wrong as times of flight, and times of late ones.
const OF_HEIGHTS: f64 = 50.0;
const OF_TIMES: f64 = 10.0;
/// Maxima of which the program's list must have all, and shares of the largest between which
/// either is right.
const LISTED: [f64; 2] = [0.06, 0.04];
/// Lists are compared until this many times the time of the wall's peak: later maxima depend on
/// everything before, and some rows are chaotic.
const LISTED_UNTIL: f64 = 2.0;
/// Times of flight that differ by more have been taken from other maxima.
const OTHER: f64 = 1e-2;
/// Times of a listed maximum may differ by this share of its time, where the accuracy is better.
const NEAR: f64 = 1e-3;
/// Or by that share of this share of the time of the wall's peak.
const EARLY: f64 = 0.1;

/// What was found wrong with a run, if anything.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Finding {
    /// Larger error than asked, or than the accuracy reached that was stated: the larger excess.
    Inaccurate { error: f64, over: f64 },
    /// A peak that the reference does not have.
    NoSuchMaximum(&'static str),
    /// A peak that is not the one of the definition: which, and the time of that one.
    OtherMaximum(&'static str, Option<f64>),
    /// A pulse reported absent that is there.
    Missed(String),
    /// A competing maximum that is not reported, or one reported that is none: which, its time,
    /// and its height over the least of such a maximum.
    Competing(&'static str, &'static str, f64, f64),
    /// A maximum that is not listed, or a listed one that is none: its time, and its share of the
    /// largest.
    List(&'static str, f64, f64),
    /// Sensitive chains, of which the reference itself is not right enough.
    Unresolved,
}

impl Finding {
    /// A word for the table.
    pub(crate) fn word(&self) -> &'static str {
        match self {
            Self::Inaccurate { .. } => "inaccurate",
            Self::NoSuchMaximum(_) => "no such maximum",
            Self::OtherMaximum(..) => "other maximum",
            Self::Missed(_) => "missed pulse",
            Self::Competing(..) => "competing maxima",
            Self::List(..) => "list of maxima",
            Self::Unresolved => "unresolved",
        }
    }
}

/// Relative error of the times of flight, and what was found.
pub(crate) struct Verdict {
    pub error: Option<f64>,
    pub finding: Option<Finding>,
}

/// Compares a run with the reference.
pub(crate) fn compare(answer: &Answer, reference: &Reference) -> Verdict {
    let none = |finding| Verdict { error: None, finding };
    let signals = reference.signals();
    let margin = margin(answer);
    let picked = match &answer.peaks {
        Ok(peaks) => peaks,
        Err(reason) => return none(missed(answer, reason, &signals)),
    };
    let near = |maxima, peak: Option<Maximum>| nearest(maxima, peak?.time_s);
    let Some(wall) = near(signals.wall, Some(picked.wall)) else {
        return none(Some(Finding::NoSuchMaximum("wall")));
    };
    let matched = Arrival {
        incident: near(signals.sensor, picked.incident),
        wall,
        reflected: near(signals.sensor, picked.reflected),
    };
    if let Some((pulse, right)) = signals.refutes(&matched, margin) {
        let right_s = right.map(|right| right.time_s);
        return none(Some(Finding::OtherMaximum(PULSES[pulse], right_s)));
    }
    let errors = match errors(picked, &matched, reference) {
        Ok(errors) => errors,
        Err(pulse) => return none(Some(Finding::NoSuchMaximum(pulse))),
    };
    let worst = |at: usize| errors.iter().map(|it| it[at]).fold(0.0, f64::max);
    let (error, unsure) = (worst(0), worst(1));
    let finding = inaccurate(answer, error)
        .or_else(|| competing(answer, &matched, reference, margin))
        .or_else(|| lists(answer, reference, margin))
        .or_else(|| (unsure > answer.asked).then_some(Finding::Unresolved));
    Verdict { error: Some(error), finding }
}

fn margin(answer: &Answer) -> Margin {
    let accuracy = answer.asked.max(answer.reached.unwrap_or(0.0)).max(1e-9);
    Margin { height: OF_HEIGHTS * accuracy, time: OF_TIMES * accuracy }
}

/// Of each time of flight the relative error beyond what the reference is unsure of, and that.
fn errors(
    picked: &Arrival,
    right: &Arrival,
    reference: &Reference,
) -> Result<Vec<[f64; 2]>, &'static str> {
    let flights = [(0, picked.incident, right.incident), (2, picked.reflected, right.reflected)];
    let seen =
        flights.into_iter().filter_map(|(pulse, picked, right)| Some((pulse, picked?, right?)));
    let error = |(pulse, at_sensor, right_there): (usize, Maximum, Maximum)| {
        let right_s = right_there.time_s - right.wall.time_s;
        let off_s = at_sensor.time_s - picked.wall.time_s - right_s;
        let unsure_s = reference.error_s(0, &right_there) + reference.error_s(1, &right.wall);
        let [off, unsure] = [off_s, unsure_s].map(|time_s| (time_s / right_s).abs());
        match off > OTHER {
            true => Err(PULSES[pulse]),
            false => Ok([off - 3.0 * unsure, unsure]),
        }
    };
    seen.map(error).collect()
}

fn inaccurate(answer: &Answer, error: f64) -> Option<Finding> {
    let stated = answer.reached.unwrap_or(answer.asked);
    let over = error / stated;
    (over > 1.0).then_some(Finding::Inaccurate { error, over })
}

/// A pulse that the program says is absent.
fn missed(answer: &Answer, reason: &str, signals: &Signals<'_>) -> Option<Finding> {
    let arrival = signals.arrival()?;
    let was_searched = arrival.search_ends_s() < answer.duration_s;
    was_searched.then(|| Finding::Missed(reason.to_owned()))
}

/// Whether one of some maxima is there at a time, within a margin of it or of a least time.
fn has(maxima: &[Maximum], time_s: f64, (margin, least_s): (Margin, f64)) -> bool {
    let near_s = NEAR.max(margin.time) * time_s.max(least_s);
    nearest(maxima, time_s).is_some_and(|near| (near.time_s - time_s).abs() <= near_s)
}

/// Competing maxima that one has and the other has not.
fn competing(
    answer: &Answer,
    right: &Arrival,
    reference: &Reference,
    margin: Margin,
) -> Option<Finding> {
    let signals = reference.signals();
    // Without an incident peak there is no time of flight to compete with.
    right.incident?;
    // Later ones depend on everything before: some rows are chaotic.
    let until_s = (LISTED_UNTIL * right.wall.time_s).min(0.99 * answer.duration_s);
    let near = (margin, EARLY * right.wall.time_s);
    (0..PULSES.len()).find_map(|pulse| {
        let said = &answer.competing[pulse];
        let expected = signals.competing(right, pulse);
        let prominent = &reference.prominent()[usize::from(pulse == 1)];
        let missing = expected.iter().find(|(maximum, over)| {
            *over > 1.0 + margin.height
                && maximum.time_s < until_s
                && prominent.contains(maximum)
                && !has(said, maximum.time_s, near)
        });
        if let Some((maximum, over)) = missing {
            return Some(Finding::Competing(PULSES[pulse], "not reported", maximum.time_s, *over));
        }
        let could: Vec<Maximum> = expected
            .iter()
            .filter(|(_, over)| *over > 1.0 - margin.height)
            .map(|(maximum, _)| *maximum)
            .collect();
        let is_none = |it: &&Maximum| it.time_s < until_s && !has(&could, it.time_s, near);
        let strange = said.iter().find(is_none)?;
        Some(Finding::Competing(PULSES[pulse], "is none", strange.time_s, strange.height_n))
    })
}

/// Maxima that one has and the other has not, within the time that both cover.
fn lists(answer: &Answer, reference: &Reference, margin: Margin) -> Option<Finding> {
    let names = [["sensor, not listed", "sensor, none"], ["wall, not listed", "wall, none"]];
    let signals = reference.signals();
    let right = [signals.sensor, signals.wall];
    let wall_s = answer.peaks.as_ref().map_or(0.0, |it| it.wall.time_s);
    let until_s = (LISTED_UNTIL * wall_s).min(0.99 * answer.duration_s);
    let near = (margin, EARLY * wall_s);
    [0, 1].into_iter().find_map(|at| {
        let (said, prominent) = (&answer.maxima[at], &reference.prominent()[at]);
        let most = largest(said, |_| true)?.height_n;
        let lacks = |what, list: &[Maximum], share: f64, others: &[Maximum]| {
            let strange = list.iter().find(|maximum| {
                maximum.time_s < until_s
                    && maximum.height_n > share * most
                    && !has(others, maximum.time_s, near)
            });
            strange.map(|maximum| Finding::List(what, maximum.time_s, maximum.height_n / most))
        };
        lacks(names[at][0], prominent, LISTED[0], said)
            .or_else(|| lacks(names[at][1], said, LISTED[1], right[at]))
    })
}
