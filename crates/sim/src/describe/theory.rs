//! What theory expects of a chain's large pulses.

use super::Group;
use super::contact;
use super::rest::{is_dimer, is_uniform};
use crate::error::StudyError;
use crate::plan::Plan;
use crate::shot::shoot;
use hertzchain_chain::laws::{Law, Nature};
use hertzchain_chain::theory::long_wave::{LongWave, LongWaveForm, preloaded_speed_beads_s};
use hertzchain_chain::theory::solitary::{SolitaryShape, SolitaryWave};
use hertzchain_chain::theory::two_body::{
    ContactEnd, ElasticCollision, ViscoelasticCollision, restitution_by_series,
};
use hertzchain_chain::{Bead, Chain, FarEnd, Push, Section, Start, System, Tension};
use hertzchain_experiment::Experiment;
use std::sync::Arc;

/// Fixed steps per contact time that give classical Runge–Kutta times of
/// flight to about 1e-6 in the paper's chain.
const STEPS: f64 = 50.0;

/// Exponent of the contacts whose viscoelastic losses are known in closed form.
const HERTZ: f64 = 1.5;

pub(super) fn scales(system: &System) -> Group {
    let mut group = Group::new("Time scales");
    let scales = system.scales();
    group.number("characteristic speed", scales.speed_m_s, "m/s");
    group.number("contact time (overlap over speed)", scales.time_s, "s");
    group.number("recommended step for fixed-step codes", scales.time_s / STEPS, "s");
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

/// The striker against bead 1 by the elastic term of contact 0.
fn impact(chain: &Chain) -> Option<ElasticCollision> {
    let (stiffness, exponent) = contact::elastic(chain, 0)?;
    let (_, speed_m_s) = striker(chain)?;
    let reduced_mass_kg = chain.pair(0)?.mass_kg;
    Some(ElasticCollision { exponent, stiffness, reduced_mass_kg, speed_m_s })
}

pub(super) fn collision(chain: &Chain) -> Option<Group> {
    let hit = impact(chain)?;
    let mut group = Group::new("Striker against bead 1 alone, without losses");
    group.number("contact time", hit.contact_time_s(), "s");
    group.number("largest overlap", hit.largest_overlap_m(), "m");
    group.number("largest force", hit.largest_force_n(), "N");
    Some(group)
}

/// Shares below this are rounding.
const ROUNDING: f64 = 1e-12;

/// Restitution of the striker and bead 1 alone, under the laws of contact 0:
/// integrated, and by theory where they are elastic and viscoelastic.
pub(super) fn restitution(chain: &Chain) -> Result<Option<Group>, StudyError> {
    let (Some((_, speed_m_s)), Some(laws)) = (striker(chain), contact::section(chain, 0)) else {
        return Ok(None);
    };
    let mut group = Group::new("Restitution of the striker and bead 1 alone");
    let pair = Chain {
        beads: chain.beads[..1].to_vec(),
        initial: Vec::new(),
        push: Push::None,
        far: FarEnd::Free,
        sections: vec![Section { contacts: 0..=1, ..laws.clone() }],
        gaps: Vec::new(),
        incline_rad: 0.0,
        suspension_m: None,
        ..chain.clone()
    };
    let elastic = |law: &Arc<dyn Law>| law.info().nature == Nature::Elastic;
    let name = "with all laws of contact 0";
    // What is stored comes back.
    match laws.laws.iter().all(elastic) {
        true => group.number(name, 1.0, ""),
        false => match parting_speed_m_s(pair)? {
            Some(speed) if speed > ROUNDING * speed_m_s => {
                group.number(name, speed / speed_m_s, "");
            }
            Some(_) => group.text(name, "none: losses stop them before they part"),
            None => {
                group.text(name, "none: forces still act across the gap long after the collision")
            }
        },
    }
    if let Some(collision) = viscoelastic(chain) {
        let x = collision.parameter();
        let end = match chain.tension {
            Tension::Allowed => ContactEnd::ZeroOverlap,
            Tension::Clipped => ContactEnd::ZeroForce,
        };
        if let Ok(rebound) = collision.rebound(end) {
            group.number("elastic and viscoelastic terms, exact", rebound.restitution, "");
        }
        if end == ContactEnd::ZeroOverlap {
            let series = restitution_by_series(collision.elastic.exponent, x);
            group.number("elastic and viscoelastic terms, series to x²", series, "");
        }
        group.number("its parameter x = (3/2) A (K/m*)^{2/5} v^{1/5}", x, "");
    }
    Ok(Some(group))
}

/// Speed in m/s at which two balls part; `None` where forces across their gap act on and on.
fn parting_speed_m_s(pair: Chain) -> Result<Option<f64>, StudyError> {
    /// Most shots, each twice as long as the one before.
    const MOST: usize = 10;
    /// A speed that changes by a smaller share in twice the time is final.
    const FINAL: f64 = 1e-8;
    /// A pair that takes more steps is held together, by a bridge, and hits itself again and again.
    const MOST_STEPS: u64 = 50_000;
    let mut plan = Plan::new(pair, 1).with_accuracy(1e-9);
    let mut before = f64::INFINITY;
    for _ in 0..MOST {
        let shot = shoot(&plan)?;
        let speed_m_s = shot.velocity_m_s[1] - shot.velocity_m_s[0];
        if (speed_m_s - before).abs() < FINAL * speed_m_s.abs() {
            return Ok(Some(speed_m_s));
        }
        if shot.work.steps > MOST_STEPS {
            break;
        }
        before = speed_m_s;
        plan.duration_s = Some(2.0 * shot.duration_s);
    }
    Ok(None)
}

/// The striker's collision by its Hertz and viscoelastic terms.
fn viscoelastic(chain: &Chain) -> Option<ViscoelasticCollision> {
    let elastic = impact(chain).filter(|elastic| elastic.exponent == HERTZ)?;
    let damped = contact::section(chain, 0)?
        .laws
        .iter()
        .find(|law| law.info().name == "damping_viscoelastic")?;
    let &[damping] = damped.coefficients(&chain.pair(0)?).ok()?.as_slice() else {
        return None;
    };
    let damping_time_s = damping / (HERTZ * elastic.stiffness);
    Some(ViscoelasticCollision { elastic, damping_time_s })
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
    let title = "Exact solitary wave of a long, unloaded row of beads and contacts like the middle ones, with the striker's energy";
    let mut group = Group::new(title);
    with_wave(chain, |wave, bead| {
        let speed = wave.speed_beads_s();
        group.number("speed", speed, "beads/s");
        group.number("speed along the row", speed * 2.0 * bead.radius_m, "m/s");
        group.number("largest bead speed", wave.peak_bead_speed_m_s(), "m/s");
        group.number("peak contact force", wave.peak_force_n(), "N");
        group.number("peak of a bead sensor", wave.peak_sensor_force_n(), "N");
        group.number("peak overlap", wave.peak_overlap_m(), "m");
        let width = wave.force_width_s();
        group.number("full width at half maximum of a contact's force, in time", width, "s");
        group.number(
            "full width at half maximum of a contact's force, in beads",
            width * speed,
            "beads",
        );
        group.number("energy", wave.energy_j(), "J");
        group.number("momentum", wave.momentum_kg_m_s(), "kg m/s");
        group.number("shift of every bead", wave.shift_m(), "m");
    })?;
    Some(group)
}

/// The wave's shape: contact force and bead velocity at distances from its centre.
pub(super) fn profile(chain: &Chain) -> Option<Group> {
    let mut group =
        Group::new("Its profile: contact force and bead speed at a distance from the centre");
    with_wave(chain, |wave, _| {
        for half_beads in 0..=6 {
            let distance = 0.5 * f64::from(half_beads);
            let mut row = |name: &str, value: f64, most: f64, unit: &str| {
                let name = format!("{name} at {distance} beads");
                match value.abs() > ROUNDING * most {
                    true => group.number(name, value, unit),
                    false => group.text(name, format!("below {ROUNDING:e} of its peak")),
                }
            };
            row("force", wave.force_n(distance), wave.peak_force_n(), "N");
            row("bead speed", wave.bead_speed_m_s(distance), wave.peak_bead_speed_m_s(), "m/s");
        }
    })?;
    Some(group)
}

pub(super) fn long_wave(chain: &Chain) -> Option<Group> {
    let (stiffness, exponent, bead) = middle(chain)?;
    let theory = LongWave { form: LongWaveForm::Displacement, exponent };
    let overlap = with_wave(chain, |wave, _| wave.peak_overlap_m())?;
    let mut group = Group::new("Long-wave theory (Nesterenko) at the same peak overlap");
    let speed = theory.speed_beads_s(stiffness, bead.mass_kg, overlap);
    group.number("speed", speed, "beads/s");
    group.number("length", theory.length_beads(), "beads");
    let width = theory.force_width_beads();
    group.number("full width at half maximum of a contact's force", width, "beads");
    Some(group)
}

/// What large pulses theory knows of in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Waves {
    /// Equal beads that just touch: the exact solitary wave and the long one.
    Touching,
    /// Equal beads under load: long waves on top of the static overlap.
    Loaded,
    /// Two kinds of beads by turns that just touch: long waves.
    Dimer,
    /// None, and why.
    None(&'static str),
}

/// What theory knows of a chain's large pulses.
pub(super) fn waves(chain: &Chain, system: &System) -> Waves {
    let beads = &chain.beads;
    let inner = 1..beads.len();
    let overlap = |c: usize| system.static_contact(c).overlap_m;
    let loaded = inner.clone().filter(|c| overlap(*c) > 0.0).count();
    if inner.clone().any(|c| overlap(c) < 0.0) {
        return Waves::None("there are gaps between the beads, which a pulse has to close first");
    }
    match (is_uniform(beads), is_dimer(beads), loaded) {
        (true, _, 0) => Waves::Touching,
        (true, _, all) if all == inner.len() => Waves::Loaded,
        (false, true, 0) => Waves::Dimer,
        (_, _, 0) => Waves::None("the beads are neither equal nor two kinds by turns"),
        (true, _, _) => Waves::None("only some of the contacts are under load"),
        (false, ..) => {
            Waves::None("the beads are unlike and under load: only small waves are known")
        }
    }
}

/// A line in place of waves that theory does not know.
pub(super) fn no_waves(reason: &str) -> Group {
    let mut group = Group::new("Solitary waves");
    group.text("no theory for this row", reason);
    group
}

/// Peak forces, over the static elastic force, at which a loaded row's speeds are given.
const OVER_STATIC: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// Long-wave solitary waves on the static load of the middle contact.
pub(super) fn loaded(chain: &Chain, system: &System) -> Option<Group> {
    let (stiffness, exponent, bead) = middle(chain)?;
    let rest = system.static_contact((chain.beads.len() / 2).max(1));
    let title =
        "Solitary wave on the static load in the middle of the chain (long waves, Nesterenko)";
    let mut group = Group::new(title);
    for excess in OVER_STATIC {
        let peak_m = (1.0 + excess).powf(exponent.recip()) * rest.overlap_m;
        let speed =
            preloaded_speed_beads_s(exponent, stiffness, bead.mass_kg, rest.overlap_m, peak_m);
        let name = format!("speed, dynamic peak force {excess} times the static elastic one");
        group.number(name, speed, "beads/s");
    }
    group.text("exact lattice wave", "not computed: known here for rows without load");
    Some(group)
}

/// A striker whose mass is that of a bead within this factor hands on nearly all of
/// its energy in one pulse.
const SIMILAR: f64 = 1.1;

/// Time of flight that theory expects of a row of equal beads that just touch:
/// under load pulses run at the speed of sound or faster, gaps delay them.
pub(super) fn expected(experiment: &Experiment, chain: &Chain, system: &System) -> Option<Group> {
    let gap_at_wall = system.static_contact(chain.beads.len()).overlap_m < 0.0;
    // The middle's wave is that of the whole way only where contacts are alike.
    let way = experiment.sensor_bead()..chain.beads.len();
    let mut contacts = way.map(|c| contact::elastic(chain, c));
    let first = contacts.next()?;
    let touching = waves(chain, system) == Waves::Touching && !gap_at_wall;
    if !touching || !experiment.has_wall() || contacts.any(|other| other != first) {
        return None;
    }
    let beads = (chain.beads.len() - experiment.sensor_bead()) as f64 + 0.5;
    let mut group = Group::new("Expected of theory, without losses or a train of waves");
    let masses = striker(chain)?.0.mass_kg / chain.beads.first()?.mass_kg;
    if !(SIMILAR.recip()..=SIMILAR).contains(&masses) {
        let why = "not estimated: a striker much lighter or heavier than a bead makes more than one pulse or rebounds";
        group.text("incident time of flight", why);
        return Some(group);
    }
    with_wave(chain, |wave, _| {
        group.number("incident time of flight, about", wave.time_of_flight_s(beads), "s");
        group.number("peak of the sensor bead, about", wave.peak_sensor_force_n(), "N");
    })?;
    Some(group)
}
