//! What is known of an experiment without a shot: its description in SI, its theory.

use crate::failure::Failure;
use crate::options::CheckOptions;
use crate::{campaign, contact, input};
use hertzchain_chain::Chain;
use hertzchain_experiment::{Experiment, Units, Warning};
use hertzchain_sim::{Group, StudyError};

/// Groups of named numbers in SI, and warnings about the experiment.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let found = check(&preset("dry")?, &CheckOptions::default())?;
/// let titles: Vec<&str> = found.groups.iter().map(|group| &*group.title).collect();
/// assert!(titles.contains(&"Beads"), "{titles:?}");
/// # Ok::<(), hertzchain::Failure>(())
/// ```
#[derive(Debug)]
pub struct Description {
    /// Groups of names, values and units.
    pub groups: Vec<Group>,
    /// Warnings about the experiment at the speed.
    pub warnings: Vec<Warning>,
}

/// Describes an experiment in SI, with what follows from it; runs nothing.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let found = check(&preset("pump")?, &CheckOptions::at(0.1))?;
/// assert_eq!(found.warnings.len(), 1); // its effective Poisson ratio exceeds 1/2 there
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// What the physics rejects, at its place in the experiment; a speed that it can't have; a campaign that no
/// rig can do.
pub fn check(experiment: &Experiment, options: &CheckOptions) -> Result<Description, Failure> {
    let mut found = described(experiment, options, |experiment, chain| {
        let mut groups = hertzchain_sim::describe(experiment, chain)?;
        groups.extend(contact::first_yield(chain).filter(|_| experiment.units() == Units::Si));
        Ok(groups)
    })?;
    found.groups.extend(campaign::described(experiment)?);
    Ok(found)
}

/// Returns what theory says of a chain: exact solitary wave, normal modes, band gap, restitution.
///
/// ```
/// use hertzchain::prelude::*;
///
/// assert!(!theory(&preset("hertz")?, &CheckOptions::default())?.groups.is_empty());
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// As [`check`].
pub fn theory(experiment: &Experiment, options: &CheckOptions) -> Result<Description, Failure> {
    described(experiment, options, hertzchain_sim::describe_theory)
}

fn described(
    experiment: &Experiment,
    options: &CheckOptions,
    describe: fn(&Experiment, &Chain) -> Result<Vec<Group>, StudyError>,
) -> Result<Description, Failure> {
    let given = options.speed.as_ref();
    let speed_m_s = input::speed(given, experiment)?;
    // What the physics refuses is reported at its place in the file.
    let found = experiment.chain_and_system(speed_m_s);
    let (chain, _, warnings) = input::at_speed(given, found)?;
    Ok(Description { groups: describe(experiment, &chain)?, warnings })
}
