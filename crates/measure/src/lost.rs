//! Speeds at which nothing was measured, though there are shots.

use crate::{Grouping, Shot};

/// A speed of a case at which no shot has a time of flight that counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Lost {
    /// The case's name; empty if nobody gave one.
    pub case: String,
    /// Programmed speed in m/s if it is known, else the first shot's own.
    pub speed_m_s: f64,
    /// Shots of this speed.
    pub shots: usize,
}

/// Where a shot belongs.
#[derive(Clone, Copy)]
pub(crate) struct At {
    programmed_m_s: Option<f64>,
    speed_m_s: f64,
}

impl At {
    pub(crate) fn of(shot: &Shot) -> Option<Self> {
        let programmed_m_s = shot.programmed_speed_m_s;
        let speed_m_s = shot.true_speed().map(|speed| speed.value);
        let speed_m_s = speed_m_s.or(programmed_m_s)?;
        Some(Self {
            programmed_m_s,
            speed_m_s: programmed_m_s.unwrap_or(speed_m_s),
        })
    }

    /// Whether both are of one speed, as shots are grouped.
    pub(crate) fn is_like(&self, other: &Self, gap_m_s: f64) -> bool {
        let gap_m_s = match (self.programmed_m_s, other.programmed_m_s) {
            (Some(_), Some(_)) => 0.0,
            (None, None) => gap_m_s,
            _ => return false,
        };
        (self.speed_m_s - other.speed_m_s).abs() <= gap_m_s
    }
}

/// The speeds of a case that are in no curve.
pub(crate) fn lost(case: &str, shots: &[Shot], grouping: &Grouping) -> Vec<Lost> {
    let counts = |shot: &Shot| {
        shot.flight.is_ok()
            && shot.true_speed().is_some()
            && (grouping.keep_dubious || !shot.is_dubious())
    };
    let of_case = shots.iter().filter(|shot| shot.case == case);
    let (counted, rest): (Vec<&Shot>, Vec<&Shot>) = of_case.partition(|shot| counts(shot));
    let counted: Vec<At> = counted.into_iter().filter_map(At::of).collect();
    let mut lost: Vec<(At, usize)> = Vec::new();
    for at in rest.into_iter().filter_map(At::of) {
        let like = |other: &At| other.is_like(&at, grouping.gap_m_s);
        match lost.iter_mut().find(|(other, _)| like(other)) {
            Some((_, shots)) => *shots += 1,
            None if counted.iter().any(like) => {}
            None => lost.push((at, 1)),
        }
    }
    lost.sort_by(|a, b| a.0.speed_m_s.total_cmp(&b.0.speed_m_s));
    let told = lost.into_iter().map(|(at, shots)| Lost {
        case: case.to_owned(),
        speed_m_s: at.speed_m_s,
        shots,
    });
    told.collect()
}
