//! Contacts: their laws and the constants that follow from the materials.

use super::Group;
use hertzchain_chain::laws::{Nature, Source};
use hertzchain_chain::{BeadPair, Chain, Material, Section};
use hertzchain_experiment::{Experiment, LawSpec, Reference, SectionSpec};

pub(super) fn section(chain: &Chain, contact: usize) -> Option<&Section> {
    chain.sections.iter().find(|section| section.contacts.contains(&contact))
}

/// Stiffness k and exponent n of F = k δⁿ, where one elastic power law acts.
pub(super) fn elastic(chain: &Chain, contact: usize) -> Option<(f64, f64)> {
    let pair = chain.pair(contact)?;
    let laws = &section(chain, contact)?.laws;
    let pushes = |nature| matches!(nature, Nature::Elastic | Nature::ElasticPlastic);
    let mut elastic = laws.iter().filter(|law| pushes(law.info().nature));
    let (law, more) = (elastic.next()?, elastic.next());
    if more.is_some() {
        return None;
    }
    match (law.info().name, law.coefficients(&pair).ok()?.as_slice()) {
        ("elastic_hertz", &[stiffness]) => Some((stiffness, 1.5)),
        ("elastic_power", &[stiffness, exponent]) => Some((stiffness, exponent)),
        _ => None,
    }
}

pub(super) fn sections(experiment: &Experiment, chain: &Chain) -> Vec<Group> {
    let section = |spec: &SectionSpec| {
        let contacts = spec.from..=spec.to.unwrap_or(chain.beads.len());
        let contacts: Vec<usize> = contacts.filter(|&c| chain.pair(c).is_some()).collect();
        let (first, last) = (contacts.first()?, contacts.last()?);
        let wet = if spec.wet { ", wet" } else { "" };
        let mut group = Group::new(format!("Contacts {first} to {last}{wet}"));
        let pairs: Vec<BeadPair> = unlike(chain, contacts);
        for law in &spec.laws {
            let reference = |name: &str| reference(experiment, (spec, law.name()), name);
            describe_law(&mut group, law, &pairs, &reference);
        }
        Some(group)
    };
    experiment.sections().iter().filter_map(section).collect()
}

/// Whose value a parameter of a section's law is, where the file names a contact.
fn reference(
    experiment: &Experiment,
    (section, law): (&SectionSpec, &str),
    name: &str,
) -> Option<Reference> {
    let path = |at: usize| format!("contacts[{at}].laws.{law}.{name}");
    let mut all = (0..experiment.sections().len()).filter_map(|at| experiment.reference(&path(at)));
    all.find(|reference| *reference.contacts.start() == section.from)
}

/// The pairs of contacts that differ from the one before.
fn unlike(chain: &Chain, contacts: Vec<usize>) -> Vec<BeadPair> {
    let mut pairs: Vec<BeadPair> = contacts.into_iter().filter_map(|c| chain.pair(c)).collect();
    pairs.dedup();
    pairs
}

fn describe_law(
    group: &mut Group,
    law: &LawSpec,
    pairs: &[BeadPair],
    reference: &dyn Fn(&str) -> Option<Reference>,
) {
    let info = &law.row.info;
    group.text(info.name, info.equation);
    for parameter in info.parameters {
        let given = law.given.iter().find(|(name, _)| *name == parameter.name);
        let name = format!("  {}", parameter.name);
        match (given, parameter.source) {
            (Some((_, value)), _) => {
                match reference(parameter.name).and_then(|of| Some((of.contact?, of.ratios))) {
                    Some((contact, ratios)) => {
                        group.number(
                            format!("{name} of contact {contact}"),
                            *value,
                            parameter.unit,
                        );
                        group.spread(name, &ratios.map(|ratio| ratio * value), parameter.unit);
                    }
                    None => group.number(name, *value, parameter.unit),
                }
            }
            (None, Source::Default(f64::INFINITY)) => group.text(name, "without limit"),
            (None, Source::Default(value)) => group.number(name, value, parameter.unit),
            (None, _) => derived(group, law, name, parameter.name, pairs),
        }
    }
}

fn derived(group: &mut Group, law: &LawSpec, name: String, parameter: &str, pairs: &[BeadPair]) {
    let relaxation = match law.name() {
        "damping_brilliantov_1996" => Material::relaxation_time_1996_s,
        _ => Material::relaxation_time_s,
    };
    let (values, unit): (Vec<f64>, _) = match parameter {
        "stiffness" => (pairs.iter().map(BeadPair::hertz_stiffness).collect(), "N/m^(3/2)"),
        "relaxation_time" => {
            let time = |pair: &BeadPair| pair.mean_relaxation_time_s(relaxation);
            (pairs.iter().map(time).collect(), "s")
        }
        _ => return group.text(name, "from the materials"),
    };
    match values.iter().any(|value| value.is_nan()) {
        true => group.text(name, "not defined"),
        false => group.spread(format!("{name} (from the materials)"), &values, unit),
    }
}
