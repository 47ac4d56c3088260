//! What went wrong, described to people.

use crate::options::{SimulationOptions as How, has_unit};
use hertzchain_experiment::{
    Experiment, Finding, Mistakes, OpenError, PathError, UnknownName, Warning,
};
use hertzchain_infer::InferError;
use hertzchain_sim::rig::RigError;
use hertzchain_sim::{StudyError, parse_speed};
use miette::{Diagnostic, Severity};
use std::path::Path;

/// Why a verb failed.
#[derive(Debug)]
pub enum Failure {
    /// Mistakes in an experiment file.
    Mistakes(Mistakes),
    /// Another mistake of the user.
    User(String),
    /// Our fault, or the machine's.
    Ours(String),
    /// The output is not read any more: no failure at all.
    BrokenPipe,
}

impl From<Mistakes> for Failure {
    fn from(mistakes: Mistakes) -> Self {
        Self::Mistakes(mistakes)
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Mistakes(mistakes) => (*mistakes).into(),
            StudyError::Number(error) => (*error).into(),
            StudyError::Unwritable(why) => Self::Ours(why),
            other => Self::User(other.to_string()),
        }
    }
}

impl From<RigError> for Failure {
    fn from(error: RigError) -> Self {
        match error {
            RigError::Mistakes(mistakes) => (*mistakes).into(),
            // A full disk is not the user's mistake.
            RigError::Record(error) => Self::Ours(error.to_string()),
            other => Self::User(other.to_string()),
        }
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Mistakes(mistakes) => mistakes.into(),
            other => Self::User(other.to_string()),
        }
    }
}

impl From<PathError> for Failure {
    fn from(error: PathError) -> Self {
        match error {
            PathError::Mistakes(mistakes) => mistakes.into(),
            other => Self::User(other.to_string()),
        }
    }
}

impl From<UnknownName> for Failure {
    fn from(error: UnknownName) -> Self {
        Self::User(error.to_string())
    }
}

impl From<InferError> for Failure {
    fn from(error: InferError) -> Self {
        Self::User(error.to_string())
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.report(false).trim_end())
    }
}

impl std::error::Error for Failure {}

impl Failure {
    /// What kept a shot from being computed, at the place in the experiment
    /// that has to do with it; what the command line asks for has no place.
    pub(crate) fn of_shot(experiment: &Experiment, how: &How, error: StudyError) -> Self {
        let asked = how.solver.is_some() || how.step.is_some() || how.accuracy.is_some();
        match &error {
            _ if asked => error.into(),
            StudyError::Solve(why) => experiment.unsolved(why).into(),
            StudyError::NotConverged(why) => experiment.unreached(why).into(),
            _ => error.into(),
        }
    }

    /// Mistakes at a speed that an option gave: what would underline the speed
    /// in the file is described of the option instead.
    pub(crate) fn at_option(option: &str, mistakes: Mistakes) -> Self {
        match of_speed(&mistakes) {
            Some(text) => Self::User(format!("{option}: {text}")),
            None => mistakes.into(),
        }
    }

    /// What people are described, with marks in colour or plain.
    pub fn report(&self, colour: bool) -> String {
        match self {
            Self::Mistakes(mistakes) => findings(mistakes.findings(), "mistakes", colour),
            Self::User(text) | Self::Ours(text) => format!("error: {text}\n"),
            Self::BrokenPipe => String::new(),
        }
    }
}

/// That a file can't be read, and why.
pub(crate) fn unread<E: std::fmt::Display>(file: &Path) -> impl Fn(E) -> Failure {
    move |error| Failure::User(format!("{} can't be read: {error}", file.display()))
}

/// A report that underlines the offending text, where that is of readable length.
#[cfg(not(target_family = "wasm"))]
fn underlined(finding: &Finding, colour: bool) -> Option<String> {
    use miette::{GraphicalReportHandler, GraphicalTheme};
    let theme = match colour {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    let handler = GraphicalReportHandler::new_themed(theme).with_links(false);
    let mut text = String::new();
    (fits(finding) && handler.render_report(&mut text, finding).is_ok()).then_some(text)
}

/// In a page a sentence has to do: its renderer is a thirtieth of the engine.
#[cfg(target_family = "wasm")]
fn underlined(_: &Finding, _: bool) -> Option<String> {
    None
}

const MOST: usize = 20;

fn findings(findings: &[Finding], kind: &str, colour: bool) -> String {
    let described = findings.iter().take(MOST);
    let mut text: String = described.map(|finding| report(finding, colour)).collect();
    let more = findings.len().saturating_sub(MOST);
    if more > 0 {
        text += &format!("… and {more} more {kind}\n");
    }
    text
}

/// Longest line that is shown with something underlined, in bytes; beyond the
/// renderer's columns there is no place for marks.
#[cfg(not(target_family = "wasm"))]
const LONGEST_LINE: usize = 2000;

/// A report, with the offending text underlined where that can be shown.
pub fn report(finding: &Finding, colour: bool) -> String {
    if let Some(text) = underlined(finding, colour) {
        return format!("{}\n", text.trim_end());
    }
    let kind = match finding.severity() {
        Some(Severity::Warning) => "warning",
        _ => "error",
    };
    format!("{kind}: {}\n", finding.one_line())
}

/// Whether all lines that a report would show are of readable length.
#[cfg(not(target_family = "wasm"))]
fn fits(finding: &Finding) -> bool {
    let shown = |label: miette::LabeledSpan| {
        let source = finding.source_code()?;
        let context = source.read_span(label.inner(), 1, 1).ok()?;
        let mut lines = context.data().split(|byte| *byte == b'\n');
        Some(lines.all(|line| line.len() <= LONGEST_LINE))
    };
    let mut labels = finding.labels().into_iter().flatten();
    labels.all(|label| shown(label) == Some(true))
}

/// Message, expectation and advice, without a place.
fn placeless(finding: &Finding) -> String {
    let help = finding.help().map_or(String::new(), |help| format!(" ({help})"));
    format!("{finding}: {}{help}", finding.label())
}

/// Why there is no shot at a speed, in words.
pub fn why(error: &StudyError) -> String {
    let of_speed = match error {
        StudyError::Mistakes(mistakes) => of_speed(mistakes),
        _ => None,
    };
    of_speed.unwrap_or_else(|| error.to_string())
}

/// A mistake that is the speed's own, without a place.
fn of_speed(mistakes: &Mistakes) -> Option<String> {
    match mistakes.findings() {
        [finding] if underlines_speed(finding) => Some(placeless(finding)),
        _ => None,
    }
}

/// A speed beyond all limits is reported at the striker as a whole.
fn underlines_speed(finding: &Finding) -> bool {
    let text = finding.text().rsplit('=').next().unwrap_or_default();
    let asked = text == "[striker]" && finding.to_string().ends_with("was asked for");
    let text = text.trim().trim_matches('"');
    // Plain numbers may be anything.
    asked || (has_unit(text) && parse_speed(text).is_ok())
}

/// Warnings at a speed that an option gave, as [`Failure::at_option`].
pub(crate) fn option_warnings(option: &str, warnings: &[Warning], colour: bool) -> String {
    let (line, file): (Vec<Warning>, Vec<Warning>) =
        warnings.iter().cloned().partition(underlines_speed);
    let mut text = self::warnings(&file, colour);
    for warning in &line {
        text += &format!("warning: {option}: {}\n", placeless(warning));
    }
    text
}

/// What is odd about an experiment, each with the odd text underlined.
pub fn warnings(warnings: &[Warning], colour: bool) -> String {
    findings(warnings, "warnings", colour)
}
