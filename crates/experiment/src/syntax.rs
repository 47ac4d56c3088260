//! What TOML's parser refuses, in the words of people who write experiments.

use crate::document::{self, Node};
use crate::finding::Problem;
use crate::keys::{Kind, ROOT};
use crate::spec::as_key;
use crate::units;
use std::ops::Range;
use toml::de::Error;

/// Most problems that are reported at once.
const MOST: usize = 20;

/// One problem a slip of the pen: what only follows from an earlier error is
/// left out.
pub(crate) fn problems(errors: &[Error], text: &str) -> Vec<Problem> {
    let mut reported = Reported::default();
    let mut problems = Vec::new();
    for error in errors {
        if problems.len() == MOST {
            break;
        }
        let place = place(error, text);
        let follows = reported.covers(&place, error, text);
        reported.add(&place, error, text);
        if !follows {
            problems.push(problem(error, &place, text));
        }
        if leaves_open(error) {
            break;
        }
    }
    problems
}

/// The text in error; at the end of the file, what stands there last.
fn place(error: &Error, text: &str) -> Range<usize> {
    let end = text.trim_end().len();
    let last = text.get(..end).and_then(|text| text.char_indices().last());
    let last = last.map_or(0, |(at, _)| at);
    match error.span() {
        Some(span) if span.start < end => span.start..span.end.min(text.len()),
        _ => last..end,
    }
}

fn is_duplicate(error: &Error) -> bool {
    error.message().starts_with("duplicate key")
}

/// Whether a list or a table in braces may go on to the end of the file.
fn leaves_open(error: &Error) -> bool {
    let inside = ["key-value pairs", "inline table", "array elements"];
    inside.iter().any(|part| error.message().contains(part))
}

/// How far the text has been reported on.
#[derive(Default)]
struct Reported {
    /// End of the last line with an error, and of what continues it.
    line_end: usize,
    /// End of the last table that stands twice.
    table_end: usize,
}

impl Reported {
    /// Whether an error follows from one already reported.
    fn covers(&self, place: &Range<usize>, error: &Error, text: &str) -> bool {
        let at = line(text, place.start);
        let in_line = at.start < self.line_end;
        let between = text.get(self.line_end..at.start).unwrap_or("?");
        let next = self.line_end > 0 && between.lines().all(is_blank);
        let in_table = is_duplicate(error) && place.start < self.table_end;
        in_line || in_table || (next && !begins_anew(text.get(at).unwrap_or_default()))
    }

    fn add(&mut self, place: &Range<usize>, error: &Error, text: &str) {
        let at = line(text, place.start);
        self.line_end = at.end;
        let header = text.get(at.clone()).unwrap_or_default().trim_start();
        if is_duplicate(error) && header.starts_with('[') {
            let rest = text.get(at.end..).unwrap_or_default();
            let next = rest.find("\n[").unwrap_or(rest.len());
            self.table_end = at.end + next;
        }
    }
}

/// The line around a byte, without its end.
fn line(text: &str, at: usize) -> Range<usize> {
    let before = text.get(..at).unwrap_or_default();
    let after = text.get(at..).unwrap_or_default();
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    let end = at + after.find('\n').unwrap_or(after.len());
    start..end
}

fn is_blank(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || line.starts_with('#')
}

/// Whether a line starts a table or gives a key a value.
fn begins_anew(line: &str) -> bool {
    let key = line.split('=').next().unwrap_or_default().trim();
    let word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    line.starts_with('[') || (line.contains('=') && !key.is_empty() && key.chars().all(word))
}

fn problem(error: &Error, place: &Range<usize>, text: &str) -> Problem {
    if is_duplicate(error) {
        return duplicate(place, text);
    }
    if let Some(problem) = bare_name(place, text) {
        return problem;
    }
    let value = value(text, place.start);
    let raw = text.get(value.clone()).unwrap_or_default();
    if let Some(label) = unquoted(raw) {
        return Problem::new(&value, "this value is not valid TOML", label);
    }
    let (place, label) = match empty(text, place.start) {
        Some(place) => (place, "expected a value after `=`, in this line"),
        None if error.message().starts_with("key with no value") => {
            (place.clone(), "expected `key = value`")
        }
        None => (place.clone(), error.message()),
    };
    Problem::new(&place, "this is not valid TOML", label)
}

/// The name of a table with letters that want quotes, or with a space for a
/// point.
fn bare_name(place: &Range<usize>, text: &str) -> Option<Problem> {
    let line = line(text, place.start);
    let written = text.get(line.clone())?;
    let code = written.split('#').next()?.trim();
    let inner = code.strip_prefix('[')?.strip_suffix(']')?;
    if inner.contains(['[', ']', '"', '\'', ',', '=']) {
        return None;
    }
    let name = match inner.trim().split_once([' ', '\t']) {
        Some(("materials", name)) => format!("materials.{}", as_key(name.trim())),
        _ => inner
            .split('.')
            .map(|part| as_key(part.trim()))
            .collect::<Vec<_>>()
            .join("."),
    };
    let start = line.start + written.find('[')?;
    let place = start..start + code.len();
    let label = format!("expected [{name}]");
    (name != inner).then(|| Problem::new(&place, "this is no name of a table", label))
}

/// A `key =` without a value, in the line of an error or right before it.
fn empty(text: &str, at: usize) -> Option<Range<usize>> {
    let here = line(text, at);
    let before = line(text, here.start.saturating_sub(1));
    let lines = [here, before].into_iter();
    let mut lines = lines.map(|l| (text.get(l.clone()).unwrap_or_default(), l));
    let (_, place) = lines.find(|(written, _)| {
        let code = written.split('#').next().unwrap_or_default();
        code.trim_end().ends_with('=') && begins_anew(written)
    })?;
    Some(place)
}

/// The value written in the line around a byte, without a comment.
fn value(text: &str, at: usize) -> Range<usize> {
    let line = line(text, at);
    let whole = text.get(line.clone()).unwrap_or_default();
    let from = whole.find('=').map_or(whole.len(), |equals| equals + 1);
    let rest = whole.get(from..).unwrap_or_default();
    let rest = rest.split('#').next().unwrap_or_default();
    let start = line.start + from + (rest.len() - rest.trim_start().len());
    start..start + rest.trim().len()
}

/// What to write for a value that lacks its quotes.
fn unquoted(raw: &str) -> Option<String> {
    if raw.contains(['“', '”', '„', '«', '»', '‘', '’']) {
        let inner = raw.trim_matches(|c: char| !c.is_alphanumeric());
        return Some(format!("expected straight quotes: \"{inner}\""));
    }
    let word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ' ');
    match units::parse_quantity(raw) {
        _ if raw.is_empty() => None,
        Ok(number) if number.dimension == units::Dimension::NONE => None,
        Ok(_) => Some(format!("expected quotes around a quantity: \"{raw}\"")),
        Err(_) if decimal_comma(raw).is_some() => decimal_comma(raw),
        Err(error) if raw.starts_with(|c: char| c.is_ascii_digit()) => Some(format!(
            "expected a number, or a quantity in quotes; {error}"
        )),
        Err(_) if raw.starts_with(char::is_alphabetic) && raw.chars().all(word) => {
            Some(format!("expected quotes around a text: \"{raw}\""))
        }
        Err(_) => None,
    }
}

/// "6,35 mm" or 6,35 with a point, in quotes where a unit needs them.
fn decimal_comma(raw: &str) -> Option<String> {
    let better = units::with_decimal_point(raw)?;
    let plain = better.parse::<f64>().is_ok();
    let written = match plain {
        true => better,
        false => format!("\"{better}\""),
    };
    Some(format!("expected a decimal point: write {written}"))
}

/// The one problem of a second `[table]` or `key = …`, whose key is at `place`.
fn duplicate(place: &Range<usize>, text: &str) -> Problem {
    let line = line(text, place.start);
    let whole = text.get(line.clone()).unwrap_or_default();
    let before = text.get(..line.start).unwrap_or_default();
    let equals = whole.find('=').map_or(line.end, |at| line.start + at);
    let first = match whole.trim_start().starts_with('[') {
        true => header(before, whole),
        false if begins_anew(whole) && place.start < equals => key(before, whole),
        false => beside(text, line.start, place),
    };
    let written = text.get(place.clone()).unwrap_or_default();
    let (what, help) = match whole.trim_start().starts_with('[') {
        true => (whole.trim(), duplicate_help(written)),
        false => (written, "keep one of the two".to_owned()),
    };
    let message = format!("`{what}` stands here a second time");
    let problem = Problem::new(place, message, "expected it once").help(help);
    match first {
        Some(span) => problem.beside(&span, "the first one is here"),
        None => problem,
    }
}

/// What to do about a second table.
fn duplicate_help(key: &str) -> String {
    match ROOT.key(key).map(|key| &key.kind) {
        Some(Kind::Tables(_)) => format!("write [[{key}]] to add one more"),
        _ => "put all its keys into one table".to_owned(),
    }
}

/// The keys of a header line, or of a line that gives a key a value.
fn path(line: &str) -> Option<Vec<String>> {
    let written = match line.trim_start().starts_with('[') {
        true => line.to_owned(),
        false => format!("{} = 0", line.split('=').next()?),
    };
    let tree = document::understood(&written);
    let mut at = &tree;
    let mut keys = Vec::new();
    while let Some(entry) = latest(at).entries().first() {
        keys.push(entry.key.clone());
        at = &entry.node;
    }
    Some(keys)
}

/// A table, or the last of a list of them.
fn latest(node: &Node) -> &Node {
    node.members().last().unwrap_or(node)
}

fn header(before: &str, whole: &str) -> Option<Range<usize>> {
    let tree = document::understood(before);
    place_of(&tree, &path(whole)?)
}

/// The same key in the table that is open where the line stands.
fn key(before: &str, whole: &str) -> Option<Range<usize>> {
    let tree = document::understood(before);
    let mut lines = before.lines().rev();
    let open = lines.find(|line| line.trim_start().starts_with('['));
    let mut full = open.map_or(Some(Vec::new()), path)?;
    full.extend(path(whole)?);
    place_of(&tree, &full)
}

/// Where a path's last key, or as much of it as there is, stands.
fn place_of(tree: &Node, path: &[String]) -> Option<Range<usize>> {
    let mut at = tree;
    let mut place = None;
    for key in path {
        let entry = latest(at).entries().iter().find(|e| e.key == *key)?;
        place = Some(entry.key_span.clone());
        at = &entry.node;
    }
    place
}

/// The same word earlier in the line, for a table in braces.
fn beside(text: &str, from: usize, place: &Range<usize>) -> Option<Range<usize>> {
    let word = text.get(place.clone())?;
    let at = from + text.get(from..place.start)?.rfind(word)?;
    Some(at..at + word.len())
}
