//! What sensors showed, one row of lanes a step.

use super::block::Block;
use super::column::WIDTH;
use crate::sensor::Sensor;

/// What one sensor showed, from step 1 on: groups of eight steps, lane by
/// lane, so that a lane's samples lie together.
#[derive(Clone, Debug)]
struct Rows {
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
    /// Steps recorded.
    steps: usize,
}

/// Steps of a group.
const GROUP: usize = 8;

/// Where a lane's sample of a step is.
#[inline(always)]
fn place(step: usize, lane: usize, lanes: usize) -> usize {
    let at = step - 1;
    (at / GROUP * lanes + lane) * GROUP + at % GROUP
}

impl Rows {
    #[inline(always)]
    fn put<const LANES: usize>(&mut self, step: usize, row: &[f64; LANES]) {
        if (step - 1).is_multiple_of(GROUP) {
            self.values.resize(self.values.len() + GROUP * LANES, 0.0);
        }
        for (lane, value) in row.iter().enumerate() {
            self.values[place(step, lane, LANES)] = *value;
        }
    }
}

impl Recorder {
    /// With room for `steps` samples, so that the loop allocates nothing.
    pub fn new(sensors: &[Sensor], lanes: usize, steps: usize) -> Self {
        let rows = |_: &Sensor| Rows {
            values: Vec::with_capacity((steps + 1).next_multiple_of(GROUP) * lanes),
            crest: [0.0; WIDTH],
        };
        Self {
            lanes,
            rows: sensors.iter().map(rows).collect(),
            sensors: sensors.to_vec(),
            steps: 0,
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
        self.steps += 1;
        for (sensor, rows) in self.sensors.iter().zip(&mut self.rows) {
            let row: [f64; LANES] = block.signals(*sensor);
            for (crest, value) in rows.crest.iter_mut().zip(row) {
                *crest = if value > *crest { value } else { *crest };
            }
            rows.put::<LANES>(self.steps, &row);
        }
    }

    /// Samples of a sensor, by its place in the list, in a lane.
    pub fn samples(&self, sensor: usize, lane: usize) -> Samples<'_> {
        Samples {
            rows: &self.rows[sensor],
            steps: self.steps,
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

/// Samples of one sensor in one lane, from step 1 on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a> {
    rows: &'a Rows,
    steps: usize,
    lanes: usize,
    lane: usize,
}

impl Samples<'_> {
    /// The largest since the last look.
    pub fn crest(self) -> f64 {
        self.rows.crest[self.lane]
    }

    /// The samples of steps 1 to `last`, as far as there are any.
    pub fn until(self, last: usize) -> Vec<f64> {
        let mut samples = Vec::with_capacity(self.steps.next_multiple_of(GROUP));
        let first = self.lane * GROUP;
        for group in self.rows.values.chunks_exact(GROUP * self.lanes) {
            samples.extend_from_slice(&group[first..first + GROUP]);
        }
        samples.truncate(last.min(self.steps));
        samples
    }

    /// The sample of a step from 1 to the latest.
    #[inline]
    pub fn at(self, step: usize) -> f64 {
        self.rows.values[place(step, self.lane, self.lanes)]
    }
}
