//! An output folder whose files are there whole or not at all.

use crate::program::{Failure, print};
use hertzchain_figures::Figure;
use hertzchain_measure::records::Files;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Resolution of PNG pictures in dots per inch.
const DPI: f64 = 300.0;

/// Files for a folder that was found writable; they appear in it together.
#[derive(Debug)]
pub(crate) struct Folder {
    files: Files,
    /// Names that no file had when the folder was opened: one that has it now is this run's own.
    free: Vec<String>,
    /// Whether files of earlier runs may be replaced.
    replace: bool,
    /// Whether the folder has results of the same verb, which this run replaces.
    has_earlier: bool,
    /// Files that not every run has: those of the earlier run go when this one's come.
    optional: &'static [&'static str],
}

impl Folder {
    /// Makes the folder if need be and checks, before anything is computed for it, that it can be
    /// written to and has no file of these names, unless files may be replaced.
    pub(crate) fn open(path: &Path, names: &[&str], replace: bool) -> Result<Self, Failure> {
        if path.exists() && !path.is_dir() {
            return Err(Failure::User(format!(
                "cannot write into {}: it is a file; --out names a folder, which is made if it \
                 does not exist",
                path.display()
            )));
        }
        let refused =
            |error| Failure::User(format!("cannot write into {}: {error}", path.display()));
        let has_earlier = names.iter().any(|name| path.join(name).exists());
        let free = |name: &&str| require_free(&path.join(name), "--out", replace);
        names.iter().try_for_each(free)?;
        let free = names.iter().map(|&name| name.to_owned()).collect();
        let files = Files::within(path).map_err(refused)?;
        Ok(Self { files, free, replace, has_earlier, optional: &[] })
    }

    /// The same of a verb that writes these files, or pictures without an ending, in some runs only.
    pub(crate) fn with_optional(self, optional: &'static [&'static str]) -> Self {
        Self { optional, ..self }
    }

    /// Writes a file that gets its name with all others.
    pub(crate) fn write(&mut self, name: &str, content: &[u8]) -> Result<(), Failure> {
        self.write_with(name, |file| file.write_all(content))
    }

    /// The same of what is made while it is written, and may be longer than memory.
    pub(crate) fn write_with(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let own = self.free.iter().any(|free| free == name);
        require_free(&self.path().join(name), "--out", self.replace || own)?;
        let written = self.files.write(name, write);
        written.map_err(|error| self.unwritable(name, &error))
    }

    fn unwritable(&self, what: &str, error: &io::Error) -> Failure {
        let (path, left) = (self.path().join(what), "its files are those of before");
        Failure::Ours(format!("cannot write {}: {error}; {left}", path.display()))
    }

    pub(crate) fn tables(&mut self, tables: &[(&str, String)]) -> Result<(), Failure> {
        let mut tables = tables.iter();
        tables.try_for_each(|(name, text)| self.write(name, text.as_bytes()))
    }

    pub(crate) fn figure(&mut self, name: &str, figure: &Figure) -> Result<(), Failure> {
        self.write(&format!("{name}.svg"), figure.svg().as_bytes())?;
        let png = figure.png(DPI).map_err(|error| Failure::Ours(format!("{name}.png: {error}")))?;
        self.write(&format!("{name}.png"), &png)
    }

    pub(crate) fn path(&self) -> &Path {
        self.files.folder()
    }

    /// The folder that an option asks for, if it asks for one.
    pub(crate) fn asked(
        path: Option<&Path>,
        names: &[&str],
        replace: bool,
    ) -> Result<Option<Self>, Failure> {
        path.map(|path| Self::open(path, names, replace)).transpose()
    }

    /// Gives all files their names, and reports them.
    pub(crate) fn finish_and_report(self) -> Result<(), Failure> {
        print::written(&self.finish()?);
        Ok(())
    }

    pub(crate) fn names(&self) -> Vec<&str> {
        self.files.names().collect()
    }

    /// Optional files that this run does not have.
    fn old_files(&self) -> Vec<PathBuf> {
        let all = self.optional.iter().flat_map(|name| match name.contains('.') {
            true => vec![(*name).to_owned()],
            false => vec![format!("{name}.svg"), format!("{name}.png")],
        });
        let old = all.filter(|name| !self.names().contains(&name.as_str()));
        old.map(|name| self.path().join(name)).collect()
    }

    /// Gives all files their names; returns them, one path a line.
    pub(crate) fn finish(self) -> Result<String, Failure> {
        let replaces = self.replace && self.has_earlier;
        let old = if replaces { self.old_files() } else { Vec::new() };
        let files = self.files.finish();
        let files = files.map_err(|error| Failure::Ours(format!("cannot name a file: {error}")))?;
        for old in old {
            // One that can't be removed was not in the way of this run's.
            let _ = fs::remove_file(old);
        }
        let lines = files.iter().map(|path| format!("  {}\n", path.display()));
        Ok(lines.collect())
    }
}

/// Rejects a file that is there already, from another run, unless it may be replaced.
pub(crate) fn require_free(path: &Path, option: &str, replace: bool) -> Result<(), Failure> {
    match path.exists() && !replace {
        true => Err(Failure::User(format!(
            "{} is there already, from another run; give another name by {option}, or replace it by --force",
            path.display()
        ))),
        false => Ok(()),
    }
}
