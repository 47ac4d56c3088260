//! Work along the steps of a shot.

use super::energy::{Budget, Dissipated, gravity, kinetic, preload, rest_energy, stop, stored};
use super::forces::Pass;
use super::state::WaveState;
use crate::laws::Nature;
use crate::system::{SectionColumns, System, TermColumns};
use std::ops::Range;

/// Integrates powers along the steps of a method.
#[derive(Clone, Debug)]
pub(crate) struct Meter {
    laws: Vec<&'static str>,
    /// Which of them each term of each section is, if any.
    slots: Vec<Vec<Option<usize>>>,
    /// Powers of the laws, then of the cut, then of the driven end; a row a stage.
    powers_w: Vec<Vec<f64>>,
    /// The same of the long step that slow bodies take.
    slow_powers_w: Vec<Vec<f64>>,
    work_j: Vec<f64>,
    start_j: f64,
    /// Largest energy seen: put in, or in motion.
    most_j: f64,
    rest_elastic_j: f64,
    start_plastic_j: Vec<f64>,
}

impl Meter {
    pub(super) fn new(system: &System, state: &WaveState, stages: usize) -> Self {
        let mut laws: Vec<&'static str> = lossy(system).map(|term| term.law.info().name).collect();
        laws.sort_unstable();
        laws.dedup();
        let slots = laws.len() + 2;
        let slot = |term: &TermColumns| {
            let name = term.law.info().name;
            laws.iter().position(|&law| law == name)
        };
        let of_section =
            |section: &SectionColumns| section.terms().chain(&section.bridge).map(slot).collect();
        let mut meter = Self {
            slots: system.sections.iter().map(of_section).collect(),
            laws,
            powers_w: vec![vec![0.0; slots]; stages],
            slow_powers_w: vec![vec![0.0; slots]; stages],
            work_j: vec![0.0; slots],
            start_j: 0.0,
            most_j: 0.0,
            rest_elastic_j: rest_energy(system),
            start_plastic_j: Vec::new(),
        };
        meter.start_plastic_j =
            meter.laws.iter().map(|law| stored(system, state, Some(law))).collect();
        meter.start_j = meter.budget(system, state, None).accounted_j();
        meter.most_j = meter.start_j.abs();
        meter
    }

    /// Powers at one stage, from the force pass just done.
    pub(super) fn stage(
        &mut self,
        stage: usize,
        system: &System,
        pass: &mut Pass,
        contacts: [Range<usize>; 2],
        driven_speed_m_s: f64,
    ) {
        let powers = &mut self.powers_w[stage];
        powers.fill(0.0);
        let (cut, driven) = (self.laws.len(), self.laws.len() + 1);
        if system.motion.is_some() {
            powers[driven] = (pass.dynamic[1] + system.static_force_n[0]) * driven_speed_m_s;
        }
        for contacts in contacts.iter().filter(|contacts| !contacts.is_empty()) {
            powers[cut] += cut_power(system, pass, contacts.clone());
            for (section, slots) in system.sections.iter().zip(&self.slots) {
                let part = section.contacts.start.max(contacts.start)
                    ..section.contacts.end.min(contacts.end);
                let terms = with_gates(section).zip(slots).filter(|_| !part.is_empty());
                for ((term, gated), slot) in terms {
                    if let Some(slot) = slot {
                        powers[*slot] += term_power(section, term, gated, pass, part.clone());
                    }
                }
                let of_bridges = slots.get(section.terms().count()).copied().flatten();
                if let Some(slot) = of_bridges.filter(|_| !part.is_empty()) {
                    powers[slot] += pull_power(pass, part);
                }
            }
        }
    }

    /// Adds the step's work, Σ h b_s P_s; `kinetic_j` is what moves after it.
    pub(super) fn finish_step(&mut self, step_s: f64, weights: &[f64], kinetic_j: f64) {
        add(&mut self.work_j, step_s, weights, &self.powers_w);
        let driven = self.work_j[self.laws.len() + 1];
        let put_in = (self.start_j + driven).abs().max(driven.abs());
        self.most_j = self.most_j.max(put_in).max(kinetic_j);
    }

    pub(super) fn finish_slow(&mut self, step_s: f64, weights: &[f64]) {
        add(&mut self.work_j, step_s, weights, &self.slow_powers_w);
    }

    /// Puts the powers of the long step in the place of the short one's, or back.
    pub(super) fn swap_slow(&mut self) {
        std::mem::swap(&mut self.powers_w, &mut self.slow_powers_w);
    }

    /// Error of the step's work, as a fraction of the energy put in.
    pub(super) fn error(&self, step_s: f64, weights: &[f64]) -> f64 {
        if self.most_j == 0.0 {
            return 0.0;
        }
        let slots = 0..self.work_j.len();
        let error = |slot: usize| -> f64 {
            let rows = weights.iter().zip(&self.powers_w);
            rows.map(|(weight, powers)| weight * powers[slot]).sum()
        };
        slots.map(|slot| (step_s * error(slot) / self.most_j).abs()).fold(0.0, f64::max)
    }

    /// The last stage of a step is the first of the next.
    pub(super) fn carry_over(&mut self, last: usize) {
        self.powers_w.swap(0, last);
    }

    /// All terms at a state that the meter has followed; `pending` is the length
    /// of a long step under way and the weights of its stages up to the state.
    pub(super) fn budget(
        &self,
        system: &System,
        state: &WaveState,
        pending: Option<&(f64, Vec<f64>)>,
    ) -> Budget {
        let mut work_j = self.work_j.clone();
        if let Some((step_s, weights)) = pending {
            add(&mut work_j, *step_s, weights, &self.slow_powers_w);
        }
        let driven_j = work_j[self.laws.len() + 1];
        let dissipated = self.laws.iter().enumerate().map(|(slot, law)| {
            let start = self.start_plastic_j.get(slot).copied().unwrap_or(0.0);
            let kept = stored(system, state, Some(law)) - start;
            Dissipated { law, energy_j: work_j[slot] - kept }
        });
        Budget {
            time_s: state.time_s,
            start_j: self.start_j,
            driven_j,
            input_j: self.most_j,
            kinetic_j: kinetic(system, state),
            elastic_j: stored(system, state, None) - self.rest_elastic_j,
            dissipated: dissipated.collect(),
            clipped_j: work_j[self.laws.len()],
            gravity_j: gravity(system, state),
            preload_j: preload(system, state),
            stop_j: stop(system, state),
        }
    }
}

fn add(work_j: &mut [f64], step_s: f64, weights: &[f64], powers_w: &[Vec<f64>]) {
    for (weight, powers) in weights.iter().zip(powers_w) {
        for (work, power) in work_j.iter_mut().zip(powers) {
            *work += step_s * weight * power;
        }
    }
}

fn lossy(system: &System) -> impl Iterator<Item = &TermColumns> {
    system
        .sections
        .iter()
        .flat_map(|section| section.terms().chain(&section.bridge))
        .filter(|term| term.law.info().nature != Nature::Elastic)
}

fn with_gates(section: &SectionColumns) -> impl Iterator<Item = (&TermColumns, bool)> {
    let gated = section.gated.iter().map(|term| (term, true));
    gated.chain(section.ungated.iter().map(|term| (term, false)))
}

/// Σ F δ̇ of one term over consecutive contacts.
fn term_power(
    section: &SectionColumns,
    term: &TermColumns,
    gated: bool,
    pass: &mut Pass,
    contacts: Range<usize>,
) -> f64 {
    let force = &mut pass.scratch[contacts.clone()];
    match term.law.info().nature {
        Nature::WithState => force.copy_from_slice(&pass.of_states[contacts.clone()]),
        _ => force.fill(0.0),
    }
    let seen = crate::laws::Contacts {
        overlap: &pass.overlap[contacts.clone()],
        root: &pass.root[contacts.clone()],
        rate: &pass.rate[contacts.clone()],
        largest: &pass.largest[contacts.clone()],
    };
    term.law.add_forces(
        pass.set,
        &term.columns,
        contacts.start - section.contacts.start,
        seen,
        force,
    );
    let (touching, rate) = (&pass.touching[contacts.clone()], &pass.rate[contacts]);
    let acting =
        force.iter().zip(touching).map(|(f, on)| if gated && *on == 0.0 { 0.0 } else { *f });
    acting.zip(rate).map(|(f, rate)| f * rate).sum()
}

/// Σ F δ̇ of liquid bridges over consecutive contacts.
fn pull_power(pass: &Pass, contacts: Range<usize>) -> f64 {
    let pulls = pass.pull[contacts.clone()].iter().zip(&pass.rate[contacts]);
    pulls.map(|(pull, rate)| pull * rate).sum()
}

fn cut_power(system: &System, pass: &Pass, contacts: Range<usize>) -> f64 {
    if system.tension == crate::chain::Tension::Allowed {
        return 0.0;
    }
    // A ring's seam lends its force to the place of contact 0.
    contacts
        .filter(|&c| system.has_contact(c))
        .map(|c| {
            let acting = pass.dynamic[c + 1] + system.static_force_n[c];
            let gated = if pass.touching[c] > 0.0 { pass.closed_force[c] } else { 0.0 };
            let pull = pass.pull.get(c).copied().unwrap_or(0.0);
            (acting - pull - gated - pass.across[c]) * pass.rate[c]
        })
        .sum()
}
