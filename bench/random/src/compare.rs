//! What a run said beside the reference.

use crate::motion::Maximum;
use crate::program::{Answer, Peaks};
use crate::reference::{Reference, largest, nearest};

/// The reflected pulse is looked for until tw + this (tw − tn): docs/conventions.md.
const RETURN_WITHIN: f64 = 3.0;
/// Heights of maxima are this many times as wrong as times.
const OF_HEIGHTS: f64 = 50.0;
/// Maxima of which the program's list must have all, and shares of the largest between which
/// either is right.
const LISTED: [f64; 2] = [0.06, 0.04];
/// Times of flight that differ by more have been taken from other maxima.
const OTHER: f64 = 1e-2;
/// Times of a listed maximum may differ by this share of the time of flight.
const NEAR: f64 = 1e-3;

/// What was found wrong with a run, if anything.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Larger error than asked, or than the accuracy reached that was stated: the larger excess.
    Inaccurate { error: f64, over: f64 },
    /// A peak that the reference does not have.
    NoSuchMaximum(&'static str),
    /// A larger maximum in the time in which the peak is looked for, by this share.
    LargerMaximum(&'static str, f64),
    /// A pulse reported absent that is there.
    Missed(String),
    /// A maximum that is not listed, or a listed one that is none: its time, and its share of the
    /// largest.
    List(&'static str, f64, f64),
    /// Sensitive chains, of which the reference itself is not right enough.
    Unresolved,
}

impl Finding {
    /// A word for the table.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Inaccurate { .. } => "inaccurate",
            Self::NoSuchMaximum(_) => "no such maximum",
            Self::LargerMaximum(..) => "larger maximum",
            Self::Missed(_) => "missed pulse",
            Self::List(..) => "list of maxima",
            Self::Unresolved => "unresolved",
        }
    }
}

/// Relative error of the times of flight, and what was found.
pub struct Verdict {
    pub error: Option<f64>,
    pub finding: Option<Finding>,
}

/// Until when the reflected pulse is looked for, in s.
pub fn search_ends_s(peaks: &Peaks) -> f64 {
    peaks.wall.time_s + RETURN_WITHIN * (peaks.wall.time_s - peaks.incident.time_s)
}

/// Compares a run with the reference.
pub fn compare(answer: &Answer, reference: &Reference) -> Verdict {
    let none = |finding| Verdict {
        error: None,
        finding,
    };
    let peaks = match &answer.peaks {
        Ok(peaks) => peaks,
        Err(reason) => return none(missed(answer, reason, reference)),
    };
    let [Some(incident), Some(wall)] = [(0, peaks.incident), (1, peaks.wall)]
        .map(|(signal, peak)| nearest(&reference.maxima[signal], peak.time_s))
    else {
        return none(Some(Finding::NoSuchMaximum("wall")));
    };
    let back = peaks
        .reflected
        .and_then(|peak| nearest(&reference.maxima[0], peak.time_s));
    let flights = [
        Some(flight(
            (peaks.incident, peaks.wall),
            (incident, wall),
            reference,
            0,
        )),
        peaks
            .reflected
            .zip(back)
            .map(|(peak, back)| flight((peaks.wall, peak), (wall, back), reference, 1)),
    ];
    let (mut error, mut unsure) = (0.0_f64, 0.0_f64);
    for (at, (off, uncertain)) in flights
        .into_iter()
        .enumerate()
        .filter_map(|(i, f)| Some((i, f?)))
    {
        if off > OTHER {
            let which = ["incident", "reflected"][at];
            return none(Some(Finding::NoSuchMaximum(which)));
        }
        error = error.max(off - 3.0 * uncertain);
        unsure = unsure.max(uncertain);
    }
    let matched = Peaks {
        incident,
        wall,
        reflected: back,
    };
    let finding = larger(answer, &matched, reference)
        .or_else(|| inaccurate(answer, error))
        .or_else(|| lists(answer, &matched, reference))
        .or_else(|| (unsure > answer.asked).then_some(Finding::Unresolved));
    Verdict {
        error: Some(error),
        finding,
    }
}

/// Relative error of a time of flight and uncertainty of the reference's.
fn flight(
    told: (Maximum, Maximum),
    right: (Maximum, Maximum),
    reference: &Reference,
    first_signal: usize,
) -> (f64, f64) {
    let right_s = right.1.time_s - right.0.time_s;
    let told_s = told.1.time_s - told.0.time_s;
    let unsure_s =
        reference.error_s(first_signal, &right.0) + reference.error_s(1 - first_signal, &right.1);
    (
        (told_s - right_s).abs() / right_s.abs(),
        unsure_s / right_s.abs(),
    )
}

fn inaccurate(answer: &Answer, error: f64) -> Option<Finding> {
    let stated = answer.reached.unwrap_or(answer.asked);
    let over = error / stated;
    (over > 1.0).then_some(Finding::Inaccurate { error, over })
}

/// A pulse that the program says is absent.
fn missed(answer: &Answer, reason: &str, reference: &Reference) -> Option<Finding> {
    let until_s = answer.duration_s.min(reference.until_s);
    let wall = largest(&reference.maxima[1], |maximum| maximum.time_s < until_s)?;
    let incident = largest(&reference.maxima[0], |maximum| maximum.time_s < wall.time_s)?;
    (incident.time_s < wall.time_s).then(|| Finding::Missed(reason.to_owned()))
}

/// A maximum above the picked one where that should be the largest.
fn larger(answer: &Answer, peaks: &Peaks, reference: &Reference) -> Option<Finding> {
    let ends_s = search_ends_s(peaks).min(reference.until_s);
    let wall_s = peaks.wall.time_s;
    let [sensor, wall] = &reference.maxima;
    let above = |name, picked: Option<Maximum>, found: Option<Maximum>| {
        let (picked, found) = (picked.map_or(0.0, |p| p.height_n), found?.height_n);
        let margin = OF_HEIGHTS * answer.asked.max(answer.reached.unwrap_or(0.0));
        let excess = found / picked.max(f64::MIN_POSITIVE) - 1.0;
        (excess > margin).then_some(Finding::LargerMaximum(name, excess))
    };
    let incident = largest(sensor, |maximum| maximum.time_s < wall_s);
    let hits = largest(wall, |maximum| maximum.time_s <= ends_s);
    let back = largest(sensor, |maximum| {
        maximum.time_s > wall_s && maximum.time_s < 0.999 * ends_s
    });
    above("wall", Some(peaks.wall), hits)
        .or_else(|| above("incident", Some(peaks.incident), incident))
        .or_else(|| match (peaks.reflected, back) {
            (None, Some(back)) if back.height_n > 1e-3 * peaks.incident.height_n => {
                Some(Finding::Missed("no reflected pulse".into()))
            }
            (picked @ Some(_), back) => above("reflected", picked, back),
            _ => None,
        })
}

/// Maxima that one has and the other has not, within the time that both cover.
fn lists(answer: &Answer, peaks: &Peaks, reference: &Reference) -> Option<Finding> {
    let until_s = 0.99 * answer.duration_s.min(reference.until_s);
    let near_s = NEAR * (peaks.wall.time_s - peaks.incident.time_s);
    let said = [
        (
            ["sensor, not listed", "sensor, none"],
            &answer.sensor_maxima,
        ),
        (["wall, not listed", "wall, none"], &answer.wall_maxima),
    ];
    said.into_iter()
        .zip(reference.prominent.iter().zip(&reference.maxima))
        .find_map(|((names, said), (prominent, right))| {
            let most = largest(said, |_| true)?.height_n;
            let lacks = |what, list: &[Maximum], share: f64, others: &[Maximum]| {
                let strange = list.iter().find(|maximum| {
                    let near = nearest(others, maximum.time_s);
                    maximum.time_s < until_s
                        && maximum.height_n > share * most
                        && near.is_none_or(|near| (near.time_s - maximum.time_s).abs() > near_s)
                });
                strange.map(|maximum| Finding::List(what, maximum.time_s, maximum.height_n / most))
            };
            lacks(names[0], prominent, LISTED[0], said)
                .or_else(|| lacks(names[1], said, LISTED[1], right))
        })
}
