//! The shots of a batch as a table.

use crate::batch::BatchShot;
use crate::shot::Shot;
use hertzchain_measure::signal::{FitError, PowerLaw, Uncertainty, power_law, uncertainty};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

/// Columns of a sweep's table; the ends of their names are the units.
pub const COLUMNS: [&str; 12] = [
    "speed_m_s",
    "tof_incident_s",
    "tof_reflected_s",
    "sensor_peak_n",
    "wall_peak_n",
    "returning_peak_n",
    "striker_rebound_m_s",
    "accuracy_reached",
    "competing_time_s",
    "competing_peak_n",
    "competing_reflected_time_s",
    "competing_reflected_peak_n",
];

/// One of [`COLUMNS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Speed of the striker.
    Speed,
    /// Incident time of flight.
    Incident,
    /// Reflected time of flight.
    Reflected,
    /// The incident pulse's peak, or the sensor's largest where none is seen to pass.
    SensorPeak,
    /// The wall's peak.
    WallPeak,
    /// The reflected pulse's peak.
    ReturningPeak,
    /// The striker's velocity at the end.
    Rebound,
    /// The relative accuracy reached.
    Accuracy,
    /// When the highest maximum is that could be the arrival instead.
    CompetingTime,
    /// Its height.
    CompetingPeak,
    /// When the highest maximum is that could be the reflected pulse's peak instead.
    CompetingReflectedTime,
    /// Its height.
    CompetingReflectedPeak,
}

/// A shot that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failed {
    /// Its place in the sweep, from 0.
    pub place: usize,
    /// Why.
    pub why: String,
}

/// Warnings about the chains of a batch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WarningSummary {
    /// The first shot with warnings, its place in the batch from 0.
    pub place: usize,
    /// Its warnings, a line each.
    pub lines: Vec<String>,
    /// Number of shots with warnings.
    pub shots: usize,
}

/// A power law, and what accuracies alone leave open of it.
pub(crate) type Law = (Result<PowerLaw, FitError>, Result<Uncertainty, FitError>);

/// The shots of a sweep, a row each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// One each of [`COLUMNS`]; NaN where a shot has no such number.
    pub columns: [Vec<f64>; COLUMNS.len()],
    /// Shots that failed, in the order of their places: their rows have a speed only.
    pub failed: Vec<Failed>,
    /// Warnings, if there are any.
    pub warnings: Option<WarningSummary>,
}

impl Rows {
    /// Adds a shot.
    pub(crate) fn add(&mut self, shot: &BatchShot) {
        let BatchShot { place, speed_m_s, .. } = *shot;
        if !shot.warnings.is_empty() {
            let first = || WarningSummary { place, lines: shot.warnings.clone(), shots: 0 };
            self.warnings.get_or_insert_with(first).shots += 1;
        }
        let cells = match &shot.shot {
            Ok(shot) => cells(speed_m_s, shot),
            Err(why) => {
                let why = why.to_string();
                self.failed.push(Failed { place, why });
                let mut none = [None; COLUMNS.len()];
                none[Column::Speed as usize] = Some(speed_m_s);
                none
            }
        };
        for (column, cell) in self.columns.iter_mut().zip(cells) {
            column.push(cell.unwrap_or(f64::NAN));
        }
    }

    /// How many shots.
    pub fn len(&self) -> usize {
        self.columns[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A column.
    pub fn column(&self, of: Column) -> &[f64] {
        &self.columns[of as usize]
    }

    /// Rows of parts that were dealt out like cards, the first part's first, put
    /// together again.
    pub fn dealt(parts: &[Self]) -> Self {
        let count = parts.iter().map(Self::len).sum();
        let of = parts.len().max(1);
        let mut whole = Self::default();
        for (at, column) in whole.columns.iter_mut().enumerate() {
            let cell = |place: usize| parts.get(place % of)?.columns[at].get(place / of);
            column.extend((0..count).filter_map(cell));
        }
        whole.failed = parts.iter().flat_map(|part| part.failed.clone()).collect();
        whole.failed.sort_by_key(|failed| failed.place);
        let warnings = parts.iter().filter_map(|part| part.warnings.as_ref());
        let shots = warnings.clone().map(|of| of.shots).sum();
        let first = warnings.min_by_key(|of| of.place).cloned();
        whole.warnings = first.map(|first| WarningSummary { shots, ..first });
        whole
    }

    /// Speeds and times of flight, incident and reflected where seen, in s.
    pub fn flights(&self) -> Vec<(f64, f64, Option<f64>)> {
        let [speed, incident, reflected] =
            [Column::Speed, Column::Incident, Column::Reflected].map(|of| self.column(of));
        let rows = speed.iter().zip(incident).zip(reflected);
        rows.filter(|((_, incident), _)| !incident.is_nan())
            .map(|((speed, incident), back)| {
                (*speed, *incident, Some(*back).filter(|b| !b.is_nan()))
            })
            .collect()
    }

    /// The power law of a time of flight, and what accuracies leave open of it:
    /// those reached, where known, else the one asked.
    pub fn law(&self, of: Column, asked: f64) -> Law {
        let times = self.column(of).iter();
        let rows = times.zip(self.column(Column::Speed)).zip(self.column(Column::Accuracy));
        let seen = rows.filter(|((time_s, _), _)| !time_s.is_nan());
        let mut seen_at: [Vec<f64>; 3] = Default::default();
        let mut known = HashSet::new();
        for ((time_s, speed_m_s), reached) in seen {
            // The same shot again says nothing more.
            if !known.insert(speed_m_s.to_bits()) {
                continue;
            }
            let accuracy = if reached.is_nan() { asked } else { *reached };
            let row = [*speed_m_s, *time_s, accuracy];
            seen_at.iter_mut().zip(row).for_each(|(column, cell)| column.push(cell));
        }
        let [speeds, times, accuracies] = seen_at;
        (power_law(&speeds, &times, None), uncertainty(&speeds, &accuracies))
    }
}

fn cells(speed_m_s: f64, shot: &Shot) -> [Option<f64>; COLUMNS.len()] {
    let seen = shot.passage.as_ref().ok();
    let (competing, reflected) = (shot.competing_arrival(), shot.competing_reflected());
    [
        Some(speed_m_s),
        shot.flight.map(|flight| flight.incident_s),
        shot.flight.and_then(|flight| flight.reflected_s),
        sensor_peak(shot),
        shot.wall().map(|wall| wall.value),
        seen.and_then(|seen| Some(seen.reflected?.value)),
        shot.rebound.and_then(|rebound| rebound.end_m_s),
        shot.accuracy_reached,
        competing.map(|maximum| maximum.time_s),
        competing.map(|maximum| maximum.value),
        reflected.map(|maximum| maximum.time_s),
        reflected.map(|maximum| maximum.value),
    ]
}

/// The incident pulse's, or the largest where none is seen to pass.
fn sensor_peak(shot: &Shot) -> Option<f64> {
    let largest = || {
        let maxima = shot.sensor_maxima.iter();
        maxima.map(|peak| peak.value).reduce(f64::max)
    };
    let passage = shot.passage.as_ref().ok();
    passage.map(|seen| seen.incident.value).or_else(largest)
}
