//! A TOML text as a tree that knows where each value stands.

use crate::finding::Problem;
use crate::syntax;
use crate::units;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// One value with its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) span: Range<usize>,
}

/// What a value is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Number(Number),
    Flag(bool),
    List(Vec<Node>),
    Table(Vec<Entry>),
    /// Something TOML knows and an experiment does not.
    Other(&'static str),
}

/// A number without quotes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub(crate) value: f64,
    /// Half a unit of the last digit written.
    pub(crate) half_digit: f64,
    /// Given in SI by a program, whatever the file's units.
    pub(crate) from_code: bool,
}

/// One key and its value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_span: Range<usize>,
    pub(crate) node: Node,
}

impl Value {
    /// A number in SI that a program sets.
    pub(crate) fn from_code(value: f64) -> Self {
        Self::Number(Number {
            value,
            half_digit: 0.0,
            from_code: true,
        })
    }
}

impl Node {
    /// What the value is called in messages.
    pub(crate) fn kind(&self) -> &'static str {
        match &self.value {
            Value::Text(_) => "text",
            Value::Number(_) => "a plain number",
            Value::Flag(_) => "true or false",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
            Value::Other(kind) => kind,
        }
    }

    /// The entries of a table; none of anything else.
    pub(crate) fn entries(&self) -> &[Entry] {
        match &self.value {
            Value::Table(entries) => entries,
            _ => &[],
        }
    }

    /// The members of a list; none of anything else.
    pub(crate) fn members(&self) -> &[Self] {
        match &self.value {
            Value::List(members) => members,
            _ => &[],
        }
    }

    /// The value of a key.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let entry = self.entries().iter().find(|entry| entry.key == key)?;
        Some(&entry.node)
    }

    /// The text of a text.
    pub(crate) fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// Parses a text; every syntax error is one problem.
pub(crate) fn parse(text: &str) -> Result<Node, Vec<Problem>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    match errors.is_empty() {
        true => Ok(root(&table)),
        false => Err(syntax::problems(&errors, text)),
    }
}

/// What can be understood of a text, whatever is wrong with the rest.
pub(crate) fn understood(text: &str) -> Node {
    root(&DeTable::parse_recoverable(text).0)
}

fn root(table: &Spanned<DeTable<'_>>) -> Node {
    Node {
        value: Value::Table(entries(table.get_ref())),
        span: table.span(),
    }
}

/// Entries in the order of the text.
fn entries(table: &DeTable<'_>) -> Vec<Entry> {
    let entry = |(key, value): (&Spanned<DeString<'_>>, &Spanned<DeValue<'_>>)| Entry {
        key: key.get_ref().to_string(),
        key_span: key.span(),
        node: node(value),
    };
    let mut entries: Vec<Entry> = table.iter().map(entry).collect();
    entries.sort_by_key(|entry| entry.key_span.start);
    entries
}

fn node(value: &Spanned<DeValue<'_>>) -> Node {
    let converted = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(whole) => number(whole as f64, 0.5),
            Err(_) => float(integer.as_str()),
        },
        DeValue::Float(text) => float(text.as_str()),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Array(members) => Value::List(members.iter().map(node).collect()),
        DeValue::Table(table) => Value::Table(entries(table)),
        DeValue::Datetime(_) => Value::Other("a date or time"),
    };
    Node {
        value: converted,
        span: value.span(),
    }
}

fn number(value: f64, half_digit: f64) -> Value {
    Value::Number(Number {
        value,
        half_digit,
        from_code: false,
    })
}

/// A float as written; what is not a finite decimal becomes NaN or an
/// infinity, which every key refuses.
fn float(text: &str) -> Value {
    let half_digit = units::parse_quantity(text).map_or(f64::NAN, |q| q.half_digit);
    number(text.parse().unwrap_or(f64::NAN), half_digit)
}
