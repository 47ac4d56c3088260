//! One force pass: from positions and velocities to accelerations.

use super::state::WaveState;
use super::step::LANES;
use crate::chain::Tension;
use crate::instruction_set::InstructionSet;
use crate::laws::Contacts;
use crate::system::{FLUSH, System};
use fearless_simd::{dispatch, f64x4, prelude::*};
use std::ops::Range;

/// Whether gates keep the mode they had when the step began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gates {
    /// Yes: the step ends where a mode changes.
    Frozen,
    /// No: every pass looks at the gate afresh.
    Instant,
}

/// Columns of one force pass, kept between passes.
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    /// Overlap, negative across a gap.
    pub signed_overlap: Vec<f64>,
    pub overlap: Vec<f64>,
    pub root: Vec<f64>,
    pub rate: Vec<f64>,
    pub largest: Vec<f64>,
    /// Sum of the gated terms as if closed.
    pub closed_force: Vec<f64>,
    /// Sum of the terms that act across gaps.
    pub across: Vec<f64>,
    /// Dynamic force of contact c at index c + 1; 0 at both ends.
    pub dynamic: Vec<f64>,
    /// Gates of the last pass, as in [`WaveState`].
    pub passing: Vec<f64>,
    pub touching: Vec<f64>,
    pub scratch: Vec<f64>,
    /// Forces of contacts' states; empty where no law has any.
    pub of_states: Vec<f64>,
    /// Forces of liquid bridges, 0 or below; empty where no section has any.
    pub pull: Vec<f64>,
    pub set: InstructionSet,
}

impl Pass {
    pub(super) fn new(system: &System) -> Self {
        let contacts = || vec![0.0; system.contacts()];
        Self {
            signed_overlap: contacts(),
            overlap: contacts(),
            root: contacts(),
            rate: contacts(),
            largest: contacts(),
            closed_force: contacts(),
            across: contacts(),
            dynamic: vec![0.0; system.contacts() + 2],
            passing: contacts(),
            touching: contacts(),
            scratch: contacts(),
            of_states: if system.has_states { contacts() } else { Vec::new() },
            pull: vec![0.0; system.bridged.len()],
            set: InstructionSet::default(),
        }
    }

    /// Accelerations in m/s² of the bodies of a window at positions `x` and
    /// velocities `v`; contacts at the window's edges carry no dynamic force.
    pub(super) fn accelerate(
        &mut self,
        system: &System,
        state: &WaveState,
        gates: Gates,
        bodies: Range<usize>,
        (x, v): (&[f64], &[f64]),
        a: &mut [f64],
    ) {
        let contacts = bodies.start..bodies.end - 1;
        dispatch!(self.set.level(), simd => simd.vectorize(
            #[inline(always)]
            || {
                self.kinematics(simd, system, contacts.clone(), x, v);
                self.memory(system, state, contacts.clone());
                self.set_gates(state, gates, contacts.clone());
                self.add_terms(system, contacts.clone());
                self.subtract_static(system, contacts.clone(), gates);
                self.add_bridges(system, state, contacts.clone());
                self.push_bodies(system, bodies.clone(), x, a);
            }
        ));
    }

    #[inline(always)]
    fn kinematics<S: Simd>(
        &mut self,
        simd: S,
        system: &System,
        contacts: Range<usize>,
        x: &[f64],
        v: &[f64],
    ) {
        let n = contacts.len();
        let (first, end) = (contacts.start, contacts.end);
        let offset = &system.offset_m[contacts.clone()];
        let (left, right) = (&x[first..end], &x[first + 1..=end]);
        let (before, after) = (&v[first..end], &v[first + 1..=end]);
        let signed = &mut self.signed_overlap[contacts.clone()][..n];
        let overlap = &mut self.overlap[contacts.clone()][..n];
        let root = &mut self.root[contacts.clone()][..n];
        let rate = &mut self.rate[contacts][..n];
        let whole = n - n % LANES;
        for c in (0..whole).step_by(LANES) {
            let here = c..c + LANES;
            let load = |values: &[f64]| f64x4::from_slice(simd, &values[here.clone()]);
            let depth = load(offset) - (load(right) - load(left));
            let deep = depth.simd_gt(f64x4::splat(simd, FLUSH));
            let overlapped = deep.select(depth, f64x4::splat(simd, 0.0));
            depth.store_slice(&mut signed[here.clone()]);
            overlapped.store_slice(&mut overlap[here.clone()]);
            overlapped.sqrt().store_slice(&mut root[here.clone()]);
            (load(before) - load(after)).store_slice(&mut rate[here.clone()]);
        }
        for c in whole..n {
            let depth = offset[c] - (right[c] - left[c]);
            signed[c] = depth;
            overlap[c] = if depth > FLUSH { depth } else { 0.0 };
            root[c] = overlap[c].sqrt();
            rate[c] = before[c] - after[c];
        }
    }

    #[inline(always)]
    fn set_gates(&mut self, state: &WaveState, gates: Gates, contacts: Range<usize>) {
        match gates {
            Gates::Frozen => {
                self.passing[contacts.clone()].copy_from_slice(&state.passing[contacts.clone()]);
                self.touching[contacts.clone()].copy_from_slice(&state.touching[contacts]);
            }
            Gates::Instant => self.look_at_gates(contacts),
        }
    }

    /// Force of a contact before any cut, taken as closed.
    pub(super) fn uncut(&self, contact: usize) -> f64 {
        self.closed_force[contact] + self.across[contact]
    }

    /// Whether any gate disagrees with the overlap of the last pass: closed
    /// across a gap or open at an overlap.
    pub(super) fn disagrees(&self, contacts: Range<usize>) -> bool {
        let gates = self.signed_overlap[contacts.clone()].iter().zip(&self.touching[contacts]);
        let wrong =
            gates.map(|(overlap, touching)| u32::from(overlap * (2.0 * touching - 1.0) < 0.0));
        wrong.sum::<u32>() > 0
    }

    /// Largest overlaps, where a law asks for them.
    fn memory(&mut self, system: &System, state: &WaveState, contacts: Range<usize>) {
        if !system.has_memory {
            return;
        }
        for c in contacts {
            self.largest[c] = state.largest[c].max(self.overlap[c]);
        }
    }

    /// Closed ⇔ δ > 0, or δ = 0 and approaching.
    fn look_at_gates(&mut self, contacts: Range<usize>) {
        for c in contacts {
            let closed = self.signed_overlap[c] > FLUSH
                || (self.signed_overlap[c] >= 0.0 && self.rate[c] > 0.0);
            self.passing[c] = f64::from(u8::from(closed));
            self.touching[c] = self.passing[c];
        }
    }

    /// Sums of the terms; those that act across gaps apart.
    fn add_terms(&mut self, system: &System, contacts: Range<usize>) {
        self.closed_force[contacts.clone()].fill(0.0);
        self.across[contacts.clone()].fill(0.0);
        if system.has_states {
            for c in contacts.clone() {
                match self.touching[c] > 0.0 {
                    true => self.closed_force[c] = self.of_states[c],
                    false => self.across[c] = self.of_states[c],
                }
            }
        }
        for section in system.sections.iter() {
            let part =
                section.contacts.start.max(contacts.start)..section.contacts.end.min(contacts.end);
            if part.is_empty() {
                continue;
            }
            let first = part.start - section.contacts.start;
            let seen = Contacts {
                overlap: &self.overlap[part.clone()],
                root: &self.root[part.clone()],
                rate: &self.rate[part.clone()],
                largest: &self.largest[part.clone()],
            };
            for term in &section.gated {
                let force = &mut self.closed_force[part.clone()];
                term.law.add_forces(self.set, &term.columns, first, seen, force);
            }
            for term in &section.ungated {
                let force = &mut self.across[part.clone()];
                term.law.add_forces(self.set, &term.columns, first, seen, force);
            }
        }
    }

    /// Gates and cuts the sums, and takes the static force away.
    #[inline(always)]
    fn subtract_static(&mut self, system: &System, contacts: Range<usize>, gates: Gates) {
        let n = contacts.len();
        let dynamic = &mut self.dynamic[contacts.start + 1..=contacts.end][..n];
        let closed = &self.closed_force[contacts.clone()][..n];
        let across = &self.across[contacts.clone()][..n];
        let passing = &self.passing[contacts.clone()][..n];
        let rest = &system.static_force_n[contacts.clone()][..n];
        match system.tension {
            Tension::Allowed => {
                for c in 0..n {
                    dynamic[c] = passing[c] * closed[c] + across[c] - rest[c];
                }
            }
            Tension::Clipped => {
                let touching = &self.touching[contacts][..n];
                for c in 0..n {
                    // A frozen closed gate keeps its smooth force until the
                    // step has been ended where that force passes 0.
                    let smooth = gates == Gates::Frozen && passing[c] > 0.0;
                    let cut = touching[c] > passing[c];
                    let force = passing[c] * closed[c] + across[c];
                    let least = if smooth { f64::NEG_INFINITY } else { 0.0 };
                    let force = if cut { 0.0 } else { force.max(least) };
                    dynamic[c] = force - rest[c];
                }
            }
        }
    }

    /// Adds what liquid bridges pull, which is never cut.
    fn add_bridges(&mut self, system: &System, state: &WaveState, contacts: Range<usize>) {
        if system.bridged.is_empty() {
            return;
        }
        for c in contacts {
            self.pull[c] =
                if state.bridged[c] { system.pull_n(c, self.signed_overlap[c]) } else { 0.0 };
            self.dynamic[c + 1] += self.pull[c];
        }
    }

    /// Newton's second law for the bodies of a window.
    #[inline(always)]
    fn push_bodies(&mut self, system: &System, bodies: Range<usize>, x: &[f64], a: &mut [f64]) {
        self.dynamic[bodies.start] = 0.0;
        self.dynamic[bodies.end] = 0.0;
        let last = system.bodies() - 1;
        if system.periodic {
            self.dynamic[1] = self.dynamic[last];
        }
        let (left, right) =
            (&self.dynamic[bodies.clone()], &self.dynamic[bodies.start + 1..=bodies.end]);
        let inverse_mass = &system.inverse_mass[bodies.clone()];
        let out = &mut a[bodies.clone()];
        for i in 0..out.len() {
            out[i] = (left[i] - right[i]) * inverse_mass[i];
        }
        push_ends(system, bodies, x, a);
        if system.periodic {
            a[last] = a[1];
        }
    }
}

fn push_ends(system: &System, bodies: Range<usize>, x: &[f64], a: &mut [f64]) {
    let last = if system.pendulum_per_s2 > 0.0 { bodies.end } else { 2 };
    for i in bodies.start..bodies.end.min(last) {
        a[i] += system.pushed(i, x[i]);
    }
}
