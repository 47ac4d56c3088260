//! A file's text as a tree of values with their places, and what is no TOML in it.

use crate::keys::{KeyKind, ROOT};
use crate::report::FileProblem;
use crate::units;
use std::io::{Error as IoError, Read};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue, Error};

/// One value with its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) value: TomlValue,
    pub(crate) span: Range<usize>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TomlValue {
    Text(String),
    Number(TomlNumber),
    Flag(bool),
    List(Vec<Node>),
    Table(Vec<TableEntry>),
    /// A date or time, which no key of an experiment is.
    Date,
}

/// A number without quotes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TomlNumber {
    pub(crate) value: f64,
    /// Half a unit of the last digit written.
    pub(crate) half_digit: f64,
    /// Given in SI by a program, whatever the file's units.
    pub(crate) from_code: bool,
}

/// One key and its value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TableEntry {
    pub(crate) key: String,
    pub(crate) key_span: Range<usize>,
    pub(crate) node: Node,
}

impl TomlValue {
    /// A number in SI that a program sets.
    pub(crate) const fn from_code(value: f64, half_digit: f64) -> Self {
        let from_code = true;
        Self::Number(TomlNumber { value, half_digit, from_code })
    }

    /// A number as the file writes it.
    pub(crate) const fn number(value: f64, half_digit: f64) -> Self {
        let from_code = false;
        Self::Number(TomlNumber { value, half_digit, from_code })
    }
}

impl Node {
    /// The kind of value in messages.
    pub(crate) const fn kind(&self) -> &'static str {
        match &self.value {
            TomlValue::Text(_) => "text",
            TomlValue::Number(_) => "a plain number",
            TomlValue::Flag(_) => "true or false",
            TomlValue::List(_) => "a list",
            TomlValue::Table(_) => "a table",
            TomlValue::Date => "a date or time",
        }
    }

    pub(crate) const fn is_table(&self) -> bool {
        matches!(self.value, TomlValue::Table(_))
    }

    /// The entries of a table; none of anything else.
    pub(crate) fn entries(&self) -> &[TableEntry] {
        match &self.value {
            TomlValue::Table(entries) => entries,
            _ => &[],
        }
    }

    /// The members of a list; none of anything else.
    pub(crate) fn members(&self) -> &[Self] {
        match &self.value {
            TomlValue::List(members) => members,
            _ => &[],
        }
    }

    /// The value of a key.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let entry = self.entries().iter().find(|entry| entry.key == key)?;
        Some(&entry.node)
    }

    /// The members of the list at a key; none without it.
    pub(crate) fn list(&self, key: &str) -> &[Self] {
        self.get(key).map_or(&[], Self::members)
    }

    pub(crate) fn text(&self) -> Option<&str> {
        match &self.value {
            TomlValue::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The value of a key, made a table where there is none. What is no table becomes one: a
    /// law given by its name alone keeps the name as its `law`.
    pub(crate) fn entry_mut(&mut self, key: &str) -> &mut Self {
        let span = self.span.clone();
        let entry = |key: &str, value: TomlValue| TableEntry {
            key: key.to_owned(),
            key_span: span.clone(),
            node: Self { value, span: span.clone() },
        };
        if !self.is_table() {
            let law = self.text().map(|law| entry("law", TomlValue::Text(law.to_owned())));
            self.value = TomlValue::Table(law.into_iter().collect());
        }
        let TomlValue::Table(entries) = &mut self.value else {
            unreachable!("the value has just been made a table");
        };
        let at = entries.iter().position(|entry| entry.key == key);
        let at = at.unwrap_or(entries.len());
        if at == entries.len() {
            entries.push(entry(key, TomlValue::Table(Vec::new())));
        }
        &mut entries[at].node
    }
}

/// Parses a text; every slip of the pen is one problem.
pub(crate) fn parse(text: &str) -> Result<Node, Vec<FileProblem>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let root = Node { value: TomlValue::Table(entries(table.get_ref())), span: table.span() };
    match errors.is_empty() {
        true => Ok(root),
        false => Err(problems(&errors, text)),
    }
}

/// Entries in the order of the text.
fn entries(table: &DeTable<'_>) -> Vec<TableEntry> {
    let entry = |(key, value): (&Spanned<DeString<'_>>, &Spanned<DeValue<'_>>)| TableEntry {
        key: key.get_ref().to_string(),
        key_span: key.span(),
        node: node(value),
    };
    let mut entries: Vec<TableEntry> = table.iter().map(entry).collect();
    entries.sort_by_key(|entry| entry.key_span.start);
    entries
}

fn node(value: &Spanned<DeValue<'_>>) -> Node {
    let converted = match value.get_ref() {
        DeValue::String(text) => TomlValue::Text(text.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(whole) => TomlValue::number(whole as f64, 0.5),
            Err(_) => float(integer.as_str()),
        },
        DeValue::Float(text) => float(text.as_str()),
        DeValue::Boolean(flag) => TomlValue::Flag(*flag),
        DeValue::Array(members) => TomlValue::List(members.iter().map(node).collect()),
        DeValue::Table(table) => TomlValue::Table(entries(table)),
        DeValue::Datetime(_) => TomlValue::Date,
    };
    Node { value: converted, span: value.span() }
}

/// A float as written; what is not a finite decimal becomes NaN or an
/// infinity, which every key refuses.
fn float(text: &str) -> TomlValue {
    let half_digit = units::parse_quantity(text).map_or(f64::NAN, |q| q.half_digit);
    TomlValue::number(text.parse().unwrap_or(f64::NAN), half_digit)
}

/// Reads the text of a file; what is none is an error that says what it is instead.
pub(crate) fn read_text(path: &Path) -> Result<String, IoError> {
    /// Larger files are a mistake.
    const MOST_BYTES: u64 = 16 << 20;
    if path.is_dir() {
        return Err(IoError::other("it is a folder; expected an experiment file"));
    }
    let mut bytes = Vec::new();
    // One byte more shows a file that is too large; an endless one ends.
    let file = std::fs::File::open(path)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(IoError::other("an experiment file has at most 16 MiB"));
    }
    let wide = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
    let binary = bytes.contains(&0);
    let wrong = match String::from_utf8(bytes) {
        Ok(text) if !binary => return Ok(text),
        _ if wide => "it is written in UTF-16; save it as UTF-8".to_owned(),
        Err(error) if !binary => {
            let valid = error.utf8_error().valid_up_to();
            let before = error.as_bytes().iter().take(valid);
            let line = 1 + before.filter(|byte| **byte == b'\n').count();
            format!("line {line} is not written in UTF-8; save the file as UTF-8")
        }
        _ => "it is no text in UTF-8: it holds zero bytes; expected an experiment file".to_owned(),
    };
    Err(IoError::other(wrong))
}

/// One problem a slip of the pen, at most 20: what only follows from an earlier error is
/// left out.
fn problems(errors: &[Error], text: &str) -> Vec<FileProblem> {
    const MOST: usize = 20;
    let mut reported = Reported::default();
    let mut problems = Vec::new();
    for error in errors {
        let place = place(error, text);
        let follows = reported.covers(&place, error, text);
        reported.add(&place, error, text);
        if !follows {
            problems.push(problem(error, &place, text));
        }
        // A list or a table in braces may go on to the end of the file.
        let inside = ["key-value pairs", "inline table", "array elements"];
        let open = inside.iter().any(|part| error.message().contains(part));
        if open || problems.len() == MOST {
            break;
        }
    }
    problems
}

/// The text in error; at the end of the file, what stands there last.
fn place(error: &Error, text: &str) -> Range<usize> {
    let end = text.trim_end().len();
    match error.span() {
        Some(span) if span.start < end => span.start..span.end.min(text.len()),
        _ => text.trim_end().char_indices().last().map_or(0, |(at, _)| at)..end,
    }
}

fn is_duplicate(error: &Error) -> bool {
    error.message().starts_with("duplicate key")
}

/// The part of a text that has been reported on.
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
        let between = text.get(self.line_end..at.start).unwrap_or("?");
        let blank = |line: &str| matches!(line.trim_start().chars().next(), None | Some('#'));
        let next = self.line_end > 0 && between.lines().all(blank);
        let in_table = is_duplicate(error) && place.start < self.table_end;
        at.start < self.line_end || in_table || (next && key_of(&text[at]).is_none())
    }

    fn add(&mut self, place: &Range<usize>, error: &Error, text: &str) {
        let at = line(text, place.start);
        self.line_end = at.end;
        if is_duplicate(error) && text[at.clone()].trim_start().starts_with('[') {
            let rest = &text[at.end..];
            self.table_end = at.end + rest.find("\n[").unwrap_or(rest.len());
        }
    }
}

/// The line around a byte, without its end.
fn line(text: &str, at: usize) -> Range<usize> {
    let at = (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    start..at + text[at..].find('\n').unwrap_or(text.len() - at)
}

/// The name of the table that a line starts, or of the key to which it gives a value.
fn key_of(line: &str) -> Option<&str> {
    let line = line.trim();
    if line.starts_with('[') {
        return Some(line.split('#').next()?.trim_matches(['[', ']', ' ']));
    }
    let word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    let key = line.split_once('=')?.0.trim();
    (!key.is_empty() && key.chars().all(word)).then_some(key)
}

fn problem(error: &Error, place: &Range<usize>, text: &str) -> FileProblem {
    if is_duplicate(error) {
        return duplicate(place, text);
    }
    let here = line(text, place.start);
    if let Some(problem) = wrong_name(&here, text) {
        return problem;
    }
    // The value in the line, without a comment.
    let value_at = here.start + text[here.clone()].find('=').map_or(here.len(), |at| at + 1);
    let raw = text[value_at..here.end].split('#').next().unwrap_or_default();
    if let Some(label) = unquoted(raw.trim()) {
        let start = value_at + (raw.len() - raw.trim_start().len());
        let place = start..start + raw.trim().len();
        return FileProblem::new(&place, "this value is not valid TOML", label);
    }
    // A `key =` without a value, in this line or right before it.
    let before = line(text, here.start.saturating_sub(1));
    let empty = [here, before].into_iter().find(|line| {
        let code = text[line.clone()].split('#').next().unwrap_or_default();
        code.trim_end().ends_with('=') && key_of(code).is_some()
    });
    let (place, label) = match empty {
        Some(place) => (place, "expected a value after `=`, in this line"),
        None if error.message().starts_with("key with no value") => {
            (place.clone(), "expected `key = value`")
        }
        None => (place.clone(), error.message()),
    };
    FileProblem::new(&place, "this is not valid TOML", label)
}

/// The name of a table with letters that need quotes, or with a space for a point.
fn wrong_name(line: &Range<usize>, text: &str) -> Option<FileProblem> {
    let written = &text[line.clone()];
    let code = written.split('#').next()?.trim();
    let inner = code.strip_prefix('[')?.strip_suffix(']')?;
    if inner.contains(['[', ']', '"', '\'', ',', '=']) {
        return None;
    }
    let name = match inner.trim().split_once([' ', '\t']) {
        Some(("materials", name)) => format!("materials.{}", as_key(name.trim())),
        _ => {
            let parts = inner.split('.').map(|part| as_key(part.trim()));
            parts.collect::<Vec<_>>().join(".")
        }
    };
    let start = line.start + written.find('[')?;
    let place = start..start + code.len();
    let label = format!("expected [{name}]");
    (name != inner).then(|| FileProblem::new(&place, "this is no name of a table", label))
}

/// A name as a key of TOML: in quotes unless it is bare.
pub(crate) fn as_key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    match !name.is_empty() && name.chars().all(bare) {
        true => name.to_owned(),
        false => format!("{name:?}"),
    }
}

/// What to write for a value that lacks its quotes.
fn unquoted(raw: &str) -> Option<String> {
    if raw.contains(['“', '”', '„', '«', '»', '‘', '’']) {
        let inner = raw.trim_matches(|c: char| !c.is_alphanumeric());
        return Some(format!("expected straight quotes: \"{inner}\""));
    }
    let word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ' ');
    let point = units::with_decimal_point(raw);
    match units::parse_quantity(raw) {
        _ if raw.is_empty() => None,
        Ok(number) if number.dimension == units::Dimension::NONE => None,
        Ok(_) => Some(format!("expected quotes around a quantity: \"{raw}\"")),
        Err(error) => match point {
            Some(better) if better.parse::<f64>().is_ok() => {
                Some(format!("expected a decimal point: write {better}"))
            }
            Some(better) => Some(format!("expected a decimal point: write \"{better}\"")),
            None if raw.starts_with(|c: char| c.is_ascii_digit()) => {
                Some(format!("expected a number, or a quantity in quotes; {error}"))
            }
            None if raw.starts_with(char::is_alphabetic) && raw.chars().all(word) => {
                Some(format!("expected quotes around a text: \"{raw}\""))
            }
            None => None,
        },
    }
}

/// The one problem of a second `[table]` or `key = …`, whose key is at `place`.
fn duplicate(place: &Range<usize>, text: &str) -> FileProblem {
    let line = line(text, place.start);
    let whole = text[line.clone()].trim();
    let key = &text[place.clone()];
    let is_header = whole.starts_with('[');
    let (what, help) = match (is_header, ROOT.key(key).map(|key| &key.kind)) {
        (true, Some(KeyKind::Tables(_))) => (whole, format!("write [[{key}]] to add one more")),
        (true, _) => (whole, "put all its keys into one table".to_owned()),
        (false, _) => (key, "keep one of the two".to_owned()),
    };
    let message = format!("`{what}` stands here a second time");
    let problem = FileProblem::new(place, message, "expected it once").help(help);
    match first_place(text, &line, place) {
        Some(span) => problem.also(&span, "the first one is here"),
        None => problem,
    }
}

/// Where the key at `place` stands for the first time: earlier in its line, for a table in
/// braces; in a line above of the same table; or in the header of an earlier table.
fn first_place(text: &str, line: &Range<usize>, place: &Range<usize>) -> Option<Range<usize>> {
    let key = &text[place.clone()];
    if let Some(at) = text[line.start..place.start].find(key)
        && text[line.start..place.start].contains('{')
    {
        return Some(line.start + at..line.start + at + key.len());
    }
    let name = key_of(&text[line.clone()])?;
    let is_header = |line: &str| line.trim_start().starts_with('[');
    let own_header = is_header(&text[line.clone()]);
    let mut end = line.start;
    let mut first = None;
    for above in text[..line.start].lines().rev() {
        end = text[..end].rfind(above)?;
        if !own_header && is_header(above) {
            break;
        }
        if own_header == is_header(above) && key_of(above) == Some(name) {
            let at = end + above.find(key)?;
            first = Some(at..at + key.len());
        }
    }
    first
}
