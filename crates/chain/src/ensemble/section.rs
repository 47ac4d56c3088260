//! Sections of a chain, for all lanes at once.

use super::column::{LaneColumn, chunks};
use super::fused::fuse;
use super::number::Number;
use super::touch::{Sides, note_open};
use crate::chain::Tension;
use crate::instruction_set::InstructionSet;
use crate::laws::Columns;
use crate::system::{SectionColumns, System, TermColumns, TouchColumns};
use fearless_simd::{Simd, dispatch, prelude::*};
use std::ops::Range;
use std::sync::Arc;

/// Where all bodies are, and which of them move.
pub(super) struct SweepPlace<'a, N, const W: usize> {
    pub offset_m: &'a LaneColumn<N, W>,
    /// Overlaps of this size and less are none.
    pub slightest_m: [N; W],
    pub lanes: usize,
    /// Chunks whose forces are to be computed.
    pub awake: Range<usize>,
    /// Forces are to be set, not added to.
    pub fresh: bool,
    /// No step has been made yet.
    pub starting: bool,
    pub x: &'a [N],
    pub v: &'a [N],
}

impl<N, const W: usize> SweepPlace<'_, N, W> {
    /// The chunks that are awake among some contacts.
    pub(super) fn chunks(&self, contacts: &Range<usize>) -> Range<usize> {
        let end = chunks::<W>(contacts.end, self.lanes).min(self.awake.end);
        let start = (contacts.start * self.lanes / W).max(self.awake.start);
        start.min(end)..end
    }
}

/// Sets, or adds to, the forces of a section's contacts.
pub(super) trait Sweep<N, const W: usize>: Send {
    /// The first element of `force` is contact 0 of lane 0. In `open` each chunk has bits of
    /// which contacts are open; it is empty where nothing follows that.
    fn add(
        &mut self,
        set: InstructionSet,
        place: &SweepPlace<'_, N, W>,
        force: &mut [N],
        open: &mut [u64],
    );
}

/// The sweep over section `index` of systems that share their shape.
pub(super) fn section<N: Number<W>, const W: usize>(
    (systems, chains): (&[&System], &[&System]),
    index: usize,
) -> Box<dyn Sweep<N, W>> {
    let lanes = systems.len();
    let sections: Vec<&SectionColumns> = chains.iter().map(|s| &s.sections[index]).collect();
    let plain = systems[0].tension == Tension::Allowed && sections[0].ungated.is_empty();
    let names: Vec<&str> = sections[0].gated.iter().map(|term| term.law.info().name).collect();
    let contacts = sections[0].contacts.clone();
    plain
        .then(|| fuse(&names, contacts, lanes, coefficients(lanes, &sections)))
        .flatten()
        .unwrap_or_else(|| Box::new(Unfused::new(systems, index, W)))
}

/// Coefficients of all gated terms from the chunk on in which the section
/// begins; 0 before it.
fn coefficients<N: Number<W>, const W: usize>(
    lanes: usize,
    sections: &[&SectionColumns],
) -> Vec<LaneColumn<N, W>> {
    let contacts = &sections[0].contacts;
    let first = contacts.start * lanes / W * W / lanes;
    let column = |term: usize, j: usize| {
        LaneColumn::new(contacts.end - first, (lanes, sections.len()), 0.0, |c, lane| {
            let inside = (first + c).checked_sub(contacts.start);
            inside.map_or(0.0, |c| sections[lane].gated[term].columns.column(j)[c])
        })
    };
    let terms = sections[0].gated.iter().enumerate();
    terms
        .flat_map(|(term, columns)| (0..columns.columns.width()).map(move |j| (term, j)))
        .map(|(term, j)| column(term, j))
        .collect()
}

/// A section that runs law by law, through columns in double precision.
struct Unfused {
    contacts: Range<usize>,
    gated: Vec<TermColumns>,
    ungated: Vec<TermColumns>,
    clipped: bool,
    /// Flat index of the chunk in which the section begins.
    first: usize,
    touch: TouchColumns,
    sum: Vec<f64>,
}

/// Terms of all lanes as one: row `contact · lanes + lane`.
fn merged<'a>(of: impl Fn(usize) -> &'a [TermColumns], lanes: usize) -> Vec<TermColumns> {
    let terms = of(0).iter().enumerate();
    let merge = |(at, term): (usize, &TermColumns)| TermColumns {
        law: Arc::clone(&term.law),
        columns: Columns::interleaved((0..lanes).map(|lane| &of(lane)[at].columns)),
    };
    terms.map(merge).collect()
}

impl Unfused {
    fn new(systems: &[&System], index: usize, width: usize) -> Self {
        let sections: Vec<&SectionColumns> = systems.iter().map(|s| &s.sections[index]).collect();
        let (lanes, contacts) = (sections.len(), sections[0].contacts.clone());
        let first = contacts.start * lanes / width * width;
        let count = (contacts.end * lanes).next_multiple_of(width) - first;
        let mut touch = TouchColumns::new(count);
        for c in contacts.clone() {
            for (lane, system) in systems.iter().enumerate() {
                touch.largest[c * lanes + lane - first] = system.offset_m[c].max(0.0);
            }
        }
        Self {
            gated: merged(|lane| &sections[lane].gated, lanes),
            ungated: merged(|lane| &sections[lane].ungated, lanes),
            clipped: systems[0].tension == Tension::Clipped,
            contacts,
            first,
            touch,
            sum: vec![0.0; count],
        }
    }

    #[inline(always)]
    fn look<S: Simd, N: Number<W>, const W: usize>(
        &mut self,
        simd: S,
        place: &SweepPlace<'_, N, W>,
        part: Range<usize>,
        open: &mut [u64],
    ) {
        let sides = Sides::new(place, part.start, part.len());
        for i in part.clone() {
            let touch = sides.touch(simd, i - part.start);
            note_open::<S, N, W>(simd, open.get_mut(i), &touch);
            let at = i * W - self.first..(i + 1) * W - self.first;
            let keep = |values: &mut [f64], now: N::Wide<S>| {
                for (value, &now) in values[at.clone()].iter_mut().zip(now.as_slice()) {
                    *value = now.into();
                }
            };
            keep(&mut self.touch.overlap, touch.overlap);
            keep(&mut self.touch.root, touch.root);
            keep(&mut self.touch.rate, touch.rate);
            keep(&mut self.touch.across, touch.across);
            for at in at.clone() {
                self.touch.largest[at] = self.touch.largest[at].max(self.touch.overlap[at]);
            }
        }
    }
}

impl<N: Number<W>, const W: usize> Sweep<N, W> for Unfused {
    fn add(
        &mut self,
        set: InstructionSet,
        place: &SweepPlace<'_, N, W>,
        force: &mut [N],
        open: &mut [u64],
    ) {
        let part = place.chunks(&self.contacts);
        if part.is_empty() {
            return;
        }
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.look(simd, place, part.clone(), open)
        ));
        // The section's own contacts among those of its chunks.
        let flat = (self.contacts.start * place.lanes).max(part.start * W)
            ..(part.end * W).min(self.contacts.end * place.lanes);
        let here = flat.start - self.first..flat.end - self.first;
        let row = flat.start - self.contacts.start * place.lanes;
        let sum = &mut self.sum[here.clone()];
        sum.fill(0.0);
        self.touch.add_forces(set, [&self.gated, &self.ungated], (here.clone(), row), sum);
        for (force, &sum) in force[flat].iter_mut().zip(&self.sum[here]) {
            let before = if place.fresh { 0.0 } else { (*force).into() };
            *force = N::of(before + if self.clipped { sum.max(0.0) } else { sum });
        }
    }
}
