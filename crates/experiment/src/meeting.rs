//! Two bodies of a chain as they meet: how deep and how hard, estimated
//! without running anything.

use crate::spec::{SectionSpec, Spec};
use hertzchain_chain::laws::{Closed, Columns, Law, Nature};
use hertzchain_chain::{Chain, Pair, Start};
use std::sync::Arc;

/// The first two bodies of a section, meeting at the speed that sets the chain
/// in motion.
#[derive(Debug)]
pub(crate) struct Meeting<'a> {
    pub(crate) section: &'a SectionSpec,
    pub(crate) contact: usize,
    pub(crate) pair: Pair,
    pub(crate) speed_m_s: f64,
    /// Overlap at which the laws that push back have taken up the energy.
    pub(crate) overlap_m: f64,
    /// In the order of the section's laws.
    terms: Vec<Term>,
}

/// One law with its numbers for the pair.
#[derive(Debug)]
struct Term {
    law: Arc<dyn Law>,
    columns: Columns,
}

/// What moves: its speed in m/s and its energy in J.
#[derive(Clone, Copy, Debug)]
struct Motion {
    speed_m_s: f64,
    energy_j: f64,
}

/// The meetings of all sections that have a law that pushes back; none where
/// nothing has a speed.
pub(crate) fn meetings<'a>(spec: &'a Spec, chain: &Chain) -> Vec<Meeting<'a>> {
    let motion = motion(chain);
    if !(motion.speed_m_s > 0.0 && motion.speed_m_s.is_finite()) {
        return Vec::new();
    }
    let sections = spec.sections.iter().zip(&chain.sections);
    let meeting = |(written, section): (&'a SectionSpec, &hertzchain_chain::Section)| {
        let pairs = section.contacts.clone().map(|c| (c, chain.pair(c)));
        let (contact, pair) = pairs.into_iter().find_map(|(c, pair)| Some((c, pair?)))?;
        let terms = section.laws.iter().map(|law| Term::new(law, &pair));
        let terms: Vec<Term> = terms.collect::<Option<_>>()?;
        let energy_j = 0.5 * pair.mass_kg * motion.speed_m_s * motion.speed_m_s;
        // No contact can hold more than what was put in.
        let overlap_m = overlap(&terms, energy_j.min(motion.energy_j))?;
        Some(Meeting {
            section: written,
            contact,
            pair,
            speed_m_s: motion.speed_m_s,
            overlap_m,
            terms,
        })
    };
    sections.filter_map(meeting).collect()
}

/// The fastest body and the energy of all that move; a driven end has no end
/// of it.
fn motion(chain: &Chain) -> Motion {
    let energy = |mass_kg: f64, speed_m_s: f64| 0.5 * mass_kg * speed_m_s * speed_m_s;
    let mut motion = match &chain.start {
        Start::Striker { bead, speed_m_s } => Motion {
            speed_m_s: *speed_m_s,
            energy_j: energy(bead.mass_kg, *speed_m_s),
        },
        Start::Driven { motion, .. } => Motion {
            speed_m_s: motion.largest_speed_m_s(),
            energy_j: f64::INFINITY,
        },
        Start::Free => Motion {
            speed_m_s: 0.0,
            energy_j: 0.0,
        },
    };
    for initial in &chain.initial {
        let bead = initial.bead.checked_sub(1).and_then(|i| chain.beads.get(i));
        motion.speed_m_s = motion.speed_m_s.max(initial.velocity_m_s.abs());
        motion.energy_j += bead.map_or(0.0, |b| energy(b.mass_kg, initial.velocity_m_s));
    }
    motion
}

impl Term {
    fn new(law: &Arc<dyn Law>, pair: &Pair) -> Option<Self> {
        // A law that can't serve this pair is reported by those who set it up.
        let row = law.coefficients(pair).ok()?;
        Some(Self {
            law: law.clone(),
            columns: Columns::from_rows(&[row]),
        })
    }

    fn force_n(&self, overlap_m: f64, rate_m_s: f64) -> f64 {
        let closed = Closed::new(overlap_m, rate_m_s);
        self.law.force(&self.columns, 0, closed)
    }

    /// Work of pressing two bodies together slowly.
    fn work_j(&self, overlap_m: f64) -> f64 {
        match self.law.info().nature {
            Nature::Dissipative => 0.0,
            Nature::Elastic => self.law.energy(&self.columns, 0, overlap_m, overlap_m),
            Nature::ElasticPlastic => self.plastic_work_j(overlap_m),
        }
    }

    /// ∫ F dδ by the midpoint rule: a part of it is not stored.
    fn plastic_work_j(&self, overlap_m: f64) -> f64 {
        const PARTS: u8 = 32;
        let part_m = overlap_m / f64::from(PARTS);
        let forces = (0..PARTS).map(|i| self.force_n((f64::from(i) + 0.5) * part_m, 0.0));
        forces.sum::<f64>() * part_m
    }
}

/// Where the slow work of all terms reaches an energy, to a hundredth; `None`
/// when it never does.
fn overlap(terms: &[Term], energy_j: f64) -> Option<f64> {
    const FACTOR: f64 = 16.0;
    const WIDTH: f64 = 1.01;
    let enough = |overlap_m: f64| {
        let work_j: f64 = terms.iter().map(|term| term.work_j(overlap_m)).sum();
        work_j >= energy_j
    };
    // Outward from the micrometre at which contacts live.
    let mut high = 1e-6;
    while !enough(high) {
        high *= FACTOR;
        if high > 1e300 {
            return None;
        }
    }
    while high > 1e-300 && enough(high / FACTOR) {
        high /= FACTOR;
    }
    let mut low = high / FACTOR;
    while high / low > WIDTH {
        let middle = (low * high).sqrt();
        if enough(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

impl Meeting<'_> {
    /// Force in N of the terms that push back, at the largest overlap.
    fn elastic_n(&self) -> f64 {
        let elastic = |term: &&Term| term.law.info().nature != Nature::Dissipative;
        let terms = self.terms.iter().filter(elastic);
        terms.map(|term| term.force_n(self.overlap_m, 0.0)).sum()
    }

    /// How strong each dissipative law is: its force at the largest overlap
    /// and the full speed over the elastic force, by the law's place in the
    /// section. Both never act together; the ratio compares their sizes.
    pub(crate) fn strengths(&self) -> impl Iterator<Item = (usize, f64)> {
        let elastic_n = self.elastic_n();
        let terms = self.terms.iter().enumerate();
        let dissipative = terms.filter(|(_, term)| term.law.info().nature == Nature::Dissipative);
        dissipative.map(move |(index, term)| {
            let force_n = term.force_n(self.overlap_m, self.speed_m_s);
            (index, force_n / elastic_n)
        })
    }
}
