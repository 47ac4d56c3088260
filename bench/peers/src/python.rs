//! The Python peers: one worker process that does what it is told, line by line.

use crate::case::Case;
use crate::tool::Timed;
use anyhow::{Context, bail};
use serde::Deserialize;
use std::cell::RefCell;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The process and its pipes.
pub struct Worker {
    child: Child,
    pipes: RefCell<(ChildStdin, BufReader<ChildStdout>)>,
}

#[derive(Deserialize)]
struct Answer {
    #[serde(default)]
    error: String,
    #[serde(default)]
    seconds: f64,
    #[serde(default)]
    tofs: Vec<(Option<f64>, Option<f64>)>,
    #[serde(default)]
    version: String,
}

impl Worker {
    /// Starts it; pinned as this process is.
    pub fn start(python: &str, script: &str) -> anyhow::Result<Self> {
        let mut command = Command::new(python);
        command
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        let mut child = command.spawn().context("cannot start Python")?;
        let stdin = child.stdin.take().context("no pipe to Python")?;
        let stdout = child.stdout.take().context("no pipe from Python")?;
        Ok(Self {
            child,
            pipes: RefCell::new((stdin, BufReader::new(stdout))),
        })
    }

    fn ask(&self, question: &serde_json::Value) -> anyhow::Result<Answer> {
        let (to, from) = &mut *self.pipes.borrow_mut();
        writeln!(to, "{question}")?;
        to.flush()?;
        let mut line = String::new();
        from.read_line(&mut line)?;
        let answer: Answer = serde_json::from_str(&line).with_context(|| line.clone())?;
        if !answer.error.is_empty() {
            bail!("{question}: {}", answer.error);
        }
        Ok(answer)
    }

    /// Version of a package.
    pub fn version(&self, package: &str) -> anyhow::Result<String> {
        Ok(self
            .ask(&serde_json::json!({ "version": package }))?
            .version)
    }

    /// An ensemble; the time is the worker's processor time for the shots alone.
    pub fn run(
        &self,
        (package, method): (&str, &str),
        case: Case,
        setting: f64,
        speeds_m_s: &[f64],
    ) -> anyhow::Result<Timed> {
        let answer = self.ask(&serde_json::json!({
            "run": package, "method": method, "case": case.name(), "setting": setting,
            "speeds": speeds_m_s,
        }))?;
        let number = |x: Option<f64>| x.unwrap_or(f64::NAN);
        let tofs_s = answer
            .tofs
            .iter()
            .map(|(a, b)| (number(*a), number(*b)))
            .collect();
        Ok(Timed {
            tofs_s,
            seconds: answer.seconds,
        })
    }

    /// LAMMPS's ns per bead and step of one chain.
    pub fn scale(&self, beads: usize) -> anyhow::Result<f64> {
        Ok(1e9 * self.ask(&serde_json::json!({ "scale": beads }))?.seconds)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // It ends when its input does; if it is already gone, so much the better.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
