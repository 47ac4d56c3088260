//! What there is to say about a file: mistakes and warnings that point at
//! their place in it.

use miette::{Diagnostic, LabeledSpan, NamedSource, Severity, SourceCode};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// The text of an experiment file with its name.
pub type Source = Arc<NamedSource<String>>;

/// One thing to say about an experiment file: what, where, what to do.
///
/// As a [`miette::Diagnostic`] it renders with the offending text underlined.
#[derive(Clone, Debug)]
pub struct Finding {
    severity: Severity,
    problem: Problem,
    source: Source,
}

/// A finding of severity [`Severity::Warning`].
pub type Warning = Finding;

/// A finding before it is known in which file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Problem {
    message: String,
    label: String,
    help: Option<String>,
    span: Range<usize>,
    /// Another place that has to do with it, and what stands there.
    other: Option<Box<(Range<usize>, String)>>,
}

impl Problem {
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

    /// Points at another place too, with what stands there.
    pub(crate) fn beside(mut self, span: &Range<usize>, label: impl Into<String>) -> Self {
        self.other = Some(Box::new((span.clone(), label.into())));
        self
    }

    /// Whether its message ends so.
    pub(crate) fn says(&self, end: &str) -> bool {
        self.message.ends_with(end)
    }

    pub(crate) fn same_message(&self, other: &Self) -> bool {
        self.message == other.message
    }

    /// Where it stands.
    pub(crate) const fn place(&self) -> &Range<usize> {
        &self.span
    }

    pub(crate) const fn start(&self) -> usize {
        self.span.start
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
        Finding {
            severity,
            problem: self,
            source: source.clone(),
        }
    }

    pub(crate) fn mistake(self, source: &Source) -> Finding {
        self.at(Severity::Error, source)
    }

    pub(crate) fn warning(self, source: &Source) -> Finding {
        self.at(Severity::Warning, source)
    }
}

/// Longest message: a text of a million letters is not repeated in full.
const LONGEST: usize = 600;

fn shortened(text: String) -> String {
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

    /// Line of the other place that has to do with it, if there is one.
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
        let other = self.problem.other.as_deref().into_iter();
        let other = other.map(|(span, label)| format!("; line {}: {label}", self.line_of(span)));
        let help = self.problem.help.iter().map(|help| format!(" ({help})"));
        format!(
            "{}:{}: {}: {}{}",
            self.file(),
            self.line(),
            self.problem.message,
            self.problem.label,
            other.chain(help).collect::<String>()
        )
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
        let label = Some(self.problem.label.clone());
        let here = LabeledSpan::new_primary_with_span(label, self.problem.span.clone());
        let other = self.problem.other.as_deref().into_iter();
        let other = other
            .map(|(span, label)| LabeledSpan::new_with_span(Some(label.clone()), span.clone()));
        Some(Box::new(std::iter::once(here).chain(other)))
    }
}

/// All mistakes found in one experiment file; at least one.
#[derive(Clone, Debug)]
pub struct Mistakes(Vec<Finding>);

impl Mistakes {
    pub(crate) fn new(problems: Vec<Problem>, source: &Source) -> Self {
        let findings = problems.into_iter().map(|p| p.mistake(source));
        Self(findings.collect())
    }

    pub(crate) fn one(problem: Problem, source: &Source) -> Self {
        Self::new(vec![problem], source)
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
