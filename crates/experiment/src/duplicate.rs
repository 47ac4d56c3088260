//! A key or table that stands in a file twice, and where the first one is.

use crate::document::{self, Node};
use crate::finding::Problem;
use crate::keys::{Kind, ROOT};
use crate::syntax::{begins_anew, line};
use std::ops::Range;

/// The one problem of a second `[table]` or `key = …`, whose key is at `place`.
pub(crate) fn problem(place: &Range<usize>, text: &str) -> Problem {
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
        true => (whole.trim(), help(written)),
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
fn help(key: &str) -> String {
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
