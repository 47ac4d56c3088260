//! Sections of contacts and their laws, by the declarations of the registry.

use crate::bodies::{BeadGroup, Materials};
use crate::document::{Node, TomlValue};
use crate::keys::ValueLimits;
use crate::report::{FileProblem, nearest_word};
use crate::settings::Liquid;
use crate::values::{ExpectedQuantity, TableView, Units, whole};
use hertzchain_chain::laws::{LAWS, Law, LawError, Nature, Parameter, Row, Source, find};
use std::ops::Range;
use std::sync::Arc;

/// One law with the values a file gives, in SI.
#[derive(Clone, Debug)]
pub struct LawSpec {
    /// Its row in the registry.
    pub row: &'static Row,
    /// Parameter values by name, in SI; also the stiffness that a law takes from
    /// the section's `elastic_hertz`, and 1 where a chain has no materials.
    pub given: Vec<(&'static str, f64)>,
    /// Values that are those of one contact, by name, with that contact: the others of the
    /// section keep the ratios to it that materials and radii give them.
    pub(crate) references: Vec<(&'static str, usize)>,
    pub(crate) span: Range<usize>,
}

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

/// Key of the contact that a law's K or A belongs to.
pub(crate) const CONTACT: &str = "contact";

/// Keys of the oil that a liquid gives to a law.
const VISCOSITY: &str = "viscosity";
const PRESSURE_VISCOSITY: &str = "pressure_viscosity";

/// Key of every stiffness that materials or other laws may set.
const STIFFNESS: &str = "stiffness";

/// Whether a parameter follows from materials and radii, contact by contact, where the file
/// gives none.
pub(crate) fn is_derived(parameter: &Parameter) -> bool {
    parameter.source == Source::Materials
}

impl LawSpec {
    /// Name of the law.
    pub fn name(&self) -> &'static str {
        self.row.info.name
    }

    pub(crate) fn is_dissipative(&self) -> bool {
        // A state pushes back only beside an elastic law; a bridge pulls.
        matches!(self.row.info.nature, Nature::Dissipative | Nature::WithState | Nature::Adhesive)
    }

    /// The value that the file gives to a parameter.
    pub(crate) fn value(&self, name: &str) -> Option<f64> {
        let found = self.given.iter().find(|(given, _)| *given == name);
        found.map(|(_, value)| *value)
    }

    /// The contact that a parameter's value belongs to.
    pub(crate) fn reference(&self, name: &str) -> Option<usize> {
        let found = self.references.iter().find(|(own, _)| *own == name);
        found.map(|(_, contact)| *contact)
    }

    /// The law with these values of its parameters.
    pub(crate) fn build(&self, given: &[(&str, f64)]) -> Result<Arc<dyn Law>, FileProblem> {
        let message = |e: &LawError| format!("law `{}` can't be used", e.law);
        let built = self.row.build(given);
        built.map_err(|e| FileProblem::new(&self.span, message(&e), e.what))
    }

    /// A parameter that the file leaves out and that has this kind of source.
    fn leaves_out_stiffness(&self, by: impl Fn(Source) -> bool) -> bool {
        let mut all = self.row.info.parameters.iter();
        all.any(|p| p.name == STIFFNESS && by(p.source)) && self.value(STIFFNESS).is_none()
    }
}

impl SectionSpec {
    /// Last contact in a chain of this many beads.
    pub fn last(&self, beads: usize) -> usize {
        self.to.unwrap_or(beads)
    }

    /// Whether one of its laws pushes back: a stiffness of 0 takes a law's force away.
    pub(crate) fn is_elastic(&self) -> bool {
        let elastic = |law: &LawSpec| !law.is_dissipative() && law.value(STIFFNESS) != Some(0.0);
        self.laws.iter().any(elastic)
    }
}

/// Everything wrong with one member of `laws`.
pub(crate) fn check_law(node: &Node, units: Units) -> Vec<FileProblem> {
    let row = match row_of(node) {
        Ok(row) => row,
        Err(problem) => return vec![problem],
    };
    let mut problems = Vec::new();
    let known = keys_of(row);
    let unknown = |entry: &&crate::document::TableEntry| {
        entry.key != "law" && !known.contains(&entry.key.as_str())
    };
    let unknown: Vec<_> = node.entries().iter().filter(unknown).collect();
    for entry in &unknown {
        let message = format!("law `{}` has no parameter `{}`", row.info.name, entry.key);
        let label = format!("expected one of: {}", known.join(", "));
        let near = nearest_word(&entry.key, known.iter().copied());
        problems.push(FileProblem::new(&entry.key_span, message, label).nearest(near));
    }
    problems.extend(contact_of(node).err().or_else(|| idle_contact(node, row)));
    let read = |p: &Parameter| Some(value_of(p, row, node, units, node.get(p.name)?));
    let unsound = |p: &&Parameter| read(p).map_or(p.source == Source::Required, |r| r.is_err());
    let unsound: Vec<&Parameter> = row.info.parameters.iter().filter(unsound).collect();
    for parameter in &unsound {
        // Its unit follows from another parameter: the report on that one comes first.
        let steers = |other: &&Parameter| parameter.unit.contains(&format!("{{{}}}", other.name));
        // A misspelt key is one mistake, and has been reported.
        let misspelt =
            |e: &&crate::document::TableEntry| nearest_word(&e.key, [parameter.name]).is_some();
        match read(parameter) {
            _ if unsound.iter().copied().any(|other| steers(&other)) => {}
            Some(read) => problems.extend(read.err()),
            None if unknown.iter().any(misspelt) => {}
            None => problems.push(missing(parameter, row, node, units)),
        }
    }
    problems
}

/// One member of `laws`, already checked; the liquid gives what is its own.
fn law(node: &Node, units: Units, liquid: Option<&Liquid>) -> Result<LawSpec, FileProblem> {
    let row = row_of(node)?;
    let contact = contact_of(node)?;
    let (mut given, mut references) = (Vec::new(), Vec::new());
    for parameter in row.info.parameters {
        if let Some(value) = node.get(parameter.name) {
            given.push((parameter.name, value_of(parameter, row, node, units, value)?));
            let own = contact.filter(|_| parameter.source.is_derived());
            references.extend(own.map(|contact| (parameter.name, contact)));
        }
    }
    if row.info.parameters.iter().any(|p| p.source == Source::Liquid) {
        fill_liquid(row, node, (units, liquid), &mut given)?;
    }
    let span = node.span.clone();
    Ok(LawSpec { row, given, references, span })
}

/// Fills in what a law leaves to the file's liquid. An oil with an η must state its α, as a film
/// of oil without it is another one.
fn fill_liquid(
    row: &Row,
    node: &Node,
    (units, liquid): (Units, Option<&Liquid>),
    given: &mut Vec<(&'static str, f64)>,
) -> Result<(), FileProblem> {
    for parameter in row.info.parameters.iter().filter(|p| node.get(p.name).is_none()) {
        let oil = parameter.name == PRESSURE_VISCOSITY && node.get(VISCOSITY).is_none();
        match liquid.and_then(|liquid| liquid.value(parameter.name)) {
            Some(value) => given.push((parameter.name, value)),
            None if oil || parameter.source == Source::Liquid => {
                return Err(missing(parameter, row, node, units).help(Liquid::suffices(row)));
            }
            None => {}
        }
    }
    Ok(())
}

/// The contact that a law's K or A belongs to, where the file names one.
fn contact_of(node: &Node) -> Result<Option<usize>, FileProblem> {
    let contact = |value| whole(CONTACT, 0, i64::MAX, value);
    let found = node.get(CONTACT).map(contact).transpose()?;
    Ok(found.and_then(|contact| usize::try_from(contact).ok()))
}

/// A `contact` without a value that could be that contact's.
fn idle_contact(node: &Node, row: &Row) -> Option<FileProblem> {
    let key = node.get(CONTACT)?;
    let derived = || row.info.parameters.iter().filter(|p| p.source.is_derived());
    let names: Vec<String> = derived().map(|p| format!("`{}`", p.name)).collect();
    let idle = !names.is_empty() && derived().all(|p| node.get(p.name).is_none());
    idle.then(|| {
        let message = format!("`{CONTACT}` says whose value a law's {} is", names.join(" or "));
        FileProblem::new(&key.span, message, "expected that value beside it, or no contact")
    })
}

/// Keys that a law's table may have beside `law`.
fn keys_of(row: &Row) -> Vec<&'static str> {
    let parameters = row.info.parameters;
    let own = parameters.iter().any(|p| p.source.is_derived()).then_some(CONTACT);
    parameters.iter().map(|p| p.name).chain(own).collect()
}

/// The registry row that a member of `laws` names.
pub(crate) fn row_of(node: &Node) -> Result<&'static Row, FileProblem> {
    let name = match node.value {
        TomlValue::Table(_) => node.get("law").ok_or_else(|| {
            let label = "expected { law = \"name\", parameter = value, … }";
            let problem = FileProblem::new(&node.span, "this law has no name", label);
            let mut words = ["name", "type", "kind", "model"].into_iter();
            match words.find(|word| node.get(word).is_some()) {
                Some(word) => problem.help(format!("write `law` in place of `{word}`")),
                None => problem,
            }
        })?,
        _ => node,
    };
    let Some(text) = name.text() else {
        let message = format!("a law is {}", name.kind());
        return Err(FileProblem::new(&name.span, message, "expected a law's name in quotes"));
    };
    find(text).ok_or_else(|| {
        let names: Vec<&str> = LAWS.iter().map(|row| row.info.name).collect();
        let part = |name: &&str| !text.is_empty() && name.split('_').any(|word| word == text);
        let near = nearest_word(text, names.iter().copied());
        let near = near.or_else(|| names.iter().copied().find(part));
        let label = format!("expected one of: {}", names.join(", "));
        FileProblem::new(&name.span, format!("there is no law `{text}`"), label).nearest(near)
    })
}

fn missing(parameter: &Parameter, row: &Row, node: &Node, units: Units) -> FileProblem {
    let (law, name) = (row.info.name, parameter.name);
    let value = match (units, unit_of(parameter, row, node, units).as_str()) {
        (Units::Si, "1") | (Units::Dimensionless, _) => "…".to_owned(),
        (Units::Si, unit) => format!("\"… {unit}\""),
    };
    let meaning = parameter.meaning;
    let label = format!("expected {{ law = \"{law}\", {name} = {value} }}: {meaning}");
    FileProblem::new(&node.span, format!("law `{law}` needs `{name}`"), label)
}

/// The value of a parameter in SI; its unit may depend on another one of the law.
fn value_of(
    parameter: &Parameter,
    row: &Row,
    node: &Node,
    units: Units,
    value: &Node,
) -> Result<f64, FileProblem> {
    let unit = unit_of(parameter, row, node, units);
    let expected =
        ExpectedQuantity { name: parameter.name, unit: &unit, limits: limits_of(parameter), units };
    expected.read(value).map(|si| si.value)
}

/// What is accepted of a parameter.
pub(crate) fn limits_of(parameter: &Parameter) -> ValueLimits {
    /// Largest exponent: steeper is a wall that no step can follow.
    const STEEPEST: f64 = 100.0;
    let is_exponent = parameter.name == "exponent";
    let words = match parameter.least {
        0.0 => "0 or more",
        1.0 if is_exponent => "from 1 to 100",
        1.0 => "1 or more",
        _ => "above the law's least value",
    };
    let most = if is_exponent { STEEPEST } else { f64::MAX };
    ValueLimits::closed(parameter.least, most, words)
}

/// A parameter's unit with `{other}` replaced by the other's value.
pub(crate) fn unit_of(parameter: &Parameter, row: &Row, node: &Node, units: Units) -> String {
    let mut unit = parameter.unit.to_owned();
    for other in row.info.parameters {
        let place = format!("{{{}}}", other.name);
        if unit.contains(&place) {
            unit = unit.replace(&place, &exponent(other, node, units));
        }
    }
    unit
}

/// The value of an exponent for a unit; 1 when the file has none.
fn exponent(parameter: &Parameter, node: &Node, units: Units) -> String {
    let fallback = match parameter.source {
        Source::Default(value) => value,
        _ => 1.0,
    };
    let plain =
        ExpectedQuantity { name: parameter.name, unit: "1", limits: ValueLimits::ANY, units };
    let value = node.get(parameter.name).and_then(|n| plain.read(n).ok());
    let value = value.map_or(fallback, |si| si.value);
    // Nine decimals are more than dimensions are compared to.
    let text = format!("{:.9}", value.clamp(-1e6, 1e6));
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// All sections of a file, in the order of the contacts.
pub(crate) fn read(
    root: &TableView<'_>,
    materials: &Materials,
    groups: &[BeadGroup],
    liquid: Option<&Liquid>,
) -> Result<Vec<SectionSpec>, FileProblem> {
    let beads = groups.iter().map(BeadGroup::count).sum();
    let tables = root.tables("contacts");
    let section = |table: &TableView<'_>| section(table, materials, beads, liquid);
    let mut sections: Vec<SectionSpec> = tables.iter().map(section).collect::<Result<_, _>>()?;
    if sections.is_empty() {
        sections.push(hertz(root));
    }
    let mut parts = groups.iter().flat_map(|group| &group.cell);
    let bare = parts.all(|part| part.material.is_none());
    for section in &mut sections {
        fill_stiffness(section, bare)?;
    }
    sections.sort_by_key(|section| section.from);
    covered(&sections, beads)?;
    Ok(sections)
}

/// The default of a dimensionless chain: Hertz contacts.
fn hertz(root: &TableView<'_>) -> SectionSpec {
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

fn section(
    table: &TableView<'_>,
    materials: &Materials,
    beads: usize,
    liquid: Option<&Liquid>,
) -> Result<SectionSpec, FileProblem> {
    let from = table.count("from")?.unwrap_or(0);
    let to = table.count("to")?;
    within(&table.span_of("from"), from, beads)?;
    within(&table.span_of("to"), to.unwrap_or(beads), beads)?;
    if to.unwrap_or(beads) < from {
        let message = format!("this section ends before it begins at contact {from}");
        let label = format!("expected a contact from {from} to {beads}");
        return Err(table.problem("to", message, label));
    }
    let members = table.node.list("laws").iter();
    let laws = members.map(|member| law(member, table.units, liquid));
    let laws: Vec<LawSpec> = laws.collect::<Result<_, _>>()?;
    each_once(&laws)?;
    for law in &laws {
        for (_, contact) in &law.references {
            within(&law.span, *contact, beads)?;
        }
    }
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

fn within(span: &Range<usize>, contact: usize, beads: usize) -> Result<(), FileProblem> {
    if contact <= beads {
        return Ok(());
    }
    let message = format!("contact {contact} is outside the chain of {beads} beads");
    let label = format!("expected a contact from 0 to {beads}, the wall contact");
    Err(FileProblem::new(span, message, label))
}

/// Refuses the same law with the same parameters twice in one section: its
/// force would count twice, which is not meant. The same
/// law with other parameters is a sum of two terms.
fn each_once(laws: &[LawSpec]) -> Result<(), FileProblem> {
    for (index, law) in laws.iter().enumerate() {
        let same = |other: &&LawSpec| other.name() == law.name() && other.given == law.given;
        if let Some(first) = laws.iter().take(index).find(same) {
            let message = format!("law `{}` stands twice in this section", law.name());
            return Err(FileProblem::new(&law.span, message, "expected each term once")
                .also(&first.span, "the first one is here")
                .help(
                    "forces of laws add, so this would double them; change a parameter instead",
                ));
        }
    }
    Ok(())
}

/// Fills in stiffnesses that do not follow from materials: 1 in a chain without any
/// (`bare`), and the K of the section's `elastic_hertz` in laws that share it.
fn fill_stiffness(section: &mut SectionSpec, bare: bool) -> Result<(), FileProblem> {
    let bare = bare && section.material.is_none();
    let unit_stiffness = |laws: &mut [LawSpec], dissipative: bool| {
        let wanted = laws.iter_mut().filter(|law| bare && law.is_dissipative() == dissipative);
        let left = wanted.filter(|law| law.leaves_out_stiffness(Source::is_derived));
        left.for_each(|law| law.given.push((STIFFNESS, 1.0)));
    };
    unit_stiffness(&mut section.laws, false);
    shared_stiffness(&mut section.laws)?;
    unit_stiffness(&mut section.laws, true);
    Ok(())
}

/// Damping whose equation has the contact's K takes that of `elastic_hertz`,
/// where the file gives it; forces of several add, so their K do.
fn shared_stiffness(laws: &mut [LawSpec]) -> Result<(), FileProblem> {
    let hertz = || laws.iter().filter(|law| law.name() == "elastic_hertz");
    if hertz().all(|law| law.value(STIFFNESS).is_none()) {
        return Ok(());
    }
    let references: Vec<Option<usize>> = hertz().map(|law| law.reference(STIFFNESS)).collect();
    // Of a sum, parts that belong to other contacts have no value at one.
    let clear = references.windows(2).all(|pair| pair[0] == pair[1]);
    let sum: Option<f64> = hertz().map(|law| law.value(STIFFNESS)).sum();
    let sum = sum.filter(|_| clear);
    let reference = references.first().copied().flatten();
    for law in laws {
        if law.leaves_out_stiffness(|source| source == Source::Hertz) {
            // One `elastic_hertz` has a number, another follows from the materials.
            let stiffness = sum.ok_or_else(|| unclear(law))?;
            law.given.push((STIFFNESS, stiffness));
            law.references.extend(reference.map(|contact| (STIFFNESS, contact)));
        }
    }
    Ok(())
}

fn unclear(law: &LawSpec) -> FileProblem {
    let message = format!("the stiffness of law `{}` is not clear", law.name());
    FileProblem::new(&law.span, message, "expected a `stiffness` here").help(
        "of several \"elastic_hertz\" in this section one has a stiffness and one leaves it to the \
         materials, or theirs belong to other contacts",
    )
}

/// Every contact belongs to one section.
fn covered(sections: &[SectionSpec], beads: usize) -> Result<(), FileProblem> {
    let mut next = 0;
    let mut before: Option<&SectionSpec> = None;
    for section in sections {
        if section.from < next {
            return Err(overlap(before.unwrap_or(section), section, beads));
        }
        if section.from > next {
            return Err(uncovered(section, next, section.from - 1));
        }
        before = Some(section);
        next = section.last(beads) + 1;
    }
    match before {
        Some(section) if next <= beads => Err(uncovered(section, next, beads)),
        _ => Ok(()),
    }
}

fn uncovered(section: &SectionSpec, from: usize, to: usize) -> FileProblem {
    let verb = if from == to { "has" } else { "have" };
    let message = format!("{} {verb} no laws", contacts(from, to));
    FileProblem::new(&section.span, message, "expected sections that leave out no contact")
}

/// "contact 3" or "contacts 3 to 5".
fn contacts(from: usize, to: usize) -> String {
    match from == to {
        true => format!("contact {from}"),
        false => format!("contacts {from} to {to}"),
    }
}

/// Two sections that share contacts, both shown.
fn overlap(first: &SectionSpec, second: &SectionSpec, beads: usize) -> FileProblem {
    let (from, end) = (second.from, first.last(beads));
    let last = end.min(second.last(beads));
    let verb = if from == last { "belongs" } else { "belong" };
    let message = format!("{} {verb} to two sections", contacts(from, last));
    let mut ends = contacts(first.from, end);
    if first.to.is_none() {
        ends += ": no `to` means up to the wall contact";
    }
    let mut begins = contacts(from, second.last(beads));
    if second.from_span == second.span {
        begins += ": no `from` means from contact 0";
    }
    let help = match from.checked_sub(1) {
        Some(before) if before >= first.from && first.to.is_some() => format!(
            "end the first section with `to = {before}`, or begin this one with `from = {}`",
            end + 1
        ),
        Some(before) if before >= first.from => {
            format!("end the first section with `to = {before}`")
        }
        _ => "give the sections `from` and `to`: each contact belongs to one; several laws on the \
              same contacts go into one `laws`"
            .to_owned(),
    };
    let expected = format!("{begins}; expected contacts that no other section has");
    FileProblem::new(&second.from_span, message, expected)
        .also(&first.to_span, format!("this section has {ends}"))
        .help(help)
}
