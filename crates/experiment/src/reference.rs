//! K or A of one contact, to which the others of its section keep their ratios.
//!
//! Sphere on plane is √2 stiffer than sphere on like sphere, and unlike beads or materials
//! make each contact another. A number that materials and radii would give is therefore that
//! of a reference contact: value at contact c = number · own value at c / own value at the
//! reference contact.

use crate::experiment::Experiment;
use crate::finding::Problem;
use crate::laws::{CONTACT, LawSpec};
use crate::spec::{SectionSpec, Spec};
use hertzchain_chain::{Chain, Material, Pair, Section};
use std::ops::RangeInclusive;

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
        let span = &self.tree().get("contacts")?.members().get(at)?.span;
        let (chain, _) = self.chain(None).ok()?;
        let spec = self.sections().iter().find(|own| own.span == *span)?;
        let given = spec.laws.iter().find(|own| own.name() == law)?;
        is_derived(given, parameter).then(|| of_section(spec, given, parameter, &chain))
    }
}

fn is_derived(law: &LawSpec, parameter: &str) -> bool {
    let mut all = law.row.info.parameters.iter();
    all.any(|one| one.name == parameter && crate::laws::is_own(one))
}

fn of_section(spec: &SectionSpec, law: &LawSpec, parameter: &str, chain: &Chain) -> Reference {
    let bodies = bodies(chain, section_material(spec, chain));
    let value = |contact: usize| own_value(law.name(), parameter, &bodies.pair(contact)?);
    let (first, last) = (spec.from, spec.last(chain.beads.len()));
    let named = |(name, contact): &(&str, usize)| (*name == parameter).then_some(*contact);
    let is_given = law.given.iter().any(|(name, _)| *name == parameter);
    let contact = match (law.references.iter().find_map(named), is_given) {
        (Some(contact), _) => Some(contact),
        (None, true) => None,
        // A contact between beads stands for the section, not that at either end.
        (None, false) => (first.max(1)..last)
            .chain([first, last])
            .find(|contact| value(*contact).is_some_and(|own| own > 0.0)),
    };
    let own_value = contact.and_then(value);
    let ratio = |contact: usize| Some(value(contact)? / own_value?);
    let ratios = (first..=last).filter_map(ratio);
    let ratios = ratios.fold(None, |range: Option<[f64; 2]>, ratio| {
        let [least, most] = range.unwrap_or([ratio; 2]);
        Some([least.min(ratio), most.max(ratio)])
    });
    Reference {
        contact,
        contacts: first..=last,
        own_value,
        ratios: ratios.unwrap_or([1.0; 2]),
    }
}

/// What materials and radii of a contact give a parameter; `None` where they give none.
fn own_value(law: &str, parameter: &str, pair: &Pair) -> Option<f64> {
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

fn section_material(spec: &SectionSpec, chain: &Chain) -> Option<Material> {
    let sections = chain.sections.iter();
    let mut own = sections.filter(|section| section.contacts.contains(&spec.from));
    own.next().and_then(|section| section.material)
}

/// The chain with all contacts of one material, or each of its bodies' own.
fn bodies(chain: &Chain, material: Option<Material>) -> Chain {
    Chain {
        sections: vec![Section {
            contacts: 0..=chain.beads.len(),
            laws: Vec::new(),
            material,
        }],
        ..chain.clone()
    }
}

/// Sections in which each contact has its own values of what belongs to a reference
/// contact: those of a chain, parted where values change.
pub(crate) fn parted(spec: &Spec, chain: &Chain) -> Result<Vec<Section>, Problem> {
    let pairs = spec.sections.iter().zip(&chain.sections);
    let mut all = Vec::new();
    for (of, section) in pairs {
        match of.laws.iter().all(|law| law.references.is_empty()) {
            true => all.push(section.clone()),
            false => all.extend(parts(of, section, chain)?),
        }
    }
    Ok(all)
}

fn parts(of: &SectionSpec, section: &Section, chain: &Chain) -> Result<Vec<Section>, Problem> {
    let bodies = bodies(chain, section.material);
    let mut parts: Vec<(Vec<Given>, RangeInclusive<usize>)> = Vec::new();
    for contact in section.contacts.clone() {
        let values = of.laws.iter().map(|law| given(law, &bodies, contact));
        let values: Vec<Given> = values.collect::<Result<_, _>>()?;
        match parts.last_mut() {
            Some((same, contacts)) if *same == values => *contacts = *contacts.start()..=contact,
            _ => parts.push((values, contact..=contact)),
        }
    }
    let part = |(values, contacts): (Vec<Given>, RangeInclusive<usize>)| {
        let laws = of.laws.iter().zip(values);
        Ok(Section {
            contacts,
            laws: laws
                .map(|(law, given)| law.build_with(&given))
                .collect::<Result<_, _>>()?,
            material: section.material,
        })
    };
    parts.into_iter().map(part).collect()
}

/// Values of a law's parameters.
type Given = Vec<(&'static str, f64)>;

fn given(law: &LawSpec, bodies: &Chain, contact: usize) -> Result<Given, Problem> {
    let value = |(name, value): &(&'static str, f64)| {
        let reference = law.references.iter().find(|(own, _)| own == name);
        let Some((_, reference)) = reference else {
            return Ok((*name, *value));
        };
        let of = |contact: usize| own_value(law.name(), name, &bodies.pair(contact)?);
        match (of(contact), of(*reference)) {
            (Some(own), Some(base)) if base > 0.0 => Ok((*name, value * (own / base))),
            // No pair: a law of no contact.
            (None, _) if bodies.pair(contact).is_none() => Ok((*name, *value)),
            _ => Err(unscaled(law, name, contact, *reference)),
        }
    };
    law.given.iter().map(value).collect()
}

fn unscaled(law: &LawSpec, name: &str, contact: usize, reference: usize) -> Problem {
    let message = format!(
        "materials and radii give no `{name}` at contact {contact} or {reference}, so that no ratio of both is known"
    );
    let label = format!("leave `{CONTACT}` out to give all contacts of the section one `{name}`");
    Problem::new(&law.span, message, label)
}
