//! What is wrong with a file: errors and warnings that point at their place in it.

use miette::{Diagnostic, LabeledSpan, NamedSource, Severity, SourceCode};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// The text of an experiment file with its name.
pub(crate) type Source = Arc<NamedSource<String>>;

/// One thing to say about an experiment file: what, where, what to do.
///
/// As a [`miette::Diagnostic`] it renders with the offending text underlined.
#[derive(Clone, Debug)]
pub struct Finding {
    severity: Severity,
    problem: FileProblem,
    source: Source,
}

/// A finding of severity [`Severity::Warning`].
pub type Warning = Finding;

/// A finding whose file is not determined yet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FileProblem {
    pub(crate) message: String,
    label: String,
    help: Option<String>,
    pub(crate) span: Range<usize>,
    /// A related place, and what stands there.
    other: Option<Box<(Range<usize>, String)>>,
}

impl FileProblem {
    /// A problem with the text at `span`: what is wrong, and what was expected.
    pub(crate) fn new(
        span: &Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Self {
        Self {
            message: shortened(message.into()),
            label: shortened(label.into()),
            help: None,
            span: span.clone(),
            other: None,
        }
    }

    /// Points at a related place too, with what stands there.
    pub(crate) fn also(mut self, span: &Range<usize>, label: impl Into<String>) -> Self {
        self.other = Some(Box::new((span.clone(), label.into())));
        self
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the word probably meant.
    pub(crate) fn nearest(mut self, word: Option<&str>) -> Self {
        self.help = word.map(|w| format!("did you mean `{w}`?")).or(self.help);
        self
    }

    fn at(self, severity: Severity, source: &Source) -> Finding {
        Finding { severity, problem: self, source: source.clone() }
    }

    pub(crate) fn warning(self, source: &Source) -> Finding {
        self.at(Severity::Warning, source)
    }
}

/// A text of a million letters is not repeated in full.
fn shortened(text: String) -> String {
    const LONGEST: usize = 600;
    match text.char_indices().nth(LONGEST) {
        None => text,
        Some((end, _)) => format!("{}…", text.get(..end).unwrap_or_default()),
    }
}

impl Finding {
    /// Name of the file.
    pub fn file(&self) -> &str {
        self.source.name()
    }

    /// Line in the file, from 1.
    pub fn line(&self) -> usize {
        self.line_of(&self.problem.span)
    }

    fn line_of(&self, span: &Range<usize>) -> usize {
        let before = self.source.inner().get(..span.start);
        1 + before.unwrap_or_default().matches('\n').count()
    }

    /// Line of the related place, if there is one.
    pub fn other_line(&self) -> Option<usize> {
        let (span, _) = self.problem.other.as_deref()?;
        Some(self.line_of(span))
    }

    /// The offending text.
    pub fn text(&self) -> &str {
        let text = self.source.inner().get(self.problem.span.clone());
        text.unwrap_or_default()
    }

    /// What was expected, as written under the offending text.
    pub fn label(&self) -> &str {
        &self.problem.label
    }

    /// File, line, message, expectation and advice in one line, for logs.
    pub fn one_line(&self) -> String {
        let FileProblem { message, label, help, other, .. } = &self.problem;
        let mut text = format!("{}:{}: {message}: {label}", self.file(), self.line());
        if let Some((span, label)) = other.as_deref() {
            text += &format!("; line {}: {label}", self.line_of(span));
        }
        if let Some(help) = help {
            text += &format!(" ({help})");
        }
        text
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem.message)
    }
}

impl std::error::Error for Finding {}

impl Diagnostic for Finding {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let help = self.problem.help.as_ref()?;
        Some(Box::new(help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&*self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let FileProblem { label, span, other, .. } = &self.problem;
        let here = LabeledSpan::new_primary_with_span(Some(label.clone()), span.clone());
        let other = other.as_deref().into_iter();
        let other = other
            .map(|(span, label)| LabeledSpan::new_with_span(Some(label.clone()), span.clone()));
        Some(Box::new(std::iter::once(here).chain(other)))
    }
}

/// All mistakes found in one experiment file; at least one.
#[derive(Clone, Debug)]
pub struct Mistakes(Vec<Finding>);

impl Mistakes {
    pub(crate) fn new(problems: Vec<FileProblem>, source: &Source) -> Self {
        let findings = problems.into_iter().map(|p| p.at(Severity::Error, source));
        Self(findings.collect())
    }

    /// Each mistake, in the order of discovery.
    pub fn findings(&self) -> &[Finding] {
        &self.0
    }
}

impl fmt::Display for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self.0.iter().map(Finding::one_line).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for Mistakes {}

/// A preset, a switch or an option that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what}; expected one of: {}{hint}", .known.join(", "))]
pub struct UnknownName {
    what: String,
    known: Vec<&'static str>,
    hint: String,
}

impl UnknownName {
    pub(crate) fn new(what: String, given: &str, known: Vec<&'static str>) -> Self {
        let near = nearest_word(given, known.iter().copied());
        let hint = near.map_or(String::new(), |word| format!("; did you mean `{word}`?"));
        Self { what, known, hint }
    }
}

/// The word nearest to `text`, if near enough to be a slip: one in three letters, begun ones
/// counted; case makes no distance.
pub(crate) fn nearest_word<'a>(
    text: &str,
    words: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let length = text.chars().count();
    let text = text.to_lowercase();
    let distance = |word: &str| strsim::damerau_levenshtein(&text, &word.to_lowercase());
    // Longer texts are no slip of any key.
    let words = words.into_iter().filter(|_| length <= 64);
    let near = words.map(|word| (distance(word), word));
    let near = near.filter(|(distance, _)| *distance <= length.div_ceil(3).max(1));
    near.min_by_key(|(distance, _)| *distance).map(|(_, word)| word)
}

/// A computed number for messages, to this many digits.
pub(crate) fn to_digits(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits - 1).parse();
    short(rounded.unwrap_or(value))
}

/// An estimate for messages, to two digits.
pub(crate) fn brief(value: f64) -> String {
    to_digits(value, 2)
}

/// A number for messages: as short as it can be read back.
pub(crate) fn short(value: f64) -> String {
    match value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        true => format!("{value}"),
        false => format!("{value:e}"),
    }
}
