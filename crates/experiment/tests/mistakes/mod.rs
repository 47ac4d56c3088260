//! Every mistake is one report with line, text, expectation and advice.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

mod counting;
mod effort;
mod files;
mod form;
mod hints;
mod laws;
mod layout;
mod materials;
mod quantities;
mod twice;
mod unsolved;
mod validity;

use crate::{Experiment, Finding};

const DRY: &str = include_str!("../../../../experiments/dry.toml");

/// The only mistake of the dry preset after a replacement.
fn after(from: &str, to: &str) -> Finding {
    assert!(DRY.contains(from), "{from}");
    only(&DRY.replacen(from, to, 1))
}

pub(crate) fn only(text: &str) -> Finding {
    let mistakes = Experiment::from_text("test.toml", text).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    mistakes.findings()[0].clone()
}

fn line_of(text: &str) -> usize {
    1 + DRY.lines().position(|line| line.contains(text)).unwrap()
}

/// Line, underlined text and words of a finding.
pub(crate) fn check(finding: &Finding, line: usize, text: &str, words: &[&str]) {
    assert_eq!(finding.line(), line, "{}", finding.one_line());
    assert_eq!(finding.text(), text, "{}", finding.one_line());
    assert_eq!(finding.file(), "test.toml");
    for word in words {
        assert!(finding.one_line().contains(word), "{} lacks {word}", finding.one_line());
    }
}

/// The only mistake that shows when the chain is set up.
fn refused(text: &str) -> Finding {
    let experiment = Experiment::from_text("test.toml", text).unwrap();
    let mistakes = experiment.system(None).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    mistakes.findings()[0].clone()
}
