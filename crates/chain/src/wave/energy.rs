//! Where the energy of a shot is.

use super::forces::Pass;
use super::state::{Mode, State};
use crate::laws::Nature;
use crate::system::{SectionColumns, System, TermColumns};
use std::ops::Range;

/// What one law has dissipated.
#[derive(Clone, Debug, PartialEq)]
pub struct Dissipated {
    /// Name of the law.
    pub law: &'static str,
    /// Energy in J.
    pub energy_j: f64,
}

/// Energy terms in J at one time:
/// kinetic + elastic + Σ dissipated + clipped + gravity + preload + stop
/// = start + driven.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Time in s.
    pub time_s: f64,
    /// All energy at the start of the shot.
    pub start_j: f64,
    /// Work that a driven end has done.
    pub driven_j: f64,
    /// Largest energy that was put in so far: `start_j` plus the most that a driven end had done.
    pub input_j: f64,
    /// Σ m v²/2 over the striker and the beads.
    pub kinetic_j: f64,
    /// Σ U(δ) − U(Δ) over contacts.
    pub elastic_j: f64,
    /// Work lost, one line a law.
    pub dissipated: Vec<Dissipated>,
    /// ∫ (F_clipped − F_unclipped) δ̇ dt.
    pub clipped_j: f64,
    /// Gravity's potential energy, that of threads included.
    pub gravity_j: f64,
    /// Potential energy of the push on bead 1.
    pub preload_j: f64,
    /// Kinetic energy of the stop and work against the force that holds it.
    pub stop_j: f64,
}

impl Budget {
    /// Energy now in the chain and lost from it, in J.
    fn accounted_j(&self) -> f64 {
        let dissipated: f64 = self.dissipated.iter().map(|line| line.energy_j).sum();
        let held = self.kinetic_j + self.elastic_j + self.gravity_j + self.preload_j + self.stop_j;
        held + dissipated + self.clipped_j
    }

    /// What is missing, in J: 0 but for the solver's error.
    #[must_use]
    pub fn residual_j(&self) -> f64 {
        self.accounted_j() - self.driven_j - self.start_j
    }

    /// Residual over the input energy.
    #[must_use]
    pub fn relative_residual(&self) -> f64 {
        if self.input_j == 0.0 {
            0.0
        } else {
            self.residual_j() / self.input_j
        }
    }
}

/// Integrates powers along the steps of a method.
#[derive(Clone, Debug)]
pub(crate) struct Meter {
    /// Laws whose work is not all stored.
    laws: Vec<&'static str>,
    /// Powers of the laws, then of the cut, then of the driven end; a row a stage.
    powers_w: Vec<Vec<f64>>,
    work_j: Vec<f64>,
    start_j: f64,
    most_driven_j: f64,
    rest_elastic_j: f64,
    start_plastic_j: Vec<f64>,
}

impl Meter {
    pub fn new(system: &System, state: &State, stages: usize) -> Self {
        let mut laws: Vec<&'static str> = lossy(system).map(|term| term.law.info().name).collect();
        laws.sort_unstable();
        laws.dedup();
        let slots = laws.len() + 2;
        let mut meter = Self {
            laws,
            powers_w: vec![vec![0.0; slots]; stages],
            work_j: vec![0.0; slots],
            start_j: 0.0,
            most_driven_j: 0.0,
            rest_elastic_j: rest_energy(system),
            start_plastic_j: Vec::new(),
        };
        meter.start_plastic_j = meter
            .laws
            .iter()
            .map(|law| stored(system, state, Some(law)))
            .collect();
        meter.start_j = meter.budget(system, state).accounted_j();
        meter
    }

    /// Powers at one stage, from the force pass just done.
    pub fn stage(
        &mut self,
        stage: usize,
        system: &System,
        pass: &mut Pass,
        contacts: Range<usize>,
        driven_speed_m_s: f64,
    ) {
        let powers = &mut self.powers_w[stage];
        powers.fill(0.0);
        let (cut, driven) = (self.laws.len(), self.laws.len() + 1);
        powers[cut] = cut_power(system, pass, contacts.clone());
        if system.motion.is_some() {
            powers[driven] = (pass.dynamic[1] + system.static_force_n[0]) * driven_speed_m_s;
        }
        for section in &system.sections {
            let part =
                section.contacts.start.max(contacts.start)..section.contacts.end.min(contacts.end);
            for (term, gated) in with_gates(section).filter(|_| !part.is_empty()) {
                let name = term.law.info().name;
                if let Some(slot) = self.laws.iter().position(|&law| law == name) {
                    powers[slot] += term_power(section, term, gated, pass, part.clone());
                }
            }
        }
    }

    /// Adds the step's work: Σ h b_s P_s.
    pub fn finish_step(&mut self, step_s: f64, weights: &[f64]) {
        for (weight, powers) in weights.iter().zip(&self.powers_w) {
            for (work, power) in self.work_j.iter_mut().zip(powers) {
                *work += step_s * weight * power;
            }
        }
        self.most_driven_j = self.most_driven_j.max(self.work_j[self.laws.len() + 1]);
    }

    /// Error of the step's work, as a fraction of the energy put in.
    pub fn error(&self, step_s: f64, weights: &[f64]) -> f64 {
        let input = self.start_j.abs() + self.most_driven_j;
        if input == 0.0 {
            return 0.0;
        }
        let slots = 0..self.work_j.len();
        let error = |slot: usize| -> f64 {
            let rows = weights.iter().zip(&self.powers_w);
            rows.map(|(weight, powers)| weight * powers[slot]).sum()
        };
        slots
            .map(|slot| (step_s * error(slot) / input).abs())
            .fold(0.0, f64::max)
    }

    /// The last stage of a step is the first of the next.
    pub fn carry_over(&mut self) {
        let last = self.powers_w.len() - 1;
        self.powers_w.swap(0, last);
    }

    /// All terms at a state that the meter has followed.
    pub fn budget(&self, system: &System, state: &State) -> Budget {
        let driven_j = self.work_j[self.laws.len() + 1];
        let dissipated = self.laws.iter().enumerate().map(|(slot, law)| {
            let start = self.start_plastic_j.get(slot).copied().unwrap_or(0.0);
            let kept = stored(system, state, Some(law)) - start;
            Dissipated {
                law,
                energy_j: self.work_j[slot] - kept,
            }
        });
        Budget {
            time_s: state.time_s,
            start_j: self.start_j,
            driven_j,
            input_j: self.start_j.abs() + self.most_driven_j,
            kinetic_j: kinetic(system, state),
            elastic_j: stored(system, state, None) - self.rest_elastic_j,
            dissipated: dissipated.collect(),
            clipped_j: self.work_j[self.laws.len()],
            gravity_j: gravity(system, state),
            preload_j: preload(system, state),
            stop_j: stop(system, state),
        }
    }
}

/// Terms whose work is not all stored.
fn lossy(system: &System) -> impl Iterator<Item = &TermColumns> {
    system
        .sections
        .iter()
        .flat_map(SectionColumns::terms)
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
    force.fill(0.0);
    let seen = crate::laws::Contacts {
        overlap: &pass.overlap[contacts.clone()],
        root: &pass.root[contacts.clone()],
        rate: &pass.rate[contacts.clone()],
        largest: &pass.largest[contacts.clone()],
    };
    term.law.add_forces(
        &term.columns,
        contacts.start - section.contacts.start,
        seen,
        force,
    );
    let (touching, rate) = (&pass.touching[contacts.clone()], &pass.rate[contacts]);
    let acting = force
        .iter()
        .zip(touching)
        .map(|(f, on)| if gated && *on == 0.0 { 0.0 } else { *f });
    acting.zip(rate).map(|(f, rate)| f * rate).sum()
}

/// Σ (F_clipped − F_unclipped) δ̇.
fn cut_power(system: &System, pass: &Pass, contacts: Range<usize>) -> f64 {
    if system.tension == crate::chain::Tension::Allowed {
        return 0.0;
    }
    contacts
        .map(|c| {
            let acting = pass.dynamic[c + 1] + system.static_force_n[c];
            let gated = if pass.touching[c] > 0.0 {
                pass.closed_force[c]
            } else {
                0.0
            };
            (acting - gated - pass.across[c]) * pass.rate[c]
        })
        .sum()
}

/// Energy that contacts hold, of one law or of all.
fn stored(system: &System, state: &State, law: Option<&str>) -> f64 {
    let mut sum = 0.0;
    for section in &system.sections {
        for term in section.terms() {
            let info = term.law.info();
            if info.nature == Nature::Dissipative || law.is_some_and(|law| law != info.name) {
                continue;
            }
            for c in section.contacts.clone() {
                let overlap = state.overlap(system, c);
                if overlap > 0.0 && state.mode[c] != Mode::Open {
                    let largest = state.largest[c].max(overlap);
                    sum += term.law.energy(
                        &term.columns,
                        c - section.contacts.start,
                        overlap,
                        largest,
                    );
                }
            }
        }
    }
    sum
}

/// Energy that contacts hold at static equilibrium.
fn rest_energy(system: &System) -> f64 {
    (0..system.contacts())
        .filter(|&c| system.offset_m[c] > 0.0)
        .map(|c| system.stored_energy(c, system.offset_m[c]))
        .sum()
}

fn kinetic(system: &System, state: &State) -> f64 {
    let beads = system.bodies() - 1;
    let moving = system.mass_kg[..beads].iter().zip(&state.v);
    moving
        .filter(|(mass, _)| mass.is_finite())
        .map(|(mass, v)| 0.5 * mass * v * v)
        .sum()
}

fn gravity(system: &System, state: &State) -> f64 {
    let beads = system.bodies() - 1;
    let first = usize::from(!system.has_striker);
    let bodies = system.mass_kg[..beads].iter().zip(&state.x).skip(first);
    bodies
        .map(|(mass, x)| mass * x * (0.5 * system.pendulum_per_s2 * x - system.slope_m_s2))
        .sum()
}

fn preload(system: &System, state: &State) -> f64 {
    let x = state.x[1];
    match system.spring {
        None => -system.push_n * x,
        Some(spring) if spring.stiffness_n_m * x < spring.force_n => {
            0.5 * spring.stiffness_n_m * x * x - spring.force_n * x
        }
        Some(spring) => -0.5 * spring.force_n * spring.force_n / spring.stiffness_n_m,
    }
}

fn stop(system: &System, state: &State) -> f64 {
    let Some(mass) = system.stop_mass_kg else {
        return 0.0;
    };
    let last = system.bodies() - 1;
    let (x, v) = (state.x[last], state.v[last]);
    0.5 * mass * v * v + system.static_force_n[last - 1] * x
}
