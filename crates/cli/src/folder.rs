//! An output folder whose files are there whole or not at all.

use crate::failure::Failure;
use hertzchain_figures::Figure;
use hertzchain_measure::records::beside;
use hertzchain_study::reproduce::write_atomically;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Resolution of PNG pictures in dots per inch.
const DPI: f64 = 300.0;

/// A folder that was found writable.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    written: Vec<PathBuf>,
}

impl Folder {
    /// Makes the folder if need be and checks that it can be written to,
    /// before anything is computed for it.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if path.exists() && !path.is_dir() {
            return Err(Failure::User(format!(
                "cannot write into {}: it is a file; --out names a folder, which is made if it \
                 does not exist",
                path.display()
            )));
        }
        let refused = |error: io::Error| {
            Failure::User(format!("cannot write into {}: {error}", path.display()))
        };
        fs::create_dir_all(path).map_err(refused)?;
        let probe = path.join(format!(".hertzchain-{}.probe", std::process::id()));
        fs::write(&probe, b"")
            .and_then(|()| fs::remove_file(&probe))
            .map_err(refused)?;
        Ok(Self {
            path: path.to_owned(),
            written: Vec::new(),
        })
    }

    /// Writes a file beside its place, then renames it.
    pub fn write(&mut self, name: &str, content: &[u8]) -> Result<(), Failure> {
        let path = self.path.join(name);
        write_atomically(&path, content).map_err(|error| Failure::Ours(error.to_string()))?;
        self.written.push(path);
        Ok(())
    }

    /// The same of what is made while it is written, and may be longer than memory.
    pub fn write_with(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let path = self.path.join(name);
        let part = beside(&path);
        let written = whole(&part, write).and_then(|()| fs::rename(&part, &path));
        written.map_err(|error| {
            // Nothing half-written stays; the first error is the one that counts.
            let _ = fs::remove_file(&part);
            Failure::Ours(format!("cannot write {}: {error}", path.display()))
        })?;
        self.written.push(path);
        Ok(())
    }

    /// Writes tables, each under its name.
    pub fn tables(&mut self, tables: &[(&str, String)]) -> Result<(), Failure> {
        let mut tables = tables.iter();
        tables.try_for_each(|(name, text)| self.write(name, text.as_bytes()))
    }

    /// Writes a figure as SVG and PNG.
    pub fn figure(&mut self, name: &str, figure: &Figure) -> Result<(), Failure> {
        self.write(&format!("{name}.svg"), figure.svg().as_bytes())?;
        let png = figure
            .png(DPI)
            .map_err(|error| Failure::Ours(format!("{name}.png: {error}")))?;
        self.write(&format!("{name}.png"), &png)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Everything written.
    pub fn into_written(self) -> Vec<PathBuf> {
        self.written
    }

    /// What was written, one path a line.
    pub fn list(&self) -> String {
        let lines = self
            .written
            .iter()
            .map(|path| format!("  {}\n", path.display()));
        lines.collect()
    }
}

/// A file that is whole, or an error.
fn whole(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    write(&mut file)?;
    file.flush()
}
