//! From a chain to columns, with every value checked on the way.

use super::check::{check_values, contact_exists};
use super::scales::{kinds, scales};
use super::statics::{elastic_force, static_overlap};
use super::{Scales, SectionColumns, Spring, System, TermColumns};
use crate::chain::{Chain, ChainError, FarEnd, Push, Section, Start};
use crate::laws::{Columns, Law, Nature};
use crate::material::BeadPair;
use std::ops::Range;
use std::sync::Arc;

pub(super) fn assemble(chain: &Chain) -> Result<System, ChainError> {
    check_values(chain)?;
    let pairs: Vec<Option<BeadPair>> = (0..=chain.beads.len()).map(|c| chain.pair(c)).collect();
    let (sections, section_of) = sections(chain, &pairs)?;
    let mut system = at_rest(chain, sections, section_of);
    let has = |nature| {
        let mut terms = system.sections.iter().flat_map(SectionColumns::terms);
        terms.any(|term| term.law.info().nature == nature)
    };
    (system.has_memory, system.has_states) = (has(Nature::ElasticPlastic), has(Nature::WithState));
    if system.sections.iter().any(|section| section.bridge.is_some()) {
        // The striker has not touched bead 1 yet.
        system.bridged = (0..=chain.beads.len()).map(|c| c > 0 || !system.has_striker).collect();
    }
    system.inverse_mass = system.mass_kg.iter().map(|mass| mass.recip()).collect();
    settle(chain, &pairs, &mut system)?;
    set_in_motion(chain, &mut system);
    system.kinds = kinds(&system, &pairs).into();
    system.scales = scales(&system, &system.kinds);
    Ok(system)
}

/// A chain's columns before its equilibrium and motion are known.
fn at_rest(chain: &Chain, sections: Vec<SectionColumns>, section_of: Vec<u32>) -> System {
    let driven = matches!(chain.start, Start::Driven { .. });
    System {
        mass_kg: masses(chain).into(),
        inverse_mass: Arc::default(),
        offset_m: vec![f64::NEG_INFINITY; chain.beads.len() + 1].into(),
        static_force_n: vec![0.0; chain.beads.len() + 1].into(),
        sections: sections.into(),
        section_of: section_of.into(),
        tension: chain.tension,
        // A driven end carries the push itself.
        spring: spring(&chain.push).filter(|_| !driven),
        push_n: if driven { 0.0 } else { chain.push.force_n() },
        slope_m_s2: chain.gravity_m_s2 * chain.incline_rad.sin(),
        // Threads carry what hangs.
        normal_m_s2: match chain.suspension_m {
            None => chain.gravity_m_s2 * chain.incline_rad.cos(),
            Some(_) => 0.0,
        },
        pendulum_per_s2: chain.suspension_m.map_or(0.0, |length| chain.gravity_m_s2 / length),
        motion: match &chain.start {
            Start::Driven { motion, .. } => Some(motion.clone()),
            _ => None,
        },
        periodic: matches!(chain.far, FarEnd::Periodic { .. }),
        has_striker: matches!(chain.start, Start::Striker { .. }),
        stop_mass_kg: match chain.far {
            FarEnd::Stop { mass_kg, .. } | FarEnd::PlaneStop { mass_kg, .. } => Some(mass_kg),
            _ => None,
        },
        has_memory: false,
        has_states: false,
        bridged: Vec::new(),
        displacement_m: vec![0.0; chain.beads.len() + 2],
        velocity_m_s: vec![0.0; chain.beads.len() + 2],
        origin_m: vec![0.0; chain.beads.len() + 2].into(),
        scales: Scales {
            speed_m_s: 1.0,
            time_s: 1.0,
            silent_force_n: 0.0,
            momentum_n_s: 0.0,
            crossing_s: 1.0,
        },
        kinds: Arc::default(),
    }
}

/// Sections in order with their columns, and the section of every contact.
fn sections(
    chain: &Chain,
    pairs: &[Option<BeadPair>],
) -> Result<(Vec<SectionColumns>, Vec<u32>), ChainError> {
    let mut ordered: Vec<&Section> = chain.sections.iter().collect();
    ordered.sort_by_key(|section| *section.contacts.start());
    let mut section_of = vec![u32::MAX; pairs.len()];
    let mut columns = Vec::new();
    for section in ordered {
        let (first, last) = (*section.contacts.start(), *section.contacts.end());
        contact_exists(chain, last, "a section")?;
        if first > last {
            let what = format!("a section ends at contact {last}, before it starts at {first}");
            return Err(ChainError::Layout(what));
        }
        if let Some(c) = (first..=last).find(|&c| section_of[c] != u32::MAX) {
            return Err(ChainError::Layout(format!("contact {c} is in two sections")));
        }
        section_of[first..=last].fill(columns.len() as u32);
        columns.push(section_columns(section, pairs)?);
    }
    match (0..pairs.len()).find(|&c| section_of[c] == u32::MAX && pairs[c].is_some()) {
        Some(c) => Err(ChainError::Layout(format!("contact {c} is in no section: it has no law"))),
        None => Ok((columns, section_of)),
    }
}

fn section_columns(
    section: &Section,
    pairs: &[Option<BeadPair>],
) -> Result<SectionColumns, ChainError> {
    let contacts = *section.contacts.start()..*section.contacts.end() + 1;
    let (mut gated, mut ungated, mut bridge) = (Vec::new(), Vec::new(), None);
    for law in &section.laws {
        let columns = columns(law, pairs, contacts.clone())?;
        let (term, info) = (TermColumns { columns, law: law.clone() }, law.info());
        match info.nature {
            Nature::Adhesive => bridge = Some(term),
            _ if info.gated => gated.push(term),
            _ => ungated.push(term),
        }
    }
    for (nature, what) in [(Nature::WithState, "law with a state"), (Nature::Adhesive, "bridge")] {
        if section.laws.iter().filter(|law| law.info().nature == nature).count() > 1 {
            let (first, last) = (section.contacts.start(), section.contacts.end());
            let what = format!("contacts {first} to {last} have more than one {what}");
            return Err(ChainError::Layout(what));
        }
    }
    Ok(SectionColumns { contacts, gated, ungated, bridge })
}

/// A law's coefficients over contacts; neighbours that join alike are asked once.
fn columns(
    law: &Arc<dyn Law>,
    pairs: &[Option<BeadPair>],
    contacts: Range<usize>,
) -> Result<Columns, ChainError> {
    let (mut runs, mut contact) = (Vec::new(), contacts.start);
    for alike in pairs[contacts].chunk_by(PartialEq::eq) {
        let row = match &alike[0] {
            Some(pair) => coefficients(law, pair, contact)?,
            // Nothing acts across a contact that does not exist.
            None => vec![0.0; law.width()],
        };
        runs.push((row, alike.len()));
        contact += alike.len();
    }
    let rows = runs.iter().map(|(row, count)| (row.as_slice(), *count));
    Ok(Columns::from_runs(rows))
}

fn coefficients(
    law: &Arc<dyn Law>,
    pair: &BeadPair,
    contact: usize,
) -> Result<Vec<f64>, ChainError> {
    law.coefficients(pair).map_err(|error| ChainError::Law { contact, error })
}

/// Masses of bodies 0..=N+1; infinite where nothing moves.
fn masses(chain: &Chain) -> Vec<f64> {
    let last = chain.beads.len() + 1;
    let ring = matches!(chain.far, FarEnd::Periodic { .. });
    (0..=last)
        .map(|i| {
            chain.body(i).filter(|_| !(ring && i == last)).map_or(f64::INFINITY, |b| b.mass_kg)
        })
        .collect()
}

fn spring(push: &Push) -> Option<Spring> {
    match *push {
        Push::Spring { force_n, stiffness_n_m } => Some(Spring { force_n, stiffness_n_m }),
        _ => None,
    }
}

/// Load of every contact at rest in N: the push and the weight above it.
fn loads(chain: &Chain, system: &System) -> Vec<f64> {
    if let FarEnd::Periodic { force_n } = chain.far {
        let mut loads = vec![force_n; system.contacts()];
        loads[0] = 0.0;
        return loads;
    }
    let driven = matches!(chain.start, Start::Driven { .. });
    let mut load = chain.push.force_n();
    let mut loads = vec![if driven { load } else { 0.0 }];
    for bead in &chain.beads {
        load += bead.mass_kg * system.slope_m_s2;
        loads.push(load);
    }
    loads
}

fn settle(
    chain: &Chain,
    pairs: &[Option<BeadPair>],
    system: &mut System,
) -> Result<(), ChainError> {
    let loads = loads(chain, system);
    let alike = |b: usize, c: usize| {
        pairs[b] == pairs[c]
            && system.section_of[b] == system.section_of[c]
            && system.bridged.get(b) == system.bridged.get(c)
    };
    check_equilibrium(chain, system, &loads)?;
    let exists = |c: usize| match c {
        0 => !matches!(chain.start, Start::Free),
        c if c == chain.beads.len() => !matches!(chain.far, FarEnd::Free),
        _ => true,
    };
    let (mut offset_m, mut force_n) = (system.offset_m.to_vec(), system.static_force_n.to_vec());
    for c in (0..loads.len()).filter(|&c| exists(c)) {
        let as_before = |before: &usize| alike(*before, c) && loads[*before] == loads[c];
        (offset_m[c], force_n[c]) = match c.checked_sub(1).filter(|b| exists(*b)).filter(as_before)
        {
            Some(before) => (offset_m[before], force_n[before]),
            None => {
                let overlap = static_overlap(system, c, loads[c])?;
                (overlap, elastic_force(system, c, overlap))
            }
        };
    }
    for gap in &chain.gaps {
        if loads[gap.contact] == 0.0 && gap.gap_m > 0.0 && exists(gap.contact) {
            (offset_m[gap.contact], force_n[gap.contact]) = (-gap.gap_m, 0.0);
        }
    }
    for (contact, bridged) in system.bridged.iter_mut().enumerate() {
        *bridged &= offset_m[contact] >= 0.0;
    }
    (system.offset_m, system.static_force_n) = (offset_m.into(), force_n.into());
    Ok(())
}

fn check_equilibrium(chain: &Chain, system: &System, loads: &[f64]) -> Result<(), ChainError> {
    let fail = |why: &str| Err(ChainError::Equilibrium(why.into()));
    if matches!(chain.far, FarEnd::Periodic { .. })
        && (chain.push.force_n() != 0.0 || system.slope_m_s2 != 0.0)
    {
        return fail("a ring can be neither pushed nor inclined");
    }
    if loads.iter().any(|&load| load < 0.0) {
        return fail("the incline lets the chain slide away from the wall");
    }
    if chain.suspension_m.is_some() && loads.iter().any(|&load| load > 0.0) {
        return fail("a hanging chain can be neither pushed nor inclined");
    }
    if matches!(chain.far, FarEnd::Free) && loads.last().is_some_and(|&load| load > 0.0) {
        return fail("the chain is pushed or inclined, but nothing holds its far end");
    }
    Ok(())
}

fn set_in_motion(chain: &Chain, system: &mut System) {
    if let Start::Striker { speed_m_s, .. } = chain.start {
        system.velocity_m_s[0] = speed_m_s;
    }
    if let Some(motion) = &system.motion {
        (system.displacement_m[0], system.velocity_m_s[0]) = motion.at(0.0);
    }
    for initial in &chain.initial {
        system.displacement_m[initial.bead] += initial.displacement_m;
        system.velocity_m_s[initial.bead] += initial.velocity_m_s;
    }
    if system.periodic {
        let last = system.bodies() - 1;
        system.displacement_m[last] = system.displacement_m[1];
        system.velocity_m_s[last] = system.velocity_m_s[1];
    }
}
