//! Sections of contacts and their laws.

use super::{Group, Materials, stiffness};
use crate::document::Node;
use crate::finding::Problem;
use crate::laws::{self, LawSpec};
use crate::view::View;
use hertzchain_chain::laws::{Nature, find};
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
    pub(crate) to_span: Range<usize>,
    pub(crate) laws_span: Range<usize>,
}

impl SectionSpec {
    /// Last contact in a chain of this many beads.
    pub fn last(&self, beads: usize) -> usize {
        self.to.unwrap_or(beads)
    }

    /// Whether one of its laws pushes back.
    pub(crate) fn is_elastic(&self) -> bool {
        self.laws
            .iter()
            .any(|law| law.row.info.nature != Nature::Dissipative && !law.is_slack())
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
    let bare = parts.all(|part| part.material.is_none());
    sections
        .iter_mut()
        .try_for_each(|section| stiffness::fill(section, bare))?;
    sections.sort_by_key(|section| section.from);
    covered(&sections, beads)?;
    Ok(sections)
}

/// The default of a dimensionless chain: Hertz contacts.
fn hertz(root: &View<'_>) -> SectionSpec {
    let law = find("elastic_hertz").map(|row| LawSpec {
        row,
        given: Vec::new(),
        references: Vec::new(),
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
        to_span: root.span(),
        laws_span: root.span(),
    }
}

fn section(table: &View<'_>, materials: &Materials, beads: usize) -> Result<SectionSpec, Problem> {
    let from = table.count("from")?.unwrap_or(0);
    let to = table.count("to")?;
    within(&table.span_of("from"), from, beads)?;
    within(&table.span_of("to"), to.unwrap_or(beads), beads)?;
    if to.unwrap_or(beads) < from {
        let message = format!("this section ends before it begins at contact {from}");
        let label = format!("expected a contact from {from} to {beads}");
        return Err(Problem::new(&table.span_of("to"), message, label));
    }
    let members = table.node.get("laws").map_or(&[][..], Node::members).iter();
    let laws = members.map(|member| laws::read(member, table.units));
    let laws: Vec<LawSpec> = laws.collect::<Result<_, _>>()?;
    laws::each_once(&laws)?;
    let mut references = laws.iter().flat_map(|law| {
        let own = law.references.iter();
        own.map(|(_, contact)| (&law.span, *contact))
    });
    references.try_for_each(|(span, contact)| within(span, contact, beads))?;
    Ok(SectionSpec {
        from,
        to: to.filter(|&contact| contact != beads),
        laws,
        wet: table.flag("wet"),
        material: materials.find(table)?,
        span: table.span(),
        from_span: table.span_of("from"),
        to_span: table.span_of("to"),
        laws_span: table.span_of("laws"),
    })
}

fn within(span: &Range<usize>, contact: usize, beads: usize) -> Result<(), Problem> {
    if contact <= beads {
        return Ok(());
    }
    let message = format!("contact {contact} is outside the chain of {beads} beads");
    let label = format!("expected a contact from 0 to {beads}, the wall contact");
    Err(Problem::new(span, message, label))
}

/// Every contact belongs to one section.
fn covered(sections: &[SectionSpec], beads: usize) -> Result<(), Problem> {
    let mut next = 0;
    let mut before: Option<&SectionSpec> = None;
    for section in sections {
        if section.from < next {
            return Err(overlap(before.unwrap_or(section), section, beads));
        }
        before = Some(section);
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

/// Two sections that share contacts, both shown.
fn overlap(first: &SectionSpec, second: &SectionSpec, beads: usize) -> Problem {
    let (from, end) = (second.from, first.last(beads));
    let last = end.min(second.last(beads));
    let message = match from == last {
        true => format!("contact {from} belongs to two sections"),
        false => format!("contacts {from} to {last} belong to two sections"),
    };
    let reach = |section: &SectionSpec| {
        let (from, last) = (section.from, section.last(beads));
        match from == last {
            true => format!("contact {from}"),
            false => format!("contacts {from} to {last}"),
        }
    };
    let ends = match first.to {
        Some(_) => reach(first),
        None => format!("{}: no `to` means up to the wall contact", reach(first)),
    };
    let begins = match second.from_span == second.span {
        true => format!("{}: no `from` means from contact 0", reach(second)),
        false => reach(second),
    };
    let expected = format!("{begins}; expected contacts that no other section has");
    Problem::new(&second.from_span, message, expected)
        .beside(&first.to_span, format!("this section has {ends}"))
        .help(advice(first, second, end))
}

fn advice(first: &SectionSpec, second: &SectionSpec, end: usize) -> String {
    match second.from.checked_sub(1) {
        Some(before) if before >= first.from => {
            let mut text = format!("end the first section with `to = {before}`");
            if first.to.is_some() {
                text += &format!(", or begin this one with `from = {}`", end + 1);
            }
            text
        }
        _ => "give the sections `from` and `to`: each contact belongs to one; several laws on the \
              same contacts go into one `laws`"
            .to_owned(),
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
