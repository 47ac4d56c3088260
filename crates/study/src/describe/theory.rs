//! What theory expects of a chain's large pulses.

use super::Group;
use super::contact;
use hertzchain_chain::theory::long_wave::{LongWave, LongWaveForm};
use hertzchain_chain::theory::solitary::{SolitaryShape, SolitaryWave};
use hertzchain_chain::theory::two_body::ElasticCollision;
use hertzchain_chain::{Bead, Chain, Start, System};
use hertzchain_experiment::Experiment;

/// Fixed steps per contact time that give classical Runge–Kutta times of
/// flight to about 1e-4 in the paper's chain.
const STEPS: f64 = 50.0;

pub(super) fn scales(system: &System) -> Group {
    let mut group = Group::new("Time scales");
    let scales = system.scales();
    group.number("characteristic speed", scales.speed_m_s, "m/s");
    group.number("contact time (overlap over speed)", scales.time_s, "s");
    group.number(
        "recommended step for fixed-step codes",
        scales.time_s / STEPS,
        "s",
    );
    group
}

/// The middle of a chain: stiffness, exponent, bead. `None` where the contact
/// is not one elastic power law.
fn middle(chain: &Chain) -> Option<(f64, f64, &Bead)> {
    let middle = (chain.beads.len() / 2).max(1);
    let (stiffness, exponent) = contact::elastic(chain, middle)?;
    Some((stiffness, exponent, chain.beads.get(middle - 1)?))
}

fn striker(chain: &Chain) -> Option<(&Bead, f64)> {
    match &chain.start {
        Start::Striker { bead, speed_m_s } => Some((bead, *speed_m_s)),
        Start::Driven { .. } | Start::Free => None,
    }
}

pub(super) fn collision(chain: &Chain) -> Option<Group> {
    let (stiffness, exponent) = contact::elastic(chain, 0)?;
    let (_, speed_m_s) = striker(chain)?;
    let hit = ElasticCollision {
        exponent,
        stiffness,
        reduced_mass_kg: contact::pair(chain, 0)?.mass_kg,
        speed_m_s,
    };
    let mut group = Group::new("Striker against bead 1 alone, without losses");
    group.number("contact time", hit.contact_time_s(), "s");
    group.number("largest overlap", hit.largest_overlap_m(), "m");
    group.number("largest force", hit.largest_force_n(), "N");
    Some(group)
}

/// Calls with the solitary wave that carries the striker's whole energy.
fn with_wave<T>(chain: &Chain, call: impl FnOnce(&SolitaryWave<'_>, &Bead) -> T) -> Option<T> {
    let (stiffness, exponent, bead) = middle(chain)?;
    let (ball, speed_m_s) = striker(chain)?;
    let shape = SolitaryShape::new(exponent).ok()?;
    let energy_j = 0.5 * ball.mass_kg * speed_m_s * speed_m_s;
    let wave = SolitaryWave::from_energy(&shape, stiffness, bead.mass_kg, energy_j).ok()?;
    Some(call(&wave, bead))
}

pub(super) fn solitary(chain: &Chain) -> Option<Group> {
    let title = "Exact lattice solitary wave with the striker's whole energy, without losses";
    let mut group = Group::new(title);
    with_wave(chain, |wave, bead| {
        let speed = wave.speed_beads_s();
        group.number("speed", speed, "beads/s");
        group.number("speed", speed * 2.0 * bead.radius_m, "m/s");
        group.number("largest bead speed", wave.peak_bead_speed_m_s(), "m/s");
        group.number("peak contact force", wave.peak_force_n(), "N");
        group.number("peak of a bead sensor", wave.peak_sensor_force_n(), "N");
        group.number("peak overlap", wave.peak_overlap_m(), "m");
        let width = wave.force_width_s();
        group.number(
            "full width at half maximum of a contact's force",
            width,
            "s",
        );
        group.number(
            "full width at half maximum of a contact's force",
            width * speed,
            "beads",
        );
        group.number("energy", wave.energy_j(), "J");
        group.number("momentum", wave.momentum_kg_m_s(), "kg m/s");
        group.number("shift of every bead", wave.shift_m(), "m");
    })?;
    Some(group)
}

pub(super) fn long_wave(chain: &Chain) -> Option<Group> {
    let (stiffness, exponent, bead) = middle(chain)?;
    let theory = LongWave {
        form: LongWaveForm::Displacement,
        exponent,
    };
    let overlap = with_wave(chain, |wave, _| wave.peak_overlap_m())?;
    let mut group = Group::new("Long-wave theory (Nesterenko) at the same peak overlap");
    let speed = theory.speed_beads_s(stiffness, bead.mass_kg, overlap);
    group.number("speed", speed, "beads/s");
    group.number("length", theory.length_beads(), "beads");
    let width = theory.force_width_beads();
    group.number(
        "full width at half maximum of a contact's force",
        width,
        "beads",
    );
    Some(group)
}

/// Time of flight that theory expects of a row of equal beads.
pub(super) fn expected(experiment: &Experiment, chain: &Chain) -> Option<Group> {
    let equal = chain.beads.windows(2).all(|pair| pair[0] == pair[1]);
    if !equal || !experiment.has_wall() {
        return None;
    }
    let beads = (chain.beads.len() - experiment.sensor_bead()) as f64 + 0.5;
    let mut group = Group::new("Expected of theory, without losses, preload or a train of waves");
    with_wave(chain, |wave, _| {
        group.number(
            "incident time of flight, about",
            wave.time_of_flight_s(beads),
            "s",
        );
        group.number(
            "peak of the sensor bead, about",
            wave.peak_sensor_force_n(),
            "N",
        );
    })?;
    Some(group)
}
