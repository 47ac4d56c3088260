//! Standard output, which may be a closed pipe.

use crate::failure::Failure;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};

/// Prints a text and a line end if it has none.
pub fn print(text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    print_with(|out| {
        out.write_all(text.as_bytes())?;
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
    let bold = io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    match bold {
        true => format!("\u{1b}[1m{text}\u{1b}[0m"),
        false => text.to_owned(),
    }
}
