//! Forces of contacts: of one alone, as sensors, events and budgets need it, and of many as columns.

use super::{SectionColumns, System, TermColumns};
use crate::instruction_set::InstructionSet;
use crate::laws::{Closed, Contacts};
use std::ops::Range;

/// What laws see of consecutive contacts.
#[derive(Clone, Debug)]
pub(crate) struct TouchColumns {
    pub overlap: Vec<f64>,
    pub root: Vec<f64>,
    /// Overlap rate; 0 where open, so that gated laws give no force there.
    pub rate: Vec<f64>,
    /// Overlap rate whether open or not.
    pub across: Vec<f64>,
    /// Largest overlap so far.
    pub largest: Vec<f64>,
}

impl TouchColumns {
    pub(crate) fn new(contacts: usize) -> Self {
        let [overlap, root, rate, across, largest] = std::array::from_fn(|_| vec![0.0; contacts]);
        Self { overlap, root, rate, across, largest }
    }

    /// Adds the forces of gated and ungated terms on some contacts, the first of which is
    /// row `first` of the terms' columns.
    pub(crate) fn add_forces(
        &self,
        set: InstructionSet,
        terms: [&[TermColumns]; 2],
        (here, first): (Range<usize>, usize),
        force: &mut [f64],
    ) {
        for (terms, rate) in terms.into_iter().zip([&self.rate, &self.across]) {
            let seen = Contacts {
                overlap: &self.overlap[here.clone()],
                root: &self.root[here.clone()],
                rate: &rate[here.clone()],
                largest: &self.largest[here.clone()],
            };
            for term in terms {
                term.law.add_forces(set, &term.columns, first, seen, force);
            }
        }
    }
}

impl System {
    pub(crate) fn section(&self, contact: usize) -> Option<&SectionColumns> {
        self.sections.get(*self.section_of.get(contact)? as usize)
    }

    /// Sum of all terms of a closed contact in N, before any cut.
    pub(crate) fn unclipped_force(&self, contact: usize, closed: Closed) -> f64 {
        let force = |term: &TermColumns, at| term.law.force(&term.columns, at, closed);
        self.section(contact).map_or(0.0, |section| {
            let at = contact - section.contacts.start;
            section.terms().map(|term| force(term, at)).sum()
        })
    }

    /// Rate of change of that sum in N/s, at an overlap and a rate that changes by `change` in m/s².
    pub(crate) fn force_rate(
        &self,
        contact: usize,
        (overlap, rate): (f64, f64),
        change: f64,
    ) -> f64 {
        let Some(section) = self.section(contact) else { return 0.0 };
        let at = contact - section.contacts.start;
        // Term by term: the rounding of a large force is not in the slope of a small one.
        let of_term = |term: &TermColumns| {
            let force =
                |overlap, rate| term.law.force(&term.columns, at, Closed::new(overlap, rate));
            slope(|overlap| force(overlap, rate), overlap) * rate
                + slope(|rate| force(overlap, rate), rate) * change
        };
        section.terms().map(of_term).sum()
    }

    /// What a contact's liquid bridge, if it has one, gives to a reader of its law.
    fn of_bridge(&self, contact: usize, of: impl Fn(&TermColumns, usize) -> f64) -> f64 {
        let section = self.section(contact);
        let bridge = section.and_then(|section| Some((section, section.bridge.as_ref()?)));
        bridge.map_or(0.0, |(section, bridge)| of(bridge, contact - section.contacts.start))
    }

    /// Force in N, 0 or below, of a bridged contact's liquid at an overlap in m, negative across a gap.
    pub(crate) fn pull_n(&self, contact: usize, overlap: f64) -> f64 {
        let closed = Closed { overlap, root: 0.0, rate: 0.0, largest: 0.0 };
        self.of_bridge(contact, |bridge, at| bridge.law.force(&bridge.columns, at, closed))
    }

    /// Energy in J of a bridged contact's liquid, 0 where the bridge ruptures.
    pub(crate) fn bridge_energy_j(&self, contact: usize, overlap: f64) -> f64 {
        let energy =
            |bridge: &TermColumns, at| bridge.law.energy(&bridge.columns, at, overlap, overlap);
        self.of_bridge(contact, energy)
    }

    /// Gap in m at which a contact's bridge ruptures.
    pub(crate) fn rupture_m(&self, contact: usize) -> f64 {
        self.of_bridge(contact, |bridge, at| bridge.law.rupture(&bridge.columns, at))
    }

    /// Whether an overlap in m is a gap that a contact's bridge, if it has one, does not bear.
    pub(crate) fn is_beyond_bridge(&self, contact: usize, overlap: f64) -> bool {
        let rupture_m = self.rupture_m(contact);
        rupture_m > 0.0 && -overlap > rupture_m
    }

    /// The pull before the shot.
    pub(crate) fn pull_at_rest_n(&self, contact: usize, overlap: f64) -> f64 {
        match self.bridged.get(contact) {
            Some(true) => self.pull_n(contact, overlap),
            _ => 0.0,
        }
    }

    /// Sum of the terms that act across a gap, in N.
    pub(crate) fn ungated_force(&self, contact: usize, closed: Closed) -> f64 {
        let force = |term: &TermColumns, at| term.law.force(&term.columns, at, closed);
        self.section(contact).map_or(0.0, |section| {
            let at = contact - section.contacts.start;
            section.ungated.iter().map(|term| force(term, at)).sum()
        })
    }

    /// Energy in J that all terms of a contact hold at an overlap never exceeded before.
    pub(crate) fn stored_energy(&self, contact: usize, overlap: f64) -> f64 {
        let Some(section) = self.section(contact) else {
            return 0.0;
        };
        let at = contact - section.contacts.start;
        section.terms().map(|term| term.law.energy(&term.columns, at, overlap, overlap)).sum()
    }
}

/// Slope of a function like a power of its argument, infinite at 0 or not: differences of order 4
/// whose step goes with the argument are off by 1e-13 of it.
fn slope(f: impl Fn(f64) -> f64, at: f64) -> f64 {
    let step = 1e-3 * at.abs().max(1e-100);
    let change = |steps: f64| f(at + steps * step) - f(at - steps * step);
    (8.0 * change(1.0) - change(2.0)) / (12.0 * step)
}
