//! What sensors showed, one row of lanes a step.

use super::block::Block;
use super::number::Number;
use crate::instruction_set::InstructionSet;
use crate::sensor::Sensor;
use fearless_simd::{dispatch, prelude::*};

/// What one sensor showed, from step 1 on.
#[derive(Clone, Debug)]
struct SensorRows<N, const W: usize> {
    values: Vec<N>,
    /// Largest of each lane between the last two looks.
    crest: [N; W],
}

#[derive(Clone, Debug)]
pub(super) struct Recorder<N, const W: usize> {
    lanes: usize,
    sensors: Vec<Sensor>,
    rows: Vec<SensorRows<N, W>>,
}

/// Extremes of a sensor and shot for which room is made.
const EXPECTED: usize = 32;

impl<N: Number<W>, const W: usize> Recorder<N, W> {
    /// With room for `steps` samples, so that the loop allocates nothing.
    pub(super) fn new(sensors: &[Sensor], lanes: usize, steps: usize) -> Self {
        let rows = |_: &Sensor| SensorRows {
            values: Vec::with_capacity((steps + 1) * lanes),
            crest: [N::default(); W],
        };
        Self { lanes, rows: sensors.iter().map(rows).collect(), sensors: sensors.to_vec() }
    }

    pub(super) fn sensors(&self) -> usize {
        self.sensors.len()
    }

    #[inline(always)]
    pub(super) fn add(&mut self, block: &Block<'_, N, W>) {
        match self.lanes == W {
            true => self.add_row::<W>(block),
            false => self.add_row::<1>(block),
        }
    }

    #[inline(always)]
    fn add_row<const LANES: usize>(&mut self, block: &Block<'_, N, W>) {
        for (sensor, rows) in self.sensors.iter().zip(&mut self.rows) {
            let row: [N; LANES] = block.signals(*sensor);
            rows.values.extend_from_slice(&row);
        }
    }

    /// Finds what each lane's sensors have shown at most in the last steps.
    #[inline(always)]
    pub(super) fn look<S: Simd>(&mut self, simd: S, steps: usize) {
        for SensorRows { values, crest } in &mut self.rows {
            let first = values.len() - steps * self.lanes;
            let mut most = N::Wide::<S>::simd_from(simd, N::default());
            let (chunks, rest) = values[first..].as_chunks::<W>();
            for chunk in chunks {
                let now = N::Wide::<S>::load_array_ref(simd, chunk);
                most = now.simd_gt(most).select(now, most);
            }
            most.store_array(crest);
            // One lane alone has its samples in all places.
            let own = rest.iter().chain(&crest[self.lanes..]);
            crest[0] = own.fold(crest[0], |a, &b| if b > a { b } else { a });
        }
    }

    /// Samples of a sensor, by its place in the list, in a lane.
    pub(super) fn samples(&self, sensor: usize, lane: usize) -> Samples<'_, N, W> {
        Samples { rows: &self.rows[sensor], lanes: self.lanes, lane }
    }

    /// Lane by lane the steps at which a sensor's samples are above both
    /// neighbours, or below both.
    pub(super) fn extremes(&self, sensor: usize, set: InstructionSet) -> Vec<Vec<usize>> {
        let mut found = vec![Vec::with_capacity(EXPECTED); self.lanes];
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.find_extremes(simd, &self.rows[sensor].values, &mut found)
        ));
        found
    }

    #[inline(always)]
    fn find_extremes<S: Simd>(&self, simd: S, values: &[N], found: &mut [Vec<usize>]) {
        let lanes = self.lanes;
        let load = |from: usize| N::Wide::<S>::from_slice(simd, &values[from..from + W]);
        let last = values.len().saturating_sub(lanes);
        let mut at = lanes;
        while at + W <= last {
            let (before, now, after) = (load(at - lanes), load(at), load(at + lanes));
            let high = now.simd_ge(before) & now.simd_gt(after);
            let low = now.simd_le(before) & now.simd_lt(after);
            let mut extremes = (high | low).to_bitmask();
            while extremes != 0 {
                let place = at + extremes.trailing_zeros() as usize;
                found[place % lanes].push(place / lanes + 1);
                extremes &= extremes - 1;
            }
            at += W;
        }
        for at in at..last {
            let (before, now, after) = (values[at - lanes], values[at], values[at + lanes]);
            if (now >= before && now > after) || (now <= before && now < after) {
                found[at % lanes].push(at / lanes + 1);
            }
        }
    }
}

/// Samples of one sensor in one lane, from step 1 on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples<'a, N, const W: usize> {
    rows: &'a SensorRows<N, W>,
    lanes: usize,
    lane: usize,
}

impl<'a, N: Number<W>, const W: usize> Samples<'a, N, W> {
    pub(super) fn crest(self) -> f64 {
        self.rows.crest[self.lane].into()
    }

    /// The samples from a step, 1 or later, to the latest.
    #[inline]
    pub(super) fn since(self, step: usize) -> impl Iterator<Item = f64> + use<'a, N, W> {
        let first = (step - 1) * self.lanes + self.lane;
        let values = self.rows.values.get(first..).unwrap_or_default();
        values.iter().step_by(self.lanes).map(|&value| value.into())
    }

    /// The sample of a step from 1 to the latest.
    #[inline]
    pub(super) fn at(self, step: usize) -> f64 {
        self.rows.values[(step - 1) * self.lanes + self.lane].into()
    }
}
