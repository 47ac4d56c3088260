//! What went wrong, told to people, with the exit code: 2 for the user's
//! mistakes, 1 for ours.

use hertzchain_experiment::{Finding, Mistakes, Warning};
use hertzchain_study::StudyError;
use miette::{GraphicalReportHandler, GraphicalTheme};
use std::io::IsTerminal;
use std::process::ExitCode;

/// Why a verb failed.
#[derive(Debug)]
pub enum Failure {
    /// Mistakes in an experiment file.
    Mistakes(Mistakes),
    /// Another mistake of the user.
    User(String),
    /// Our fault, or the machine's.
    Ours(String),
    /// Nobody reads the output any more: no failure at all.
    BrokenPipe,
}

impl From<Mistakes> for Failure {
    fn from(mistakes: Mistakes) -> Self {
        Self::Mistakes(mistakes)
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        Self::User(error.to_string())
    }
}

impl Failure {
    /// Prints itself and says how the program ends.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Mistakes(mistakes) => {
                mistakes.findings().iter().for_each(print_finding);
                ExitCode::from(2)
            }
            Self::User(text) => {
                eprintln!("error: {text}");
                ExitCode::from(2)
            }
            Self::Ours(text) => {
                eprintln!("error: {text}");
                ExitCode::from(1)
            }
            Self::BrokenPipe => ExitCode::SUCCESS,
        }
    }
}

fn handler() -> GraphicalReportHandler {
    let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let theme = match colour {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    GraphicalReportHandler::new_themed(theme).with_links(false)
}

/// A report that underlines the offending text.
fn print_finding(finding: &Finding) {
    let mut text = String::new();
    match handler().render_report(&mut text, finding) {
        Ok(()) => eprintln!("{}", text.trim_end()),
        Err(_) => eprintln!("error: {}", finding.one_line()),
    }
}

/// What is odd about an experiment, one line each.
pub fn print_warnings(warnings: &[Warning]) {
    for warning in warnings {
        eprintln!("warning: {}", warning.one_line());
    }
}
