//! From what a file says to a chain for one impact speed.
//!
//! K or A of one contact may stand for a section. Sphere on plane is √2 stiffer than sphere on
//! like sphere, and unlike beads or materials make each contact another. A number that materials
//! and radii would give is therefore that of a reference contact: value at contact c = number ·
//! own value at c / own value at the reference contact.

use crate::bodies::sphere_mass_kg;
use crate::contacts::{self, CONTACT, LawSpec, SectionSpec};
use crate::experiment::Experiment;
use crate::keys::SPEED;
use crate::report::{FileProblem, short};
use crate::settings::{BodyShape, Far, Near};
use crate::spec::Spec;
use crate::validity;
use crate::values::Units;
use hertzchain_chain::laws::Parameter;
use hertzchain_chain::{Bead, BeadPair, Chain, FarEnd, Material, Section, Start};
use std::collections::HashSet;
use std::ops::RangeInclusive;

/// The chain of an experiment, hit at this speed, and warnings about it.
pub(crate) fn chain(
    spec: &Spec,
    speed_m_s: Option<f64>,
) -> Result<(Chain, Vec<FileProblem>), FileProblem> {
    let speed_m_s = striker_speed(spec, speed_m_s)?;
    let (materials, mut warnings) = materials(spec, speed_m_s)?;
    let mut beads = Vec::new();
    spec.groups.iter().for_each(|group| group.append(&materials, &mut beads));
    beads.truncate(spec.bead_count());
    let (Some(first), Some(last)) = (beads.first(), beads.last()) else {
        return Err(FileProblem::new(&(0..0), "the chain has no beads", "expected at least one"));
    };
    if spec.units == Units::Si {
        let groups = spec.groups.iter();
        warnings.extend(groups.flat_map(|g| g.improbable(&spec.materials, &materials)));
    }
    warnings.extend(inelastic(spec));
    warnings.extend(closed_gaps(spec));
    warnings.extend(films(spec));
    let mut chain = Chain {
        start: start(spec, speed_m_s, first, &materials)?,
        far: far(&spec.far, last, &materials),
        initial: spec.initial.iter().map(|(initial, _)| *initial).collect(),
        push: spec.push,
        sections: sections(spec, &materials, beads.len())?,
        gaps: spec.gaps.iter().map(|(gap, _)| *gap).collect(),
        incline_rad: spec.incline_rad,
        gravity_m_s2: spec.gravity_m_s2,
        suspension_m: spec.suspension_m,
        tension: spec.tension,
        beads,
    };
    chain.sections = scaled_sections(spec, &chain)?;
    warnings.extend(validity::warnings(spec, &chain));
    // Groups of one material say the same of it.
    let mut seen = HashSet::new();
    warnings.retain(|one| seen.insert((one.span.clone(), one.message.clone())));
    Ok((chain, warnings))
}

/// The speed of the shot: the one asked for, else the file's.
fn striker_speed(spec: &Spec, asked_m_s: Option<f64>) -> Result<Option<f64>, FileProblem> {
    let limits = SPEED.within(spec.units, "m/s");
    let asked = |speed| {
        let speed = spec.units.with_unit(&short(speed), "m/s");
        format!("a shot at {speed} was asked for")
    };
    match (spec.near.speed_m_s(), asked_m_s) {
        (Some(_), Some(speed)) if limits.hold(speed) => Ok(Some(speed)),
        (Some(_), Some(speed)) => {
            let label = format!("expected a positive, finite speed, {}", limits.words);
            Err(FileProblem::new(&spec.near.span(), asked(speed), label))
        }
        (None, Some(speed)) => {
            Err(no_striker(spec, format!("{}, but there is no striker", asked(speed))))
        }
        (own, None) => Ok(own),
    }
}

/// A problem where a striker is needed and something else sets the chain in motion.
pub(crate) fn no_striker(spec: &Spec, message: impl Into<String>) -> FileProblem {
    FileProblem::new(&spec.near.span(), message, "this sets the chain in motion")
        .help("put a [striker] with a `speed` in its place")
}

/// Every material at this speed; those without use only cost a warning.
fn materials(
    spec: &Spec,
    speed: Option<f64>,
) -> Result<(Vec<Material>, Vec<FileProblem>), FileProblem> {
    let used = spec.used_materials();
    let sections = spec.cases.iter().filter_map(|case| case.sections.as_ref());
    let of_cases: Vec<usize> = sections.flatten().filter_map(|section| section.material).collect();
    let mut materials = Vec::new();
    let mut warnings = Vec::new();
    for (index, material) in spec.materials.0.iter().enumerate() {
        if used.contains(&index) {
            let (values, warning) = material.at(speed)?;
            materials.push(values);
            warnings.extend(warning);
            continue;
        }
        materials.push(Material::RIGID);
        if !of_cases.contains(&index) {
            let message = format!("nothing is made of `{}`", material.name);
            warnings.push(FileProblem::new(&material.span, message, "this material is not used"));
        }
    }
    Ok((materials, warnings))
}

fn start(
    spec: &Spec,
    speed_m_s: Option<f64>,
    first: &Bead,
    materials: &[Material],
) -> Result<Start, FileProblem> {
    match (&spec.near, speed_m_s) {
        (Near::Striker { shape, .. }, Some(speed_m_s)) => {
            Ok(Start::Striker { bead: striker(spec, shape, first, materials)?, speed_m_s })
        }
        (Near::Driven { shape, motion }, _) => Ok(Start::Driven {
            bead: Bead {
                radius_m: shape.radius_m.unwrap_or(first.radius_m),
                mass_kg: first.mass_kg,
                material: material_of(shape, materials).unwrap_or(first.material),
            },
            motion: motion.clone(),
        }),
        _ => Ok(Start::Free),
    }
}

fn material_of(shape: &BodyShape, materials: &[Material]) -> Option<Material> {
    materials.get(shape.material?).copied()
}

/// The striker: what the file leaves out is as in bead 1; another size or
/// material has another mass, which then needs a density.
fn striker(
    spec: &Spec,
    shape: &BodyShape,
    first: &Bead,
    materials: &[Material],
) -> Result<Bead, FileProblem> {
    let radius_m = shape.radius_m.unwrap_or(first.radius_m);
    let of_bead_1 = spec.groups.first().and_then(|group| group.cell.first()?.material);
    let of_striker = shape.material.or(of_bead_1);
    let like_bead_1 = radius_m == first.radius_m && of_striker == of_bead_1;
    let density = spec.materials.density_kg_m3(of_striker);
    let own = like_bead_1.then_some(first.mass_kg);
    let full = density.map(|density| sphere_mass_kg(radius_m, density));
    let mass = match spec.units {
        Units::Si => "mass = \"8.54 g\"",
        Units::Dimensionless => "mass = 1.0",
    };
    let label = format!("it differs from bead 1: expected `{mass}`, or a density in its material");
    let missing = || FileProblem::new(&shape.span, "the striker has no mass", label);
    Ok(Bead {
        radius_m,
        mass_kg: shape.mass_kg.or(own).or(full).ok_or_else(missing)?,
        material: material_of(shape, materials).unwrap_or(first.material),
    })
}

fn far(far: &Far, last: &Bead, materials: &[Material]) -> FarEnd {
    match far {
        Far::Wall { is_plane, shape, stop_kg } => {
            let material = material_of(shape, materials).unwrap_or(last.material);
            let radius_m = shape.radius_m.unwrap_or(last.radius_m);
            match (is_plane, *stop_kg) {
                (false, None) => FarEnd::HalfBead { radius_m, material },
                (false, Some(mass_kg)) => FarEnd::Stop { radius_m, material, mass_kg },
                (true, None) => FarEnd::Plane { material },
                (true, Some(mass_kg)) => FarEnd::PlaneStop { material, mass_kg },
            }
        }
        Far::Periodic { force_n } => FarEnd::Periodic { force_n: *force_n },
        Far::Free => FarEnd::Free,
    }
}

fn sections(
    spec: &Spec,
    materials: &[Material],
    beads: usize,
) -> Result<Vec<Section>, FileProblem> {
    let section = |section: &SectionSpec| {
        let laws = section.laws.iter().map(|law| law.build(&law.given));
        Ok(Section {
            contacts: section.from..=section.last(beads),
            laws: laws.collect::<Result<_, _>>()?,
            material: section.material.and_then(|m| materials.get(m).copied()),
        })
    };
    spec.sections.iter().map(section).collect()
}

/// A warning for sections that nothing pushes apart.
fn inelastic(spec: &Spec) -> impl Iterator<Item = FileProblem> {
    let inelastic = spec.sections.iter().filter(|section| !section.is_elastic());
    inelastic.map(|section| {
        let message = "no law of these contacts pushes the beads apart";
        FileProblem::new(&section.laws_span, message, "an elastic law is missing")
            .help("add \"elastic_hertz\" to `laws`")
    })
}

/// Whether contacts between beads are pressed together at rest.
fn is_pressed(spec: &Spec) -> bool {
    let ring = matches!(spec.far, Far::Periodic { force_n } if force_n > 0.0);
    let weighs = spec.incline_rad > 0.0 && spec.gravity_m_s2 > 0.0;
    ring || weighs || spec.push.force_n() > 0.0
}

/// A warning for films in contacts that start otherwise than the law is for.
fn films(spec: &Spec) -> impl Iterator<Item = FileProblem> {
    let pressed = is_pressed(spec);
    let laws =
        spec.sections.iter().flat_map(|section| section.laws.iter().map(move |law| (section, law)));
    laws.filter_map(move |(section, law)| {
        let contacts = section.from..=section.last(spec.bead_count());
        let gap = spec.gaps.iter().any(|(gap, _)| gap.gap_m > 0.0 && contacts.contains(&gap.contact));
        let (message, label) = match (law.name(), gap, pressed) {
            ("film_drained", _, true) => (
                "`film_drained` is for beads that start apart, and these are pressed together at rest",
                "it acts only once a contact has opened",
            ),
            ("film_entrained", true, false) => (
                "`film_entrained` is for beads that touch or are pressed, and here is a gap",
                "oil in the gap resists nothing before touch",
            ),
            _ => return None,
        };
        Some(FileProblem::new(&law.span, message, label))
    })
}

/// A warning for gaps in contacts that are pressed together at rest.
fn closed_gaps(spec: &Spec) -> impl Iterator<Item = FileProblem> {
    let pressed = is_pressed(spec);
    let gaps = spec.gaps.iter().filter(move |_| pressed);
    let closed = gaps.filter(|(gap, _)| gap.contact > 0 && gap.gap_m > 0.0);
    closed.map(|(gap, span)| {
        let message = format!("contact {} is pressed together at rest", gap.contact);
        FileProblem::new(span, message, "this gap closes and has no effect")
    })
}

/// The contacts that a number of a contact law holds for.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The contact whose value the number is; `None` where it is that of all contacts.
    pub contact: Option<usize>,
    /// Contacts of the section.
    pub contacts: RangeInclusive<usize>,
    /// The reference contact's value by materials and radii, in SI.
    pub own_value: Option<f64>,
    /// Least and largest value of the section's contacts over the reference contact's.
    pub ratios: [f64; 2],
}

impl Experiment {
    /// The contacts that the number at a path holds for, at the experiment's own speed;
    /// `None` where materials and radii would not give it.
    pub fn reference(&self, path: &str) -> Option<Reference> {
        let (section, rest) = path.strip_prefix("contacts[")?.split_once("].laws.")?;
        let (law, parameter) = rest.split_once('.')?;
        let at: usize = section.parse().ok()?;
        let span = &self.tree().list("contacts").get(at)?.span;
        let (chain, _) = self.chain(None).ok()?;
        let section = self.sections().iter().find(|own| own.span == *span)?;
        let law = section.laws.iter().find(|own| own.name() == law)?;
        let mut parameters = law.row.info.parameters.iter();
        let is_derived = |p: &Parameter| p.name == parameter && contacts::is_derived(p);
        let derived = parameters.any(is_derived) || law.reference(parameter).is_some();
        derived.then(|| Reference::of(section, law, parameter, &chain))
    }
}

impl Reference {
    fn of(section: &SectionSpec, law: &LawSpec, parameter: &str, chain: &Chain) -> Self {
        let mut sections = chain.sections.iter();
        let own = sections.find(|own| own.contacts.contains(&section.from));
        let bodies = of_one_material(chain, own.and_then(|own| own.material));
        let value = |contact: usize| own_value(law.name(), parameter, &bodies.pair(contact)?);
        let (first, last) = (section.from, section.last(chain.beads.len()));
        let contact = law.reference(parameter).or_else(|| {
            // A contact between beads stands for the section, not that at either end.
            let mut inner_first = (first.max(1)..last).chain([first, last]);
            let is_given = law.value(parameter).is_some();
            let stands = |contact: &usize| value(*contact).is_some_and(|own| own > 0.0);
            inner_first.find(|contact| !is_given && stands(contact))
        });
        let own_value = contact.and_then(value);
        let ratio = |contact: usize| Some(value(contact)? / own_value?);
        let [least, most] = (first..=last)
            .filter_map(ratio)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], ratio| {
                [least.min(ratio), most.max(ratio)]
            });
        Self {
            contact,
            contacts: first..=last,
            own_value,
            ratios: if least <= most { [least, most] } else { [1.0; 2] },
        }
    }
}

/// A parameter's value by materials and radii of a contact; `None` where they give none.
fn own_value(law: &str, parameter: &str, pair: &BeadPair) -> Option<f64> {
    let value = match (law, parameter) {
        (_, "stiffness") => pair.hertz_stiffness(),
        ("damping_brilliantov_1996", _) => {
            pair.mean_relaxation_time_s(Material::relaxation_time_1996_s)
        }
        (_, "relaxation_time") => pair.mean_relaxation_time_s(Material::relaxation_time_s),
        _ => return None,
    };
    (value.is_finite() && value >= 0.0).then_some(value)
}

/// The chain with all contacts of one material, or each of its bodies' own.
fn of_one_material(chain: &Chain, material: Option<Material>) -> Chain {
    let section = Section { contacts: 0..=chain.beads.len(), laws: Vec::new(), material };
    Chain { sections: vec![section], ..chain.clone() }
}

/// Sections in which each contact has its own values of what belongs to a reference
/// contact: those of a chain, divided where values change.
fn scaled_sections(spec: &Spec, chain: &Chain) -> Result<Vec<Section>, FileProblem> {
    let mut all = Vec::new();
    for (of, section) in spec.sections.iter().zip(&chain.sections) {
        if of.laws.iter().all(|law| law.references.is_empty()) {
            all.push(section.clone());
            continue;
        }
        let bodies = of_one_material(chain, section.material);
        let mut before = None;
        for contact in section.contacts.clone() {
            let values = of.laws.iter().map(|law| scaled(law, &bodies, contact));
            let values: Vec<Given> = values.collect::<Result<_, _>>()?;
            match all.last_mut() {
                Some(Section { contacts, .. }) if before.as_ref() == Some(&values) => {
                    *contacts = *contacts.start()..=contact;
                }
                _ => {
                    let laws = of.laws.iter().zip(&values).map(|(law, given)| law.build(given));
                    all.push(Section {
                        contacts: contact..=contact,
                        laws: laws.collect::<Result<_, _>>()?,
                        material: section.material,
                    });
                }
            }
            before = Some(values);
        }
    }
    Ok(all)
}

/// Values of a law's parameters.
type Given = Vec<(&'static str, f64)>;

/// Values of a law at a contact, by the ratios of the bodies' own values.
fn scaled(law: &LawSpec, bodies: &Chain, contact: usize) -> Result<Given, FileProblem> {
    let value = |(name, value): &(&'static str, f64)| {
        let Some(reference) = law.reference(name) else {
            return Ok((*name, *value));
        };
        let of = |contact: usize| own_value(law.name(), name, &bodies.pair(contact)?);
        match (of(contact), of(reference)) {
            (Some(own), Some(base)) if base > 0.0 => Ok((*name, value * (own / base))),
            // No pair: a law of no contact.
            (None, _) if bodies.pair(contact).is_none() => Ok((*name, *value)),
            _ => {
                let message = format!(
                    "materials and radii give no `{name}` at contact {contact} or {reference}, so that no ratio \
                     of both is known"
                );
                let label = format!(
                    "leave `{CONTACT}` out to give all contacts of the section one `{name}`"
                );
                Err(FileProblem::new(&law.span, message, label))
            }
        }
    };
    law.given.iter().map(value).collect()
}
