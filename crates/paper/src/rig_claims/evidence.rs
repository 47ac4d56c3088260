//! Series of virtual rigs, and the statistics of their spreads.
//!
//! Shots of one series hang together: what one leaves, the next finds. Series do not, as each
//! begins with a chain that is laid anew. So whole series are drawn with replacement [Efron1979],
//! and the standard deviation over draws is the standard error.

use super::design::{RigDesign, TriedRig};
use crate::claims::{SPEED_SCATTER_M_S, TofBranch};
use crate::reproduce::ReproduceProgress;
use hertzchain_measure::signal::power_law;
use hertzchain_sim::rig::{Plan, Purpose, RandomStream, RigError, Shot, run_series};
use rayon::prelude::*;

/// Shots of equal speed, with taps before each and without.
#[derive(Clone, Debug)]
pub(crate) struct SpeedSeries {
    pub speed_m_s: f64,
    pub loose: Vec<Shot>,
    pub tapped: Vec<Shot>,
}

#[derive(Clone, Debug)]
pub(crate) struct Observed {
    pub rig: TriedRig,
    /// Series by speed, slowest first.
    pub speeds: Vec<SpeedSeries>,
}

/// All that claims are evaluated on.
#[derive(Clone, Debug, Default)]
pub struct RigEvidence {
    /// The dry rigs in the design's order: what claims are evaluated on.
    pub(crate) rigs: Vec<Observed>,
    /// The others, each of which is evaluated alone.
    pub(crate) wet: Vec<Observed>,
}

impl RigEvidence {
    /// The evidence of each of the rigs alone.
    pub(crate) fn alone(&self) -> impl Iterator<Item = Self> + '_ {
        let all = self.rigs.iter().chain(&self.wet);
        all.map(|observed| Self { rigs: vec![observed.clone()], wet: Vec::new() })
    }
}

/// A time of flight of a shot in s; not a number if it has none.
pub(super) fn tof_s(shot: &Shot, branch: TofBranch) -> f64 {
    match branch {
        TofBranch::Incident => shot.incident_s,
        TofBranch::Reflected => shot.reflected_s,
    }
}

/// Velocity of the striker when it went, in m/s; 0 if it stayed.
pub(crate) fn rebound_m_s(shot: &Shot) -> f64 {
    match shot.rebound_m_s.is_nan() {
        true => 0.0,
        false => shot.rebound_m_s,
    }
}

pub(super) fn largest_m(gaps_m: &[f64]) -> f64 {
    gaps_m.iter().copied().fold(0.0, f64::max)
}

/// What shots have, where it is a number.
pub(super) fn each(shots: &[Shot], of: impl Fn(&Shot) -> f64) -> Vec<f64> {
    shots.iter().map(of).filter(|v| v.is_finite()).collect()
}

/// Accuracy of times of flight in s: no spread is taken to be smaller.
const SURE_S: f64 = 0.2e-9;

/// Standard deviation in s of a ToF of shots of equal speed; NaN of fewer than two.
pub(crate) fn spread_s(shots: &[Shot], branch: TofBranch) -> f64 {
    let spread_s = deviation(&each(shots, |shot| tof_s(shot, branch)));
    // Not `max`, which prefers any number to none.
    if spread_s < SURE_S { SURE_S } else { spread_s }
}

impl Observed {
    /// Series with what the striker's ± 0.003 m/s adds to a time of flight, in
    /// s: |dT/dv| of a power law through the means of tapped shots.
    pub(crate) fn with_scatter_s(
        &self,
        branch: TofBranch,
    ) -> impl Iterator<Item = (&SpeedSeries, f64)> {
        let mean_s = |at: &SpeedSeries| mean(&each(&at.tapped, |shot| tof_s(shot, branch)));
        let means_s: Vec<f64> = self.speeds.iter().map(mean_s).collect();
        let speeds: Vec<f64> = self.speeds.iter().map(|at| at.speed_m_s).collect();
        let law = power_law(&speeds, &means_s, None);
        let exponent = law.map_or(f64::NAN, |law| law.exponent);
        let scatter = move |(at, mean_s): (_, f64)| {
            let at: &SpeedSeries = at;
            (at, (exponent * mean_s / at.speed_m_s).abs() * SPEED_SCATTER_M_S)
        };
        self.speeds.iter().zip(means_s).map(scatter)
    }
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

const DRAWS: usize = 1000;

const SEED: u64 = 1;

/// 95 % of a normal distribution are within so many standard errors.
const SURE: f64 = 1.96;

/// A number with the error that 95 % stay within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WithError {
    pub value: f64,
    /// Half of its 95 % interval.
    pub error: f64,
}

/// Standard deviation, with n − 1; not a number of fewer than two values.
pub(super) fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    // 0/0 of one value and of none.
    (square / values.len().saturating_sub(1) as f64).sqrt()
}

/// Mean of what shots have, with its error.
pub(super) fn mean_of(values: &[f64]) -> WithError {
    WithError {
        value: mean(values),
        error: SURE * deviation(values) / (values.len() as f64).sqrt(),
    }
}

/// ln of the geometric mean of a number that series have, with its error. Series
/// whose number is none, having no pulses, count for nothing.
pub(crate) fn typical(of_series: impl Iterator<Item = f64>) -> WithError {
    let logs: Vec<f64> = of_series.map(f64::ln).filter(|log| log.is_finite()).collect();
    bootstrap(&logs, mean)
}

/// ln of the root mean square of a number that series have, with its error, and
/// not below that of `least`: for numbers that may all be 0.
pub(crate) fn root_mean_square(of_series: &[f64], least: f64) -> WithError {
    bootstrap(of_series, |drawn| {
        let squares: Vec<f64> = drawn.iter().map(|v| v * v).collect();
        mean(&squares).sqrt().max(least).ln()
    })
}

/// One series alone has no error: it is not a number then.
fn bootstrap(of_series: &[f64], statistic: impl Fn(&[f64]) -> f64) -> WithError {
    let mut stream = RandomStream::new(SEED, 0, Purpose::Resampling);
    let mut drawn = || {
        let any = |_| of_series[(stream.uniform() * of_series.len() as f64) as usize];
        statistic(&of_series.iter().enumerate().map(any).collect::<Vec<f64>>())
    };
    let draws: Vec<f64> = (0..DRAWS).map(|_| drawn()).collect();
    let alone = of_series.len() < 2;
    WithError {
        value: statistic(of_series),
        error: if alone { f64::NAN } else { SURE * deviation(&draws) },
    }
}

/// A rig's campaigns: without taps and with them.
type Plans = [Plan; 2];

/// Runs the campaigns of all rigs, series side by side.
///
/// What comes out depends on neither the number of threads nor the order.
///
/// # Errors
/// An experiment that is not a rig's, a shot that can't be computed.
pub fn observe(
    design: &RigDesign,
    progress: &dyn ReproduceProgress,
) -> Result<RigEvidence, RigError> {
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
    let seen: Result<Vec<(usize, SpeedSeries)>, RigError> = due
        .par_iter()
        .with_max_len(1)
        .map(|(rig, series)| {
            let at = at_speed(&plans[*rig], *series, design.first)?;
            progress.advance();
            Ok((*rig, at))
        })
        .collect();
    let mut rigs: Vec<Observed> =
        design.rigs.iter().map(|rig| Observed { rig: rig.clone(), speeds: Vec::new() }).collect();
    for (rig, at) in seen? {
        rigs[rig].speeds.push(at);
    }
    let (rigs, wet) = rigs.into_iter().partition(|seen| seen.rig.case == 0);
    Ok(RigEvidence { rigs, wet })
}

fn at_speed([loose, tapped]: &Plans, series: usize, first: usize) -> Result<SpeedSeries, RigError> {
    Ok(SpeedSeries {
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
