//! Standard output, which may be a closed pipe.

use crate::failure::Failure;
use hertzchain_measure::records::without_controls;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};

/// Prints a text and a line end if it has none.
pub fn print(text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    let plain = shown(text, bold());
    print_with(|out| {
        out.write_all(plain.as_bytes())?;
        out.write_all(end.as_bytes())
    })
}

/// Prints what is made while it is printed.
pub fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    let written = write(&mut out);
    match written.and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::BrokenPipe),
        Err(error) => Err(Failure::Ours(format!("standard output: {error}"))),
    }
}

/// Prints indented JSON.
pub fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    print(&format!("{value:#}"))
}

/// A heading, bold on a terminal.
pub fn heading(text: &str) -> String {
    match bold() {
        true => format!("{}{}{}", BOLD[0], without_controls(text), BOLD[1]),
        false => text.to_owned(),
    }
}

fn bold() -> bool {
    io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// What begins and ends bold text on a terminal.
const BOLD: [&str; 2] = ["\u{1b}[1m", "\u{1b}[0m"];

/// A text as it may go to a terminal, with headings in bold.
fn shown(text: &str, bold: bool) -> String {
    if !bold {
        return without_controls(text).into_owned();
    }
    let parts = text.split(BOLD[0]).map(|part| {
        let parts: Vec<_> = part.split(BOLD[1]).map(without_controls).collect();
        parts.join(BOLD[1])
    });
    parts.collect::<Vec<_>>().join(BOLD[0])
}

/// Reports which files were written, one path a line.
pub fn written(files: &str) {
    eprint!("Written:\n{}", without_controls(files));
}

/// Writes a line to standard error.
pub fn note(text: &str) {
    eprintln!("{}", without_controls(text));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_bold_and_nothing_else_steers_the_terminal() {
        let text = format!("{}a\u{1b}[2J{}b", BOLD[0], BOLD[1]);
        assert_eq!(
            shown(&text, true),
            format!("{}a\\u001b[2J{}b", BOLD[0], BOLD[1])
        );
        assert!(!shown(&text, false).contains('\u{1b}'));
    }
}
