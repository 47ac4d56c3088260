//! Why there is no answer.

use super::Step;
use hertzchain_experiment::{Finding, Mistakes, PathError};
use hertzchain_sim::StudyError;
use miette::Diagnostic;
use serde::Serialize;
use std::ops::Range;
use toml_edit::{Document, Item, TableLike, Value};

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    /// Mistakes in the experiment.
    Mistakes(Vec<Mistake>),
    /// Anything else, in words.
    Error(String),
    /// The page does not want the answer any more.
    Stopped,
}

/// A mistake in an experiment, or a warning about it, with its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mistake {
    /// What is wrong.
    pub message: String,
    /// What was expected.
    pub expected: String,
    /// What to do.
    pub help: Option<String>,
    /// Line of the text, from 1.
    pub line: usize,
    /// Keys and indices that lead to the value; empty where it has no place of its own.
    pub path: Vec<Step>,
}

impl Refusal {
    /// Returns a refusal in the words of an error.
    pub fn words(error: impl std::fmt::Display) -> Self {
        Self::Error(error.to_string())
    }

    /// Returns why a request can't be read.
    pub(crate) fn unread(error: serde_json::Error) -> Self {
        Self::Error(format!("the request is not understood: {error}"))
    }

    /// Returns the mistakes of an experiment's text.
    pub fn of_text(text: &str, mistakes: &Mistakes) -> Self {
        Self::Mistakes(Mistake::all(text, mistakes.findings()))
    }

    /// Returns what kept a shot of an experiment's text from being computed.
    pub fn of_study(text: &str, error: StudyError) -> Self {
        match error {
            StudyError::Mistakes(mistakes) => Self::of_text(text, &mistakes),
            StudyError::Number(error) => match *error {
                PathError::Mistakes(mistakes) => Self::of_text(text, &mistakes),
                other => Self::words(other),
            },
            StudyError::Stopped => Self::Stopped,
            other => Self::words(other),
        }
    }
}

impl Mistake {
    /// Returns findings with their places in the text as keys and indices.
    pub fn all(text: &str, findings: &[Finding]) -> Vec<Self> {
        let document = Document::parse(text).ok();
        let mut places = Vec::new();
        if let Some(document) = &document {
            of_table(document.as_table(), None, &mut Vec::new(), &mut places);
        }
        findings.iter().map(|finding| Self::of(finding, &places)).collect()
    }

    fn of(finding: &Finding, places: &[Place]) -> Self {
        let label = finding.labels().and_then(|mut labels| labels.next());
        let start = label.map_or(0, |label| label.offset());
        let around = places.iter().filter(|(span, _)| span.contains(&start));
        let innermost = around.min_by_key(|(span, _)| span.len());
        Self {
            message: finding.to_string(),
            expected: finding.label().to_owned(),
            help: finding.help().map(|help| help.to_string()),
            line: finding.line(),
            path: innermost.map_or_else(Vec::new, |(_, path)| path.clone()),
        }
    }
}

/// Bytes of a value, or of its key, and what leads to it.
type Place = (Range<usize>, Vec<Step>);

fn of_table(
    table: &dyn TableLike,
    span: Option<Range<usize>>,
    path: &mut Vec<Step>,
    places: &mut Vec<Place>,
) {
    places.extend(span.map(|span| (span, path.clone())));
    for (name, item) in table.iter() {
        path.push(Step::Key(name.to_owned()));
        let key = table.key(name).and_then(toml_edit::Key::span);
        places.extend(key.map(|span| (span, path.clone())));
        of_item(item, path, places);
        path.pop();
    }
}

fn of_item(item: &Item, path: &mut Vec<Step>, places: &mut Vec<Place>) {
    match item {
        Item::None => {}
        Item::Value(value) => of_value(value, path, places),
        Item::Table(table) => of_table(table, table.span(), path, places),
        Item::ArrayOfTables(tables) => {
            for (at, table) in tables.iter().enumerate() {
                path.push(Step::Index(at));
                of_table(table, table.span(), path, places);
                path.pop();
            }
        }
    }
}

fn of_value(value: &Value, path: &mut Vec<Step>, places: &mut Vec<Place>) {
    places.extend(value.span().map(|span| (span, path.clone())));
    match value {
        Value::Array(array) => {
            for (at, value) in array.iter().enumerate() {
                path.push(Step::Index(at));
                of_value(value, path, places);
                path.pop();
            }
        }
        Value::InlineTable(table) => of_table(table, None, path, places),
        _ => {}
    }
}
