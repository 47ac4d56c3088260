//! Campaigns on all rigs of a design.

use super::design::Design;
use super::evidence::{AtSpeed, Evidence, Observed};
use crate::reproduce::Progress;
use hertzchain_sim::rig::Plan;
use hertzchain_sim::rig::RigError;
use hertzchain_sim::rig::Shot;
use hertzchain_sim::rig::run_series;
use rayon::prelude::*;

/// A rig's campaigns: without taps and with them.
type Plans = [Plan; 2];

/// Runs the campaigns of all rigs, series side by side.
///
/// What comes out depends on neither the number of threads nor the order.
///
/// # Errors
/// An experiment that is not a rig's, a shot that can't be computed.
pub fn observe(design: &Design, progress: &dyn Progress) -> Result<Evidence, RigError> {
    let plans: Result<Vec<Plans>, RigError> = design
        .rigs
        .iter()
        .map(|rig| {
            let plan = |taps| Plan::new(&design.experiment(rig, taps)?, None);
            Ok([plan(0)?, plan(design.taps())?])
        })
        .collect();
    let plans = plans?;
    let speeds = |(rig, plans): (usize, &Plans)| {
        let own = plans[0].series.iter().enumerate();
        own.filter(|(_, series)| series.case == design.rigs[rig].case)
            .map(move |(at, _)| (rig, at))
            .collect::<Vec<_>>()
    };
    let due: Vec<(usize, usize)> = plans.iter().enumerate().flat_map(speeds).collect();
    progress.begin("shots on virtual rigs", due.len() as u64);
    let seen: Result<Vec<(usize, AtSpeed)>, RigError> = due
        .par_iter()
        .with_max_len(1)
        .map(|(rig, series)| {
            let at = at_speed(&plans[*rig], *series, design.first)?;
            progress.advance();
            Ok((*rig, at))
        })
        .collect();
    let mut rigs: Vec<Observed> = design
        .rigs
        .iter()
        .map(|rig| Observed {
            rig: rig.clone(),
            speeds: Vec::new(),
        })
        .collect();
    for (rig, at) in seen? {
        rigs[rig].speeds.push(at);
    }
    let (rigs, wet) = rigs.into_iter().partition(|seen| seen.rig.case == 0);
    Ok(Evidence { rigs, wet })
}

/// Both series of a speed.
fn at_speed([loose, tapped]: &Plans, series: usize, first: usize) -> Result<AtSpeed, RigError> {
    Ok(AtSpeed {
        speed_m_s: loose.series[series].programmed_m_s,
        loose: shots(loose, series, first)?,
        tapped: shots(tapped, series, first)?,
    })
}

/// The shots of a series after the first.
fn shots(plan: &Plan, series: usize, first: usize) -> Result<Vec<Shot>, RigError> {
    let mut shots = Vec::new();
    run_series(plan, &plan.series[series], &mut |fired| {
        shots.extend((fired.number as usize >= first).then_some(fired.shot));
        Ok(())
    })?;
    Ok(shots)
}
