//! Campaigns on a virtual rig.

use crate::failure::Failure;
use crate::inference::warnings;
use crate::options::CampaignOptions;
use crate::sweep;
use hertzchain_experiment::{Experiment, Warning};
use hertzchain_sim::rig::{self, Done, Plan, Progress};
use hertzchain_sim::{Group, Row, Value};

/// A campaign that is ready to run.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let options = CampaignOptions::default();
/// let prepared = PreparedCampaign::new(&preset("paper")?, &options)?;
/// assert!(prepared.plan.series.len() > 10);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
pub struct PreparedCampaign<'a> {
    options: &'a CampaignOptions,
    /// Series, and the seed of all that is random.
    pub plan: Plan,
    /// What is improbable about the experiment, records that will end before the wave is back, and rates
    /// of few samples a pulse.
    pub warnings: Vec<String>,
}

impl<'a> PreparedCampaign<'a> {
    /// Plans a campaign's series.
    ///
    /// # Errors
    /// An experiment that no rig can do.
    pub fn new(experiment: &Experiment, options: &'a CampaignOptions) -> Result<Self, Failure> {
        let plan = Plan::new(experiment, options.seed)?;
        let improbable = warnings([experiment]);
        let lines = improbable.iter().map(Warning::one_line).chain(rig::forecast(&plan)?);
        Ok(Self { options, warnings: lines.collect(), plan })
    }

    /// Runs the series that the folder does not have yet, and calls `watch` after every shot.
    ///
    /// # Errors
    /// A folder with something else in it, a recording that can't be written.
    pub fn run(&self, watch: &(dyn Fn(Progress) + Sync)) -> Result<Done, Failure> {
        let CampaignOptions { out, shard, threads, .. } = self.options;
        Ok(sweep::pool(*threads)?.install(|| rig::campaign(&self.plan, out, *shard, watch))?)
    }
}

/// A file's campaign, if it has one of several speeds.
///
/// # Errors
/// A campaign that no rig can do.
pub(crate) fn described(experiment: &Experiment) -> Result<Option<Group>, Failure> {
    let campaign = experiment.campaign();
    if campaign.speeds_m_s.len() < 2 {
        return Ok(None);
    }
    let plan = Plan::new(experiment, None)?;
    let speeds = plan.series.iter().map(|series| series.programmed_m_s);
    let slowest = speeds.clone().fold(f64::INFINITY, f64::min);
    let (recorder, amplifier) = (&campaign.recorder, &campaign.amplifier);
    let rows = [
        ("series", Value::Count(plan.series.len()), ""),
        ("shots of a series", Value::Count(campaign.shots), ""),
        ("taps before a shot", Value::Count(campaign.taps), ""),
        ("programmed speeds", Value::Range(slowest, speeds.fold(0.0, f64::max)), "m/s"),
        ("deviation of speeds", Value::Number(campaign.actuator.spread_m_s), "m/s"),
        ("error of measured speeds", Value::Number(campaign.photogate.error_m_s), "m/s"),
        ("mean gap as laid", Value::Number(campaign.laying.gap_scatter_m), "m"),
        ("noise", Value::Number(amplifier.noise_v), "V"),
        ("low-pass", Value::Number(amplifier.low_pass_hz), "Hz"),
        ("sampling rate", Value::Number(recorder.sampling_hz), "Hz"),
        ("length of a record", Value::Number(recorder.record_s), "s"),
    ];
    let row = |(name, value, unit): (&str, Value, &str)| Row {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
    };
    Ok(Some(Group { title: "Campaign".to_owned(), rows: rows.map(row).into() }))
}

/// Runs a campaign: taps and shots on a virtual rig, recorded as by a real one.
///
/// ```no_run
/// use hertzchain::prelude::*;
///
/// let options = CampaignOptions { out: "records".into(), ..CampaignOptions::default() };
/// let done = campaign(&preset("paper")?, &options)?;
/// println!("{} shots", done.shots);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// As [`PreparedCampaign::new`] and [`PreparedCampaign::run`].
pub fn campaign(experiment: &Experiment, options: &CampaignOptions) -> Result<Done, Failure> {
    PreparedCampaign::new(experiment, options)?.run(&|_| {})
}
