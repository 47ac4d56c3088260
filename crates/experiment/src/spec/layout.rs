//! Whether the parts of an experiment fit together.

use super::{Far, Near, Spec};
use crate::finding::Problem;
use std::ops::Range;

impl Spec {
    /// Everything must lie inside the chain, whatever a reading did to it.
    pub(crate) fn check_layout(&self) -> Result<(), Problem> {
        let beads = self.bead_count();
        if beads == 0 {
            let message = "the chain has no beads";
            let place = self.groups.first().map_or(0..0, |group| group.span.clone());
            return Err(Problem::new(&place, message, "expected at least one"));
        }
        self.check_sensors(beads)?;
        for (gap, span) in &self.gaps {
            inside("contact", gap.contact, 0, beads, span)?;
        }
        for (initial, span) in &self.initial {
            inside("bead", initial.bead, 1, beads, span)?;
        }
        self.check_repeated()?;
        self.check_ring()
    }

    fn check_sensors(&self, beads: usize) -> Result<(), Problem> {
        let sensors = &self.sensors;
        inside("sensor bead", sensors.bead, 1, beads, &sensors.span)?;
        for (bead, span) in &sensors.beads {
            inside("sensor bead", *bead, 1, beads, span)?;
        }
        for (contact, span) in &sensors.contacts {
            inside("contact", *contact, 0, beads, span)?;
        }
        for (body, span) in sensors.positions.iter().chain(&sensors.velocities) {
            inside("body", *body, 0, beads, span)?;
        }
        Ok(())
    }

    /// Two gaps in one contact, or two initial states of one bead.
    fn check_repeated(&self) -> Result<(), Problem> {
        let gaps = self.gaps.iter().map(|(gap, span)| (gap.contact, span));
        let initial = self
            .initial
            .iter()
            .map(|(initial, span)| (initial.bead, span));
        repeated("contact", gaps.collect())?;
        repeated("bead", initial.collect())
    }

    /// A ring has no end to strike, to drive or to push.
    fn check_ring(&self) -> Result<(), Problem> {
        let ring = matches!(self.far, Far::Periodic { .. });
        let pushed = !matches!(self.push, hertzchain_chain::Push::None);
        if ring && (pushed || !matches!(self.near, Near::Free)) {
            let message = "a periodic chain has no near end";
            let label = "expected [[initial]] and neither striker, driven nor near_end";
            return Err(Problem::new(&self.far_span, message, label));
        }
        Ok(())
    }
}

fn inside(
    what: &str,
    found: usize,
    least: usize,
    most: usize,
    span: &Range<usize>,
) -> Result<(), Problem> {
    if (least..=most).contains(&found) {
        return Ok(());
    }
    let message = format!("{what} {found} is outside the chain of {most} beads");
    let label = format!("expected a number from {least} to {most}");
    Err(Problem::new(span, message, label))
}

fn repeated(what: &str, mut found: Vec<(usize, &Range<usize>)>) -> Result<(), Problem> {
    found.sort_by_key(|(index, span)| (*index, span.start));
    match found.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        None => Ok(()),
        Some(pair) => {
            let message = format!("{what} {} stands here a second time", pair[1].0);
            Err(Problem::new(
                pair[1].1,
                message,
                "expected each at most once",
            ))
        }
    }
}
