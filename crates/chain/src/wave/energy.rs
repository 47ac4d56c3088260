//! Where the energy of a shot is.

use super::state::{ContactMode, WaveState};
use crate::laws::Nature;
use crate::system::{System, TermColumns};

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
    /// Largest energy so far that was put in or in motion: what the residual is
    /// measured against.
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
    pub(super) fn accounted_j(&self) -> f64 {
        let dissipated: f64 = self.dissipated.iter().map(|line| line.energy_j).sum();
        let held = self.kinetic_j + self.elastic_j + self.gravity_j + self.preload_j + self.stop_j;
        held + dissipated + self.clipped_j
    }

    /// What is missing, in J: 0 but for the solver's error.
    pub fn residual_j(&self) -> f64 {
        self.accounted_j() - self.driven_j - self.start_j
    }

    /// Residual over the input energy; infinite if there was none.
    pub fn relative_residual(&self) -> f64 {
        match self.residual_j() {
            0.0 => 0.0,
            residual => residual / self.input_j,
        }
    }
}

/// Energy of liquid bridges, if they are of the law asked for.
fn stored_in_bridges(system: &System, state: &WaveState, law: Option<&str>) -> f64 {
    let mut sum = 0.0;
    for section in system.sections.iter() {
        let asked = |bridge: &TermColumns| law.is_none_or(|law| law == bridge.law.info().name);
        if section.bridge.as_ref().is_some_and(asked) {
            let bridged = section.contacts.clone().filter(|&c| state.is_bridged(c));
            sum +=
                bridged.map(|c| system.bridge_energy_j(c, state.overlap(system, c))).sum::<f64>();
        }
    }
    sum
}

/// Energy that contacts hold, of one law or of all.
pub(super) fn stored(system: &System, state: &WaveState, law: Option<&str>) -> f64 {
    let mut sum = match state.bridged.is_empty() {
        true => 0.0,
        false => stored_in_bridges(system, state, law),
    };
    for section in system.sections.iter() {
        for term in section.terms() {
            let info = term.law.info();
            if info.nature == Nature::Dissipative || law.is_some_and(|law| law != info.name) {
                continue;
            }
            for c in section.contacts.clone() {
                let overlap = state.overlap(system, c);
                let closed = overlap > 0.0 && state.mode[c] != ContactMode::Open;
                if info.nature == Nature::WithState {
                    if closed || state.states.acts_across(c) {
                        sum += state.states.energy_j(c, overlap);
                    }
                } else if closed {
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

pub(super) fn rest_energy(system: &System) -> f64 {
    let in_laws: f64 = (0..system.contacts())
        .filter(|&c| system.offset_m[c] > 0.0)
        .map(|c| system.stored_energy(c, system.offset_m[c]))
        .sum();
    let bridged = system.bridged.iter().enumerate().filter(|(_, bridged)| **bridged);
    in_laws + bridged.map(|(c, _)| system.bridge_energy_j(c, system.offset_m[c])).sum::<f64>()
}

pub(super) fn kinetic(system: &System, state: &WaveState) -> f64 {
    let beads = system.bodies() - 1;
    let moving = system.mass_kg[..beads].iter().zip(&state.v);
    moving.filter(|(mass, _)| mass.is_finite()).map(|(mass, v)| 0.5 * mass * v * v).sum()
}

pub(super) fn gravity(system: &System, state: &WaveState) -> f64 {
    let beads = system.bodies() - 1;
    let first = usize::from(!system.has_striker);
    let bodies = system.mass_kg[..beads].iter().zip(&state.x).skip(first);
    bodies.map(|(mass, x)| mass * x * (0.5 * system.pendulum_per_s2 * x - system.slope_m_s2)).sum()
}

pub(super) fn preload(system: &System, state: &WaveState) -> f64 {
    let x = state.x[1];
    match system.spring {
        None => -system.push_n * x,
        Some(spring) if spring.stiffness_n_m * x < spring.force_n => {
            0.5 * spring.stiffness_n_m * x * x - spring.force_n * x
        }
        Some(spring) => -0.5 * spring.force_n * spring.force_n / spring.stiffness_n_m,
    }
}

pub(super) fn stop(system: &System, state: &WaveState) -> f64 {
    let Some(mass) = system.stop_mass_kg else {
        return 0.0;
    };
    let last = system.bodies() - 1;
    let (x, v) = (state.x[last], state.v[last]);
    0.5 * mass * v * v + system.static_force_n[last - 1] * x
}
