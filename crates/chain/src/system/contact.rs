//! One contact alone, as sensors, events and budgets need it.

use super::{SectionColumns, System};
use crate::laws::Closed;

impl System {
    pub(crate) fn section(&self, contact: usize) -> Option<&SectionColumns> {
        self.sections.get(*self.section_of.get(contact)? as usize)
    }

    /// Sum of all terms of a closed contact in N, before any cut.
    pub(crate) fn unclipped_force(&self, contact: usize, closed: Closed) -> f64 {
        let Some(section) = self.section(contact) else {
            return 0.0;
        };
        let at = contact - section.contacts.start;
        section.terms().map(|term| term.law.force(&term.columns, at, closed)).sum()
    }

    /// Sum of the terms that act across a gap, in N.
    pub(crate) fn ungated_force(&self, contact: usize, closed: Closed) -> f64 {
        let Some(section) = self.section(contact) else {
            return 0.0;
        };
        let at = contact - section.contacts.start;
        section.ungated.iter().map(|term| term.law.force(&term.columns, at, closed)).sum()
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
