//! Contact laws of a file, by the registry's declarations.

use crate::check::whole;
use crate::document::{Node, Value};
use crate::finding::Problem;
use crate::keys::Limits;
use crate::nearest;
use crate::units;
use crate::value::{Expected, Units};
use hertzchain_chain::laws::{LAWS, Law, Parameter, Row, Source, find};
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

/// Key of the contact that a law's K or A belongs to.
pub(crate) const CONTACT: &str = "contact";

/// Whether a parameter follows from materials and radii, contact by contact, where the file
/// gives none.
pub(crate) fn is_own(parameter: &Parameter) -> bool {
    parameter.source == Source::Materials
}

impl LawSpec {
    /// Name of the law.
    pub fn name(&self) -> &'static str {
        self.row.info.name
    }

    /// Whether a stiffness of 0 takes its force away.
    pub(crate) fn is_slack(&self) -> bool {
        self.given.contains(&("stiffness", 0.0))
    }

    pub(crate) fn build(&self) -> Result<Arc<dyn Law>, Problem> {
        self.build_with(&self.given)
    }

    /// The law with other values.
    pub(crate) fn build_with(&self, given: &[(&str, f64)]) -> Result<Arc<dyn Law>, Problem> {
        let problem = |e: hertzchain_chain::laws::LawError| {
            Problem::new(&self.span, format!("law `{}` can't be used", e.law), e.what)
        };
        self.row.build(given).map_err(problem)
    }
}

/// Everything wrong with one member of `laws`.
pub(crate) fn check(node: &Node, units: Units) -> Vec<Problem> {
    let row = match row_of(node) {
        Ok(row) => row,
        Err(problem) => return vec![problem],
    };
    let mut problems = unknown_parameters(node, row);
    problems.extend(contact(node).err());
    let unsound = unsound(node, row, units);
    for parameter in row.info.parameters {
        // Its unit is not known: the exponent's own report comes first.
        if unsound
            .iter()
            .any(|name| parameter.unit.contains(&format!("{{{name}}}")))
        {
            continue;
        }
        match (node.get(parameter.name), parameter.source) {
            (Some(value), _) => {
                let read = expected(parameter, row, node, units, |e| e.read(value));
                problems.extend(read.err());
            }
            // A misspelt key is one mistake, and has been reported.
            (None, Source::Required) if is_misspelt(parameter.name, node, row) => {}
            (None, Source::Required) => problems.push(missing(parameter, row, node, units)),
            (None, _) => {}
        }
    }
    problems
}

/// Parameters that are needed and missing, or wrong.
fn unsound(node: &Node, row: &Row, units: Units) -> Vec<&'static str> {
    let wrong = |p: &&Parameter| match node.get(p.name) {
        Some(value) => expected(p, row, node, units, |e| e.read(value)).is_err(),
        None => p.source == Source::Required,
    };
    row.info
        .parameters
        .iter()
        .filter(wrong)
        .map(|p| p.name)
        .collect()
}

/// One member of `laws`, already checked.
pub(crate) fn read(node: &Node, units: Units) -> Result<LawSpec, Problem> {
    let row = row_of(node)?;
    let contact = contact(node)?;
    let (mut given, mut references) = (Vec::new(), Vec::new());
    for parameter in row.info.parameters {
        if let Some(value) = node.get(parameter.name) {
            let si = expected(parameter, row, node, units, |e| e.read(value))?;
            given.push((parameter.name, si.value));
            let own = contact.filter(|_| is_own(parameter));
            references.extend(own.map(|contact| (parameter.name, contact)));
        }
    }
    Ok(LawSpec {
        row,
        given,
        references,
        span: node.span.clone(),
    })
}

/// The contact that a law's K or A belongs to, where the file names one.
fn contact(node: &Node) -> Result<Option<usize>, Problem> {
    node.get(CONTACT)
        .map(|value| whole(CONTACT, 0, i64::MAX, value))
        .transpose()
        .map(|found| found.and_then(|contact| usize::try_from(contact).ok()))
}

/// Refuses the same law with the same parameters twice in one section: its
/// force would count twice, which is not meant. The same
/// law with other parameters is a sum of two terms.
pub(crate) fn each_once(laws: &[LawSpec]) -> Result<(), Problem> {
    for (index, law) in laws.iter().enumerate() {
        let same = |other: &&LawSpec| other.name() == law.name() && other.given == law.given;
        let Some(first) = laws.iter().take(index).find(same) else {
            continue;
        };
        let message = format!("law `{}` stands twice in this section", law.name());
        return Err(Problem::new(&law.span, message, "expected each term once")
            .beside(&first.span, "the first one is here")
            .help("forces of laws add, so this would double them; change a parameter instead"));
    }
    Ok(())
}

/// The registry row that a member of `laws` names.
pub(crate) fn row_of(node: &Node) -> Result<&'static Row, Problem> {
    let name = match &node.value {
        Value::Text(_) => node,
        Value::Table(_) => node.get("law").ok_or_else(|| {
            let label = "expected { law = \"name\", parameter = value, … }";
            let called = |key: &&str| node.get(key).is_some();
            let called = ["name", "type", "kind", "model"].into_iter().find(called);
            let problem = Problem::new(&node.span, "this law has no name", label);
            match called {
                Some(word) => problem.help(format!("write `law` in place of `{word}`")),
                None => problem,
            }
        })?,
        _ => node,
    };
    let Some(text) = name.text() else {
        let message = format!("a law is {}", name.kind());
        return Err(Problem::new(
            &name.span,
            message,
            "expected a law's name in quotes",
        ));
    };
    find(text).ok_or_else(|| {
        let names: Vec<&str> = LAWS.iter().map(|row| row.info.name).collect();
        let part = |name: &&str| !text.is_empty() && name.split('_').any(|word| word == text);
        let near = nearest::of(text, names.iter().copied());
        let near = near.or_else(|| names.iter().copied().find(part));
        let label = format!("expected one of: {}", names.join(", "));
        Problem::new(&name.span, format!("there is no law `{text}`"), label).nearest(near)
    })
}

/// Whether a key that the law does not know is a slip of this one.
fn is_misspelt(name: &str, node: &Node, row: &Row) -> bool {
    let known = |key: &str| {
        key == "law" || key == CONTACT || row.info.parameters.iter().any(|p| p.name == key)
    };
    let mut strange = node.entries().iter().filter(|entry| !known(&entry.key));
    strange.any(|entry| nearest::of(&entry.key, [name]).is_some())
}

fn unknown_parameters(node: &Node, row: &Row) -> Vec<Problem> {
    let own = row.info.parameters.iter().any(is_own).then_some(CONTACT);
    let names = row.info.parameters.iter().map(|p| p.name);
    let known: Vec<&str> = names.chain(own).collect();
    let strange = |key: &str| key != "law" && !known.contains(&key);
    let entries = node.entries().iter().filter(|entry| strange(&entry.key));
    entries
        .map(|entry| {
            let message = format!("law `{}` has no parameter `{}`", row.info.name, entry.key);
            let label = format!("expected one of: {}", known.join(", "));
            let near = nearest::of(&entry.key, known.iter().copied());
            Problem::new(&entry.key_span, message, label).nearest(near)
        })
        .collect()
}

fn missing(parameter: &Parameter, row: &Row, node: &Node, units: Units) -> Problem {
    let unit = unit(parameter, row, node, units);
    let message = format!("law `{}` needs `{}`", row.info.name, parameter.name);
    let value = match (units, unit.as_str()) {
        (Units::Si, "1") | (Units::Dimensionless, _) => "…".to_owned(),
        (Units::Si, unit) => format!("\"… {unit}\""),
    };
    let label = format!(
        "expected {{ law = \"{}\", {} = {value} }}: {}",
        row.info.name, parameter.name, parameter.meaning
    );
    Problem::new(&node.span, message, label)
}

/// Largest exponent: steeper is a wall that no step can follow.
const STEEPEST: f64 = 100.0;

fn is_exponent(parameter: &Parameter) -> bool {
    parameter.name == "exponent"
}

/// Calls with what a parameter must be; a law's unit may depend on another
/// of its parameters.
fn expected<T>(
    parameter: &Parameter,
    row: &Row,
    node: &Node,
    units: Units,
    call: impl FnOnce(Expected<'_>) -> T,
) -> T {
    let unit = unit(parameter, row, node, units);
    let most = if is_exponent(parameter) {
        STEEPEST
    } else {
        f64::MAX
    };
    let words = match parameter.least {
        0.0 => "0 or more",
        1.0 if is_exponent(parameter) => "from 1 to 100",
        1.0 => "1 or more",
        _ => "above the law's least value",
    };
    call(Expected {
        name: parameter.name,
        unit: &unit,
        limits: Limits::new(parameter.least, most, true, words),
        units,
    })
}

/// A parameter's unit with `{other}` replaced by the other's value.
pub(crate) fn unit(parameter: &Parameter, row: &Row, node: &Node, units: Units) -> String {
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
    let plain = Expected {
        name: parameter.name,
        unit: "1",
        limits: Limits::ANY,
        units,
    };
    let value = node.get(parameter.name).and_then(|n| plain.read(n).ok());
    // Nine decimals are more than dimensions are compared to, and keep the
    // exponent a ratio of small whole numbers.
    let value = value.map_or(fallback, |si| si.value);
    let text = format!("{:.9}", value.clamp(-1e6, 1e6));
    let short = text.trim_end_matches('0').trim_end_matches('.');
    debug_assert!(units::parse_unit(&format!("m^{short}")).is_ok());
    short.to_owned()
}
