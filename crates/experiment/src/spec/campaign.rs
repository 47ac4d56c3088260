//! What a rig is to do, shot after shot.

use super::contacts::{self, SectionSpec};
use super::instruments::{Actuator, Amplifier, Laying, Photogate, Recorder};
use super::{Group, Liquid, Materials};
use crate::finding::Problem;
use crate::view::View;

/// Everything that a rig does: series at several speeds, each for every case.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// Seed of all that is random.
    pub seed: u64,
    /// Programmed speeds in m/s, in the file's order.
    pub speeds_m_s: Vec<f64>,
    /// Shots of a series.
    pub shots: usize,
    /// Taps before a shot; 0 switches them off.
    pub taps: usize,
    /// Speed of the striker in a tap, in m/s.
    pub tap_speed_m_s: f64,
    /// How a chain is laid before a series.
    pub laying: Laying,
    /// What launches the striker.
    pub actuator: Actuator,
    /// What measures its speed.
    pub photogate: Photogate,
    /// What turns forces into voltages.
    pub amplifier: Amplifier,
    /// What turns voltages into records.
    pub recorder: Recorder,
}

/// One of several chains that a campaign measures.
#[derive(Clone, Debug)]
pub(crate) struct CaseSpec {
    pub(crate) name: String,
    /// Sections in place of the file's own.
    pub(crate) sections: Option<Vec<SectionSpec>>,
    /// Liquid in place of the file's own.
    pub(crate) liquid: Option<Liquid>,
}

/// Speed of the paper's taps in m/s, and their number.
const TAP_SPEED_M_S: f64 = 0.18;
const TAPS: usize = 40;
/// The paper's shots of a series.
const SHOTS: usize = 20;

impl Campaign {
    /// The campaign of a file; without the table the paper's numbers and the
    /// striker's own speed.
    pub(super) fn read(root: &View<'_>, striker_m_s: Option<f64>) -> Result<Self, Problem> {
        let table = root.table("campaign");
        let count = |key| table.map_or(Ok(None), |t| t.count(key));
        let part = |key| table.and_then(|t| t.table(key));
        let tap = table.map_or(Ok(None), |t| t.quantity("tap_speed"))?;
        Ok(Self {
            seed: count("seed")?.map_or(1, |seed| seed as u64),
            speeds_m_s: match &table {
                Some(table) => speeds(table, striker_m_s)?,
                None => striker_m_s.into_iter().collect(),
            },
            shots: count("shots")?.unwrap_or(SHOTS),
            taps: count("taps")?.unwrap_or(TAPS),
            tap_speed_m_s: tap.unwrap_or(TAP_SPEED_M_S),
            laying: Laying::read(part("laying").as_ref())?,
            actuator: Actuator::read(part("actuator").as_ref())?,
            photogate: Photogate::read(part("photogate").as_ref())?,
            amplifier: Amplifier::read(part("amplifier").as_ref())?,
            recorder: Recorder::read(part("recorder").as_ref())?,
        })
    }
}

/// The speeds as a list, or in equal ratios from the slowest to the fastest.
fn speeds(table: &View<'_>, striker_m_s: Option<f64>) -> Result<Vec<f64>, Problem> {
    let listed = table.quantities("speeds")?;
    let ends = (table.quantity("slowest")?, table.quantity("fastest")?);
    let count = table.count("speed_count")?;
    let named = ["slowest", "fastest", "speed_count"];
    let given = named.iter().find(|key| table.has(key));
    match (given, ends, count) {
        (Some(key), _, _) if !listed.is_empty() => {
            let message = "the speeds are given twice";
            let problem = Problem::new(&table.span_of(key), message, "expected nothing here");
            Err(problem.beside(&table.span_of("speeds"), "they are listed here"))
        }
        (None, _, _) if listed.is_empty() => Ok(striker_m_s.into_iter().collect()),
        (None, _, _) => match listed.iter().all(|speed| *speed > 0.0) {
            true => Ok(listed),
            false => {
                let message = "a speed of `speeds` is not positive";
                let label = "expected speeds such as \"0.5 m/s\"";
                Err(Problem::new(&table.span_of("speeds"), message, label))
            }
        },
        (Some(_), (Some(slowest), Some(fastest)), Some(count)) if slowest < fastest => {
            Ok(in_equal_ratios(slowest, fastest, count))
        }
        (Some(key), _, _) => {
            let message = "these speeds are not complete";
            let label = "expected `slowest` below `fastest`, and `speed_count`";
            Err(Problem::new(&table.span_of(key), message, label))
        }
    }
}

fn in_equal_ratios(slowest: f64, fastest: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    let speed = |at: usize| slowest * (fastest / slowest).powf(at as f64 / last);
    (0..count).map(speed).collect()
}

/// The cases of a campaign, in the file's order.
pub(super) fn cases(
    root: &View<'_>,
    materials: &Materials,
    groups: &[Group],
) -> Result<Vec<CaseSpec>, Problem> {
    let Some(table) = root.table("campaign") else {
        return Ok(Vec::new());
    };
    let mut cases: Vec<CaseSpec> = Vec::new();
    for view in table.tables("cases") {
        let case = case(&view, materials, groups)?;
        if cases.iter().any(|other| other.name == case.name) {
            let message = format!("there are two cases with the name `{}`", case.name);
            let label = "expected another name";
            return Err(Problem::new(&view.span_of("name"), message, label));
        }
        cases.push(case);
    }
    Ok(cases)
}

fn case(view: &View<'_>, materials: &Materials, groups: &[Group]) -> Result<CaseSpec, Problem> {
    let name = view.text("name").unwrap_or_default().to_owned();
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() || !name.chars().all(plain) {
        let message = format!("`{name}` cannot be part of a file's name");
        let label = "expected letters, digits, `-` and `_`";
        return Err(Problem::new(&view.span_of("name"), message, label));
    }
    let sections = view
        .has("contacts")
        .then(|| contacts::read(view, materials, groups));
    Ok(CaseSpec {
        name,
        sections: sections.transpose()?,
        liquid: Liquid::read(view)?,
    })
}
