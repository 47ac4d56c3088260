//! Whether the parts of an experiment fit together.

use super::{Far, Near, Spec};
use crate::finding::Problem;
use crate::known;
use hertzchain_chain::Initial;
use std::ops::{Range, RangeInclusive};

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
            self.inside("contact", gap.contact, self.contacts(), span)?;
        }
        for (initial, span) in &self.initial {
            self.inside("bead", initial.bead, 1..=beads, span)?;
        }
        self.check_repeated()?;
        self.check_motion()?;
        self.check_ring()
    }

    /// Bodies that move: the beads, body 0 if there is one, and a stop of finite mass.
    fn bodies(&self) -> RangeInclusive<usize> {
        let stop_kg = match self.far {
            Far::HalfBead { stop_kg, .. } | Far::Plane { stop_kg, .. } => stop_kg,
            Far::Periodic { .. } | Far::Free => None,
        };
        let last = self.bead_count() + usize::from(stop_kg.is_some());
        usize::from(matches!(self.near, Near::Free { .. }))..=last
    }

    /// Contacts between two bodies; a free end has none.
    fn contacts(&self) -> RangeInclusive<usize> {
        let last = self.bead_count() - usize::from(matches!(self.far, Far::Free));
        *self.bodies().start()..=last
    }

    fn check_sensors(&self, beads: usize) -> Result<(), Problem> {
        let sensors = &self.sensors;
        self.inside("sensor bead", sensors.bead, 1..=beads, &sensors.span)?;
        for (bead, span) in &sensors.beads {
            self.inside("sensor bead", *bead, 1..=beads, span)?;
        }
        for (contact, span) in &sensors.contacts {
            self.inside("contact", *contact, self.contacts(), span)?;
        }
        for (body, span) in sensors.positions.iter().chain(&sensors.velocities) {
            self.inside("body", *body, self.bodies(), span)?;
        }
        match &sensors.channel {
            Some(span) if !self.has_wall() => {
                let message = "the channel adds the wall's signal, but there is no wall";
                Err(Problem::new(
                    span,
                    message,
                    "expected a [far_end] to lean on",
                ))
            }
            _ => Ok(()),
        }
    }

    /// Whether bead N leans on something.
    pub(crate) fn has_wall(&self) -> bool {
        matches!(self.far, Far::HalfBead { .. } | Far::Plane { .. })
    }

    fn inside(
        &self,
        what: &str,
        found: usize,
        there: RangeInclusive<usize>,
        span: &Range<usize>,
    ) -> Result<(), Problem> {
        if there.contains(&found) {
            return Ok(());
        }
        let beads = self.bead_count();
        let message = format!("{what} {found} is outside the chain of {beads} beads");
        let label = match there.is_empty() {
            true => "expected nothing: this chain has none".to_owned(),
            false => format!(
                "expected a number from {} to {}",
                there.start(),
                there.end()
            ),
        };
        let problem = Problem::new(span, message, label);
        Err(match (what, found) {
            ("sensor bead" | "bead", 0) => problem.help(known::BEADS),
            _ => problem,
        })
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

    /// Without striker or driven end some bead must move or be displaced.
    fn check_motion(&self) -> Result<(), Problem> {
        let still = |i: &Initial| i.displacement_m == 0.0 && i.velocity_m_s == 0.0;
        match (&self.near, self.initial.first()) {
            (Near::Free { .. }, Some((_, span))) if self.initial.iter().all(|(i, _)| still(i)) => {
                let message = "nothing sets the chain in motion";
                let label = "all [[initial]] are 0: expected a bead that moves or is displaced";
                Err(Problem::new(span, message, label))
            }
            _ => Ok(()),
        }
    }

    /// A ring has no end to strike, to drive or to push.
    fn check_ring(&self) -> Result<(), Problem> {
        let ring = matches!(self.far, Far::Periodic { .. });
        let pushed = !matches!(self.push, hertzchain_chain::Push::None);
        if ring && (pushed || !matches!(self.near, Near::Free { .. })) {
            let message = "a periodic chain has no near end";
            let label = "expected [[initial]] and neither striker, driven nor near_end";
            return Err(Problem::new(&self.far_span, message, label));
        }
        Ok(())
    }
}

fn repeated(what: &str, mut found: Vec<(usize, &Range<usize>)>) -> Result<(), Problem> {
    found.sort_by_key(|(index, span)| (*index, span.start));
    match found.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        None => Ok(()),
        Some(pair) => {
            let message = format!("{what} {} stands here a second time", pair[1].0);
            let problem = Problem::new(pair[1].1, message, "expected each at most once");
            Err(problem.beside(pair[0].1, "the first one is here"))
        }
    }
}
