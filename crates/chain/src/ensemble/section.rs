//! Sections of a chain, for all lanes at once.

use super::column::{Column, WIDTH, chunks};
use super::fused::fuse;
use super::touch::Sides;
use crate::chain::Tension;
use crate::instruction_set::InstructionSet;
use crate::laws::{Columns, Contacts};
use crate::system::{SectionColumns, System, TermColumns};
use fearless_simd::{Simd, dispatch};
use std::ops::Range;
use std::sync::Arc;

/// Where all bodies are, and which of them move.
pub(super) struct Place<'a> {
    pub offset_m: &'a Column,
    pub lanes: usize,
    /// Chunks whose forces are to be computed.
    pub awake: Range<usize>,
    /// Forces are to be set, not added to.
    pub fresh: bool,
    /// No step has been made yet.
    pub starting: bool,
    pub x: &'a [f64],
    pub v: &'a [f64],
}

impl Place<'_> {
    /// The chunks that are awake among some contacts.
    pub fn chunks(&self, contacts: &Range<usize>) -> Range<usize> {
        let end = chunks(contacts.end, self.lanes).min(self.awake.end);
        let start = (contacts.start * self.lanes / WIDTH).max(self.awake.start);
        start.min(end)..end
    }
}

/// Sets, or adds to, the forces of a section's contacts.
pub(super) trait Sweep: Send {
    /// The first element of `force` is contact 0 of lane 0.
    fn add(&mut self, set: InstructionSet, place: &Place<'_>, force: &mut [f64]);
}

/// The sweep over section `index` of systems that share their shape.
pub(super) fn section(systems: &[&System], index: usize) -> Box<dyn Sweep> {
    let sections: Vec<&SectionColumns> = systems.iter().map(|s| &s.sections[index]).collect();
    let plain = systems[0].tension == Tension::Allowed && sections[0].ungated.is_empty();
    let names: Vec<&str> = sections[0]
        .gated
        .iter()
        .map(|term| term.law.info().name)
        .collect();
    let contacts = sections[0].contacts.clone();
    plain
        .then(|| fuse(&names, contacts, systems.len(), coefficients(&sections)))
        .flatten()
        .unwrap_or_else(|| Box::new(Unfused::new(systems, &sections)))
}

/// Coefficients of all gated terms from the chunk on in which the section
/// begins; 0 before it.
fn coefficients(sections: &[&SectionColumns]) -> Vec<Column> {
    let (lanes, contacts) = (sections.len(), &sections[0].contacts);
    let first = contacts.start * lanes / WIDTH * WIDTH / lanes;
    let column = |term: usize, j: usize| {
        Column::new(contacts.end - first, lanes, 0.0, |c, lane| {
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

/// A section that runs law by law, through columns.
struct Unfused {
    contacts: Range<usize>,
    gated: Vec<TermColumns>,
    ungated: Vec<TermColumns>,
    clipped: bool,
    /// Chunk in which the section begins.
    first: usize,
    overlap: Vec<f64>,
    root: Vec<f64>,
    rate: Vec<f64>,
    across: Vec<f64>,
    /// Largest overlaps so far.
    largest: Vec<f64>,
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
    fn new(systems: &[&System], sections: &[&SectionColumns]) -> Self {
        let (lanes, contacts) = (sections.len(), sections[0].contacts.clone());
        let first = contacts.start * lanes / WIDTH;
        let count = (chunks(contacts.end, lanes) - first) * WIDTH;
        let numbers = || vec![0.0; count];
        let mut largest = numbers();
        for c in contacts.clone() {
            for (lane, system) in systems.iter().enumerate() {
                largest[c * lanes + lane - first * WIDTH] = system.offset_m[c].max(0.0);
            }
        }
        Self {
            gated: merged(|lane| &sections[lane].gated, lanes),
            ungated: merged(|lane| &sections[lane].ungated, lanes),
            clipped: systems[0].tension == Tension::Clipped,
            contacts,
            first,
            overlap: numbers(),
            root: numbers(),
            rate: numbers(),
            across: numbers(),
            sum: numbers(),
            largest,
        }
    }

    #[inline(always)]
    fn touch<S: Simd>(&mut self, simd: S, place: &Place<'_>, part: Range<usize>) {
        let sides = Sides::new(
            place.offset_m,
            (part.end, place.lanes),
            (place.x, place.v),
            place.starting,
        );
        for i in part {
            let touch = sides.touch(simd, i);
            let at = (i - self.first) * WIDTH..(i - self.first + 1) * WIDTH;
            self.overlap[at.clone()].copy_from_slice(&touch.overlap);
            self.root[at.clone()].copy_from_slice(&touch.root);
            self.rate[at.clone()].copy_from_slice(&touch.rate);
            self.across[at.clone()].copy_from_slice(&touch.across);
            for (largest, overlap) in self.largest[at].iter_mut().zip(touch.overlap) {
                *largest = largest.max(overlap);
            }
        }
    }
}

impl Sweep for Unfused {
    fn add(&mut self, set: InstructionSet, place: &Place<'_>, force: &mut [f64]) {
        let part = place.chunks(&self.contacts);
        if part.is_empty() {
            return;
        }
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.touch(simd, place, part.clone())
        ));
        // The section's own contacts among those of its chunks.
        let flat = (self.contacts.start * place.lanes).max(part.start * WIDTH)
            ..(part.end * WIDTH).min(self.contacts.end * place.lanes);
        let here = flat.start - self.first * WIDTH..flat.end - self.first * WIDTH;
        let sum = &mut self.sum[here.clone()];
        sum.fill(0.0);
        for (terms, rate) in [(&self.gated, &self.rate), (&self.ungated, &self.across)] {
            let seen = Contacts {
                overlap: &self.overlap[here.clone()],
                root: &self.root[here.clone()],
                rate: &rate[here.clone()],
                largest: &self.largest[here.clone()],
            };
            for term in terms {
                term.law.add_forces(set, &term.columns, 0, seen, sum);
            }
        }
        for (force, sum) in force[flat].iter_mut().zip(sum) {
            let before = if place.fresh { 0.0 } else { *force };
            *force = before + if self.clipped { sum.max(0.0) } else { *sum };
        }
    }
}
