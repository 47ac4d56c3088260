//! One series: a chain is laid, then tapped and shot at again and again.
//!
//! What a shot leaves, positions, gaps and all, is what the next taps find.

use crate::StudyError;
use crate::rig::bench::Bench;
use crate::rig::chance::{Chance, Purpose};
use crate::rig::error::RigError;
use crate::rig::photogate::Passing;
use crate::rig::plan::{Plan, Series};
use crate::rig::record::{Record, Window};
use crate::rig::shot::{Shot, shoot};
use crate::rig::striker::{fired_m_s, misplaced_m, programmed};
use crate::stopped;
use hertzchain_experiment::Campaign;

/// One shot with all that is known of it.
#[derive(Clone, Debug)]
pub struct Fired {
    /// Number in the series, from 0.
    pub number: u32,
    /// Programmed speed in m/s.
    pub programmed_m_s: f64,
    /// Speed in m/s by the photogate.
    pub measured_m_s: f64,
    /// True speed in m/s.
    pub speed_m_s: f64,
    /// What happened in the chain.
    pub shot: Shot,
    /// What the recorder stored.
    pub record: Record,
}

/// A series under way.
struct Run<'a> {
    plan: &'a Plan,
    series: &'a Series,
    campaign: &'a Campaign,
    bench: Bench<'a>,
    sensor_bead: usize,
}

/// Runs a series and hands over every shot as it comes.
///
/// # Errors
/// A shot that can't be computed, or what `take` says.
pub fn run(
    plan: &Plan,
    series: &Series,
    take: &mut dyn FnMut(Fired) -> Result<(), RigError>,
) -> Result<(), RigError> {
    let experiment = &plan.case(series).experiment;
    let mut chance = Chance::new(plan.seed, series.number, Purpose::Laying);
    let gaps_mm = 1e3 * experiment.campaign().laying.gap_scatter_m;
    let when = || format!("laying the chain with gaps of {gaps_mm} mm in the mean (`gap_scatter`)");
    let bench = Bench::lay(experiment, &mut chance).map_err(|why| failed(series, when(), why))?;
    let mut run = Run {
        campaign: experiment.campaign(),
        sensor_bead: experiment.sensor_bead(),
        plan,
        series,
        bench,
    };
    let shots = u32::try_from(run.campaign.shots).unwrap_or(u32::MAX);
    (0..shots).try_for_each(|number| take(run.repeat(number)?))
}

fn failed(series: &Series, when: String, why: StudyError) -> RigError {
    RigError::Shot {
        series: series.name.clone(),
        when,
        why,
    }
}

impl Run<'_> {
    /// Taps, rest, shot.
    fn repeat(&mut self, number: u32) -> Result<Fired, RigError> {
        let mut chance = Chance::new(self.plan.seed, self.series.number, Purpose::Shot(number));
        // Chance of the shot first: it is the same after any number of taps.
        let speed_m_s = fired_m_s(
            &self.campaign.actuator,
            self.series.programmed_m_s,
            &mut chance,
        );
        let misplaced_m = misplaced_m(&self.campaign.actuator, &mut chance);
        let gate = &self.campaign.photogate;
        let passing = Passing::of(gate, speed_m_s, misplaced_m, &mut chance);
        let window = Window::new(&self.campaign.recorder, passing.time_s, &mut chance);
        self.taps(number, &mut chance)?;
        let mut tape = window.tape();
        let shot = shoot(&mut self.bench, self.sensor_bead, speed_m_s, &mut tape);
        let shot = shot.map_err(|why| failed(self.series, format!("shot {}", number + 1), why))?;
        let mut noise = Chance::new(self.plan.seed, self.series.number, Purpose::Noise(number));
        let (amplifier, recorder) = (&self.campaign.amplifier, &self.campaign.recorder);
        Ok(Fired {
            number,
            programmed_m_s: self.series.programmed_m_s,
            measured_m_s: passing.speed_m_s,
            speed_m_s,
            shot,
            record: window.record(tape, amplifier, recorder, &mut noise),
        })
    }

    fn taps(&mut self, number: u32, chance: &mut Chance) -> Result<(), RigError> {
        let actuator = &self.campaign.actuator;
        let told_m_s = programmed(actuator, self.campaign.tap_speed_m_s).map_err(|why| {
            let what = format!(
                "taps before shot {} of series {}",
                number + 1,
                self.series.name
            );
            RigError::Speed { what, why }
        })?;
        for tap in 0..self.campaign.taps {
            if stopped() {
                return Err(RigError::Stopped);
            }
            let speed_m_s = fired_m_s(actuator, told_m_s, chance);
            self.bench.tap(speed_m_s).map_err(|why| {
                let when = format!("tap {} before shot {}", tap + 1, number + 1);
                failed(self.series, when, why)
            })?;
        }
        Ok(())
    }
}
