//! Campaigns on a virtual rig.

use crate::failure::Failure;
use crate::inference::warnings;
use crate::options::CampaignOptions;
use crate::sweep;
use hertzchain_experiment::{Experiment, Warning};
use hertzchain_sim::rig::{self, Done, Plan, Progress};

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
