//! Firing shots: blocks of lanes, each lane to its own end.

use super::behind::Behind;
use super::block::Block;
use super::number::Number;
use super::passing::{End, Passing};
use super::peaks::{Clock, LaneTrace};
use super::record::Recorder;
use super::weights::Schedule;
use crate::instruction_set::InstructionSet;
use crate::observe::{Signal, least_n_s};
use crate::sensor::Sensor;
use crate::system::System;
use crate::wave::{SolveError, Work};
use fearless_simd::{Simd, dispatch};

/// One shot to be fired.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// The chain with whatever sets it in motion.
    pub system: &'a System,
    /// Step in contact times: overlap at which a pair stops, over the speed.
    pub step: f64,
    /// Longest duration in s.
    pub duration_s: f64,
    /// How long numbers are.
    pub precision: Precision,
}

impl Shot<'_> {
    fn step_s(&self) -> f64 {
        self.step * self.system.scales().time_s
    }
}

/// How long the numbers of a shot are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// f64: rounding is never seen.
    Double,
    /// f32, twice as fast: rounding moves times of flight by some 1e-6,
    /// reflected ones by up to 2e-5, and more where a chain is pressed.
    Single,
}

impl Precision {
    /// Shots that run side by side.
    pub fn lanes(self) -> usize {
        match self {
            Self::Double => 8,
            Self::Single => 16,
        }
    }
}

/// How shots are fired.
#[derive(Clone, Debug)]
pub struct Settings {
    /// What to watch; for an end other than [`End::Duration`] the sensor that
    /// times the pulse comes first and the wall second.
    pub sensors: Vec<Sensor>,
    /// When a shot is over before that.
    pub end: End,
    /// Vector instructions.
    pub set: InstructionSet,
    /// Step also what nothing has reached.
    pub whole_chain: bool,
    /// Keep the shape of signals too, for widths and levels, not their maxima
    /// alone.
    pub shapes: bool,
    /// Find openings between steps and integrate the forces that end there as
    /// they are: for accuracies that equal steps alone do not give.
    pub openings: bool,
}

/// One shot to its end.
#[derive(Clone, Debug)]
pub struct LaneResult {
    /// What each sensor showed.
    pub signals: Vec<Signal>,
    /// Duration in s.
    pub time_s: f64,
    /// Whether the shot came to its own end before its longest duration.
    pub finished: bool,
    /// Velocities of all bodies at the end in m/s; of bodies that a returning
    /// pulse has left behind ([`End::Passed`]) at that time.
    pub velocity_m_s: Vec<f64>,
    /// Step in s.
    pub step_s: f64,
    /// What the first sensor showed at the largest sample of the second one, the wall.
    pub at_wall_n: f64,
    /// What it cost.
    pub work: Work,
    /// Bodies looked at, summed over steps: fewer than all where the shots of
    /// a block leave out what does not move. The only number here that
    /// depends on what flies along.
    pub bodies_looked_at: u64,
}

/// Steps between looks at whether a shot is over.
const LOOK_EVERY: usize = 16;

/// Steps between looks at how good the steps are.
const CORRECTION_EVERY: usize = 64;

/// A single step may correct a velocity by this fraction of the speed that set the chain in motion:
/// more, and something happens that equal steps do not resolve, or the motion is unstable.
const MOST_CORRECTION: f64 = 0.01;

/// Most steps of a shot: what sixteen lanes' sensors show in so many takes 67 MB. Pulses are
/// through chains of a thousand beads in half of them; what takes longer flies through gaps, which
/// the wave loop crosses in few steps.
const MOST_STEPS: usize = 1 << 19;

/// Most rows that are reserved before a shot; longer shots allocate as they go.
const RESERVED: usize = 1 << 16;

/// Fires shots, side by side where chains have the same shape; one that fails stops no other.
pub fn fire(shots: &[Shot<'_>], settings: &Settings) -> Vec<Result<LaneResult, SolveError>> {
    fire_each(shots, settings, &|| true, |_, lane| lane)
}

/// The same, of each shot only what `kept` makes of it, by its place in the list: signals take
/// memory, and those of one shot at a time are held. It goes on for as long as `wanted` says so,
/// which is asked every few steps; what has not ended then is [`SolveError::BrokenOff`].
pub fn fire_each<T>(
    shots: &[Shot<'_>],
    settings: &Settings,
    wanted: &dyn Fn() -> bool,
    kept: impl Fn(usize, Result<LaneResult, SolveError>) -> T,
) -> Vec<T> {
    let mut all: Vec<Option<T>> = shots.iter().map(|_| None).collect();
    let mut ready = Vec::with_capacity(shots.len());
    for (shot, fired) in shots.iter().enumerate() {
        match check(fired, settings) {
            Ok(()) => ready.push(shot),
            Err(error) => all[shot] = Some(kept(shot, Err(error))),
        }
    }
    for block in blocks(shots, &ready) {
        let side_by_side: Vec<Shot<'_>> = block.iter().map(|&shot| shots[shot]).collect();
        let mut keep = |lane: usize, result| all[block[lane]] = Some(kept(block[lane], result));
        match side_by_side[0].precision {
            Precision::Double => fire_block::<f64, 8>(&side_by_side, settings, wanted, &mut keep),
            Precision::Single => fire_block::<f32, 16>(&side_by_side, settings, wanted, &mut keep),
        }
    }
    all.into_iter().flatten().collect()
}

/// Shots alike in precision and in the shape of their chains, as many together
/// as there are lanes.
fn blocks(shots: &[Shot<'_>], ready: &[usize]) -> Vec<Vec<usize>> {
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    // The last block of each kind.
    let mut open: Vec<usize> = Vec::new();
    for &shot in ready {
        let fired = &shots[shot];
        let alike = |at: &&mut usize| {
            let first = &shots[blocks[**at][0]];
            first.precision == fired.precision && first.system.has_shape_of(fired.system)
        };
        match open.iter_mut().find(alike) {
            Some(at) if blocks[*at].len() < fired.precision.lanes() => {
                blocks[*at].push(shot);
                continue;
            }
            Some(at) => *at = blocks.len(),
            None => open.push(blocks.len()),
        }
        blocks.push(vec![shot]);
    }
    blocks
}

fn check(shot: &Shot<'_>, settings: &Settings) -> Result<(), SolveError> {
    let setting = |what, value: f64| match value > 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(SolveError::Setting { what, value }),
    };
    setting("step in contact times", shot.step)?;
    setting("duration in s", shot.duration_s)?;
    let system = shot.system;
    if system.motion.is_some() {
        let why = "a driven end cannot be followed with equal steps";
        return Err(SolveError::Refused(why.to_owned()));
    }
    if system.has_states {
        let why = "a law whose contacts have a state, as film_entrained, needs the wave loop";
        return Err(SolveError::Refused(why.to_owned()));
    }
    if !system.bridged.is_empty() {
        let why = "a liquid bridge needs the wave loop";
        return Err(SolveError::Refused(why.to_owned()));
    }
    let missing = settings.sensors.iter().find(|sensor| !system.has(**sensor));
    missing
        .map_or(Ok(()), |sensor| Err(SolveError::Refused(format!("the chain has no {sensor:?}"))))
}

#[derive(Clone, Debug)]
struct Lane {
    passing: Passing,
    last_step: usize,
    velocity_m_s: Vec<f64>,
    state: LaneState,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum LaneState {
    Flying,
    Finished { step: usize, early: bool },
    Failed { step: usize },
    BrokenOff { step: usize },
    TooLong { step: usize },
}

/// Fires alike shots, one or up to `W`.
fn fire_block<N: Number<W>, const W: usize>(
    shots: &[Shot<'_>],
    settings: &Settings,
    wanted: &dyn Fn() -> bool,
    keep: &mut dyn FnMut(usize, Result<LaneResult, SolveError>),
) {
    let schedule = Schedule::shared();
    // One shot runs alone; several fill the lanes, the last ones idly.
    let lanes = if shots.len() == 1 { 1 } else { W };
    let of = |lane: usize| &shots[lane.min(shots.len() - 1)];
    let fired: Vec<&System> = (0..lanes).map(|lane| of(lane).system).collect();
    let steps_s: Vec<f64> = (0..lanes).map(|lane| of(lane).step_s()).collect();
    let begun = shots.iter().map(|shot| {
        let last_step = last_step(shot.duration_s, shot.step_s());
        let least = least_n_s(shot.system) / shot.step_s();
        Lane::new(last_step, shot.system.bodies(), least)
    });
    let mut flying: Vec<Lane> = begun.collect();
    let most = flying.iter().map(|lane| lane.last_step).max().unwrap_or(0);
    let mut recorder = Recorder::<N, W>::new(&settings.sensors, lanes, most.min(RESERVED));
    let mut block = Block::new(
        &fired,
        &steps_s,
        schedule,
        settings.set,
        (settings.whole_chain, settings.openings),
    );
    let ends = (settings, wanted);
    fly(&mut block, &mut recorder, &mut flying, ends, &fired);
    let looked_at = block.bodies_looked_at / lanes as u64;
    let extremes = |sensor| recorder.extremes(sensor, settings.set);
    let extremes: Vec<Vec<Vec<usize>>> = (0..settings.sensors.len()).map(extremes).collect();
    for (at, lane) in flying.into_iter().enumerate() {
        let clock = Clock { schedule, step_s: steps_s[at], step: shots[at].step };
        let signals = settings.sensors.iter().enumerate().map(|(index, &sensor)| {
            let trace = LaneTrace {
                samples: recorder.samples(index, at),
                last_step: lane.ended(),
                clock,
                silent: fired[at].silence(sensor),
                least_n_s: least_n_s(fired[at]),
            };
            trace.signal(sensor, &extremes[index][at], settings.shapes)
        });
        let signals = signals.collect();
        let at_wall_n = match recorder.sensors() {
            0 => 0.0,
            _ => lane.passing.at_wall_n(recorder.samples(0, at)),
        };
        keep(at, lane.result(signals, clock, (looked_at, at_wall_n)));
    }
}

/// Steps until a duration is over, at the next look.
fn last_step(duration_s: f64, step_s: f64) -> usize {
    let steps = (duration_s / step_s).min(1e15).ceil() as usize + LOOK_EVERY;
    steps.next_multiple_of(LOOK_EVERY)
}

/// Steps until every lane has come to its end. Nothing is allocated here.
fn fly<N: Number<W>, const W: usize>(
    block: &mut Block<'_, N, W>,
    recorder: &mut Recorder<N, W>,
    lanes: &mut [Lane],
    (settings, wanted): (&Settings, &dyn Fn() -> bool),
    systems: &[&System],
) {
    let leaves = settings.end == End::Passed && systems.iter().all(|s| s.flies_free());
    let (count, contacts) = (systems.len(), systems[0].contacts());
    let mut behind = leaves.then(|| Behind::new(count, contacts, &settings.sensors));
    while lanes.iter().any(|lane| lane.state == LaneState::Flying) {
        if !wanted() {
            lanes.iter_mut().for_each(|lane| lane.break_off(block.steps));
            return;
        }
        dispatch!(settings.set.level(), simd => simd.vectorize(
            #[inline(always)]
            || {
                for _ in 0..LOOK_EVERY {
                    block.step(simd);
                    recorder.add(block);
                }
                recorder.look(simd, LOOK_EVERY);
            }
        ));
        if block.steps.is_multiple_of(CORRECTION_EVERY) {
            let corrections = block.corrections();
            for ((lane, correction), system) in lanes.iter_mut().zip(corrections).zip(systems) {
                lane.check(block.steps, correction / system.scales().speed_m_s);
            }
        }
        for (at, lane) in lanes.iter_mut().enumerate() {
            if lane.state == LaneState::Flying {
                lane.look(block, recorder, at, settings.end, systems[at]);
                lane.give_up(block, at);
            }
        }
        if let Some(behind) = &mut behind {
            block.leave_behind(behind);
        }
        block.look(LOOK_EVERY);
    }
}

impl Lane {
    fn new(last_step: usize, bodies: usize, least: f64) -> Self {
        Self {
            passing: Passing::new(least),
            last_step,
            velocity_m_s: Vec::with_capacity(bodies),
            state: LaneState::Flying,
        }
    }

    /// Gives up where a step corrects too much, or by what is no number.
    fn check(&mut self, step: usize, correction: f64) {
        let is_small = correction <= MOST_CORRECTION;
        if self.state == LaneState::Flying && !is_small {
            self.state = LaneState::Failed { step };
        }
    }

    fn break_off(&mut self, step: usize) {
        if self.state == LaneState::Flying {
            self.state = LaneState::BrokenOff { step };
        }
    }

    fn look<N: Number<W>, const W: usize>(
        &mut self,
        block: &Block<'_, N, W>,
        recorder: &Recorder<N, W>,
        at: usize,
        end: End,
        system: &System,
    ) {
        let step = block.steps;
        let early = recorder.sensors() > 1 && {
            let (sensor, wall) = (recorder.samples(0, at), recorder.samples(1, at));
            self.passing.look(sensor, wall, step);
            self.passing.is_over(end, system.scales().silent_force_n)
        };
        if early || step >= self.last_step {
            self.velocity_m_s.extend(block.velocities(at));
            self.state = LaneState::Finished { step, early };
        }
    }

    /// Gives up what takes too many steps: at once where bodies only fly until then.
    fn give_up<N: Number<W>, const W: usize>(&mut self, block: &Block<'_, N, W>, at: usize) {
        let step = block.steps;
        if self.last_step <= MOST_STEPS || self.state != LaneState::Flying {
            return;
        }
        let look = step.is_multiple_of(LOOK_EVERY << 8);
        if step >= MOST_STEPS || look && block.fly_for(at) > MOST_STEPS as f64 {
            self.state = LaneState::TooLong { step };
        }
    }

    /// Step at which the lane came to its end.
    fn ended(&self) -> usize {
        match self.state {
            LaneState::Finished { step, .. }
            | LaneState::Failed { step }
            | LaneState::BrokenOff { step }
            | LaneState::TooLong { step } => step,
            LaneState::Flying => self.last_step,
        }
    }

    fn result(
        self,
        signals: Vec<Signal>,
        clock: Clock<'_>,
        (looked_at, at_wall_n): (u64, f64),
    ) -> Result<LaneResult, SolveError> {
        let (step, finished) = match self.state {
            LaneState::Finished { step, early } => (step, early),
            LaneState::Flying => (self.last_step, false),
            LaneState::Failed { step } => return Err(diverged(clock, step)),
            LaneState::BrokenOff { .. } => return Err(SolveError::BrokenOff),
            LaneState::TooLong { step } => {
                let time_s = clock.time_s(step);
                let why = format!(
                    "a batch keeps {MOST_STEPS} steps of a shot, and this one, at t = {time_s:e} s, takes more"
                );
                return Err(SolveError::TooManySteps { time_s, why });
            }
        };
        if !self.velocity_m_s.iter().all(|v| v.is_finite()) {
            return Err(diverged(clock, step));
        }
        let bodies = self.velocity_m_s.len() as u64;
        Ok(LaneResult {
            signals,
            time_s: clock.time_s(step),
            finished,
            velocity_m_s: self.velocity_m_s,
            step_s: clock.step_s,
            at_wall_n,
            work: Work {
                force_passes: step as u64 + 1,
                steps: step as u64,
                bodies_passed: (step as u64 + 1) * bodies,
                ..Work::default()
            },
            bodies_looked_at: looked_at,
        })
    }
}

fn diverged(clock: Clock<'_>, step: usize) -> SolveError {
    SolveError::Diverged(format!(
        "the step of {:e} s is too long for this chain: at t = {:e} s it corrects a velocity by more than {:.0} % of \
         the shot's speed",
        clock.step_s,
        clock.time_s(step),
        100.0 * MOST_CORRECTION
    ))
}
