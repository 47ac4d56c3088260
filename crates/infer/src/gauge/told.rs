//! What a gauge says of several pairs.

use super::Gauge;
use super::contacts::{Branch, Contact, WetRow};
use crate::data::Observable;

impl Gauge {
    /// Of rows that several pairs fit: that they do, which stands first and why, and whether
    /// all were found.
    #[must_use]
    pub fn ambiguous(&self, rows: &[WetRow]) -> Option<String> {
        let several = |contact: &Contact| !contact.others.is_empty();
        told(rows).any(|(_, contact)| several(contact)).then(|| {
            let branches = [Branch::Smooth, Branch::Unknown].map(|branch| of(rows, branch));
            format!(
                "At some speeds several pairs of K and A give the same numbers; those found are listed. {}{}{}",
                smooth(&branches[0]),
                unknown(&branches[1], self.wet().has(Observable::ReturningOverPassing)),
                scanned(rows)
            )
        })
    }
}

fn told(rows: &[WetRow]) -> impl Iterator<Item = (f64, &Contact)> {
    rows.iter()
        .filter_map(|row| Some((row.speed_m_s, row.told.as_ref().ok()?)))
}

/// Speeds of a branch as text.
fn of(rows: &[WetRow], branch: Branch) -> Vec<String> {
    let rows = told(rows).filter(|(_, contact)| contact.branch == branch);
    rows.map(|(speed, _)| format!("{speed:.4}")).collect()
}

fn smooth(speeds: &[String]) -> &'static str {
    match speeds {
        [] => "",
        _ => {
            "Told first is the pair whose A goes on most smoothly from speed to speed, where every way through \
              another bends much more: its error holds if contacts do change smoothly. "
        }
    }
}

fn unknown(speeds: &[String], has_ratios: bool) -> String {
    let more = match has_ratios {
        true => "More speeds, or smaller errors, may tell which",
        false => {
            "More speeds, or ratios of peaks (--use incident,reflected,returning-ratio), may tell which"
        }
    };
    match speeds {
        [] => String::new(),
        speeds => format!(
            "The branch is not known at {} m/s: none of the pairs stands for the result there, and no power law goes \
             through them. {more}. ",
            speeds.join(", ")
        ),
    }
}

fn scanned(rows: &[WetRow]) -> String {
    let scans: Vec<_> = told(rows)
        .filter_map(|(speed, contact)| Some((speed, contact.scan.as_ref()?)))
        .collect();
    let Some((_, first)) = scans.first() else {
        return "They were looked for from a few starts: there may be others.".to_owned();
    };
    let [from, to] = first.between_s.map(|a| 1e9 * a);
    let looked = format!("A was scanned from {from:.0} to {to:.0} ns");
    let open = scans.iter().filter(|(_, scan)| !scan.is_complete());
    let open: Vec<String> = open.map(|(speed, _)| format!("{speed:.4}")).collect();
    match open.is_empty() {
        true => format!("{looked}, completely."),
        false => format!(
            "{looked}, but not completely at {} m/s, where for some A no K gives such times: there may be others.",
            open.join(", ")
        ),
    }
}

#[cfg(test)]
#[path = "tests/told.rs"]
mod tests;
