//! What sensors showed, one row of lanes a step.

use super::block::Block;
use super::column::WIDTH;
use crate::sensor::Sensor;
use std::ops::Range;

/// Zeros before the first sample, for maxima near it.
const BEFORE: usize = 4;

/// Rows of one sensor, from the first that is not 0 in every lane.
#[derive(Clone, Debug)]
struct Rows {
    first: usize,
    values: Vec<f64>,
    /// Largest of each lane since the last look.
    crest: [f64; WIDTH],
}

/// Records sensors of all lanes.
#[derive(Clone, Debug)]
pub(super) struct Recorder {
    lanes: usize,
    sensors: Vec<Sensor>,
    rows: Vec<Rows>,
}

impl Recorder {
    /// With room for `steps` samples, so that the loop allocates nothing.
    pub fn new(sensors: &[Sensor], lanes: usize, steps: usize) -> Self {
        let rows = |_: &Sensor| Rows {
            first: 0,
            values: Vec::with_capacity((steps + 1) * lanes),
            crest: [0.0; WIDTH],
        };
        Self {
            lanes,
            rows: sensors.iter().map(rows).collect(),
            sensors: sensors.to_vec(),
        }
    }

    /// Adds what all sensors show now.
    #[inline]
    pub fn add(&mut self, block: &Block<'_>) {
        match self.lanes {
            WIDTH => self.add_row::<WIDTH>(block),
            _ => self.add_row::<1>(block),
        }
    }

    #[inline(always)]
    fn add_row<const LANES: usize>(&mut self, block: &Block<'_>) {
        for (sensor, rows) in self.sensors.iter().zip(&mut self.rows) {
            let row: [f64; LANES] = block.signals(*sensor);
            if rows.values.is_empty() {
                if row == [0.0; LANES] {
                    continue;
                }
                rows.first = block.steps;
            }
            for (crest, value) in rows.crest.iter_mut().zip(row) {
                *crest = if value > *crest { value } else { *crest };
            }
            rows.values.extend_from_slice(&row);
        }
    }

    /// Samples of a sensor, by its place in the list, in a lane.
    pub fn samples(&self, sensor: usize, lane: usize) -> Samples<'_> {
        Samples {
            rows: &self.rows[sensor],
            lanes: self.lanes,
            lane,
        }
    }

    /// Begins a new stretch between looks.
    pub fn looked(&mut self) {
        for rows in &mut self.rows {
            rows.crest = [0.0; WIDTH];
        }
    }
}

/// Samples of one sensor in one lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a> {
    rows: &'a Rows,
    lanes: usize,
    lane: usize,
}

impl<'a> Samples<'a> {
    /// The largest since the last look.
    pub fn crest(self) -> f64 {
        self.rows.crest[self.lane]
    }

    /// The latest, 0 before the first.
    pub fn latest(self) -> f64 {
        let before_end = self.lanes - self.lane;
        let at = self.rows.values.len().checked_sub(before_end);
        at.map_or(0.0, |at| self.rows.values[at])
    }

    /// Step of the first sample.
    pub fn first(self) -> usize {
        self.rows.first
    }

    /// Number of samples.
    pub fn count(self) -> usize {
        self.rows.values.len() / self.lanes
    }

    /// Sample `i` from the first.
    #[inline]
    pub fn at(self, i: usize) -> f64 {
        self.rows.values[i * self.lanes + self.lane]
    }

    /// The samples of some steps, as far as there are any.
    pub fn of(self, steps: Range<usize>) -> impl Iterator<Item = (usize, f64)> + 'a {
        let first = self.rows.first;
        let from = steps.start.max(first);
        let row = (from - first) * self.lanes + self.lane;
        let values = self.rows.values.get(row..).unwrap_or_default();
        let count = steps.end.saturating_sub(from);
        let values = values.iter().step_by(self.lanes).take(count);
        values.enumerate().map(move |(i, &value)| (from + i, value))
    }
}
