//! Sections of contacts and their laws.

use super::{Group, Materials};
use crate::document::Node;
use crate::finding::Problem;
use crate::laws::{self, LawSpec};
use crate::view::View;
use hertzchain_chain::laws::{Nature, Parameter, Source, find};
use std::ops::Range;

/// Consecutive contacts that share laws.
#[derive(Clone, Debug)]
pub struct SectionSpec {
    /// First contact.
    pub from: usize,
    /// Last contact; `None` for the wall contact, wherever a reading puts it.
    pub to: Option<usize>,
    /// Laws whose forces add.
    pub laws: Vec<LawSpec>,
    /// Whether the contacts are wet.
    pub wet: bool,
    /// Index of the effective material of both sides.
    pub(crate) material: Option<usize>,
    pub(crate) span: Range<usize>,
    pub(crate) from_span: Range<usize>,
}

impl SectionSpec {
    /// Last contact in a chain of this many beads.
    #[must_use]
    pub fn last(&self, beads: usize) -> usize {
        self.to.unwrap_or(beads)
    }

    /// Whether one of its laws pushes back.
    pub(crate) fn is_elastic(&self) -> bool {
        self.laws
            .iter()
            .any(|law| law.row.info.nature != Nature::Dissipative)
    }
}

/// All sections of a file, in the order of the contacts.
pub(crate) fn read(
    root: &View<'_>,
    materials: &Materials,
    groups: &[Group],
) -> Result<Vec<SectionSpec>, Problem> {
    let beads = groups.iter().map(Group::count).sum();
    let tables = root.tables("contacts");
    let section = |table: &View<'_>| section(table, materials, beads);
    let mut sections: Vec<SectionSpec> = tables.iter().map(section).collect::<Result<_, _>>()?;
    if sections.is_empty() {
        sections.push(hertz(root));
    }
    let mut parts = groups.iter().flat_map(|group| &group.cell);
    if parts.all(|part| part.material.is_none()) {
        sections.iter_mut().for_each(unit_stiffness);
    }
    sections.sort_by_key(|section| section.from);
    covered(&sections, beads)?;
    Ok(sections)
}

/// The default of a dimensionless chain: Hertz contacts.
fn hertz(root: &View<'_>) -> SectionSpec {
    let law = find("elastic_hertz").map(|row| LawSpec {
        row,
        given: Vec::new(),
        span: root.span(),
    });
    SectionSpec {
        from: 0,
        to: None,
        laws: law.into_iter().collect(),
        wet: false,
        material: None,
        span: root.span(),
        from_span: root.span(),
    }
}

fn section(table: &View<'_>, materials: &Materials, beads: usize) -> Result<SectionSpec, Problem> {
    let from = table.count("from")?.unwrap_or(0);
    let to = table.count("to")?;
    within(table, "from", from, beads)?;
    within(table, "to", to.unwrap_or(beads), beads)?;
    if to.unwrap_or(beads) < from {
        let message = format!("this section ends before it begins at contact {from}");
        let label = format!("expected a contact from {from} to {beads}");
        return Err(Problem::new(&table.span_of("to"), message, label));
    }
    let members = table.node.get("laws").map_or(&[][..], Node::members).iter();
    let laws = members.map(|member| laws::read(member, table.units));
    Ok(SectionSpec {
        from,
        to: to.filter(|&contact| contact != beads),
        laws: laws.collect::<Result<_, _>>()?,
        wet: table.flag("wet"),
        material: materials.find(table)?,
        span: table.span(),
        from_span: table.span_of("from"),
    })
}

fn within(table: &View<'_>, key: &str, contact: usize, beads: usize) -> Result<(), Problem> {
    if contact <= beads {
        return Ok(());
    }
    let message = format!("contact {contact} is outside the chain of {beads} beads");
    let label = format!("expected a contact from 0 to {beads}, the wall contact");
    Err(Problem::new(&table.span_of(key), message, label))
}

/// Without materials a stiffness that they would set is 1.
fn unit_stiffness(section: &mut SectionSpec) {
    let declares = |p: &Parameter| p.name == "stiffness" && p.source == Source::Materials;
    for law in section
        .laws
        .iter_mut()
        .filter(|_| section.material.is_none())
    {
        let given = law.given.iter().any(|(name, _)| *name == "stiffness");
        if law.row.info.parameters.iter().any(declares) && !given {
            law.given.push(("stiffness", 1.0));
        }
    }
}

/// Every contact belongs to one section.
fn covered(sections: &[SectionSpec], beads: usize) -> Result<(), Problem> {
    let mut next = 0;
    for section in sections {
        if section.from < next {
            let message = format!("contact {} belongs to two sections", section.from);
            let label = format!("expected a section that begins at contact {next} or later");
            return Err(Problem::new(&section.from_span, message, label));
        }
        if section.from > next {
            return Err(uncovered(section, next, section.from - 1));
        }
        next = section.last(beads) + 1;
    }
    match sections.last() {
        Some(section) if next <= beads => Err(uncovered(section, next, beads)),
        _ => Ok(()),
    }
}

fn uncovered(section: &SectionSpec, from: usize, to: usize) -> Problem {
    let message = match from == to {
        true => format!("contact {from} has no laws"),
        false => format!("contacts {from} to {to} have no laws"),
    };
    Problem::new(
        &section.span,
        message,
        "expected sections that leave out no contact",
    )
}
