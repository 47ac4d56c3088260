//! Standard output, which may be a closed pipe.

use crate::program::{Failure, lines};
use hertzchain_measure::records::without_controls;
use std::fmt::Display;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};

/// Prints a text and a line end if it has none.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    let plain = shown(text, bold());
    to_stdout(|out| {
        out.write_all(plain.as_bytes())?;
        out.write_all(end.as_bytes())
    })
}

/// Prints what is made while it is printed, without control characters.
pub(crate) fn print_with(
    write: impl FnOnce(&mut Plain<&mut StandardOutput>) -> io::Result<()>,
) -> Result<(), Failure> {
    to_stdout(|out| {
        let mut plain = Plain { out, held: Vec::new() };
        write(&mut plain)?;
        plain.flush()
    })
}

type StandardOutput = BufWriter<io::StdoutLock<'static>>;

fn to_stdout(write: impl FnOnce(&mut StandardOutput) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    let written = write(&mut out);
    match written.and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::BrokenPipe),
        Err(error) => Err(Failure::Ours(format!("standard output: {error}"))),
    }
}

/// A writer of text without control characters, given whole letters at a time, as by serde.
pub(crate) struct Plain<W> {
    out: W,
    /// Text that is yet to be written, checked all at once.
    held: Vec<u8>,
}

impl<W: Write> Plain<W> {
    /// Bytes held at most, about.
    const HELD: usize = 1 << 16;

    fn write_held(&mut self) -> io::Result<()> {
        match std::str::from_utf8(&self.held) {
            Ok(text) => self.out.write_all(without_controls(text).as_bytes())?,
            Err(_) => self.out.write_all(&self.held)?,
        }
        self.held.clear();
        Ok(())
    }
}

impl<W: Write> Write for Plain<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.held.extend_from_slice(bytes);
        if self.held.len() >= Self::HELD {
            self.write_held()?;
        }
        Ok(bytes.len())
    }

    /// Without the loop over what `write` left: serde writes few bytes at a time.
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write(bytes).map(drop)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.write_held()?;
        self.out.flush()
    }
}

pub(crate) fn stream_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    print_with(|out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}

pub(crate) fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    print(&format!("{value:#}"))
}

/// Prints a verb's result as JSON or for people, and before all else that a model which was not named
/// was assumed.
pub(crate) fn result(
    json: bool,
    all: &mut serde_json::Value,
    assumed: Option<String>,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    all["assumed_model"] = assumed.clone().into();
    match json {
        true => print_json(all),
        false => print(&(lines(assumed) + &text())),
    }
}

pub(crate) fn heading(text: &str) -> String {
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

pub(crate) fn written(files: &str) {
    eprint!("Written:\n{}", without_controls(files));
}

pub(crate) fn warn<T: Display>(warnings: impl IntoIterator<Item = T>) {
    warnings.into_iter().for_each(|text| note(&format!("warning: {text}")));
}

pub(crate) fn note(text: &str) {
    eprintln!("{}", without_controls(text));
}

#[cfg(test)]
#[path = "tests/print.rs"]
mod tests;
