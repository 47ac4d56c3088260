//! Sums of laws that the loop runs in one go.
//!
//! Any section of a chain runs through [`super::section`]; the sums listed in
//! [`fuse`] run faster, because nothing is stored between one law and the
//! next. A law needs no line here.

use super::column::LaneColumn;
use super::number::Number;
use super::section::{Sweep, SweepPlace};
use super::touch::{LaneTouch, Sides, note_open};
use crate::instruction_set::InstructionSet;
use fearless_simd::{dispatch, prelude::*};
use std::ops::Range;

/// Laws that are fused, each with all those before it; each has one coefficient. Their forces
/// stand in [`sum`] once more, for registers.
const FUSED: [&str; 3] = ["elastic_hertz", "damping_viscoelastic", "damping_cubic"];

/// The fast sweep over a section with these laws, in this order, if there is one.
pub(super) fn fuse<N: Number<W>, const W: usize>(
    laws: &[&str],
    contacts: Range<usize>,
    lanes: usize,
    coefficients: Vec<LaneColumn<N, W>>,
) -> Option<Box<dyn Sweep<N, W>>> {
    let first = contacts.start * lanes / W;
    let section = (contacts, first, coefficients);
    match laws.len() {
        _ if !FUSED.starts_with(laws) => None,
        1 => Some(Box::new(Fused::<N, W, 1>::new(section))),
        2 => Some(Box::new(Fused::<N, W, 2>::new(section))),
        3 => Some(Box::new(Fused::<N, W, 3>::new(section))),
        _ => None,
    }
}

/// A section of which the first `LAWS` fused laws act.
struct Fused<N, const W: usize, const LAWS: usize> {
    contacts: Range<usize>,
    /// Chunk in which the section and its coefficients begin.
    first: usize,
    coefficients: Vec<LaneColumn<N, W>>,
}

impl<N: Number<W>, const W: usize, const LAWS: usize> Fused<N, W, LAWS> {
    fn new((contacts, first, coefficients): (Range<usize>, usize, Vec<LaneColumn<N, W>>)) -> Self {
        Self { contacts, first, coefficients }
    }

    #[inline(always)]
    fn sweep<S: Simd>(
        &self,
        simd: S,
        place: &SweepPlace<'_, N, W>,
        chunks: Range<usize>,
        (force, open): (&mut [N], &mut [u64]),
    ) {
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        let columns: [&LaneColumn<N, W>; LAWS] = std::array::from_fn(|j| &self.coefficients[j]);
        if columns.iter().all(|column| column.uniform().is_some()) {
            // Loaded once, they stay in registers.
            let k = columns.map(|column| load(column.reader().at(0)));
            pass::<S, N, W, LAWS>(simd, place, chunks, (force, open), |_| k);
        } else {
            let columns = columns.map(LaneColumn::reader);
            pass::<S, N, W, LAWS>(simd, place, chunks, (force, open), |i| {
                columns.map(|column| load(column.at(i - self.first)))
            });
        }
    }
}

/// Forces of chunks of contacts whose coefficients `k` gives.
#[inline(always)]
fn pass<S: Simd, N: Number<W>, const W: usize, const LAWS: usize>(
    simd: S,
    place: &SweepPlace<'_, N, W>,
    chunks: Range<usize>,
    (force, open): (&mut [N], &mut [u64]),
    k: impl Fn(usize) -> [N::Wide<S>; LAWS],
) {
    let first = chunks.start;
    let force = force[first * W..chunks.end * W].as_chunks_mut::<W>().0;
    let open = open.get_mut(first..chunks.end).unwrap_or_default();
    let sides = Sides::new(place, first, force.len());
    // Loops of their own, so that what most steps need is all that they do.
    let plain = place.offset_m.is_all(0.0) && !place.starting;
    match (plain, place.fresh, open.is_empty()) {
        (true, true, true) => {
            for (i, force) in force.iter_mut().enumerate() {
                sum::<S, N, W, LAWS>(simd, k(first + i), sides.plain_touch(simd, i))
                    .store_array(force);
            }
        }
        (true, true, false) => {
            for (i, (force, open)) in force.iter_mut().zip(open).enumerate() {
                let touch = sides.plain_touch(simd, i);
                note_open::<S, N, W>(simd, Some(open), &touch);
                sum::<S, N, W, LAWS>(simd, k(first + i), touch).store_array(force);
            }
        }
        (_, fresh, _) => {
            for (i, force) in force.iter_mut().enumerate() {
                let touch = sides.touch(simd, i);
                note_open::<S, N, W>(simd, open.get_mut(i), &touch);
                let more = sum::<S, N, W, LAWS>(simd, k(first + i), touch);
                let before = N::Wide::<S>::load_array_ref(simd, force);
                (if fresh { more } else { before + more }).store_array(force);
            }
        }
    }
}

/// √δ (K δ + A′ δ̇) + B δ̇³, or as many terms of it: products are added without being formed
/// first, and √δ multiplies once.
#[inline(always)]
fn sum<S: Simd, N: Number<W>, const W: usize, const LAWS: usize>(
    simd: S,
    k: [N::Wide<S>; LAWS],
    touch: LaneTouch<N::Wide<S>>,
) -> N::Wide<S> {
    // Minus 0 changes no sum and no sign: the compiler leaves it out.
    let none = N::Wide::<S>::simd_from(simd, N::of(-0.0));
    let mut rooted = k[0].mul_add(touch.overlap, none);
    let mut plain = none;
    if LAWS > 1 {
        rooted = k[1].mul_add(touch.rate, rooted);
    }
    if LAWS > 2 {
        plain = (k[2] * touch.rate).mul_add(touch.rate * touch.rate, none);
    }
    touch.root.mul_add(rooted, plain)
}

impl<N: Number<W>, const W: usize, const LAWS: usize> Sweep<N, W> for Fused<N, W, LAWS> {
    fn add(
        &mut self,
        set: InstructionSet,
        place: &SweepPlace<'_, N, W>,
        force: &mut [N],
        open: &mut [u64],
    ) {
        let chunks = place.chunks(&self.contacts);
        if chunks.is_empty() {
            return;
        }
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.sweep(simd, place, chunks.clone(), (force, open))
        ));
    }
}
