//! Which of a method's two tables a step takes.
//!
//! Where contacts keep their modes, long steps of high order do with a third of the force passes. Where they
//! open and close, each change ends a step, and what is computed twice for it costs less in short steps of low order.

use super::table::Table;

/// Steps over which the share of repeated ones is averaged: of high order, of low order.
const MEMORY: [f64; 2] = [8.0, 32.0];

/// Repeated steps per accepted one above which high order gives way to low order, and below which it comes back.
const CHANGE: [f64; 2] = [1.0, 0.15];

/// Steps of high order over those of low order, about.
const LONGER: f64 = 3.0;

/// Error that steps of low order may make beside steps of high order, whose errors are that much smaller than their
/// estimates.
const OF_LOW: f64 = 0.1;

#[derive(Clone, Debug)]
pub(super) struct Order<'a> {
    low: &'a Table,
    high: Option<&'a Table>,
    is_high: bool,
    /// Mean number of repeated steps per accepted one.
    repeated: f64,
}

impl<'a> Order<'a> {
    pub(super) fn new(low: &'a Table, high: Option<&'a Table>) -> Self {
        Self { low, high, is_high: high.is_some(), repeated: 0.0 }
    }

    /// Most stages of a step.
    pub(super) fn most_stages(&self) -> usize {
        self.high.map_or(0, Table::stages).max(self.low.stages())
    }

    pub(super) fn table(&self) -> &'a Table {
        self.high.filter(|_| self.is_high).unwrap_or(self.low)
    }

    /// Part of a step's tolerance that its table is held to.
    pub(super) fn share(&self) -> f64 {
        if self.high.is_some() && !self.is_high { OF_LOW } else { 1.0 }
    }

    /// Counts an accepted step and those that were repeated for it.
    pub(super) fn count(&mut self, repeated: u32) {
        let weight = MEMORY[usize::from(!self.is_high)].recip();
        self.repeated += weight * (f64::from(repeated) - self.repeated);
    }

    /// Changes the table where that pays: the factor on the next step then.
    pub(super) fn change(&mut self) -> Option<f64> {
        self.high?;
        let [most, least] = CHANGE;
        let longer = match self.is_high {
            true if self.repeated > most => LONGER.recip(),
            false if self.repeated < least => LONGER,
            _ => return None,
        };
        self.is_high = !self.is_high;
        self.repeated = 0.5 * (most + least);
        Some(longer)
    }
}
