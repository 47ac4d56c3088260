//! The chain at rest and its small waves.

use super::Group;
use hertzchain_chain::theory::linear::{Dimer, UniformChain};
use hertzchain_chain::{Bead, Chain, System};

pub(super) fn at_rest(chain: &Chain, system: &System) -> Group {
    let mut group = Group::new("At rest");
    let last = chain.beads.len();
    let overlaps: Vec<f64> = (0..=last).map(|c| system.static_contact(c).overlap_m).collect();
    let loaded = overlaps.iter().filter(|overlap| **overlap > 0.0).count();
    if loaded == 0 {
        group.text("static overlaps", "none: contacts just touch or are open");
    } else {
        for contact in [1, last] {
            let rest = system.static_contact(contact);
            group.number(format!("static force of contact {contact}"), rest.force_n, "N");
            group.number(format!("static overlap of contact {contact}"), rest.overlap_m, "m");
        }
        let largest = overlaps.iter().copied().fold(0.0, f64::max);
        group.number("largest static overlap", largest, "m");
        let contacts = (0..=last).filter(|&contact| chain.pair(contact).is_some()).count();
        group.count(format!("contacts under load, of {contacts}"), loaded);
    }
    let open = overlaps.iter().filter(|gap| **gap < 0.0 && gap.is_finite());
    let gaps: Vec<f64> = open.map(|gap| -gap).collect();
    group.spread("gaps", &gaps, "m");
    group
}

/// Sound speed and cutoff under load; `None` when nothing is loaded.
pub(super) fn linear_waves(chain: &Chain, system: &System) -> Option<Group> {
    let mut group = Group::new("Small waves under the static load");
    let beads = &chain.beads;
    let middle = (beads.len() / 2).max(1);
    let stiffness = |contact: usize| system.static_contact(contact).stiffness_n_m;
    let inner = 1..beads.len();
    if inner.is_empty() || inner.clone().any(|c| stiffness(c) <= 0.0) {
        return None;
    }
    let bead = beads.get(middle - 1)?;
    if is_uniform(beads) {
        for contact in ends(1, beads.len() - 1) {
            let row =
                UniformChain { mass_kg: bead.mass_kg, contact_stiffness_n_m: stiffness(contact) };
            let at = format!("at contact {contact}");
            let speed = row.sound_speed_beads_s();
            group.number(format!("sound speed {at}"), speed, "beads/s");
            group.number(
                format!("sound speed {at}, along the row"),
                speed * 2.0 * bead.radius_m,
                "m/s",
            );
            group.number(format!("cutoff frequency {at}"), row.cutoff_frequency_hz(), "Hz");
        }
    } else if is_dimer(beads) {
        dimer(&mut group, beads, [stiffness(middle), stiffness((middle + 1).min(beads.len()))]);
    } else {
        let mass_kg = beads.iter().map(|bead| bead.mass_kg).sum::<f64>() / beads.len() as f64;
        let compliances = inner.clone().map(|c| stiffness(c).recip());
        let compliance_m_n = compliances.sum::<f64>() / inner.len() as f64;
        let speed = (mass_kg * compliance_m_n).sqrt().recip();
        group.number("sound speed, by mean mass and mean compliance", speed, "beads/s");
    }
    Some(group)
}

/// First and last, once if they are the same.
fn ends(first: usize, last: usize) -> Vec<usize> {
    if first >= last { vec![first] } else { vec![first, last] }
}

pub(super) fn is_uniform(beads: &[Bead]) -> bool {
    beads.windows(2).all(|pair| pair[0] == pair[1])
}

pub(super) fn is_dimer(beads: &[Bead]) -> bool {
    beads.len() >= 4 && beads.windows(3).all(|three| three[0] == three[2])
}

fn dimer(group: &mut Group, beads: &[Bead], contact_stiffnesses_n_m: [f64; 2]) {
    let cell = Dimer { masses_kg: [beads[0].mass_kg, beads[1].mass_kg], contact_stiffnesses_n_m };
    let edges = cell.band_edges();
    group.number("sound speed in the middle", cell.sound_speed_cells_s(), "cells/s");
    group.number("band gap from", edges.acoustic_top_hz, "Hz");
    group.number("band gap to", edges.optical_bottom_hz, "Hz");
    group.number("cutoff frequency", edges.optical_top_hz, "Hz");
}
