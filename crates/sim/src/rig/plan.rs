//! What a campaign consists of.

use crate::rig::RigError;
use crate::rig::instruments::{MOST_SHOTS, programmed};
use hertzchain_experiment::{Experiment, Units};

/// Most series of a campaign: random streams are counted in 32 bits.
const MOST_SERIES: usize = 1 << 20;

/// A campaign that can be run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The experiment as given, with all cases.
    pub experiment: Experiment,
    /// Its cases, each with its own contacts.
    pub cases: Vec<Case>,
    /// All series, in the order of their numbers.
    pub series: Vec<Series>,
    /// Seed of all that is random.
    pub seed: u64,
}

/// One of the chains of a campaign.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// The experiment with its contacts.
    pub experiment: Experiment,
}

/// One case at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Number in the campaign, from 0.
    pub number: u32,
    /// Which case.
    pub case: usize,
    /// Programmed speed in m/s.
    pub programmed_m_s: f64,
    /// Name, also of its file: case, number of the speed, speed.
    pub name: String,
}

impl Plan {
    /// Of an experiment; `seed` in place of the file's.
    ///
    /// # Errors
    /// An experiment that no rig can do, speeds that the actuator does not
    /// have, a case with mistakes.
    pub fn new(experiment: &Experiment, seed: Option<u64>) -> Result<Self, RigError> {
        suits(experiment)?;
        let cases = cases(experiment)?;
        let campaign = experiment.campaign();
        let actuator = &campaign.actuator;
        if campaign.taps > 0 {
            programmed(actuator, campaign.tap_speed_m_s)
                .map_err(|why| RigError::Speed(format!("taps: {why}")))?;
        }
        let mut series = Vec::new();
        for (case, Case { name, experiment }) in cases.iter().enumerate() {
            for (at, asked_m_s) in campaign.speeds_m_s.iter().enumerate() {
                let programmed_m_s = programmed(actuator, *asked_m_s).map_err(|why| {
                    RigError::Speed(format!("speed {} of case `{name}`: {why}", at + 1))
                })?;
                experiment.system(Some(programmed_m_s))?;
                row_of_beads(experiment, programmed_m_s)?;
                let number = u32::try_from(series.len()).unwrap_or(u32::MAX);
                series.push(Series {
                    number,
                    case,
                    programmed_m_s,
                    name: format!("{name}-{:02}-{programmed_m_s:.4}", at + 1),
                });
            }
        }
        Ok(Self {
            experiment: experiment.clone(),
            cases,
            series,
            seed: seed.unwrap_or(campaign.seed),
        })
    }

    /// The case of a series.
    pub(crate) fn case(&self, series: &Series) -> &Case {
        &self.cases[series.case]
    }

    /// Shots of the series of one part.
    pub(crate) fn shots(&self, series: usize) -> u64 {
        (series * self.experiment.campaign().shots) as u64
    }
}

/// Beads that lie farther apart than the smallest of them is large are no row: what
/// closes such gaps are flights, not a wave.
fn row_of_beads(experiment: &Experiment, speed_m_s: f64) -> Result<(), RigError> {
    let gap_m = experiment.campaign().laying.gap_scatter_m;
    let (chain, _) = experiment.chain(Some(speed_m_s))?;
    let radii_m = chain.beads.iter().map(|bead| bead.radius_m);
    let least_m = radii_m.fold(f64::INFINITY, f64::min);
    match gap_m < least_m {
        true => Ok(()),
        false => Err(RigError::Unsuited(format!(
            "the chain is laid with gaps of {} mm in the mean, wider than its smallest bead's radius of \
             {} mm: `gap_scatter` in [campaign.laying] is expected below that, some micrometres as a rule",
            1e3 * gap_m,
            1e3 * least_m
        ))),
    }
}

/// The cases of a file, or its one chain by the file's name.
fn cases(experiment: &Experiment) -> Result<Vec<Case>, RigError> {
    let named = |name: &str| {
        let chosen = experiment.case(name).unwrap_or_else(|| Ok(experiment.clone()));
        Ok(Case { name: name.to_owned(), experiment: chosen? })
    };
    match experiment.cases() {
        none if none.is_empty() => Ok(vec![named(&own_name(experiment))?]),
        names => names.into_iter().map(named).collect(),
    }
}

/// The file's name without its ending, as far as it can be part of another.
fn own_name(experiment: &Experiment) -> String {
    let path = std::path::Path::new(experiment.name());
    let stem = path.file_stem().map(|stem| stem.to_string_lossy());
    let kept = |c: char| match c.is_ascii_alphanumeric() || c == '-' || c == '_' {
        true => c,
        false => '-',
    };
    match stem {
        Some(stem) => stem.chars().map(kept).collect(),
        None => "chain".to_owned(),
    }
}

fn suits(experiment: &Experiment) -> Result<(), RigError> {
    experiment.needs_striker("a campaign was asked for, but there is no striker")?;
    let campaign = experiment.campaign();
    let series = experiment.cases().len().max(1) * campaign.speeds_m_s.len();
    let why = match experiment {
        _ if experiment.units() == Units::Dimensionless => {
            "a rig has volts and seconds: a dimensionless experiment cannot be one"
        }
        _ if !experiment.has_wall() => {
            "a rig's second sensor is at the wall, and this chain has none: expected a [far_end] to \
             lean on"
        }
        _ if campaign.shots > MOST_SHOTS => "a series has at most a thousand million shots",
        _ if series > MOST_SERIES => "a campaign has at most a million series",
        _ => return Ok(()),
    };
    Err(RigError::Unsuited(why.to_owned()))
}
