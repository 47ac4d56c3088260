//! States of contacts, integrated beside the motion: numbers of each, by the method's own stages.

use crate::laws::{Closed, ContactState, Nature};
use crate::system::{FLUSH, System, TermColumns};
use std::ops::Range;

#[derive(Clone, Debug)]
struct StatefulContact {
    contact: usize,
    /// The numbers at the start of the step.
    start_m: [f64; 4],
    /// The same at the stage that is computed.
    stage_m: [f64; 4],
    state: Box<dyn ContactState>,
}

/// Contacts whose laws have a state, in order; none in most chains.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactStates {
    contacts: Vec<StatefulContact>,
    /// Rates of the numbers, a row a stage.
    rates_m_s: Vec<Vec<[f64; 4]>>,
}

impl ContactStates {
    /// All contacts as they are at their overlaps in m and rates in m/s.
    pub(super) fn new(
        system: &System,
        stages: usize,
        at_start: impl Fn(usize) -> (f64, f64),
    ) -> Self {
        let mut contacts = Vec::new();
        for section in system.sections.iter().filter(|_| system.has_states) {
            let with_state = |term: &&TermColumns| term.law.info().nature == Nature::WithState;
            let Some(term) = section.terms().find(with_state) else { continue };
            for contact in section.contacts.clone().filter(|&c| system.has_contact(c)) {
                let at = contact - section.contacts.start;
                let Some(mut state) = term.law.state(&term.columns, at) else { continue };
                let seen = closed(&*state, at_start(contact));
                state.begin(seen.overlap);
                // What acts across a gap may do more at once than at rest.
                let across = state.acts_across();
                let start_m = if across { state.accept([0.0; 4], seen).0 } else { [0.0; 4] };
                contacts.push(StatefulContact { contact, start_m, stage_m: start_m, state });
            }
        }
        Self { rates_m_s: vec![vec![[0.0; 4]; contacts.len()]; stages], contacts }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// The numbers of a stage: those at the start of the step and what the stages before it add.
    pub(super) fn combine(&mut self, step_s: f64, weights: &[f64], moving: &Range<usize>) {
        let all = self.contacts.iter_mut().enumerate();
        for (at, own) in all.filter(|(_, own)| moving.contains(&own.contact)) {
            let moved = moved(step_s, weights.iter().copied(), &self.rates_m_s, at);
            own.stage_m = std::array::from_fn(|j| own.start_m[j] + moved[j]);
        }
    }

    /// Forces and rates of a stage in the touching contacts of a part of the chain.
    pub(super) fn stage(
        &mut self,
        stage: usize,
        system: &System,
        contacts: Range<usize>,
        (x, v, touching): (&[f64], &[f64], &[f64]),
        force_n: &mut [f64],
    ) {
        force_n[contacts.clone()].fill(0.0);
        for (own, rate) in self.contacts.iter().zip(&mut self.rates_m_s[stage]) {
            let c = own.contact;
            if contacts.contains(&c) && (touching[c] > 0.0 || own.state.acts_across()) {
                let overlap = system.offset_m[c] - (x[c + 1] - x[c]);
                let closed = closed(&*own.state, (overlap, v[c] - v[c + 1]));
                let (force, own_rate) = own.state.force_and_rates(own.stage_m, closed);
                force_n[c] += force;
                *rate = own_rate;
            } else {
                *rate = [0.0; 4];
            }
        }
    }

    /// The largest error estimate of the numbers in m, with its contact; NaN if any is.
    pub(super) fn error_m(&self, step_s: f64, weights: &[f64]) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (at, own) in self.contacts.iter().enumerate() {
            for error in moved(step_s, weights.iter().copied(), &self.rates_m_s, at) {
                if error.abs() > worst.0 || error.is_nan() {
                    worst = (error.abs(), own.contact);
                }
            }
        }
        worst
    }

    /// Makes the end of a step its start, at the overlaps in m and rates in m/s there; returns
    /// whether the first stage must be computed anew.
    pub(super) fn accept(
        &mut self,
        moving: &Range<usize>,
        at: impl Fn(usize) -> (f64, f64),
    ) -> bool {
        let mut any = false;
        for own in self.contacts.iter_mut().filter(|own| moving.contains(&own.contact)) {
            let seen = closed(&*own.state, at(own.contact));
            let (numbers, changed) = own.state.accept(own.stage_m, seen);
            (own.start_m, own.stage_m) = (numbers, numbers);
            any |= changed;
        }
        let last = self.rates_m_s.len() - 1;
        self.rates_m_s.swap(0, last);
        any
    }

    /// A contact has opened: what comes next begins anew.
    pub(super) fn open(&mut self, contact: usize) {
        if let Some(at) = self.find(contact).filter(|at| !self.contacts[*at].state.acts_across()) {
            let own = &mut self.contacts[at];
            (own.start_m, own.stage_m) = ([0.0; 4], [0.0; 4]);
            own.state.begin(0.0);
        }
    }

    /// Whether a contact has a state that goes on where it is open.
    pub(super) fn acts_across(&self, contact: usize) -> bool {
        self.find(contact).is_some_and(|at| self.contacts[at].state.acts_across())
    }

    /// What `of` says of a contact's state at an overlap in m and a rate in m/s and its numbers, moved
    /// by these weights of the stages since the start of the step.
    pub(super) fn seen(
        &self,
        contact: usize,
        (step_s, weights): (f64, impl Iterator<Item = f64>),
        at_m_and_m_s: (f64, f64),
        of: impl Fn(&dyn ContactState, [f64; 4], Closed) -> f64,
    ) -> Option<f64> {
        let at = self.find(contact)?;
        let own = &self.contacts[at];
        let moved = moved(step_s, weights, &self.rates_m_s, at);
        let numbers = std::array::from_fn(|j| own.start_m[j] + moved[j]);
        Some(of(&*own.state, numbers, closed(&*own.state, at_m_and_m_s)))
    }

    fn find(&self, contact: usize) -> Option<usize> {
        self.contacts.binary_search_by_key(&contact, |own| own.contact).ok()
    }

    /// Energy in J of a contact's state at an overlap in m.
    pub(super) fn energy_j(&self, contact: usize, overlap_m: f64) -> f64 {
        let own = self.find(contact).map(|at| &self.contacts[at]);
        own.map_or(0.0, |own| own.state.energy_j(own.start_m, overlap_m))
    }
}

/// How far a contact's numbers move by some weights of the stages.
fn moved(
    step_s: f64,
    weights: impl Iterator<Item = f64>,
    rates_m_s: &[Vec<[f64; 4]>],
    at: usize,
) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for (weight, row) in weights.zip(rates_m_s) {
        sum = std::array::from_fn(|j| sum[j] + weight * row[at][j]);
    }
    sum.map(|sum| step_s * sum)
}

/// A contact as its state sees it.
fn closed(state: &dyn ContactState, (overlap_m, rate_m_s): (f64, f64)) -> Closed {
    let closed = Closed::new(if overlap_m > FLUSH { overlap_m } else { 0.0 }, rate_m_s);
    match state.acts_across() && overlap_m < 0.0 {
        true => Closed { overlap: overlap_m, ..closed },
        false => closed,
    }
}
