//! Python in a throw-away environment, for tests against other programs.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// A Python with packages, made at first use and kept with the build.
pub(super) struct Python {
    environment: &'static str,
    packages: &'static [&'static str],
    untested: &'static str,
    interpreter: OnceLock<Option<PathBuf>>,
}

impl Python {
    /// Of this name and with these packages; `untested` is what a notice says if
    /// there is none.
    pub(super) const fn new(
        environment: &'static str,
        packages: &'static [&'static str],
        untested: &'static str,
    ) -> Self {
        Self { environment, packages, untested, interpreter: OnceLock::new() }
    }

    /// Runs a Python program in a folder and gives what it prints; `None`, with a
    /// notice that no test captures, where there is no Python with the packages.
    pub(super) fn run(&self, folder: &Path, program: &str) -> Option<String> {
        let python = self.interpreter.get_or_init(|| self.made()).as_ref()?;
        let script = folder.join("script.py");
        fs::write(&script, program).unwrap();
        let output = Command::new(python).arg(&script).current_dir(folder).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{error}");
        Some(String::from_utf8(output.stdout).unwrap())
    }

    fn made(&self) -> Option<PathBuf> {
        let made = self.make();
        if made.is_none() {
            let mut stderr = std::io::stderr();
            let _ = writeln!(
                stderr,
                "\nNOTICE: no Python with {:?} here and none can be installed:\nNOTICE: {}.\n",
                self.packages, self.untested
            );
        }
        made
    }

    fn make(&self) -> Option<PathBuf> {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let lock = File::create(place.join(format!("{}.lock", self.environment))).ok()?;
        lock.lock().ok()?;
        let environment = place.join(self.environment);
        let python = environment.join("bin/python");
        let complete = environment.join("complete");
        if complete.exists() {
            return Some(python);
        }
        run(Path::new("python3"), &["-m", "venv", environment.to_str()?])?;
        let mut install = vec!["-m", "pip", "install", "--quiet"];
        install.extend(self.packages);
        run(&python, &install)?;
        fs::write(complete, "").ok().map(|()| python)
    }
}

fn run(program: &Path, arguments: &[&str]) -> Option<()> {
    let output = Command::new(program).args(arguments).output().ok()?;
    output.status.success().then_some(())
}
