//! What a reflected pulse leaves behind.
//!
//! A strongly nonlinear pulse is faster than anything that follows it, and
//! what follows is weaker. On its way back from the wall it therefore shows
//! nothing of what is some beads behind it, and a shot that ends when it has
//! passed the sensor need not move those bodies any more. Each lane finds its
//! own crest and lets go of its own bodies, so that its bits stay its own.

use super::number::Number;
use crate::instruction_set::InstructionSet;
use crate::sensor::Sensor;
use fearless_simd::{dispatch, prelude::*};
use std::ops::Range;

/// Most contacts that a crest travels between two looks; a greater leap is
/// another pulse.
const LEAP: usize = 4;

/// Follows the crest of each lane on its way back from the wall.
#[derive(Clone, Debug)]
pub(super) struct Behind<const W: usize> {
    lanes: usize,
    contacts: usize,
    /// Contact nearest to the wall that a sensor other than the wall watches.
    watched: usize,
    /// Where each lane's crest is, at the wall until it comes back.
    crest: [usize; W],
    reached: [bool; W],
    /// First body that each lane has left behind.
    left: [usize; W],
}

impl<const W: usize> Behind<W> {
    /// For chains of as many contacts; the wall is the second sensor.
    pub(super) fn new(lanes: usize, contacts: usize, sensors: &[Sensor]) -> Self {
        let place = |sensor: &Sensor| match *sensor {
            Sensor::Bead(at)
            | Sensor::Contact(at)
            | Sensor::Position(at)
            | Sensor::Velocity(at) => at,
            Sensor::BeadPlusWall(_) => contacts,
        };
        let others = sensors.iter().enumerate().filter(|(at, _)| *at != 1);
        Self {
            lanes,
            contacts,
            watched: others.map(|(_, s)| place(s)).max().unwrap_or(contacts),
            crest: [contacts; W],
            reached: [false; W],
            left: [contacts + 1; W],
        }
    }

    /// Looks where the crests are, from the forces of all contacts, of which
    /// some chunks are awake; gives, lane by lane, the bodies that are left
    /// behind since the last look.
    pub(super) fn look<N: Number<W>>(
        &mut self,
        set: InstructionSet,
        force: &[N],
        awake: Range<usize>,
    ) -> impl Iterator<Item = (usize, Range<usize>)> + use<N, W> {
        let wall = (self.contacts - 1) * self.lanes;
        for (lane, reached) in self.reached.iter_mut().enumerate().take(self.lanes) {
            *reached |= force[wall + lane] > N::default();
        }
        let before = self.left;
        if self.reached.contains(&true) {
            let highest = dispatch!(set.level(), simd => simd.vectorize(
                #[inline(always)]
                || highest(simd, force, awake.clone())
            ));
            self.follow(highest);
        }
        let after = self.left;
        (0..self.lanes)
            .map(move |lane| (lane, after[lane]..before[lane]))
            .filter(|(_, left)| !left.is_empty())
    }

    /// Takes in the largest force of each place in a chunk, and its chunk.
    fn follow<N: Number<W>>(&mut self, (force, chunk): ([N; W], [usize; W])) {
        for lane in 0..self.lanes {
            let own = (lane..W).step_by(self.lanes);
            let largest = own.reduce(|a, b| if force[b] > force[a] { b } else { a });
            let place = largest.unwrap_or(lane);
            let at = (chunk[place] * W + place) / self.lanes;
            let crest = &mut self.crest[lane];
            if self.reached[lane] && at < *crest && at + LEAP >= *crest {
                *crest = at;
                let body = at.max(self.watched) + N::FOLLOWED + 1;
                self.left[lane] = self.left[lane].min(body);
            }
        }
    }
}

/// The largest force of each place in chunks, and the chunk that has it.
#[inline(always)]
fn highest<S: Simd, N: Number<W>, const W: usize>(
    simd: S,
    force: &[N],
    awake: Range<usize>,
) -> ([N; W], [usize; W]) {
    let wide = |value: f64| N::Wide::<S>::simd_from(simd, N::of(value));
    let (mut most, mut place) = (wide(0.0), wide(0.0));
    for (at, chunk) in force.as_chunks::<W>().0[awake.clone()].iter().enumerate() {
        let force = N::Wide::<S>::load_array_ref(simd, chunk);
        let higher = force.simd_gt(most);
        most = higher.select(force, most);
        place = higher.select(wide((awake.start + at) as f64), place);
    }
    let (mut force, mut chunk) = ([N::default(); W], [N::default(); W]);
    most.store_array(&mut force);
    place.store_array(&mut chunk);
    (force, chunk.map(|at| Into::<f64>::into(at) as usize))
}
