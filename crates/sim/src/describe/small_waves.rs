//! Linear waves and normal modes under the static load, in numbers.

use super::Group;
use hertzchain_chain::theory::linear::{Dimer, Ends, Mode, UniformChain, normal_modes};
use hertzchain_chain::{Bead, Chain, FarEnd, Start, System};
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
    if beads.windows(2).all(|two| two[0] == two[1]) {
        let row = UniformChain { mass_kg: beads[0].mass_kg, contact_stiffness_n_m: pair[0] };
        return Some(uniform(&row));
    }
    let alternate = beads.len() >= 4 && beads.windows(3).all(|three| three[0] == three[2]);
    alternate.then(|| dimer(&beads[middle - 1], &beads[middle], pair))
}

fn uniform(row: &UniformChain) -> Group {
    let mut group = Group::new("Dispersion in the middle of the chain: frequency at wavenumber");
    for (part, name) in QUARTERS {
        let frequency_hz = row.angular_frequency_rad_s(part * PI) / TAU;
        group.number(format!("{name} per bead"), frequency_hz, "Hz");
    }
    group
}

fn dimer(first: &Bead, second: &Bead, contact_stiffnesses_n_m: [f64; 2]) -> Group {
    let masses_kg = [first.mass_kg, second.mass_kg];
    let cell = Dimer { masses_kg, contact_stiffnesses_n_m };
    let mut group = Group::new("Dispersion in the middle of the chain: frequency at wavenumber");
    for (part, name) in QUARTERS {
        let (acoustic, optical) = cell.branches_rad_s(part * PI);
        group.number(format!("{name} per cell, acoustic"), acoustic / TAU, "Hz");
        group.number(format!("{name} per cell, optical"), optical / TAU, "Hz");
    }
    group
}

/// Lowest and highest frequencies of the chain as a whole; `None` when a
/// contact carries no load, for then it is no spring.
pub(super) fn modes(chain: &Chain, system: &System) -> Option<Group> {
    let (ends, contacts) = ends(chain);
    let masses: Vec<f64> = chain.beads.iter().map(|bead| bead.mass_kg).collect();
    let stiffnesses: Vec<f64> = contacts.map(|c| system.static_contact(c).stiffness_n_m).collect();
    let mut group = Group::new("Normal modes of the chain under its static load");
    if masses.len() > MOST_BEADS {
        let springs = stiffnesses.iter().all(|k| *k > 0.0);
        group.text("modes", format!("not computed for more than {MOST_BEADS} beads"));
        return springs.then_some(group);
    }
    let modes = normal_modes(&masses, &stiffnesses, ends).ok()?;
    let shown = |i: usize| i < SHOWN || i + SHOWN >= modes.len();
    for (i, mode) in modes.iter().enumerate().filter(|(i, _)| shown(*i)) {
        group.number(format!("mode {} of {}", i + 1, modes.len()), hertz(mode), "Hz");
    }
    Some(group)
}

fn hertz(mode: &Mode) -> f64 {
    mode.angular_frequency_rad_s / TAU
}

/// What holds the ends, and the contacts that are springs then. A striker
/// leans on nothing; a finite stop counts as fixed.
fn ends(chain: &Chain) -> (Ends, std::ops::RangeInclusive<usize>) {
    let last = chain.beads.len();
    let driven = matches!(chain.start, Start::Driven { .. });
    match (&chain.far, driven) {
        (FarEnd::Periodic { .. }, _) => (Ends::Periodic, 1..=last),
        (FarEnd::Free, false) => (Ends::FreeFree, 1..=last - 1),
        (FarEnd::Free, true) => (Ends::FixedFree, 0..=last - 1),
        (_, false) => (Ends::FreeFixed, 1..=last),
        (_, true) => (Ends::FixedFixed, 0..=last),
    }
}
