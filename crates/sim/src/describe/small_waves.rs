//! Linear waves and normal modes under the static load, in numbers.

use super::Group;
use super::rest::{is_dimer, is_uniform};
use hertzchain_chain::theory::linear::{Dimer, Ends, UniformChain, normal_modes};
use hertzchain_chain::{Chain, FarEnd, Push, Start, System};
use std::f64::consts::{PI, TAU};

/// Modes of longer chains take seconds and add nothing to the dispersion.
const MOST_BEADS: usize = 200;

/// Modes shown from each end of the spectrum.
const SHOWN: usize = 3;

/// Quarters of the Brillouin zone at which the dispersion is given.
const QUARTERS: [(f64, &str); 4] = [(0.25, "π/4"), (0.5, "π/2"), (0.75, "3π/4"), (1.0, "π")];

/// ω(k) of a uniform chain or of both branches of a dimer, from the contact
/// in the middle.
pub(super) fn dispersion(chain: &Chain, system: &System) -> Option<Group> {
    let beads = &chain.beads;
    let middle = (beads.len() / 2).max(1);
    let stiffness = |c: usize| system.static_contact(c).stiffness_n_m;
    let pair = [stiffness(middle), stiffness((middle + 1).min(beads.len()))];
    if beads.len() < 2 || pair.iter().any(|k| *k <= 0.0) {
        return None;
    }
    let mut group = Group::new("Dispersion in the middle of the chain: frequency at wavenumber");
    let mut add = |name: String, rad_s: f64| group.number(name, rad_s / TAU, "Hz");
    if is_uniform(beads) {
        let row = UniformChain { mass_kg: beads[0].mass_kg, contact_stiffness_n_m: pair[0] };
        for (part, name) in QUARTERS {
            add(format!("{name} per bead"), row.angular_frequency_rad_s(part * PI));
        }
    } else if is_dimer(beads) {
        let masses_kg = [beads[middle - 1].mass_kg, beads[middle].mass_kg];
        let cell = Dimer { masses_kg, contact_stiffnesses_n_m: pair };
        for (part, name) in QUARTERS {
            let (acoustic, optical) = cell.branches_rad_s(part * PI);
            add(format!("{name} per cell, acoustic"), acoustic);
            add(format!("{name} per cell, optical"), optical);
        }
    }
    (!group.rows.is_empty()).then_some(group)
}

/// Lowest and highest frequencies of the chain as a whole; `None` when a
/// contact carries no load, for then it is no spring.
pub(super) fn modes(chain: &Chain, system: &System) -> Option<Group> {
    let (ends, masses, stiffnesses) = springs(chain, system);
    let mut group = Group::new("Normal modes of the chain under its static load");
    if chain.beads.len() > MOST_BEADS {
        let springs = stiffnesses.iter().all(|k| *k > 0.0);
        group.text("modes", format!("not computed for more than {MOST_BEADS} beads"));
        return springs.then_some(group);
    }
    // Threads add g/L to the squares of all frequencies where all bodies hang.
    let swing_rad_s = chain.suspension_m.map_or(0.0, |m| (chain.gravity_m_s2 / m).sqrt());
    if swing_rad_s > 0.0 && masses.len() > chain.beads.len() {
        group.text("modes", "not computed for threads beside a stop of finite mass");
        return Some(group);
    }
    let modes = normal_modes(&masses, &stiffnesses, ends).ok()?;
    let modes = modes.into_iter().map(|mode| mode.angular_frequency_rad_s.hypot(swing_rad_s));
    let modes: Vec<f64> = modes.collect();
    let highest_rad_s = *modes.last()?;
    let shown = |i: usize| i < SHOWN || i + SHOWN >= modes.len();
    for (i, mode) in modes.iter().enumerate().filter(|(i, _)| shown(*i)) {
        let name = format!("mode {} of {}", i + 1, modes.len());
        match *mode {
            shift if shift <= SHIFT * highest_rad_s => group.text(name, "a shift of all bodies"),
            rad_s => group.number(name, rad_s / TAU, "Hz"),
        }
    }
    Some(group)
}

/// Frequencies below this share of the highest are 0 but for rounding.
const SHIFT: f64 = 1e-10;

/// What holds the ends, the bodies' masses in kg, and the springs between them in N/m. A striker leans
/// on nothing, a stop of finite mass is a body, and a spring that pushes is one to a fixed end, of no
/// stiffness if it does not push at rest, for it never pulls.
fn springs(chain: &Chain, system: &System) -> (Ends, Vec<f64>, Vec<f64>) {
    let last = chain.beads.len();
    let mut masses: Vec<f64> = chain.beads.iter().map(|bead| bead.mass_kg).collect();
    let driven = matches!(chain.start, Start::Driven { .. });
    let (far_is_fixed, last_contact) = match chain.far {
        FarEnd::Free => (false, last - 1),
        FarEnd::Stop { mass_kg, .. } | FarEnd::PlaneStop { mass_kg, .. } => {
            masses.push(mass_kg);
            (false, last)
        }
        FarEnd::HalfBead { .. } | FarEnd::Plane { .. } => (true, last),
        FarEnd::Periodic { .. } => (false, last),
    };
    let near = match (driven, chain.push) {
        (true, _) => Some(system.static_contact(0).stiffness_n_m),
        (false, Push::Spring { stiffness_n_m, force_n }) => {
            Some(if force_n > 0.0 { stiffness_n_m } else { 0.0 })
        }
        (false, Push::None | Push::Constant { .. }) => None,
    };
    let contacts = (1..=last_contact).map(|contact| system.static_contact(contact).stiffness_n_m);
    let ends = match (&chain.far, near.is_some(), far_is_fixed) {
        (FarEnd::Periodic { .. }, ..) => Ends::Periodic,
        (_, false, false) => Ends::FreeFree,
        (_, false, true) => Ends::FreeFixed,
        (_, true, false) => Ends::FixedFree,
        (_, true, true) => Ends::FixedFixed,
    };
    (ends, masses, near.into_iter().chain(contacts).collect())
}
